#include "sardf/shapes_contour.hpp"

#include <algorithm>
#include <cmath>

#include "sardf/arithmetic.hpp"
#include "sardf/ops_domain.hpp"
#include "sardf/ops_plane.hpp"
#include "sardf/short_number.hpp"

namespace sardf {

namespace {

/// A formula of a contour that runs counter-clockwise.
class LineFormula {
 public:
  LineFormula(const Contour& contour, const Blend& blend) : contour_(contour), blend_(blend) {}

  Expression whole() const {
    std::vector<size_t> all(contour_.size());
    for (size_t i = 0; i < all.size(); ++i) all[i] = i;
    std::vector<size_t> hull = on_hull(all);
    hull.push_back(hull.front() + contour_.size());
    return joined(hull, blend_.intersection, blend_.unite);
  }

 private:
  // The parts between consecutive corners, folded from the left. `inside` joins within a part.
  Expression joined(const std::vector<size_t>& corners, const OperationPointer& join,
                    const OperationPointer& inside) const {
    Expression result;
    for (size_t k = 0; k + 1 < corners.size(); ++k) {
      const Expression part = chain(corners[k], corners[k + 1], inside, join);
      result = result ? call(join, {result, part}) : part;
    }
    return result;
  }

  // The corners from first to last, which are beyond the contour's size after its end.
  Expression chain(size_t first, size_t last, const OperationPointer& join,
                   const OperationPointer& inside) const {
    if (last == first + 1) return line(first);
    std::vector<size_t> run;
    for (size_t i = first; i <= last; ++i) run.push_back(i);
    const std::vector<size_t> hull = on_hull(run);
    // A straight run has no hull: its edges lie on one line.
    return joined(hull.size() < 3 ? run : hull, join, inside);
  }

  Expression line(size_t edge) const {
    const Vec2 &a = corner(edge), &b = corner(edge + 1);
    HalfPlane left;
    left.point = a;
    left.normal = {a[1] - b[1], b[0] - a[0]};
    return call(make_operation(left), {coordinate(0), coordinate(1)});
  }

  const Vec2& corner(size_t i) const { return contour_[i % contour_.size()]; }

  // Those of the corners that are corners of their convex hull, in the order given
  // (Andrew's monotone chain).
  std::vector<size_t> on_hull(const std::vector<size_t>& corners) const {
    std::vector<size_t> sorted = corners;
    std::sort(sorted.begin(), sorted.end(),
              [this](size_t i, size_t j) { return corner(i) < corner(j); });
    std::vector<size_t> kept;
    const auto add_half = [&](auto begin, auto end) {
      std::vector<size_t> half;
      for (auto at = begin; at != end; ++at) {
        while (half.size() > 1 &&
               cross(corner(half[half.size() - 2]), corner(half.back()), corner(*at)) <= 0) {
          half.pop_back();
        }
        half.push_back(*at);
      }
      kept.insert(kept.end(), half.begin(), half.end());
    };
    add_half(sorted.begin(), sorted.end());
    add_half(sorted.rbegin(), sorted.rend());
    std::sort(kept.begin(), kept.end());
    std::vector<size_t> hull;
    for (const size_t i : corners) {
      if (std::binary_search(kept.begin(), kept.end(), i)) hull.push_back(i);
    }
    return hull;
  }

  const Contour& contour_;
  const Blend& blend_;
};

}  // namespace

Expression ImplicitPolygon::expression() const {
  check_contour(vertices, "implicit polygon");
  if (doubled_area(vertices) > 0) return LineFormula(vertices, *blend).whole();
  const Contour turned(vertices.rbegin(), vertices.rend());
  return LineFormula(turned, *blend).whole();
}

namespace {

void check_sections(const std::vector<PlaneSection>& sections) {
  for (size_t i = 0; i < sections.size(); ++i) {
    const std::string which = "section " + std::to_string(i + 1);
    if (sections[i].field.expression()->coordinates & 4) {
      throw Error("the field of " + which +
                  " depends on z; a field of x and y alone is accepted here");
    }
    if (i == 0 || sections[i - 1].z < sections[i].z) continue;
    const bool same = sections[i - 1].z == sections[i].z;
    throw Error(which + " is at z = " + short_number(sections[i].z, 6) +
                (same ? ", where section " : ", below section ") + std::to_string(i) +
                (same ? " is: the contours would cross" : ": the sides would cross") +
                "; heights must rise");
  }
}

// The share of the way from section i to the next; below and above it the ends go on.
Expression share(const std::vector<PlaneSection>& sections, size_t i) {
  const double from = sections[i].z, to = sections[i + 1].z;
  return function(
      "clamp", {(coordinate(2) - constant(from)) / constant(to - from), constant(0), constant(1)});
}

Expression value(const std::vector<PlaneSection>& sections, size_t i) {
  return sections[i].field.expression();
}

Expression chord(const std::vector<PlaneSection>& sections, size_t i) {
  return (value(sections, i + 1) - value(sections, i)) /
         constant(sections[i + 1].z - sections[i].z);
}

// The argument nearest to 0 where all have one sign, else 0.
Expression least_change(const Expression& a, const Expression& b, const Expression& c) {
  const Expression zero = constant(0);
  return max(zero, min(a, min(b, c))) + min(zero, max(a, max(b, c)));
}

// The field's rate of change by height at a section: the parabola's through it and its neighbours,
// limited to twice each chord's so that the cubics on both sides rise or fall throughout.
Expression rate(const std::vector<PlaneSection>& sections, size_t i) {
  if (i == 0) return chord(sections, 0);
  if (i + 1 == sections.size()) return chord(sections, i - 1);
  const double below = sections[i].z - sections[i - 1].z, above = sections[i + 1].z - sections[i].z;
  const Expression before = chord(sections, i - 1), after = chord(sections, i);
  const Expression parabola =
      constant(above / (below + above)) * before + constant(below / (below + above)) * after;
  return least_change(parabola, constant(2) * before, constant(2) * after);
}

// Says what is true of any interpolation that rises or falls throughout; without it intervals could
// not tell that a loft ends somewhere.
Expression between(const Expression& interpolated, const Expression& a, const Expression& b) {
  return max(min(a, b), min(max(a, b), interpolated));
}

Expression linear(const std::vector<PlaneSection>& sections, size_t i) {
  return function("mix", {value(sections, i), value(sections, i + 1), share(sections, i)});
}

// Hermite's cubic as the straight part plus what bends away from it, which vanishes at both ends.
Expression cubic(const std::vector<PlaneSection>& sections, size_t i) {
  const Expression t = share(sections, i), rest = constant(1) - t, straight = chord(sections, i);
  const Expression start = rate(sections, i) - straight, end = straight - rate(sections, i + 1);
  const double height = sections[i + 1].z - sections[i].z;
  return linear(sections, i) + constant(height) * (t * rest) * (rest * start + t * end);
}

}  // namespace

Expression Loft::expression() const {
  check_sections(sections);
  if (interpolation != "smooth" && interpolation != "linear") {
    throw Error("interpolation is '" + interpolation + "'; accepted are 'smooth' and 'linear'" +
                did_you_mean(interpolation, {"smooth", "linear"}));
  }
  const bool smooth = interpolation == "smooth" && sections.size() > 2;
  Expression side;
  for (size_t i = sections.size() - 1; i-- > 0;) {
    const Expression slab = between(smooth ? cubic(sections, i) : linear(sections, i),
                                    value(sections, i), value(sections, i + 1));
    Below below;
    below.height = sections[i + 1].z;
    side = side ? call(make_operation(below), {coordinate(2), slab, side}) : slab;
  }
  const double bottom = sections.front().z, top = sections.back().z;
  const Expression caps =
      constant(0.5 * (top - bottom)) - abs(coordinate(2) - constant(0.5 * (bottom + top)));
  return min(side, caps);
}

}  // namespace sardf

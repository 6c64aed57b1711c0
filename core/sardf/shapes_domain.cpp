#include "sardf/shapes_domain.hpp"

#include <numbers>

#include "sardf/arithmetic.hpp"
#include "sardf/bounds.hpp"
#include "sardf/evaluate.hpp"
#include "sardf/frame.hpp"
#include "sardf/ops_domain.hpp"

namespace sardf {

namespace {

constexpr int most_copies = 4096;

std::array<Expression, 3> xyz() { return {coordinate(0), coordinate(1), coordinate(2)}; }

// The copies along one axis; 0: without end.
std::array<int, 3> checked_counts(const Repeat& repeat) {
  std::array<int, 3> counts{1, 1, 1};
  double all = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const std::string name = std::string("along ") + char('x' + axis);
    const bool steps = repeat.spacing[axis] > 0;
    if (!repeat.counts) {
      counts[axis] = steps ? 0 : 1;
      continue;
    }
    const double n = (*repeat.counts)[axis];
    all *= n;
    if (!(n >= 1) || n != std::floor(n) || n > most_copies || all > most_copies) {
      throw Error("counts " + name +
                  " is not accepted; whole numbers from 1 are, whose product is " +
                  std::to_string(most_copies) + " at most");
    }
    if (n > 1 && !steps) throw Error("there are several copies " + name + " but the spacing is 0");
    counts[axis] = int(n);
  }
  return counts;
}

// The middle of the solid, from which it is tried to prove that it fits between its neighbours.
Vec3 middle(const Field& field) {
  const Evaluator evaluator(field.expression());
  // A feature's distance is negative nowhere: a search for its bounds would look everywhere.
  const Vec3 ends{infinity, infinity, infinity};
  if (evaluator.interval({-1.0 * ends, ends}).lo >= 0) return {};
  try {
    return certified_bounds(evaluator).center();
  } catch (const Error&) {
    return {};  // unbounded along an axis without steps, say
  }
}

// Whether the solid is proven to lie within half a step of its middle along each repeated axis:
// then the nearest two copies along each axis hold the nearest point of all.
bool fits(const Repeat& repeat, const Vec3& center) {
  const Evaluator evaluator(repeat.field.expression());
  for (int axis = 0; axis < 3; ++axis) {
    if (repeat.spacing[axis] == 0) continue;
    BoundingBox low{{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}}, high = low;
    low.hi[axis] = center[axis] - 0.5 * repeat.spacing[axis];
    high.lo[axis] = center[axis] + 0.5 * repeat.spacing[axis];
    if (evaluator.interval(low).hi > 0 || evaluator.interval(high).hi > 0) return false;
  }
  return true;
}

struct Plan {
  std::array<int, 3> counts;
  Vec3 center;
  bool stays_distance;
};

Plan plan(const Repeat& repeat) {
  const std::array<int, 3> counts = checked_counts(repeat);
  const bool exact = repeat.field.quality().outside == Exactness::exact;
  const bool endless = counts[0] * counts[1] * counts[2] == 0;
  if (!exact && !endless) return {counts, {}, false};  // all copies will be evaluated
  const Vec3 center = middle(repeat.field);
  return {counts, center, exact && fits(repeat, center)};
}

Expression largest(const std::vector<Expression>& all) {
  Expression most = all[0];
  for (size_t i = 1; i < all.size(); ++i) most = max(most, all[i]);
  return most;
}

// Every copy.
Expression listed(const Repeat& repeat, const std::array<int, 3>& counts) {
  std::vector<Expression> copies;
  for (int i = 0; i < counts[0]; ++i) {
    for (int j = 0; j < counts[1]; ++j) {
      for (int k = 0; k < counts[2]; ++k) {
        const Vec3 at{i * repeat.spacing[0], j * repeat.spacing[1], k * repeat.spacing[2]};
        std::array<Expression, 3> moved;
        for (int axis = 0; axis < 3; ++axis) {
          Vec3 row{};
          row[axis] = 1;
          moved[axis] = affine(xyz(), row, -at[axis]);
        }
        copies.push_back(substitute(repeat.field.expression(), moved));
      }
    }
  }
  return largest(copies);
}

// The nearest two copies along each axis.
Expression nearest(const Repeat& repeat, const Plan& plan) {
  std::vector<Expression> copies;
  for (int corner = 0; corner < 8; ++corner) {
    std::array<Expression, 3> local = xyz();
    bool twice = false;
    for (int axis = 0; axis < 3; ++axis) {
      const int upper = corner >> axis & 1;
      if (repeat.spacing[axis] == 0) {
        twice = twice || upper;
        continue;
      }
      CopyCoordinate copy;
      copy.spacing = repeat.spacing[axis];
      copy.center = plan.center[axis];
      copy.upper = upper;
      copy.last = plan.counts[axis] - 1;
      copy.jumps = !plan.stays_distance;
      local[axis] = call(make_operation(copy), {coordinate(axis)});
    }
    if (!twice) copies.push_back(substitute(repeat.field.expression(), local));
  }
  return largest(copies);
}

}  // namespace

Expression Repeat::expression() const {
  const Plan how = plan(*this);
  const int all = how.counts[0] * how.counts[1] * how.counts[2];
  // Few copies, or copies of which the nearest may not be among two, are all evaluated.
  if (all > 0 && (all <= 8 || !how.stays_distance)) return listed(*this, how.counts);
  return nearest(*this, how);
}

Quality Repeat::quality() const {
  const Plan how = plan(*this);
  if (how.stays_distance) return field.quality();
  const bool all_evaluated = how.counts[0] * how.counts[1] * how.counts[2] > 0;
  if (!all_evaluated) return {};
  // As the union by max of all copies.
  const Quality q = field.quality();
  return {std::max(Exactness::bound, q.inside), q.outside};
}

Expression Twist::expression() const {
  Frame frame;
  frame.set(center, axis);
  const std::array<Vec3, 3> rows = frame.rows();
  std::array<Expression, 3> local;
  for (int i = 0; i < 3; ++i) local[i] = affine(xyz(), rows[i], -dot(rows[i], center));
  const Expression angle = constant(rate * std::numbers::pi / 180) * local[2];
  const Expression c = function("cos", {angle}), s = function("sin", {angle});
  const Expression u = c * local[0] + s * local[1], v = c * local[1] - s * local[0];
  std::array<Expression, 3> back;
  for (int i = 0; i < 3; ++i) {
    back[i] = constant(rows[0][i]) * u + constant(rows[1][i]) * v +
              constant(rows[2][i]) * local[2] + constant(center[i]);
  }
  return substitute(field.expression(), back);
}

Expression Bend::expression() const {
  const Expression x = coordinate(0), down = constant(radius) - coordinate(2);
  const Expression along = constant(radius) * function("atan2", {x, down});
  return substitute(field.expression(), {along, coordinate(1), constant(radius) - length(x, down)});
}

}  // namespace sardf

#include "sardf/surface_search.hpp"

#include <algorithm>

#include "sardf/numbers/interval.hpp"

namespace sardf {

namespace {

// After so many halvings in each direction a patch is smaller than the rounding of coordinates.
constexpr int deepest = 96;
constexpr double polish_within = 1e-5;

double product(const Weighted& a, const Weighted& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// A patch's parameters within the one that is searched.
struct Range {
  Vec2 from{0, 0}, to{1, 1};
  Vec2 at(const Vec2& x) const {
    return {from[0] + x[0] * (to[0] - from[0]), from[1] + x[1] * (to[1] - from[1])};
  }
};

/// Bounds of the second derivatives of g: g_uu >= a, g_vv >= b, |g_uv| <= m.
struct Curvature {
  double a = 0, b = 0, m = 0;
  bool is_convex() const { return a > 0 && b > 0 && a * b > m * m; }
  /// The most that a function can fall below its value where its slopes are these.
  double fall(double u, double v) const {
    return (b * u * u + a * v * v + 2 * m * std::abs(u * v)) / (2 * (a * b - m * m));
  }
};

/// Memory of a search, kept between searches.
struct Scratch {
  std::vector<Weighted> patches;  // two for each level
  std::vector<double> squares, weights, g;
  std::vector<Weighted> scaled;
};

class PatchPart {
 public:
  PatchPart(SurfaceSearch& search, size_t patch, PatchDegrees degrees, Scratch& scratch)
      : search_(search), patch_(patch), degrees_(degrees), scratch_(scratch) {}
  void visit(const Weighted* points, const Range& range, int depth);

 private:
  const Weighted& corner(const Weighted* points, int k) const {
    return points[size_t((k & 1 ? degrees_.u : 0) * (degrees_.v + 1) + (k & 2 ? degrees_.v : 0))];
  }
  bool is_beyond_plane(const Weighted* points, double distance) const;
  void set_coefficients(const Weighted* points);
  bool may_be_nearer(double distance);
  Curvature curvature() const;
  Vec2 start() const;
  Vec2 minimum(const Weighted* points, Vec2 x) const;
  bool is_minimum(const Weighted* points, const Vec2& x);
  void split(const Weighted* points, const Range& range, const Vec2& x, int depth);
  double size_along(const Weighted* points, int axis) const;

  SurfaceSearch& search_;
  size_t patch_;
  PatchDegrees degrees_;
  Scratch& scratch_;
};

bool PatchPart::is_beyond_plane(const Weighted* points, double distance) const {
  Vec3 sight{};
  for (int k = 0; k < 4; ++k) sight = sight + point_of(corner(points, k));
  const double size = norm(sight);
  if (!(size > 0)) return false;
  sight = (1 / size) * sight;
  for (size_t i = 0; i < degrees_.points(); ++i) {
    const Weighted& p = points[i];
    if (p[0] * sight[0] + p[1] * sight[1] + p[2] * sight[2] < distance * p[3]) return false;
  }
  return true;
}

void PatchPart::set_coefficients(const Weighted* points) {
  const int p = degrees_.u, q = degrees_.v;
  const size_t width = size_t(2 * q + 1);
  for (int i = 0; i <= p; ++i) {
    for (int j = 0; j <= q; ++j) {
      const size_t at = size_t(i * (q + 1) + j);
      scratch_.scaled[at] = binomial(p, i) * binomial(q, j) * points[at];
    }
  }
  std::fill(scratch_.squares.begin(), scratch_.squares.end(), 0.0);
  std::fill(scratch_.weights.begin(), scratch_.weights.end(), 0.0);
  for (int i = 0; i <= p; ++i) {
    for (int k = i; k <= p; ++k) {
      const Weighted *a = &scratch_.scaled[size_t(i * (q + 1))],
                     *b = &scratch_.scaled[size_t(k * (q + 1))];
      double *squares = &scratch_.squares[size_t(i + k) * width],
             *weights = &scratch_.weights[size_t(i + k) * width];
      const double times = i == k ? 1 : 2;
      for (int j = 0; j <= q; ++j) {
        const Weighted left = times * a[j];
        for (int l = 0; l <= q; ++l) {
          squares[j + l] += product(left, b[l]);
          weights[j + l] += left[3] * b[l][3];
        }
      }
    }
  }
  for (int k = 0; k <= 2 * p; ++k) {
    for (int l = 0; l <= 2 * q; ++l) {
      const size_t at = size_t(k) * width + size_t(l);
      const double inverse = 1 / (binomial(2 * p, k) * binomial(2 * q, l));
      scratch_.squares[at] *= inverse;
      scratch_.weights[at] *= inverse;
    }
  }
}

bool PatchPart::may_be_nearer(double distance) {
  const double threshold = distance * distance;
  double least = infinity;
  for (size_t k = 0; k < scratch_.g.size(); ++k) {
    scratch_.g[k] = scratch_.squares[k] - threshold * scratch_.weights[k];
    least = min(least, scratch_.g[k]);
  }
  return least < 0;
}

Curvature PatchPart::curvature() const {
  const size_t rows = size_t(2 * degrees_.u + 1), columns = size_t(2 * degrees_.v + 1);
  const double rounding =
      64 * 0x1p-52 * *std::max_element(scratch_.squares.begin(), scratch_.squares.end());
  Curvature bound{infinity, infinity, 0};
  const auto g = [&](size_t k, size_t l) { return scratch_.g[k * columns + l]; };
  for (size_t k = 0; k < rows; ++k) {
    for (size_t l = 0; l < columns; ++l) {
      if (k + 2 < rows) bound.a = min(bound.a, g(k + 2, l) - 2 * g(k + 1, l) + g(k, l));
      if (l + 2 < columns) bound.b = min(bound.b, g(k, l + 2) - 2 * g(k, l + 1) + g(k, l));
      if (k + 1 < rows && l + 1 < columns) {
        const double mixed = (g(k + 1, l + 1) - g(k + 1, l)) - (g(k, l + 1) - g(k, l));
        bound.m = max(bound.m, std::abs(mixed));
      }
    }
  }
  const double p = 2 * degrees_.u, q = 2 * degrees_.v;
  return {p * (p - 1) * (bound.a - rounding), q * (q - 1) * (bound.b - rounding),
          p * q * (bound.m + rounding)};
}

Vec2 PatchPart::start() const {
  const auto least = std::min_element(scratch_.g.begin(), scratch_.g.end());
  const int at = int(least - scratch_.g.begin()), width = 2 * degrees_.v + 1;
  return {double(at / width) / (2 * degrees_.u), double(at % width) / (2 * degrees_.v)};
}

// Where the squared distance bends by less than this share of what it would on a plane, all points
// in this direction are about as near: a step there would follow rounding.
constexpr double least_bend = 1e-7;

/// A step towards the minimum of half the squared distance over the square [0, 1]².
struct Step {
  Vec2 by{};
  bool is_done = false;

  Step(const SurfacePoint& p, const Vec2& x) {
    const Vec2 slope{dot(p.at, p.u), dot(p.at, p.v)};
    const Vec2 flat{dot(p.u, p.u), dot(p.v, p.v)};
    const Vec2 rise{flat[0] + dot(p.at, p.uu), flat[1] + dot(p.at, p.vv)};
    const double mixed = dot(p.u, p.v) + dot(p.at, p.uv);
    std::array<bool, 2> fixed;
    for (size_t k = 0; k < 2; ++k) {
      fixed[k] = std::abs(rise[k]) < least_bend * flat[k] || (x[k] == 0 && slope[k] >= 0) ||
                 (x[k] == 1 && slope[k] <= 0);
      const double by_rise = rise[k] > 0 ? rise[k] : flat[k];
      by[k] = fixed[k] || by_rise == 0 ? 0 : -slope[k] / by_rise;
    }
    const double determinant = rise[0] * rise[1] - mixed * mixed;
    if (!fixed[0] && !fixed[1] && rise[0] > 0 && determinant > 1e-14 * rise[0] * rise[1]) {
      by = {(mixed * slope[1] - rise[1] * slope[0]) / determinant,
            (mixed * slope[0] - rise[0] * slope[1]) / determinant};
    }
    is_done = by == Vec2{};
  }
};

Vec2 PatchPart::minimum(const Weighted* points, Vec2 x) const {
  SurfacePoint p = surface_point(points, degrees_, x, {});
  for (int step = 0; step < 30; ++step) {
    Step next(p, x);
    if (next.is_done) break;
    Vec2 to = x;
    for (int half = 0; half < 8; ++half) {
      for (size_t k = 0; k < 2; ++k) to[k] = std::clamp(x[k] + next.by[k], 0.0, 1.0);
      const SurfacePoint there = surface_point(points, degrees_, to, {});
      const double moved = max(std::abs(to[0] - x[0]), std::abs(to[1] - x[1]));
      // Near the end rounding hides whether the distance falls.
      if (moved < 1e-6 || dot(there.at, there.at) < dot(p.at, p.at)) {
        p = there;
        break;
      }
      next.by = {0.5 * next.by[0], 0.5 * next.by[1]};
      to = x;
    }
    const double moved = max(std::abs(to[0] - x[0]), std::abs(to[1] - x[1]));
    x = to;
    // The next step would move by about the square of this one.
    if (moved < 1e-9) break;
  }
  return x;
}

/// A patch's point with first derivatives, weights included.
struct PatchJet {
  Weighted at, u, v, uu, uv, vv;
};

PatchJet patch_jet(const Weighted* points, PatchDegrees degrees, const Vec2& x) {
  const Bernstein along_u(degrees.u, x[0]), along_v(degrees.v, x[1]);
  std::array<Weighted, most_degree + 1> at, first, second;
  for (size_t i = 0; i <= size_t(degrees.u); ++i) {
    const Jet row = jet_of(points + i * size_t(degrees.v + 1), along_v);
    at[i] = row.at;
    first[i] = row.first;
    second[i] = row.second;
  }
  const Jet by_u = jet_of(at.data(), along_u), mixed = jet_of(first.data(), along_u);
  return {by_u.at,     by_u.first,  mixed.at,
          by_u.second, mixed.first, jet_of(second.data(), along_u).at};
}

bool PatchPart::is_minimum(const Weighted* points, const Vec2& x) {
  const Curvature bound = curvature();
  if (!bound.is_convex()) return false;
  const PatchJet jet = patch_jet(points, degrees_, x);
  const double distance = search_.distance_threshold(), threshold = distance * distance;
  Vec2 slope{2 * (product(jet.at, jet.u) - threshold * jet.at[3] * jet.u[3]),
             2 * (product(jet.at, jet.v) - threshold * jet.at[3] * jet.v[3])};
  for (size_t k = 0; k < 2; ++k) {
    // At an edge towards which g falls it is least there.
    if ((x[k] == 0 && slope[k] > 0) || (x[k] == 1 && slope[k] < 0)) slope[k] = 0;
  }
  const double g = product(jet.at, jet.at) - threshold * jet.at[3] * jet.at[3];
  return g - bound.fall(slope[0], slope[1]) >= 0;
}

double PatchPart::size_along(const Weighted* points, int axis) const {
  const size_t width = size_t(degrees_.v + 1), stride = axis == 0 ? width : 1;
  const size_t rows = size_t(degrees_.u + (axis == 0 ? 0 : 1));
  const size_t columns = width - (axis == 0 ? 0 : 1);
  double most = 0;
  for (size_t i = 0; i < rows; ++i) {
    for (size_t j = 0; j < columns; ++j) {
      const Weighted* p = points + i * width + j;
      const Vec3 step = point_of(p[stride]) - point_of(*p);
      most = max(most, dot(step, step));
    }
  }
  return std::sqrt(most) * (axis == 0 ? degrees_.u : degrees_.v);
}

void PatchPart::split(const Weighted* points, const Range& range, const Vec2& x, int depth) {
  int axis = size_along(points, 0) >= size_along(points, 1) ? 0 : 1;
  const SurfacePoint p = surface_point(points, degrees_, x, {});
  const auto is_inside = [&](size_t k) { return x[k] > 0 && x[k] < 1; };
  const bool bends_u = dot(p.u, p.u) * least_bend < std::abs(dot(p.u, p.u) + dot(p.at, p.uu));
  const bool bends_v = dot(p.v, p.v) * least_bend < std::abs(dot(p.v, p.v) + dot(p.at, p.vv));
  if (bends_u && !bends_v && is_inside(0)) axis = 0;
  if (bends_v && !bends_u && is_inside(1)) axis = 1;
  const size_t k = size_t(axis);
  const double t =
      is_inside(k) && (bends_u != bends_v || (x[k] > 0.05 && x[k] < 0.95)) ? x[k] : 0.5;
  Weighted* left = &scratch_.patches[size_t(2 * depth) * degrees_.points()];
  Weighted* right = left + degrees_.points();
  split_patch(points, degrees_, axis, t, left, right);
  Range low = range, high = range;
  low.to[k] = high.from[k] = range.at(Vec2{t, t})[k];
  if (x[k] < t) {
    visit(left, low, depth + 1);
    visit(right, high, depth + 1);
  } else {
    visit(right, high, depth + 1);
    visit(left, low, depth + 1);
  }
}

void PatchPart::visit(const Weighted* points, const Range& range, int depth) {
  for (int k = 0; k < 4; ++k) {
    const Weighted& p = corner(points, k);
    search_.note(product(p, p) / (p[3] * p[3]), patch_,
                 range.at({k & 1 ? 1.0 : 0.0, k & 2 ? 1.0 : 0.0}), false);
  }
  // Within the tolerance the distance is known, but not yet which of two patches has the minimum.
  const double distance = depth == 0 ? search_.tight_threshold() : search_.distance_threshold();
  if (is_beyond_plane(points, distance)) return;
  set_coefficients(points);
  if (!may_be_nearer(distance)) return;
  const Vec2 x = minimum(points, start());
  const Weighted there = patch_jet(points, degrees_, x).at;
  const bool is_inside = x[0] > 0 && x[0] < 1 && x[1] > 0 && x[1] < 1;
  search_.note(product(there, there) / (there[3] * there[3]), patch_, range.at(x), is_inside);
  if (!may_be_nearer(search_.distance_threshold()) || is_minimum(points, x)) return;
  if (depth < deepest) split(points, range, x, depth);
}

}  // namespace

double SurfaceSearch::tight_threshold() const { return std::sqrt(squared) * (1 - 0x1p-50); }

double SurfaceSearch::distance_threshold() const {
  return max(std::sqrt(squared) * (1 - 1e-13) - 16 * rounding, 0.0);
}

void SurfaceSearch::visit(const Weighted* points, PatchDegrees degrees, size_t patch) {
  thread_local Scratch scratch;
  thread_local std::vector<Weighted> moved;
  const size_t each = degrees.points();
  const size_t coefficients = size_t((2 * degrees.u + 1) * (2 * degrees.v + 1));
  scratch.patches.resize(2 * (deepest + 1) * each);
  scratch.scaled.resize(each);
  scratch.squares.resize(coefficients);
  scratch.weights.resize(coefficients);
  scratch.g.resize(coefficients);
  moved.resize(each);
  for (size_t i = 0; i < each; ++i) {
    const Weighted& p = points[i];
    moved[i] = {p[0] - p[3] * point[0], p[1] - p[3] * point[1], p[2] - p[3] * point[2], p[3]};
  }
  PatchPart(*this, patch, degrees, scratch).visit(moved.data(), {}, 0);
}

void SurfaceSearch::note(double squared_there, size_t patch, const Vec2& at, bool is_minimum) {
  if (!(squared_there < squared * (is_minimum ? 1 + 0x1p-50 : 1))) return;
  squared = min(squared, squared_there);
  part = patch;
  parameters = at;
}

void SurfaceSearch::polish(const Weighted* points, PatchDegrees degrees) {
  const auto is_inside = [](double t) { return t > 0 && t < 1; };
  for (int step = 0; step < 3; ++step) {
    const SurfacePoint p = surface_point(points, degrees, parameters, point);
    const Vec2 slope{dot(p.at, p.u), dot(p.at, p.v)};
    const double uu = dot(p.u, p.u) + dot(p.at, p.uu), vv = dot(p.v, p.v) + dot(p.at, p.vv);
    const double uv = dot(p.u, p.v) + dot(p.at, p.uv), determinant = uu * vv - uv * uv;
    // A parameter on a side stays there.
    Vec2 by{};
    if (is_inside(parameters[0]) && is_inside(parameters[1])) {
      by = {(uv * slope[1] - vv * slope[0]) / determinant,
            (uv * slope[0] - uu * slope[1]) / determinant};
    } else if (is_inside(parameters[0])) {
      by[0] = -slope[0] / uu;
    } else if (is_inside(parameters[1])) {
      by[1] = -slope[1] / vv;
    }
    const Vec2 next{parameters[0] + by[0], parameters[1] + by[1]};
    for (size_t k = 0; k < 2; ++k) {
      if (by[k] != 0 && !(std::abs(by[k]) < polish_within && is_inside(next[k]))) return;
    }
    parameters = next;
  }
}

SurfacePoint surface_point(const Weighted* points, PatchDegrees degrees, const Vec2& at,
                           const Vec3& origin) {
  const PatchJet jet = patch_jet(points, degrees, at);
  const auto relative = [&](const Weighted& a) {
    return Vec3{a[0] - a[3] * origin[0], a[1] - a[3] * origin[1], a[2] - a[3] * origin[2]};
  };
  const double inverse = 1 / jet.at[3];
  SurfacePoint p;
  p.at = inverse * relative(jet.at);
  p.u = inverse * (relative(jet.u) - jet.u[3] * p.at);
  p.v = inverse * (relative(jet.v) - jet.v[3] * p.at);
  p.uu = inverse * (relative(jet.uu) - 2 * jet.u[3] * p.u - jet.uu[3] * p.at);
  p.vv = inverse * (relative(jet.vv) - 2 * jet.v[3] * p.v - jet.vv[3] * p.at);
  p.uv = inverse * (relative(jet.uv) - jet.u[3] * p.v - jet.v[3] * p.u - jet.uv[3] * p.at);
  return p;
}

void split_patch(const Weighted* points, PatchDegrees degrees, int axis, double t, Weighted* left,
                 Weighted* right) {
  const size_t width = size_t(degrees.v + 1);
  if (axis == 0) {
    for (size_t j = 0; j < width; ++j) {
      split_bezier(points + j, degrees.u, width, t, left + j, right + j);
    }
  } else {
    for (size_t i = 0; i <= size_t(degrees.u); ++i) {
      split_bezier(points + i * width, degrees.v, 1, t, left + i * width, right + i * width);
    }
  }
}

}  // namespace sardf

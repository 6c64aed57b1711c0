#include "sardf/curve_search.hpp"

#include <algorithm>

#include "sardf/numbers/interval.hpp"

namespace sardf {

namespace {

constexpr int most_points = most_degree + 1, most_coefficients = 2 * most_degree + 1;
// After so many halvings a piece is shorter than the rounding of its coordinates.
constexpr int deepest = 48;
constexpr double polish_within = 1e-5;

using Points = std::array<Weighted, most_points>;
using Coefficients = std::array<double, most_coefficients>;

Jet jet_at(const Points& points, int degree, double t) {
  return jet_of(points.data(), Bernstein(degree, t));
}

template <bool rational>
CurvePoint projected(const Jet& jet) {
  const auto vector = [](const Weighted& a) { return Vec3{a[0], a[1], a[2]}; };
  CurvePoint p{vector(jet.at), vector(jet.first), vector(jet.second)};
  if constexpr (rational) {
    const double inverse = 1 / jet.at[3];
    p.at = inverse * p.at;
    p.first = inverse * (p.first - jet.first[3] * p.at);
    p.second = inverse * (p.second - 2 * jet.first[3] * p.first - jet.second[3] * p.at);
  }
  return p;
}

double product(const Weighted& a, const Weighted& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// A part of a piece: its points relative to the search's point.
template <bool rational>
class Part {
 public:
  Part(CurveSearch& search, size_t piece, int degree)
      : search_(search), piece_(piece), degree_(degree) {}

  void visit(const Points& points, double from, double to, int depth);

 private:
  double squared_at(const Weighted& at) const {
    return rational ? product(at, at) / (at[3] * at[3]) : product(at, at);
  }
  void set_coefficients(const Points& points);
  /// The coefficients of g for the present threshold; false where none is negative.
  bool may_be_nearer(double threshold);
  /// A bound of g'' from below, 0 where it is within rounding.
  double convexity() const;
  double minimum(const Points& points) const;
  bool is_minimum(const Points& points, double t);

  CurveSearch& search_;
  size_t piece_;
  int degree_;
  Coefficients squares_, weights_, g_;
};

template <bool rational>
void Part<rational>::set_coefficients(const Points& points) {
  const int n = degree_;
  Points scaled;
  for (int i = 0; i <= n; ++i) scaled[size_t(i)] = binomial(n, i) * points[size_t(i)];
  for (int k = 0; k <= 2 * n; ++k) {
    double square = 0, weight = 0;
    for (int i = std::max(0, k - n); 2 * i <= k; ++i) {
      const Weighted &a = scaled[size_t(i)], &b = scaled[size_t(k - i)];
      const double times = 2 * i == k ? 1 : 2;
      square += times * product(a, b);
      if constexpr (rational) weight += times * a[3] * b[3];
    }
    const double inverse = 1 / binomial(2 * n, k);
    squares_[size_t(k)] = square * inverse;
    weights_[size_t(k)] = rational ? weight * inverse : 1;
  }
}

template <bool rational>
bool Part<rational>::may_be_nearer(double threshold) {
  double least = infinity;
  for (size_t k = 0; k <= size_t(2 * degree_); ++k) {
    g_[k] = squares_[k] - threshold * weights_[k];
    least = min(least, g_[k]);
  }
  return least < 0;
}

template <bool rational>
double Part<rational>::convexity() const {
  double least = infinity, most = 0;
  for (size_t k = 0; k + 2 <= size_t(2 * degree_); ++k) {
    least = min(least, (g_[k + 2] - g_[k + 1]) - (g_[k + 1] - g_[k]));
    most = max(most, max(squares_[k], squares_[k + 2]));
  }
  const double rounding = 64 * 0x1p-52 * most;
  return least > rounding ? 2 * degree_ * (2 * degree_ - 1) * (least - rounding) : 0;
}

// The zero of half the derivative of the squared distance, kept between two ends where it has
// different signs.
template <bool rational>
double Part<rational>::minimum(const Points& points) const {
  const auto slope = [](const CurvePoint& p) { return dot(p.at, p.first); };
  const double at_start = slope(projected<rational>(jet_at(points, degree_, 0)));
  if (at_start >= 0) return 0;
  const double at_end = slope(projected<rational>(jet_at(points, degree_, 1)));
  if (at_end <= 0) return 1;
  double low = 0, high = 1, t = at_start / (at_start - at_end);
  for (int step = 0; step < 60; ++step) {
    const CurvePoint p = projected<rational>(jet_at(points, degree_, t));
    const double f = slope(p), rise = dot(p.first, p.first) + dot(p.at, p.second);
    (f < 0 ? low : high) = t;
    double next = t - f / rise;
    if (!(rise > 0 && next >= low && next <= high)) next = 0.5 * (low + high);
    const double moved = std::abs(next - t);
    t = next;
    // The next step would move by about the square of this one.
    if (moved < 1e-9 && rise > 0) break;
  }
  return t;
}

template <bool rational>
bool Part<rational>::is_minimum(const Points& points, double t) {
  const double a = convexity();
  if (!(a > 0)) return false;
  const Jet jet = jet_at(points, degree_, t);
  const double threshold = search_.threshold(), w = rational ? jet.at[3] : 1;
  double slope = 2 * product(jet.at, jet.first);
  if constexpr (rational) slope -= 2 * threshold * w * jet.first[3];
  // At an end towards which g falls it is least there.
  if ((t == 0 && slope > 0) || (t == 1 && slope < 0)) slope = 0;
  const double g = product(jet.at, jet.at) - threshold * w * w;
  return g - slope * slope / (2 * a) >= 0;
}

template <bool rational>
void Part<rational>::visit(const Points& points, double from, double to, int depth) {
  const double start = squared_at(points[0]), end = squared_at(points[size_t(degree_)]);
  search_.note(start, piece_, from, false);
  search_.note(end, piece_, to, false);
  set_coefficients(points);
  // Within the tolerance the distance is known, but not yet which of two pieces has the minimum.
  if (!may_be_nearer(depth == 0 ? search_.tight_threshold() : search_.threshold())) return;
  if (depth == 0 || convexity() > 0) {
    const double t = minimum(points);
    const double there = squared_at(jet_at(points, degree_, t).at);
    search_.note(there, piece_, from + t * (to - from), t > 0 && t < 1);
    if (!may_be_nearer(search_.threshold()) || is_minimum(points, t)) return;
  }
  if (depth == deepest) return;
  Points left, right;
  split_bezier(points.data(), degree_, 1, 0.5, left.data(), right.data());
  const double middle = 0.5 * (from + to);
  if (start < end) {
    visit(left, from, middle, depth + 1);
    visit(right, middle, to, depth + 1);
  } else {
    visit(right, middle, to, depth + 1);
    visit(left, from, middle, depth + 1);
  }
}

Points relative(const Weighted* points, int degree, const Vec3& origin) {
  Points moved;
  for (size_t i = 0; i <= size_t(degree); ++i) {
    const Weighted& p = points[i];
    moved[i] = {p[0] - p[3] * origin[0], p[1] - p[3] * origin[1], p[2] - p[3] * origin[2], p[3]};
  }
  return moved;
}

}  // namespace

double CurveSearch::threshold() const {
  const double distance = std::sqrt(squared);
  const double least = max(distance * (1 - 1e-13) - 16 * rounding, 0.0);
  return least * least;
}

template <bool rational>
void CurveSearch::visit(const Weighted* points, int degree, size_t piece) {
  Part<rational>(*this, piece, degree).visit(relative(points, degree, point), 0, 1, 0);
}

void CurveSearch::note(double squared_there, size_t piece, double at, bool is_minimum) {
  if (!(squared_there < squared * (is_minimum ? 1 + 0x1p-50 : 1))) return;
  squared = min(squared, squared_there);
  part = piece;
  parameter = at;
}

void CurveSearch::polish(const Weighted* points, int degree) {
  for (int step = 0; step < 3 && parameter > 0 && parameter < 1; ++step) {
    const CurvePoint p = curve_point(points, degree, parameter, point);
    const double rise = dot(p.first, p.first) + dot(p.at, p.second);
    const double next = parameter - dot(p.at, p.first) / rise;
    if (!(rise > 0 && next > 0 && next < 1 && std::abs(next - parameter) < polish_within)) return;
    parameter = next;
  }
}

CurvePoint curve_point(const Weighted* points, int degree, double t, const Vec3& origin) {
  return projected<true>(jet_at(relative(points, degree, origin), degree, t));
}

template void CurveSearch::visit<false>(const Weighted*, int, size_t);
template void CurveSearch::visit<true>(const Weighted*, int, size_t);

}  // namespace sardf

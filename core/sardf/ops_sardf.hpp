// The SARDF blends: the corner {min = d} rounded by a circle of radius r(d), tangent to both rays.
//
// Source: Fayolle, Pasko, Schmitt, Mirenkov 2004, section 2, with its typos corrected; the C1
// variant from the authors' later papers (2006, 2008). Sign and zero set are those of min and max.
#pragma once

#include "sardf/ops_blends.hpp"

namespace sardf {

/// Half the diagonal that a quarter circle of radius 1 cuts off a square corner.
inline constexpr double corner_cut = 0.29289321881345254;  // 1 - 1/sqrt(2)

/// Whether (x, y) can lie where the radius shrinks towards the edge from outside: both negative,
/// in the band, nearer than 3 R. Only there do the partial derivatives add up to more than 1.
inline bool can_reach_outer_corner(Interval x, Interval y, double radius) {
  const bool band = x.lo - y.hi < radius && y.lo - x.hi < radius;
  return band && x.lo < 0 && y.lo < 0 && x.hi > -3 * radius && y.hi > -3 * radius;
}

/// Whether the blend of (lo, hi) is lo for every radius profile: where the signs differ, and so
/// near the edge that lo differs from the blend by less than rounding; there squares would vanish.
template <class T>
auto is_sharp(const T& lo, const T& hi, double radius) {
  return (lo <= T(0.0) && hi >= T(0.0)) || (lo > T(-1e-15 * radius) && hi < T(1e-15 * radius));
}

/// Whether the arc through a point of the band has the radius R, the fixed arc's value given.
template <class T>
auto is_fixed(const T& lo, const T& fixed, const T& radius) {
  return select(lo > T(0.0), fixed, T(-0.5) * fixed) >= radius;
}

/// Intersection and union that are min and max but where |x - y| < R. There the intersection is
/// arc(lo, hi, hi - lo): a function of its own, so that a loop over many values keeps its registers
/// for what is done everywhere.
template <class T, class Arc>
T rounded_min(const T& x, const T& y, const T& R, Arc arc) {
  const T lo = smaller(x, y), hi = larger(x, y), t = hi - lo;
  return shortcut(t >= R, lo, [&] { return arc(lo, hi, t); });
}
template <class T, class Arc>
T rounded_max(const T& x, const T& y, const T& R, Arc arc) {
  const T lo = smaller(x, y), hi = larger(x, y), t = hi - lo;
  return shortcut(t >= R, hi, [&] { return -arc(-hi, -lo, t); });
}

/// sardf: r(d) = min(d, R) inside, min(-d/2, R) outside (2.2). Not C1 across d = R and d = -2R.
struct Sardf {
  static constexpr const char *name = "sardf",
                              *doc =
                                  "Rounded in the band |x - y| < R: zero set and sign of "
                                  "min/max, error at most 0.2929 R.";
  double radius = 1;
  template <class V>
  static void parameters(V& v) {
    v(positive_length("radius", "R, the largest radius of the rounded level lines"),
      &Sardf::radius);
  }
  double blend_error() const { return rounded_up(corner_cut * radius, 2); }
  double gain(Interval x, Interval y) const {
    return can_reach_outer_corner(x, y, radius) ? 1.1715728752538102 : 1;  // 4 - 2 sqrt(2)
  }
  /// With the angle's cosine C and sine S on an arc, the partials are C/D and S/D, where D is
  /// (1 + r') (C + S) - r'. For r' >= 0 they add up to at most 1. For r' = -1/2, gradients of the
  /// length L with the product p, and s = C + S in [1, sqrt(2)], the square of the result's length
  /// is at most 4 (L² + (s² - 1) p) / (1 + s)²: that falls and then rises with s.
  double steepness(Interval x, Interval y, double longer, Interval product) const {
    if (!can_reach_outer_corner(x, y, radius)) return longer;
    constexpr double at_middle = 0.6862915010152397;  // 4 / (1 + sqrt(2))²
    const double squared = longer * longer;
    return rounded_up(std::sqrt(max(squared, at_middle * (squared + product.hi))), 8);
  }

  template <class T>
  auto keeps(T x, T y) const {
    return is_above_band(x, y, radius);
  }
  template <class T>
  T intersection(T x, T y) const {
    return rounded_min(x, y, T(radius), [this](T lo, T hi, T t) { return arc(lo, hi, t); });
  }
  template <class T>
  T unite(T x, T y) const {
    return rounded_max(x, y, T(radius), [this](T lo, T hi, T t) { return arc(lo, hi, t); });
  }

 private:
  template <class T>
  [[gnu::noinline]] T arc(T lo, T hi, T t) const {
    const T fixed = fixed_arc(lo, t);
    const T rounded = shortcut(is_fixed(lo, fixed, T(radius)), fixed,
                               [&] { return max(growing_arc(lo, hi, t), fixed); });
    return select(is_sharp(lo, hi, radius), lo, rounded);
  }
  // Arc of radius d through (x, y) where lo > 0, of radius -d/2 where hi < 0; lo off the cone.
  template <class T>
  T growing_arc(T lo, T hi, T t) const {
    const auto inside = lo > T(0.0);
    const T root = sqrt(
        max(select(inside, T(2.0) * lo * (lo + t) - T(3.0) * square(t), T(8.0) * lo * hi), T(0.0)));
    const T cut =
        select(inside, (T(2.0) * t - T(3.0) * lo + root) * T(1.0 / 7), T(3.0) * hi - t + root);
    return select(t < select(inside, lo, -hi), lo + cut, lo);
  }
  template <class T>
  T fixed_arc(T lo, T t) const {
    return lo + (T(0.5) * (t + sqrt(T(2 * radius * radius) - square(t))) - T(radius));
  }
};

/// sardf_c1: r(d) = 2 sqrt(R d) - d for 0 <= d < R, -d - d²/(4R) for -2R < d <= 0, R beyond.
struct SardfC1 {
  static constexpr const char *name = "sardf_c1",
                              *doc =
                                  "As sardf with a radius that grows smoothly: continuously "
                                  "differentiable off the edge.";
  double radius = 1;
  template <class V>
  static void parameters(V& v) {
    v(positive_length("radius", "R, the largest radius of the rounded level lines"),
      &SardfC1::radius);
  }
  double blend_error() const { return rounded_up(corner_cut * radius, 2); }
  double gain(Interval x, Interval y) const {
    return can_reach_outer_corner(x, y, radius) ? 1.4142135623730952 : 1;  // sqrt(2)
  }
  /// As of sardf, with r' between -1 and 0: D is at least 1.
  double steepness(Interval x, Interval y, double longer, Interval product) const {
    if (!can_reach_outer_corner(x, y, radius)) return longer;
    return rounded_up(std::sqrt(longer * longer + max(product.hi, 0.0)), 8);
  }

  template <class T>
  auto keeps(T x, T y) const {
    return is_above_band(x, y, radius);
  }
  template <class T>
  T intersection(T x, T y) const {
    return rounded_min(x, y, T(radius), [this](T lo, T hi, T t) { return arc(lo, hi, t); });
  }
  template <class T>
  T unite(T x, T y) const {
    return rounded_max(x, y, T(radius), [this](T lo, T hi, T t) { return arc(lo, hi, t); });
  }

 private:
  template <class T>
  [[gnu::noinline]] T arc(T lo, T hi, T t) const {
    const T fixed =
        lo + (T(0.5) * (t + sqrt(max(T(2 * radius * radius) - square(t), T(0.0)))) - T(radius));
    const T rounded = shortcut(is_fixed(lo, fixed, T(radius)), fixed, [&] {
      const auto inside = lo > T(0.0);
      return select(inside, shortcut(!inside, lo, [&] { return inner(lo, hi); }),
                    shortcut(inside, lo, [&] { return outer(lo, hi, t); }));
    });
    return select(is_sharp(lo, hi, radius), lo, rounded);
  }
  // d = R s², s⁴ - 4s³ - 4s² + 4s(X + Y) - (X² + Y²) = 0, between the parabolas 4 R lo = hi².
  template <class T>
  T inner(T lo, T hi) const {
    const T X = lo * T(1 / radius), Y = hi * T(1 / radius);
    const auto on_arc = T(4.0) * X > square(Y);
    const T sum = X + Y, squares = square(X) + square(Y);
    const T a = freeze(sum), b = freeze(squares);
    T s = min(T(1.0), T(0.5) * (a + sqrt(max(square(a) - b, T(0.0)))));
    for (int step = 0; step < 6; ++step) {
      const T value = quartic(s, a, b), slope = quartic_slope(s, a);
      const T bend = T(12.0) * square(s) - T(24.0) * s - T(8.0);
      s = s - T(2.0) * value * slope / (T(2.0) * square(slope) - value * bend);
    }
    s = s - quartic(s, sum, squares) / quartic_slope(s, a);
    return select(on_arc, T(radius) * square(s), lo);
  }
  template <class T>
  static T quartic(T s, T sum, T squares) {
    return (((s - T(4.0)) * s - T(4.0)) * s + T(4.0) * sum) * s - squares;
  }
  template <class T>
  static T quartic_slope(T s, T sum) {
    return ((T(4.0) * s - T(12.0)) * s - T(8.0)) * s + T(4.0) * sum;
  }

  // d = -2R e, e⁴ + 4e³ + (2(X + Y) - 4) e² + X² + Y² = 0, between the parabolas -4 R hi = lo².
  template <class T>
  T outer(T lo, T hi, T t) const {
    const T X = lo * T(1 / radius), Y = hi * T(1 / radius);
    const auto on_arc = T(-4.0) * Y > square(X);
    const T sum = X + Y, squares = square(X) + square(Y);
    const T a = freeze(sum), b = freeze(squares), n = freeze(-Y), w = freeze(t * T(1 / radius));
    // The start is the arc of `sardf` through the point: radius half the distance.
    T e = T(0.5) * (T(4.0) * n + T(2.0) * w - sqrt(max(T(8.0) * n * (n + w), T(0.0))));
    for (int step = 0; step < 6; ++step) e = e - outer_quartic(e, a, b) / outer_slope(e, a);
    e = e - outer_quartic(e, sum, squares) / outer_slope(e, a);
    return select(on_arc, T(-2 * radius) * e, lo);
  }
  template <class T>
  static T outer_quartic(T e, T sum, T squares) {
    return ((e + T(4.0)) * e + (T(2.0) * sum - T(4.0))) * square(e) + squares;
  }
  template <class T>
  static T outer_slope(T e, T sum) {
    return ((T(4.0) * e + T(12.0)) * e + T(2.0) * (T(2.0) * sum - T(4.0))) * e;
  }
};

using BlendList = OpList<Sardf, SardfC1, MinMax, RFunction, Smooth>;
using JoinOps = OpsOfBlends<Sardf, SardfC1, MinMax, RFunction, Smooth>;
using BlendOps = Joined<JoinOps, OpList<Equivalence>>::type;

}  // namespace sardf

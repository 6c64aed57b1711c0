// Ellipsoid and ellipse: exact signed distance in a bounded number of steps.
//
// With e the radii and y >= 0 the point in their frame, the foot of the nearest point is
// e_i z_i, z_i = e_i y_i / (t + e_i²), where t is the largest root of G(t) = Σ z_i² = 1 (Eberly,
// "Distance from a point to an ellipse, an ellipsoid, or a hyperellipsoid"). Newton's iteration for
// 1/sqrt(G) = 1, t += (sqrt(G) - 1) G / Σ z_i²/(t + e_i²), rises monotonically to the root, because
// 1/sqrt(G) is concave. The unknown is s = t + min(e)²: t alone would lose the digits of s near the
// medial disc.
//
// The distance then is min over unit normals n of h(n) - n·y with the support function h(n) = |e
// n|. It is stationary at the true normal, so an error of the root enters squared, any normal gives
// an upper bound, and the derivative is -n without one of the iteration.
#pragma once

#include "sardf/ops_solids.hpp"

namespace sardf {

template <int N>
class EllipsoidDistance {
 public:
  void set(const std::array<double, N>& radii);

  template <class T>
  T eval(const std::array<T, N>& at) const {
    std::array<T, N> y, z;
    for (int i = 0; i < N; ++i) y[i] = abs(at[i]);
    for (int i = 0; i < N; ++i) {
      // A trace of thickness keeps the root positive on the plane of the shortest radius.
      z[i] = T(radii_[i]) * freeze(i == shortest_ ? max(y[i], T(radii_[i] * 1e-18)) : y[i]);
    }
    const T s = root(z);
    T toward(0.0), unit(0.0), normal(0.0);
    for (int i = 0; i < N; ++i) {
      const T c = z[i] / (s + T(excess_[i])), n = c * T(1 / radii_[i]);
      toward = i == 0 ? n * y[i] : toward + n * y[i];
      unit = i == 0 ? square(c) : unit + square(c);
      normal = i == 0 ? square(n) : normal + square(n);
    }
    return (sqrt(unit) - toward) / sqrt(normal);
  }

  int steps() const { return steps_; }

  /// Encloses the partial derivatives: the root rises with each |at_i|, so those of the nearest and
  /// of the farthest corner enclose it.
  std::array<Interval, N> partials(const std::array<Interval, N>& at) const;

 private:
  /// Encloses e_i² - min(e)².
  Interval excess(int i) const;
  /// Encloses (s + excess_i) / (s + excess_k) over s.
  Interval quotient(int i, int k, const Interval& s) const;
  /// Encloses G(s) at a point y.
  Interval sum_of_squares(const std::array<double, N>& y, double s) const;
  /// Encloses the root over these y, none of them negative.
  Interval root_between(const std::array<Interval, N>& y) const;

  // The root lies between the largest z_i - excess_i and |z|, which may be many decades apart near
  // the medial disc: halving their logarithm's range comes before Newton's iteration.
  template <class T>
  T root(const std::array<T, N>& z) const {
    T low = z[0] - T(excess_[0]), squares = square(z[0]);
    for (int i = 1; i < N; ++i) {
      low = max(low, z[i] - T(excess_[i]));
      squares = squares + square(z[i]);
    }
    T high = sqrt(squares);
    for (int step = 0; step < halvings; ++step) {
      const T middle = sqrt(low) * sqrt(high);
      T g(0.0);
      for (int i = 0; i < N; ++i) {
        const T squared = square(z[i] / (middle + T(excess_[i])));
        g = i == 0 ? squared : g + squared;
      }
      const auto is_low = g >= T(1.0);
      low = select(is_low, middle, low);
      high = select(is_low, high, middle);
    }
    T s = low;
    for (int step = 0; step < steps_; ++step) {
      T g(0.0), slope(0.0);
      for (int i = 0; i < N; ++i) {
        const T inverse = T(1.0) / (s + T(excess_[i]));
        const T squared = square(z[i] * inverse);
        g = i == 0 ? squared : g + squared;
        slope = i == 0 ? squared * inverse : slope + squared * inverse;
      }
      const T former = s;
      s = s + max((sqrt(g) - T(1.0)) * g / slope, T(0.0));
      if (is_at_rest(former, s)) break;
    }
    return s;
  }

  /// Newton steps that the root takes for this point, and the most where a ray in this
  /// direction meets the medial disc's rim.
  int steps_needed(std::array<double, N> y) const;
  int steps_needed_near_rim(const std::array<double, N>& direction) const;

  static constexpr int halvings = 5;
  static constexpr double most_ratio = 200;
  std::array<double, N> radii_{};
  std::array<double, N> excess_{};  // e_i² - min(e)²
  int shortest_ = 0;
  int steps_ = 0;
};

extern template class EllipsoidDistance<2>;
extern template class EllipsoidDistance<3>;

struct Ellipsoid : Solid {
  static constexpr const char *name = "ellipsoid",
                              *doc = "An ellipsoid with its axes along x, y and z.";
  static constexpr double rounding = 256;
  Vec3 center{}, radii{1, 1, 1};
  template <class V>
  static void parameters(V& v) {
    v(length_of("center", "its middle"), &Ellipsoid::center);
    v(positive_length("radii", "its three radii, their ratio at most 200"), &Ellipsoid::radii);
  }
  void prepare() { distance_to.set(radii); }
  template <class T>
  T eval(T x, T y, T z) const {
    return distance_to.eval<T>({x - T(center[0]), y - T(center[1]), z - T(center[2])});
  }
  std::array<Interval, 3> partials(const std::array<Interval, 3>& in) const {
    return distance_to.partials({in[0] - center[0], in[1] - center[1], in[2] - center[2]});
  }
  std::array<double, 3> top() const { return center; }

 private:
  EllipsoidDistance<3> distance_to;
};

struct Ellipse {
  static constexpr const char *name = "ellipse",
                              *doc = "An ellipse in the xy plane with its axes along x and y.";
  static constexpr Kind kind = Kind::plane;
  static constexpr int arity = 2;
  static constexpr bool distance = true;
  static constexpr double rounding = 256;
  Vec2 center{}, radii{1, 1};
  template <class V>
  static void parameters(V& v) {
    v(length_of("center", "its middle"), &Ellipse::center);
    v(positive_length("radii", "its two radii, their ratio at most 200"), &Ellipse::radii);
  }
  void prepare() { distance_to.set(radii); }
  template <class T>
  T eval(T x, T y) const {
    return distance_to.eval<T>({x - T(center[0]), y - T(center[1])});
  }
  std::array<Interval, 2> partials(const std::array<Interval, 2>& in) const {
    return distance_to.partials({in[0] - center[0], in[1] - center[1]});
  }
  std::array<double, 2> top() const { return center; }

 private:
  EllipsoidDistance<2> distance_to;
};

using EllipsoidOps = OpList<Ellipsoid, Ellipse>;

}  // namespace sardf

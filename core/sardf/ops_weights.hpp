// What fractions and colours are made of: shares by inverse distances, and sums with factors.
#pragma once

#include <cmath>
#include <utility>

#include "sardf/op_list.hpp"

namespace sardf {

/// The share u0^-k / Σ ui^-k that the first of N distances has, for N from 2 to 4, by products:
/// one division and neither a power nor a logarithm. A distance of at most `least` counts as 0;
/// where some are 0 these share evenly. Distances beyond 1e37 count as 1e37.
/// Source: Biswas, Shapiro, Tsukanov 2004, section 3.2, the form with products of the others.
template <int N>
struct InverseShare {
  static inline const std::string name = "inverse_share_" + std::to_string(N),
                                  doc = "The share of the first of " + std::to_string(N) +
                                        " distances, weighted by their inverse powers.";
  static constexpr Kind kind = Kind::internal;
  static constexpr int arity = N;
  static constexpr std::array<int, N> monotone = [] {
    std::array<int, N> signs{};
    for (int i = 0; i < N; ++i) signs[i] = i == 0 ? -1 : 1;
    return signs;
  }();
  static constexpr double rounding = 32;
  int exponent = 1;
  double least = 1e-12;
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"exponent", "the power k, from 1"}, &InverseShare::exponent);
    v(positive_length("least", "what counts as no distance"), &InverseShare::least);
  }

  void prepare() {
    const int factors = std::max(1, exponent) * (N - 1);
    lowest_ = std::max(least, std::pow(1e-30, 1.0 / factors));
  }

  template <class T, class... Rest>
  T eval(T first, Rest... rest) const {
    const std::array<T, N> u{first, rest...};
    T nearest = u[0];
    for (int i = 1; i < N; ++i) nearest = min(nearest, u[i]);
    const std::array<T, N> powers{power(first), power(rest)...};
    const T own = without<0>(powers);
    const T total = own + others_of(powers, std::make_index_sequence<N - 1>());
    // On no feature, and products far from the limits of floats; not so for NaN.
    const auto is_plain = nearest > T(lowest_) && total < T(1e30);
    return shortcut(is_plain, own / total, [&] { return by_ratios(u); });
  }

 private:
  template <class T>
  T power(T u) const {
    if (exponent <= 1) return u;
    T p = u * u;
    for (int i = 2; i < exponent; ++i) p = p * u;
    return p;
  }
  // Written without loops, so that the compiler keeps the arrays in registers.
  /// The product of all but one.
  template <int left_out, class T>
  static T without(const std::array<T, N>& a) {
    constexpr int first = left_out == 0 ? 1 : 0;
    return product<left_out, first>(a);
  }
  template <int left_out, int from, class T>
  static T product(const std::array<T, N>& a) {
    constexpr int next = from + 1 == left_out ? from + 2 : from + 1;
    if constexpr (next >= N) {
      return a[from];
    } else {
      return a[from] * product<left_out, next>(a);
    }
  }
  /// The sum of the products that lack one of the others.
  template <class T, size_t... I>
  static T others_of(const std::array<T, N>& a, std::index_sequence<I...>) {
    return (without<int(I) + 1>(a) + ...);
  }
  /// The nearest distance over each, to the power k: no float is too large or too small for it.
  template <class T>
  T by_ratios(const std::array<T, N>& u) const {
    const auto limited = [&](const T& a) { return min(max(a, T(least)), T(1e37)); };
    T nearest = limited(u[0]), touched = T(0.0), total = T(0.0);
    for (int i = 1; i < N; ++i) nearest = min(nearest, limited(u[i]));
    for (int i = 0; i < N; ++i) {
      touched = touched + jump(u[i] <= T(least), T(1.0), T(0.0));
      total = total + power(nearest / limited(u[i]));
    }
    const T on = jump(u[0] <= T(least), T(1.0), T(0.0));
    return jump(touched > T(0.0), on / max(touched, T(1.0)),
                power(nearest / limited(u[0])) / total);
  }

  double lowest_ = 1e-12;
};

/// The square of the distance to a point.
struct PointSquared {
  static constexpr const char *name = "point_squared", *doc = "The squared distance to a point.";
  static constexpr Kind kind = Kind::internal;
  static constexpr int arity = 3;
  Vec3 at{};
  template <class V>
  static void parameters(V& v) {
    v(required_length("at", "the point"), &PointSquared::at);
  }
  template <class T>
  T eval(T x, T y, T z) const {
    return square(x - T(at[0])) + square(y - T(at[1])) + square(z - T(at[2]));
  }
};

/// Three values with factors, as of three materials.
struct WeightedSum {
  static constexpr const char *name = "weighted_sum",
                              *doc = "The sum of three values with factors.";
  static constexpr Kind kind = Kind::internal;
  static constexpr int arity = 3;
  std::array<double, 3> factors{};
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"factors", "the factor of each"}, &WeightedSum::factors);
  }
  template <class T>
  T eval(T a, T b, T c) const {
    return a * T(factors[0]) + b * T(factors[1]) + c * T(factors[2]);
  }
};

using WeightOps =
    OpList<InverseShare<2>, InverseShare<3>, InverseShare<4>, PointSquared, WeightedSum>;

}  // namespace sardf

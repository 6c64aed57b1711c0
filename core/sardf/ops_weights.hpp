// What fractions and colours are made of: shares by inverse distances, and sums with factors.
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "sardf/op_list.hpp"

namespace sardf {

/// The shares ui^-k / Σ uj^-k of N distances, for N from 2 to 4, by products: one division for all
/// and neither a power nor a logarithm. A distance of at most `least` counts as 0; where some are 0
/// these share evenly. Distances beyond 1e37 count as 1e37.
/// Source: Biswas, Shapiro, Tsukanov 2004, section 3.2, the form with products of the others.
template <int N>
struct InverseShares {
  static constexpr int arity = N, together = N;
  int exponent = 1;
  double least = 1e-12;
  double lowest = 1e-12;  // that a distance must exceed to be part of a product

  void prepare() {
    const int factors = std::max(1, exponent) * (N - 1);
    lowest = std::max(least, std::pow(1e-30, 1.0 / factors));
  }

  /// The I-th alone.
  template <int I, class T>
  T share(const std::array<T, N>& u) const {
    const Steps<T> steps = steps_of(u, every);
    return shortcut(steps.is_plain, without<I>(steps.powers) * steps.factor,
                    [&] { return by_ratios<I>(u, every); });
  }

  /// All of them, by the same steps.
  template <class T, class Put>
  static void results(const InverseShares* ops, const std::array<T, N>& u, Put put) {
    ops->put_shares(u, put, every);
  }

 private:
  // Steps of all distances are written without loops, so that the compiler keeps arrays in
  // registers.
  static constexpr std::make_index_sequence<N> every{};

  template <class T>
  struct Steps {
    std::array<T, N> powers;
    T factor;  // of the product of the others' powers
    // On no feature, and products far from the limits of floats; not so for NaN.
    decltype(std::declval<T>() < std::declval<T>()) is_plain;
  };

  template <class T, size_t... I>
  Steps<T> steps_of(const std::array<T, N>& u, std::index_sequence<I...>) const {
    T nearest = u[0];
    for (int i = 1; i < N; ++i) nearest = min(nearest, u[i]);
    const std::array<T, N> powers{power(u[I])...};
    const T total = (without<int(I)>(powers) + ...);
    return {powers, T(1.0) / total, nearest > T(lowest) && total < T(1e30)};
  }

  template <class T, class Put, size_t... I>
  void put_shares(const std::array<T, N>& u, Put put, std::index_sequence<I...>) const {
    const Steps<T> steps = steps_of(u, every);
    const std::array<T, N> plain{without<int(I)>(steps.powers) * steps.factor...};
    if (all(steps.is_plain)) [[likely]] {
      (put(plain[I], I), ...);
    } else {
      (put(select(steps.is_plain, plain[I], by_ratios<int(I)>(u, every)), I), ...);
    }
  }

  template <class T>
  T power(T u) const {
    if (exponent <= 1) return u;
    T p = u * u;
    for (int i = 2; i < exponent; ++i) p = p * u;
    return p;
  }
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
  /// The nearest distance over each, to the power k: no float is too large or too small for it.
  template <int I, class T, size_t... J>
  T by_ratios(const std::array<T, N>& u, std::index_sequence<J...>) const {
    const auto limited = [&](const T& a) { return min(max(a, T(least)), T(1e37)); };
    const auto is_on = [&](const T& a) { return jump(a <= T(least), T(1.0), T(0.0)); };
    T nearest = limited(u[0]);
    for (int i = 1; i < N; ++i) nearest = min(nearest, limited(u[i]));
    const T touched = (is_on(u[J]) + ...);
    const T total = (power(nearest / limited(u[J])) + ...);
    return jump(touched > T(0.0), is_on(u[I]) / max(touched, T(1.0)),
                power(nearest / limited(u[I])) / total);
  }
};

/// The share of the I-th of N distances.
template <int N, int I>
struct InverseShare : InverseShares<N> {
  static inline const std::string name = "inverse_share_" + std::to_string(N) + "_" +
                                         std::to_string(I + 1),
                                  doc = "The share of number " + std::to_string(I + 1) + " of " +
                                        std::to_string(N) +
                                        " distances, weighted by their inverse powers.";
  static constexpr Kind kind = Kind::internal;
  static constexpr int arity = N;
  static constexpr std::array<int, N> monotone = [] {
    std::array<int, N> signs{};
    for (int i = 0; i < N; ++i) signs[i] = i == I ? -1 : 1;
    return signs;
  }();
  static constexpr double rounding = 32;
  using Family = InverseShares<N>;
  static constexpr int place = I;
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"exponent", "the power k, from 1"}, &InverseShare::exponent);
    v(positive_length("least", "what counts as no distance"), &InverseShare::least);
  }

  template <class T, class... Rest>
  T eval(T first, Rest... rest) const {
    return this->template share<I>(std::array<T, N>{first, rest...});
  }
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

/// N values with factors, as of N materials, for N from 2 to 4.
template <int N>
struct WeightedSum {
  static inline const std::string name = "weighted_sum_" + std::to_string(N),
                                  doc = "The sum of " + std::to_string(N) + " values with factors.";
  static constexpr Kind kind = Kind::internal;
  static constexpr int arity = N;
  using Family = WeightedSum;
  static constexpr int together = 3;  // as of the channels of a colour
  std::array<double, N> factors{};
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"factors", "the factor of each"}, &WeightedSum::factors);
  }
  template <class T, class... Rest>
  T eval(T first, Rest... rest) const {
    return sum(std::array<T, N>{first, rest...}, every);
  }
  template <class T, class Put>
  static void results(const WeightedSum* ops, const std::array<T, N>& values, Put put) {
    for (int k = 0; k < together; ++k) put(ops[k].sum(values, every), k);
  }

 private:
  static constexpr std::make_index_sequence<N> every{};
  template <class T, size_t... I>
  T sum(const std::array<T, N>& values, std::index_sequence<I...>) const {
    return (... + (values[I] * T(factors[I])));
  }
};

using WeightOps =
    OpList<InverseShare<2, 0>, InverseShare<2, 1>, InverseShare<3, 0>, InverseShare<3, 1>,
           InverseShare<3, 2>, InverseShare<4, 0>, InverseShare<4, 1>, InverseShare<4, 2>,
           InverseShare<4, 3>, PointSquared, WeightedSum<2>, WeightedSum<3>, WeightedSum<4>>;

}  // namespace sardf

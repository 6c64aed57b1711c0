// The number type Gradient: a value and N partial derivatives, over any other number type.
//
// At a kink (min, max, abs, select) the derivative is that of the branch that gives the value, the
// second argument's where both do.
#pragma once

#include <array>
#include <utility>

#include "sardf/numbers/interval.hpp"
#include "sardf/numbers/real.hpp"

namespace sardf {

template <class T, int N>
struct Gradient {
  T v;
  std::array<T, N> d;

  Gradient() = default;
  Gradient(double a) : v(a) { d.fill(T(0.0)); }
  explicit Gradient(const T& a)
    requires(!std::is_same_v<T, double>)
      : v(a) {
    d.fill(T(0.0));
  }
  static Gradient variable(const T& a, int index) {
    return made(a, [&](int i) { return T(i == index ? 1.0 : 0.0); });
  }

  /// slope(i) is derivative number i. Not a loop: compilers would keep the derivatives in memory.
  template <class Slope>
  static Gradient made(const T& value, Slope slope) {
    return made(value, slope, std::make_integer_sequence<int, N>());
  }
  template <class Slope, int... I>
  static Gradient made(const T& value, [[maybe_unused]] Slope slope,
                       std::integer_sequence<int, I...>) {
    Gradient g;
    g.v = value;
    ((g.d[I] = slope(I)), ...);
    return g;
  }

  /// The value `value` whose derivative is slope times the derivative of a.
  static Gradient chain(const Gradient& a, const T& value, const T& slope) {
    return made(value, [&](int i) { return slope * a.d[i]; });
  }
  static Gradient chain(const Gradient& a, const Gradient& b, const T& value, const T& by_a,
                        const T& by_b) {
    return made(value, [&](int i) { return by_a * a.d[i] + by_b * b.d[i]; });
  }

  /// `value` with a's derivative, b's, or the mean of both where neither is chosen.
  template <class Mask>
  static Gradient tied(const Gradient& a, const Gradient& b, const Mask& is_a, const Mask& is_b,
                       const T& value) {
    return made(value, [&](int i) {
      return select(is_a, a.d[i], select(is_b, b.d[i], T(0.5) * (a.d[i] + b.d[i])));
    });
  }

  friend Gradient operator+(const Gradient& a, const Gradient& b) {
    return made(a.v + b.v, [&](int i) { return a.d[i] + b.d[i]; });
  }
  friend Gradient operator-(const Gradient& a, const Gradient& b) {
    return made(a.v - b.v, [&](int i) { return a.d[i] - b.d[i]; });
  }
  friend Gradient operator-(const Gradient& a) {
    return made(-a.v, [&](int i) { return -a.d[i]; });
  }
  friend Gradient operator*(const Gradient& a, const Gradient& b) {
    return chain(a, b, a.v * b.v, b.v, a.v);
  }
  friend Gradient operator/(const Gradient& a, const Gradient& b) {
    const T quotient = a.v / b.v;
    return chain(a, b, quotient, T(1.0) / b.v, -(quotient / b.v));
  }
  friend auto operator<(const Gradient& a, const Gradient& b) { return a.v < b.v; }
  friend auto operator<=(const Gradient& a, const Gradient& b) { return a.v <= b.v; }
  friend auto operator>(const Gradient& a, const Gradient& b) { return a.v > b.v; }
  friend auto operator>=(const Gradient& a, const Gradient& b) { return a.v >= b.v; }

  template <class Mask>
  friend Gradient select(const Mask& mask, const Gradient& a, const Gradient& b) {
    return made(select(mask, a.v, b.v), [&](int i) { return select(mask, a.d[i], b.d[i]); });
  }
  friend Gradient min(const Gradient& a, const Gradient& b) {
    Gradient g = select(a.v < b.v, a, b);
    g.v = min(a.v, b.v);
    return g;
  }
  friend Gradient max(const Gradient& a, const Gradient& b) {
    Gradient g = select(a.v > b.v, a, b);
    g.v = max(a.v, b.v);
    return g;
  }
  friend Gradient smaller(const Gradient& a, const Gradient& b) {
    return tied(a, b, a.v < b.v, b.v < a.v, min(a.v, b.v));
  }
  friend Gradient larger(const Gradient& a, const Gradient& b) {
    return tied(a, b, a.v > b.v, b.v > a.v, max(a.v, b.v));
  }
  friend Gradient abs(const Gradient& a) {
    return chain(a, abs(a.v), select(a.v < T(0.0), T(-1.0), T(1.0)));
  }
  friend Gradient square(const Gradient& a) { return chain(a, square(a.v), a.v + a.v); }
  friend bool is_at_rest(const Gradient& before, const Gradient& after) {
    bool rests = is_at_rest(before.v, after.v);
    for (int k = 0; k < N; ++k) rests = rests && is_at_rest(before.d[k], after.d[k]);
    return rests;
  }
  friend Gradient freeze(const Gradient& a) {
    return made(freeze(a.v), [](int) { return T(0.0); });
  }
  friend Gradient sqrt(const Gradient& a) {
    const T root = sqrt(a.v);
    return chain(a, root, T(0.5) / root);
  }
  friend Gradient length(const Gradient& a, const Gradient& b) {
    const T whole = length(a.v, b.v);
    return chain(a, b, whole, cosine(a.v, whole), cosine(b.v, whole));
  }
  friend Gradient length(const Gradient& a, const Gradient& b, const Gradient& c) {
    const T whole = length(a.v, b.v, c.v);
    const T i = cosine(a.v, whole), j = cosine(b.v, whole), k = cosine(c.v, whole);
    return made(whole, [&](int n) { return i * a.d[n] + j * b.d[n] + k * c.d[n]; });
  }
  friend Gradient exp(const Gradient& a) {
    const T e = exp(a.v);
    return chain(a, e, e);
  }
  friend Gradient log(const Gradient& a) { return chain(a, log(a.v), T(1.0) / a.v); }
  friend Gradient sin(const Gradient& a) { return chain(a, sin(a.v), cos(a.v)); }
  friend Gradient cos(const Gradient& a) { return chain(a, cos(a.v), -sin(a.v)); }
  friend Gradient tan(const Gradient& a) {
    const T t = tan(a.v);
    return chain(a, t, T(1.0) + square(t));
  }
  friend Gradient asin(const Gradient& a) {
    return chain(a, asin(a.v), T(1.0) / sqrt(T(1.0) - square(a.v)));
  }
  friend Gradient acos(const Gradient& a) {
    return chain(a, acos(a.v), T(-1.0) / sqrt(T(1.0) - square(a.v)));
  }
  friend Gradient atan2(const Gradient& y, const Gradient& x) {
    const T squared = square(x.v) + square(y.v), cut = slope_of_cut(y.v, x.v);
    return chain(y, x, atan2(y.v, x.v), x.v / squared + cut, cut - y.v / squared);
  }
  friend Gradient floor(const Gradient& a) {
    const T whole = floor(a.v);
    return chain(a, whole, slope_of_steps(whole));
  }
  friend Gradient pow(const Gradient& a, const Gradient& b) {
    const T power = pow(a.v, b.v);
    // The derivative by a constant exponent is never needed, and ln of a negative base is none. The
    // smallest positive double stands in for it, so that ln of an interval is finite.
    const T by_b = select(a.v > T(0.0), power * log(max(a.v, T(0x1p-1074))), T(0.0));
    return chain(a, b, power, b.v * pow(a.v, b.v - T(1.0)), by_b + slope_of_exponents(a.v, b.v));
  }
};

template <int N>
Gradient<Interval, N> jump(IntervalMask mask, const Gradient<Interval, N>& a,
                           const Gradient<Interval, N>& b) {
  Gradient<Interval, N> g = select(mask, a, b);
  if (mask.can_hold && mask.can_fail) g.d.fill(Interval::all());
  return g;
}

}  // namespace sardf

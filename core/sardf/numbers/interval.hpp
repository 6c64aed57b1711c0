// The number type Interval: outward rounded enclosures, [lo, hi] holds every value over a box.
//
// [lo, hi] holds the real result of every step and the double one, infinities included, for all
// arguments in the intervals, -0 as well as 0. Sums, products, quotients and roots are rounded to
// nearest by IEEE 754 and then moved outwards; elementary functions rest on the C library's
// documented error (glibc manual, "Known Maximum Errors in Math Functions": at most 1 ulp). Where a
// step has no value (NaN: 0/0, inf - inf, the logarithm of a negative number) the formula is not
// defined, and nothing is said of that point. No bound is ever NaN where the arguments' are not.
#pragma once

#include <cfloat>
#include <limits>

#include "sardf/numbers/real.hpp"

namespace sardf {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// A value rounded towards -inf (+inf) by at least `ulps` units in the last place. Overflow is
/// undone: the largest finite number stands for any larger one. Of NaN, from infinite ends such as
/// inf - inf, nothing is known: -inf (+inf).
inline double rounded_down(double a, double ulps = 1) {
  if (!(a < infinity)) return a == infinity ? DBL_MAX : -infinity;
  return a - (abs(a) * ulps * 0x1p-52 + ulps * 0x1p-1074);
}
inline double rounded_up(double a, double ulps = 1) { return -rounded_down(-a, ulps); }

/// What is known of a comparison of two intervals.
struct IntervalMask {
  bool can_hold;
  bool can_fail;
  friend IntervalMask operator&&(IntervalMask a, IntervalMask b) {
    return {a.can_hold && b.can_hold, a.can_fail || b.can_fail};
  }
  friend IntervalMask operator||(IntervalMask a, IntervalMask b) {
    return {a.can_hold || b.can_hold, a.can_fail && b.can_fail};
  }
  friend IntervalMask operator!(IntervalMask a) { return {a.can_fail, a.can_hold}; }
};

struct Interval {
  double lo = 0;
  double hi = 0;

  Interval() = default;
  Interval(double a) : lo(a), hi(a) {}
  Interval(double low, double high) : lo(low), hi(high) {}

  static Interval all() { return {-infinity, infinity}; }
  bool contains(double a) const { return lo <= a && a <= hi; }
  double magnitude() const { return max(abs(lo), abs(hi)); }

  friend bool operator==(const Interval&, const Interval&) = default;
  // A sum of doubles that is 0 is exact. The smallest numbers in its place would be right, too, but
  // processors multiply them a hundred times slower.
  friend Interval operator+(Interval a, Interval b) {
    const double low = a.lo + b.lo, high = a.hi + b.hi;
    return {low == 0 ? 0 : rounded_down(low), high == 0 ? 0 : rounded_up(high)};
  }
  friend Interval operator-(Interval a) { return {-a.hi, -a.lo}; }
  friend Interval operator-(Interval a, Interval b) { return a + -b; }
  friend Interval operator*(Interval a, Interval b);
  friend Interval operator/(Interval a, Interval b);
  friend IntervalMask operator<(Interval a, Interval b) { return {a.lo < b.hi, !(a.hi < b.lo)}; }
  friend IntervalMask operator<=(Interval a, Interval b) { return {a.lo <= b.hi, !(a.hi <= b.lo)}; }
  friend IntervalMask operator>(Interval a, Interval b) { return b < a; }
  friend IntervalMask operator>=(Interval a, Interval b) { return b <= a; }
};

inline Interval hull(Interval a, Interval b) { return {min(a.lo, b.lo), max(a.hi, b.hi)}; }
/// The common part of two enclosures of the same value.
inline Interval intersect(Interval a, Interval b) { return {max(a.lo, b.lo), min(a.hi, b.hi)}; }
inline Interval select(IntervalMask mask, Interval a, Interval b) {
  return !mask.can_fail ? a : !mask.can_hold ? b : hull(a, b);
}
template <class T, class Full>
T shortcut(IntervalMask mask, const T& cheap, Full full) {
  return !mask.can_fail ? cheap : select(mask, cheap, full());
}

inline Interval min(Interval a, Interval b) { return {min(a.lo, b.lo), min(a.hi, b.hi)}; }
inline Interval max(Interval a, Interval b) { return {max(a.lo, b.lo), max(a.hi, b.hi)}; }
inline Interval freeze(Interval a) { return a; }
inline Interval slope_of_cut(Interval y, Interval x) {
  return x.lo <= 0 && y.lo <= 0 && y.hi >= 0 ? Interval::all() : 0;
}
/// What a changing exponent adds to the slope of a power where the base may be negative, which has
/// powers at whole numbers only, or 0, whose power jumps at the exponent 0.
inline Interval slope_of_exponents(Interval base, Interval exponent) {
  const bool jumps = base.lo < 0 || (base.lo <= 0 && exponent.lo <= 0);
  return jumps && exponent.lo < exponent.hi ? Interval::all() : 0;
}
inline Interval slope_of_steps(Interval a) { return a.lo < a.hi ? Interval{0, infinity} : 0; }
Interval abs(Interval a);
Interval square(Interval a);
Interval cosine(Interval a, Interval b);
/// Square root of the part of the interval that is not negative.
Interval sqrt(Interval a);
Interval exp(Interval a);
Interval log(Interval a);
Interval sin(Interval a);
Interval cos(Interval a);
Interval tan(Interval a);
Interval asin(Interval a);
Interval acos(Interval a);
Interval atan2(Interval y, Interval x);
Interval floor(Interval a);
Interval pow(Interval a, Interval b);

}  // namespace sardf

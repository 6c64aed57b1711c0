// The number type Choice: what a value can be over a box, in double and in float arithmetic, and
// which argument of the formula it is a copy of.
//
// Over a box many a formula is simply one of its arguments: a minimum whose operands' ranges do not
// overlap, a blend outside of its band, a select whose condition is decided. A program for that box
// can leave the operation out, and with it all that only the other arguments needed.
#pragma once

#include <cfloat>

#include "sardf/numbers/interval.hpp"

namespace sardf {

struct Choice {
  /// What a value is, but for computed ones, in every bit: `open`: one of several; `number`: the
  /// constant `constant`; 0, 1, ...: that argument, negated or not.
  static constexpr int computed = -1, open = -2, number = -3;

  /// Encloses the results of double and of float arithmetic, if they are numbers.
  Interval range;
  bool may_be_nan = false;
  bool negated = false;
  int origin = computed;
  double constant = 0;

  Choice() = default;
  /// Float arithmetic rounds the number.
  Choice(double a)
      : range(double(float(a)) == a ? Interval(a) : outward(a, 1)), origin(number), constant(a) {}
  static Choice argument(int index, Interval range, bool may_be_nan) {
    Choice c = of(range, may_be_nan);
    c.origin = index;
    return c;
  }
  /// A computed value in the range. Beyond 2^120 a float may have become infinite.
  static Choice of(Interval range, bool may_be_nan) {
    constexpr double most = 0x1p120;
    Choice c;
    c.range = {range.lo < -most ? -infinity : range.lo, range.hi > most ? infinity : range.hi};
    c.may_be_nan = may_be_nan;
    if (!(range.lo <= range.hi)) {
      c.range = Interval::all();
      c.may_be_nan = true;
    }
    return c;
  }
  static Interval outward(Interval a, double float_ulps) {
    return {a.lo - (abs(a.lo) * 0x1p-23 + 0x1p-149) * float_ulps,
            a.hi + (abs(a.hi) * 0x1p-23 + 0x1p-149) * float_ulps};
  }
  /// The result of an elementary step, which floats round in its last place.
  static Choice rounded(Interval range, bool may_be_nan, double float_ulps = 1) {
    return of(outward(range, float_ulps), may_be_nan);
  }
  /// The result of a step that is never negative.
  static Choice rounded_from_zero(Interval range, bool may_be_nan, double float_ulps = 1) {
    const Interval wide = outward(range, float_ulps);
    return of({max(0.0, wide.lo), wide.hi}, may_be_nan);
  }

  /// The number 0 whose sign is +.
  bool is_zero() const { return origin == number && constant == 0 && !std::signbit(constant); }
  bool may_vanish() const { return range.lo <= 0 && range.hi >= 0; }
  bool may_be_infinite() const { return range.lo == -infinity || range.hi == infinity; }
  bool is_copy_of(const Choice& b) const {
    return origin == b.origin && origin != computed && origin != open && negated == b.negated &&
           constant == b.constant;
  }

  friend Choice operator-(Choice a) {
    a.range = -a.range;
    a.negated = !a.negated && a.origin != number;
    a.constant = -a.constant;
    return a;
  }
  friend Choice operator+(const Choice& a, const Choice& b) {
    const bool opposite = (a.range.hi == infinity && b.range.lo == -infinity) ||
                          (a.range.lo == -infinity && b.range.hi == infinity);
    return rounded(a.range + b.range, a.may_be_nan || b.may_be_nan || opposite);
  }
  friend Choice operator-(const Choice& a, const Choice& b) {
    // A sum with 0 is no copy: it changes the sign of -0.
    return b.is_zero() ? a : a + -b;
  }
  friend Choice operator*(const Choice& a, const Choice& b) {
    const bool nan = a.may_be_nan || b.may_be_nan || (a.may_vanish() && b.may_be_infinite()) ||
                     (b.may_vanish() && a.may_be_infinite());
    const bool no_sign = (a.is_zero() || a.range.lo > 0) && (b.is_zero() || b.range.lo > 0);
    if (!nan && no_sign && (a.is_zero() || b.is_zero())) return 0.0;
    return rounded(a.range * b.range, nan);
  }
  friend Choice operator/(const Choice& a, const Choice& b) {
    const bool nan = a.may_be_nan || b.may_be_nan || (a.may_vanish() && b.may_vanish()) ||
                     (a.may_be_infinite() && b.may_be_infinite());
    return rounded(a.range / b.range, nan);
  }
  /// A comparison with NaN does not hold.
  friend IntervalMask operator<(const Choice& a, const Choice& b) {
    IntervalMask mask = a.range < b.range;
    mask.can_fail = mask.can_fail || a.may_be_nan || b.may_be_nan;
    return mask;
  }
  friend IntervalMask operator<=(const Choice& a, const Choice& b) {
    IntervalMask mask = a.range <= b.range;
    mask.can_fail = mask.can_fail || a.may_be_nan || b.may_be_nan;
    return mask;
  }
  friend IntervalMask operator>(const Choice& a, const Choice& b) { return b < a; }
  friend IntervalMask operator>=(const Choice& a, const Choice& b) { return b <= a; }
};

/// One of the two, in the range.
inline Choice either(const Choice& a, const Choice& b, Interval range, bool may_be_nan) {
  if (a.is_copy_of(b)) return a;
  Choice c = Choice::of(range, may_be_nan);
  const bool both = a.origin == Choice::computed && b.origin == Choice::computed;
  c.origin = both ? Choice::computed : Choice::open;
  return c;
}
inline Choice select(IntervalMask mask, const Choice& a, const Choice& b) {
  if (!mask.can_fail) return a;
  if (!mask.can_hold) return b;
  return either(a, b, hull(a.range, b.range), a.may_be_nan || b.may_be_nan);
}
/// As double and floats have it, the second argument where one is NaN. Equal arguments decide
/// nothing: there the gradient may be the mean of theirs.
inline Choice min(const Choice& a, const Choice& b) {
  if (b.range.hi < a.range.lo) return b;
  if (a.range.hi < b.range.lo && !a.may_be_nan && !b.may_be_nan) return a;
  const Interval least = min(a.range, b.range);
  return either(a, b, a.may_be_nan ? hull(least, b.range) : least, b.may_be_nan);
}
inline Choice max(const Choice& a, const Choice& b) {
  if (b.range.lo > a.range.hi) return b;
  if (a.range.lo > b.range.hi && !a.may_be_nan && !b.may_be_nan) return a;
  const Interval most = max(a.range, b.range);
  return either(a, b, a.may_be_nan ? hull(most, b.range) : most, b.may_be_nan);
}
inline Choice abs(const Choice& a) {
  if (a.range.lo > 0 && !a.may_be_nan) return a;
  if (a.range.hi < 0 && !a.may_be_nan) return -a;
  return either(a, -a, abs(a.range), a.may_be_nan);
}
inline Choice square(const Choice& a) {
  return a.is_zero() ? Choice(0.0) : Choice::rounded_from_zero(square(a.range), a.may_be_nan);
}
inline Choice freeze(const Choice& a) { return a; }
inline Choice cosine(const Choice& a, const Choice& b) {
  return Choice::rounded(cosine(a.range, b.range),
                         a.may_be_nan || b.may_be_nan || b.may_vanish() || b.may_be_infinite());
}
inline Choice sqrt(const Choice& a) {
  return Choice::rounded_from_zero(sqrt(a.range), a.may_be_nan || a.range.lo < 0);
}

/// Functions of floats, ours and the C library's, are right within so many units in the last place.
inline constexpr double float_library_ulps = 3;

inline Choice exp(const Choice& a) {
  return Choice::rounded_from_zero(exp(a.range), a.may_be_nan, float_library_ulps);
}
inline Choice log(const Choice& a) {
  return Choice::rounded(log(a.range), a.may_be_nan || a.range.lo < 0, float_library_ulps);
}
inline Choice sin(const Choice& a) {
  return Choice::rounded(sin(a.range), a.may_be_nan || a.may_be_infinite(), float_library_ulps);
}
inline Choice cos(const Choice& a) {
  return Choice::rounded(cos(a.range), a.may_be_nan || a.may_be_infinite(), float_library_ulps);
}
inline Choice tan(const Choice& a) {
  return Choice::rounded(tan(a.range), a.may_be_nan || a.may_be_infinite(), float_library_ulps);
}
inline bool may_leave_unit(const Choice& a) {
  return a.may_be_nan || a.range.lo < -1 || a.range.hi > 1;
}
inline Choice asin(const Choice& a) {
  return Choice::rounded(asin(a.range), may_leave_unit(a), float_library_ulps);
}
inline Choice acos(const Choice& a) {
  return Choice::rounded(acos(a.range), may_leave_unit(a), float_library_ulps);
}
inline Choice atan2(const Choice& y, const Choice& x) {
  return Choice::rounded(atan2(y.range, x.range), y.may_be_nan || x.may_be_nan, float_library_ulps);
}
inline Choice floor(const Choice& a) { return Choice::of(floor(a.range), a.may_be_nan); }
inline Choice pow(const Choice& a, const Choice& b) {
  return Choice::rounded(pow(a.range, b.range), a.may_be_nan || b.may_be_nan || a.range.lo < 0,
                         float_library_ulps);
}

}  // namespace sardf

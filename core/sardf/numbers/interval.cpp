#include "sardf/numbers/interval.hpp"

#include <numbers>

namespace sardf {

namespace {

// The C library's elementary functions are right within one unit in the last place. Two are kept:
// the value at an end may be one too small and a value beside it one too large.
constexpr double library_ulps = 2;

double product(double a, double b) { return a == 0 || b == 0 ? 0 : a * b; }

Interval widened(double lo, double hi) {
  return {rounded_down(lo, library_ulps), rounded_up(hi, library_ulps)};
}

// Whether offset + k * period lies in [a.lo, a.hi] for an integer k, erring towards yes.
bool reaches(Interval a, double offset, double period) {
  const double slack = 1e-15 * (abs(a.lo) + abs(a.hi) + abs(offset));
  const double k = std::ceil((a.lo - slack - offset) / period);
  return offset + k * period <= a.hi + slack;
}

}  // namespace

Interval operator*(Interval a, Interval b) {
  const double p = product(a.lo, b.lo), q = product(a.lo, b.hi);
  const double r = product(a.hi, b.lo), s = product(a.hi, b.hi);
  Interval all{rounded_down(min(min(p, q), min(r, s))), rounded_up(max(max(p, q), max(r, s)))};
  // Rounding does not reach beyond 0 where the signs are known, as for a sum (interval.hpp).
  if ((a.lo >= 0 && b.lo >= 0) || (a.hi <= 0 && b.hi <= 0)) all.lo = max(all.lo, 0.0);
  if ((a.lo >= 0 && b.hi <= 0) || (a.hi <= 0 && b.lo >= 0)) all.hi = min(all.hi, 0.0);
  return all;
}

Interval operator/(Interval a, Interval b) {
  // Also where 0 is an end of b: 1 / -0 is -inf.
  if (b.lo <= 0 && b.hi >= 0) return Interval::all();
  // A finite bound over an infinite one tends to 0.
  const Interval inverse{b.hi == infinity || b.hi == -infinity ? 0 : 1 / b.hi,
                         b.lo == infinity || b.lo == -infinity ? 0 : 1 / b.lo};
  return a * Interval{rounded_down(inverse.lo), rounded_up(inverse.hi)};
}

Interval abs(Interval a) {
  if (a.lo >= 0) return a;
  if (a.hi <= 0) return -a;
  return {0, max(-a.lo, a.hi)};
}

Interval square(Interval a) {
  const Interval m = abs(a);
  return {max(0.0, rounded_down(m.lo * m.lo)), m.hi == 0 ? 0 : rounded_up(m.hi * m.hi)};
}

Interval cosine(Interval a, Interval b) {
  const Interval whole{-1, 1};
  if (b.lo <= 0) return a.lo >= 0 ? Interval{0, 1} : a.hi <= 0 ? Interval{-1, 0} : whole;
  return intersect(a / b, whole);
}

Interval sqrt(Interval a) {
  if (a.hi <= 0) return 0;
  return {max(0.0, rounded_down(std::sqrt(max(0.0, a.lo)))), rounded_up(std::sqrt(a.hi))};
}

Interval exp(Interval a) {
  const Interval e = widened(std::exp(a.lo), std::exp(a.hi));
  return {max(0.0, e.lo), e.hi};
}

Interval log(Interval a) {
  return {a.lo <= 0 ? -infinity : rounded_down(std::log(a.lo), library_ulps),
          a.hi <= 0 ? -infinity : rounded_up(std::log(a.hi), library_ulps)};
}

Interval cos(Interval a) {
  constexpr double pi = std::numbers::pi;
  if (!(a.hi - a.lo < 2 * pi) || a.magnitude() > 1e9) return {-1, 1};
  const double p = std::cos(a.lo), q = std::cos(a.hi);
  Interval c = widened(min(p, q), max(p, q));
  if (reaches(a, 0, 2 * pi)) c.hi = 1;
  if (reaches(a, pi, 2 * pi)) c.lo = -1;
  return intersect(c, {-1, 1});
}

Interval sin(Interval a) {
  constexpr double half_pi = std::numbers::pi / 2;
  if (!(a.hi - a.lo < 4 * half_pi) || a.magnitude() > 1e9) return {-1, 1};
  const double p = std::sin(a.lo), q = std::sin(a.hi);
  Interval s = widened(min(p, q), max(p, q));
  if (reaches(a, half_pi, 4 * half_pi)) s.hi = 1;
  if (reaches(a, -half_pi, 4 * half_pi)) s.lo = -1;
  return intersect(s, {-1, 1});
}

Interval tan(Interval a) {
  constexpr double pi = std::numbers::pi;
  if (!(a.hi - a.lo < pi) || a.magnitude() > 1e9 || reaches(a, pi / 2, pi)) return Interval::all();
  return widened(std::tan(a.lo), std::tan(a.hi));
}

Interval asin(Interval a) {
  const Interval c = intersect(a, {-1, 1});
  if (c.lo > c.hi) return Interval::all();
  return widened(std::asin(c.lo), std::asin(c.hi));
}

Interval acos(Interval a) {
  const Interval c = intersect(a, {-1, 1});
  if (c.lo > c.hi) return Interval::all();
  return widened(std::acos(c.hi), std::acos(c.lo));
}

Interval atan2(Interval y, Interval x) {
  constexpr double pi = std::numbers::pi;
  // The angle jumps across the half-line y = 0, x < 0 and is undefined at the origin.
  if (x.lo <= 0 && y.lo <= 0 && y.hi >= 0) return {-rounded_up(pi), rounded_up(pi)};
  // Elsewhere the extremes of the angle of a box lie at its corners.
  const double a = std::atan2(y.lo, x.lo), b = std::atan2(y.lo, x.hi);
  const double c = std::atan2(y.hi, x.lo), d = std::atan2(y.hi, x.hi);
  return widened(min(min(a, b), min(c, d)), max(max(a, b), max(c, d)));
}

Interval floor(Interval a) { return {std::floor(a.lo), std::floor(a.hi)}; }

Interval pow(Interval a, Interval b) {
  // a^b = exp(b ln a) holds for a > 0 only; a negative base has powers at integers alone.
  if (a.lo < 0) {
    const double m = std::pow(a.magnitude(), b.lo), n = std::pow(a.magnitude(), b.hi);
    const double most = b.lo < 0 ? infinity : rounded_up(max(m, n), library_ulps);
    return {-most, most};
  }
  // A power of -0 may be -inf.
  if (a.lo == 0 && b.lo < 0) return Interval::all();
  const double p = std::pow(a.lo, b.lo), q = std::pow(a.lo, b.hi);
  const double r = std::pow(a.hi, b.lo), s = std::pow(a.hi, b.hi);
  Interval all = widened(min(min(p, q), min(r, s)), max(max(p, q), max(r, s)));
  if (a.contains(1) || b.contains(0)) all = hull(all, {1});
  return {max(0.0, all.lo), all.hi};
}

}  // namespace sardf

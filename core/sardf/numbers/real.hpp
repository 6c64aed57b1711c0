// The number type double: what eval<T> needs beyond the standard library.
#pragma once

#include <cmath>

namespace sardf {

using std::abs;
using std::acos;
using std::asin;
using std::atan2;
using std::cos;
using std::exp;
using std::floor;
using std::log;
using std::pow;
using std::sin;
using std::sqrt;
using std::tan;

inline double select(bool mask, double a, double b) { return mask ? a : b; }
inline double min(double a, double b) { return a < b ? a : b; }
inline double max(double a, double b) { return a > b ? a : b; }
inline double square(double a) { return a * a; }
inline double freeze(double a) { return a; }

/// Whether an iteration that went from one value to the other, by a step that depends on nothing
/// else, has come to rest: all its further steps would change nothing. Numbers that record or
/// enclose a formula take all the steps.
template <class T>
bool is_at_rest(const T&, const T&) {
  return false;
}
inline bool is_at_rest(double before, double after) { return before == after; }

/// a / b for a component a of a vector of length b: a direction cosine.
inline double cosine(double a, double b) { return a / b; }

/// min and max for formulas that are smooth across a = b: where both are equal, the derivative is
/// the mean of theirs.
template <class T>
T smaller(const T& a, const T& b) {
  return min(a, b);
}
template <class T>
T larger(const T& a, const T& b) {
  return max(a, b);
}

/// What has no bounded slope over an interval that holds the change: select between values that
/// need not meet where the mask changes, a step function (the slope where its value is this), the
/// angle of (x, y) across its cut y = 0, x < 0, and a power of a base that is not positive (what
/// these add to their slopes).
template <class Mask, class T>
T jump(const Mask& mask, const T& a, const T& b) {
  return select(mask, a, b);
}
template <class T>
T slope_of_steps(const T&) {
  return T(0.0);
}
template <class T>
T slope_of_cut(const T&, const T&) {
  return T(0.0);
}

template <class T>
T slope_of_exponents(const T&, const T&) {
  return T(0.0);
}

/// a^n for n >= 1, by products.
template <class T>
T whole_power(const T& a, int n) {
  int bit = 1;
  while (bit <= n / 2) bit *= 2;
  T power = a;
  for (bit /= 2; bit > 0; bit /= 2) {
    power = square(power);
    if (n & bit) power = power * a;
  }
  return power;
}

/// The length of the vector with these components.
template <class T>
T length(const T& a, const T& b) {
  return sqrt(square(a) + square(b));
}
template <class T>
T length(const T& a, const T& b, const T& c) {
  return sqrt(square(a) + square(b) + square(c));
}

/// `cheap` where the mask holds, else full(); a select whose costly branch is skipped.
template <class T, class Full>
T shortcut(bool mask, const T& cheap, Full full) {
  return mask ? cheap : full();
}

}  // namespace sardf

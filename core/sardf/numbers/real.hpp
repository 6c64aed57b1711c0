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

/// a / b for a component a of a vector of length b: a direction cosine.
inline double cosine(double a, double b) { return a / b; }

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

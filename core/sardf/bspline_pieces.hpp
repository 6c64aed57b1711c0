// B-splines as Bezier pieces.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "sardf/vec.hpp"

namespace sardf {

/// Highest degree of B-splines.
inline constexpr int most_degree = 12;

/// A point times its weight, and the weight.
using Weighted = std::array<double, 4>;

inline Weighted operator+(const Weighted& a, const Weighted& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]};
}
inline Weighted operator-(const Weighted& a, const Weighted& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]};
}
inline Weighted operator*(double s, const Weighted& a) {
  return {s * a[0], s * a[1], s * a[2], s * a[3]};
}
inline Vec3 point_of(const Weighted& a) { return {a[0] / a[3], a[1] / a[3], a[2] / a[3]}; }

/// Pascal's triangle up to twice the highest degree.
inline constexpr auto binomials = [] {
  std::array<std::array<double, 2 * most_degree + 1>, 2 * most_degree + 1> all{};
  for (size_t i = 0; i < all.size(); ++i) {
    all[i][0] = 1;
    for (size_t j = 1; j <= i; ++j) all[i][j] = all[i - 1][j - 1] + all[i - 1][j];
  }
  return all;
}();
constexpr double binomial(int n, int k) { return binomials[size_t(n)][size_t(k)]; }

/// A polynomial piece of a B-spline: Bezier point j is the sum over k of weight(j, k) times control
/// point (first + k) modulo their number. The weights are not negative and sum to 1.
struct Span {
  size_t first = 0;
  int degree = 0;
  std::vector<double> weights;
  double weight(int j, int k) const { return weights[size_t(j * (degree + 1) + k)]; }
};

/// One direction of a B-spline as the user gives it.
struct Direction {
  double degree = 3;
  const std::vector<double>& knots;  // empty: clamped and uniform, or uniform where closed
  bool closed = false;
  /// What is appended to the names of parameters in messages.
  std::string suffix;
};

/// The pieces of a B-spline of `count` control points, those of no length left out. Throws Error
/// for a degree that is no whole number from 1 to most_degree, for too few control points, and for
/// knots that are not count + degree + 1, fall, leave no piece, or are given for a closed one.
/// Source: the polar form of Ramshaw 1989, "Blossoms are polar forms", by de Boor's algorithm.
std::vector<Span> spans_of(const Direction& direction, size_t count);

/// Splits a Bezier piece of `degree` at t: `points[k * stride]`; left and right alike.
void split_bezier(const Weighted* points, int degree, size_t stride, double t, Weighted* left,
                  Weighted* right);

/// The Bernstein polynomials of a degree and of the two below it at t.
struct Bernstein {
  using Values = std::array<double, most_degree + 1>;
  int degree;
  Values values{}, one_less{}, two_less{};

  Bernstein(int n, double t);
};

/// A point of a Bezier piece with two derivatives by its parameter, all with their weights. They
/// come of differences of the points, so that those of a short piece keep their digits.
struct Jet {
  Weighted at{}, first{}, second{};
};
Jet jet_of(const Weighted* points, const Bernstein& basis);

/// A power of two that brings coordinates up to `magnitude` near 1.
double unit_scale(double magnitude);

}  // namespace sardf

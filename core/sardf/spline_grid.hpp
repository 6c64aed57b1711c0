// Uniform tensor-product B-splines on a box: how many, of which degree, and their values.
//
// Source: Biswas, Shapiro, Tsukanov, sections 2.3 and 3.3: the basis of the remainder term.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "sardf/vec.hpp"

namespace sardf {

inline constexpr int most_spline_degree = 5;
inline constexpr int most_spline_weights = most_spline_degree + 1;

/// Where a coordinate lies: in which span, and where in it (0 to 1).
struct SplinePlace {
  int span = 0;
  double t = 0;
};

/// `counts[k]` functions on counts[k] - degrees[k] equal spans between lower[k] and upper[k]. Of
/// two dimensions, the third axis has one function of degree 0. The last coordinate's index is the
/// fastest in lists of coefficients.
struct SplineGrid {
  Vec3 lower{}, upper{1, 1, 1};
  std::array<int, 3> counts{1, 1, 1};
  std::array<int, 3> degrees{0, 0, 0};
  int dimensions = 3;

  int spans(int axis) const { return counts[size_t(axis)] - degrees[size_t(axis)]; }
  double per_length(int axis) const {
    return spans(axis) / (upper[size_t(axis)] - lower[size_t(axis)]);
  }
  size_t size() const { return size_t(counts[0]) * size_t(counts[1]) * size_t(counts[2]); }
  size_t cells() const { return size_t(spans(0)) * size_t(spans(1)) * size_t(spans(2)); }
  size_t index(int i, int j, int k) const {
    return (size_t(i) * size_t(counts[1]) + size_t(j)) * size_t(counts[2]) + size_t(k);
  }
  friend bool operator==(const SplineGrid&, const SplineGrid&) = default;
  /// The spans of a cell, whose number counts as that of a coefficient does.
  std::array<int, 3> cell(size_t number) const;
  size_t cell_number(const std::array<int, 3>& spans_of_cell) const;
  /// A coordinate outside counts as the nearest end, NaN as the lower. Monotone in x.
  SplinePlace place(int axis, double x) const {
    const double s = (x - lower[size_t(axis)]) * per_length(axis), end = spans(axis);
    const double inside = x >= upper[size_t(axis)] ? end : s > 0 ? std::min(s, end) : 0;
    const int span = std::min(int(inside), spans(axis) - 1);
    return {span, inside - span};
  }
};

/// Checks and makes: 2 or 3 counts, each a whole number above the degree; a degree from 1 to 5;
/// lower below upper along each axis that counts. Throws Error; a grid of more than 2 GiB of
/// coefficients is refused with its size.
SplineGrid spline_grid(const Vec3& lower, const Vec3& upper, const std::vector<double>& counts,
                       double degree);

/// "12.3 GiB" or "45 MiB".
std::string memory_text(double bytes);

/// Values of the degree + 1 functions that are not 0 in a span, for an argument of each of the
/// `degree` steps of de Boor's recursion: t[r * stride]. One argument for all gives the values at
/// it, different ones the polar form. Arguments in [0, 1] give weights >= 0 whose sum is 1.
template <class Degree>
void spline_weights(Degree degree, const double* t, int stride, double* weights) {
  weights[0] = 1;
  for (int d = 1; d <= degree; ++d) {
    const double at = t[(d - 1) * stride];
    weights[d] = at * weights[d - 1] / d;
    for (int j = d - 1; j > 0; --j) {
      weights[j] = ((at + (d - j)) * weights[j - 1] + ((1 - at) + j) * weights[j]) / d;
    }
    weights[0] = (1 - at) * weights[0] / d;
  }
}

/// Values and derivatives by t at t in [0, 1].
template <class Degree>
void spline_weights_and_slopes(Degree degree, double t, double* weights, double* slopes) {
  spline_weights(degree, &t, 0, weights);
  if (degree == 0) {
    slopes[0] = 0;
    return;
  }
  double lower[most_spline_weights];
  spline_weights(degree - 1, &t, 0, lower);
  slopes[0] = -lower[0];
  for (int j = 1; j < degree; ++j) slopes[j] = lower[j - 1] - lower[j];
  slopes[degree] = lower[degree - 1];
}

}  // namespace sardf

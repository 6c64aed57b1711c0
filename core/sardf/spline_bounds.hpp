// Proven bounds of a tensor-product B-spline and of its slopes over boxes.
#pragma once

#include <span>

#include "sardf/numbers/interval.hpp"
#include "sardf/spline_grid.hpp"

namespace sardf {

/// Keeps references to the grid and the coefficients.
class SplineBounds {
 public:
  SplineBounds(const SplineGrid& grid, const std::vector<double>& coefficients);
  SplineBounds(const SplineBounds&) = delete;
  SplineBounds& operator=(const SplineBounds&) = delete;

  /// Encloses the values, rounding included, over the part of the box that is inside the grid's, or
  /// nearest to it.
  Interval values(const std::array<Interval, 3>& box) const { return over(box, none); }
  /// The same for the partial derivative by coordinate k, whose degree is not 0.
  Interval slopes(const std::array<Interval, 3>& box, int k) const { return over(box, k); }

 private:
  static constexpr int none = 3;
  using Index = std::array<int, 3>;

  Interval over(const std::array<Interval, 3>& box, int derived) const;
  Interval in_cell(const Index& span, const std::array<Interval, 3>& t, int derived) const;
  Interval of_coefficients(const Index& first, const Index& last, int derived) const;
  Interval scanned(const Index& first, const Index& last, int derived) const;
  Interval widened(Interval found, double magnitude, int derived) const;
  Index blocks() const;

  const SplineGrid& grid_;
  const std::vector<double>& coefficients_;
  /// Of blocks of coefficients: their range, and that of their differences along each axis.
  std::array<std::vector<Interval>, 4> ranges_;
};

}  // namespace sardf

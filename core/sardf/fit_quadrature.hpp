// Quadrature over a solid on the cells of a spline grid.
#pragma once

#include <vector>

#include "sardf/evaluate.hpp"
#include "sardf/spline_grid.hpp"

namespace sardf {

/// Gauss-Legendre points on [0, 1], ascending, and weights whose sum is 1.
struct GaussRule {
  std::vector<double> at, weight;
};
GaussRule gauss_rule(int points);

/// Points and weights: in cells wholly inside, a tensor-product Gauss rule; in the others, any.
struct Quadrature {
  int points = 4;            // of the rule, along each axis
  std::vector<size_t> full;  // cells with the rule, ascending
  /// Cells with points of their own, ascending: cell cut[i] has those from first[i] to first[i +
  /// 1].
  std::vector<size_t> cut, first{0};
  std::vector<Vec3> at;
  std::vector<double> weight;
  double volume = 0, volume_error = 0;

  size_t points_of_rule(const SplineGrid& grid) const;
  size_t size(const SplineGrid& grid) const;
};

/// Over the part of the box where the solid is not negative; a null one is the whole box. Cells
/// that may be cut are halved a few times; what is left at the boundary counts by the share that a
/// plane cuts off. Throws Error where the solid is empty, Cancelled.
Quadrature quadrature_over(const SplineGrid& grid, const Expression& solid, int points,
                           const Progress& progress);

/// From points inside the box in any order.
Quadrature quadrature_of(const SplineGrid& grid, const std::vector<Vec3>& at,
                         const std::vector<double>& weight);

}  // namespace sardf

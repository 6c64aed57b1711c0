// Cholesky factors of a banded symmetric matrix.
#pragma once

#include "sardf/fit_system.hpp"

namespace sardf {

/// Of S (A + a little of the diagonal) S, where S makes the diagonal of A one: a preconditioner,
/// also where A itself is singular.
class BandFactors {
 public:
  /// Whether making them takes less than some seconds.
  static bool are_cheap(const SplineGrid& grid);

  /// `scale`: the diagonal of S. Throws Cancelled.
  BandFactors(const FitSystem& system, const SplineGrid& grid, const std::vector<double>& scale,
              const Progress& pulse);
  /// x becomes the solution for the right-hand side x.
  void solve(std::vector<double>& x) const;

 private:
  double* row(size_t i) { return &entries_[i * (width_ + 1)]; }
  const double* row(size_t i) const { return &entries_[i * (width_ + 1)]; }
  void factor(const Progress& pulse);

  size_t n_, width_;
  std::vector<double> entries_;  // of row i: columns i - width_ to i
};

}  // namespace sardf

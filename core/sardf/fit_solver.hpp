// The minimum of a fit's energy, with or without a prescribed mean.
#pragma once

#include <optional>

#include "sardf/fit_system.hpp"

namespace sardf {

struct SolvedEquations {
  std::vector<double> coefficients;
  int iterations = 0;
  double residual = 0;  // of the equations scaled by their diagonal, relative
};

/// Conjugate gradients from `guess`, preconditioned by a band's factors where these are cheap, else
/// by the diagonal, in the subspace of the prescribed mean. Throws Error where the residual does
/// not fall below 1e-10, Cancelled.
SolvedEquations solve(const FitSystem& system, std::optional<double> mean,
                      std::vector<double> guess, const Progress& progress);

}  // namespace sardf

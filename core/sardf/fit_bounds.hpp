// Bounds of fitted functions.
#pragma once

#include "sardf/fit_solver.hpp"

namespace sardf {

/// Throws Error where bounds contradict each other, the mean, or the start where factor is 0.
void check_bounds(const FitProblem& problem, const FitSystem& system);

/// From the minimum without bounds to that with F inside the bounds at every point of the
/// quadrature, to 1e-6 of the largest magnitude. Throws Error where there is none, Cancelled.
SolvedEquations solve_within_bounds(const FitProblem& problem, FitSystem& system,
                                    SolvedEquations free, const Progress& progress);

/// By how much a function leaves the bounds at 200 000 points of the solid.
double measured_cut(const FitProblem& problem, const Expression& uncut, const Progress& progress);

}  // namespace sardf

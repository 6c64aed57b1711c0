// Functions F = start + factor * Phi, where Phi is a sum of B-splines whose coefficients minimise
// an energy: constraints of material functions that are stated, and solved.
//
// Source: Biswas, Shapiro, Tsukanov, sections 2.3 (eq. 6) and 3.3 (eq. 10, Ritz).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sardf/fit_quadrature.hpp"
#include "sardf/graph.hpp"
#include "sardf/progress.hpp"

namespace sardf {

/// What is minimised, over the solid (a null one: the grid's box):
///   values_weight * integral of (F - values)²
/// + slope_weight * integral of (grad F . grad along - slope)²
/// + smoothness * integral of |grad F|²,
/// each term only where its expression is not null, or its weight not 0.
struct FitProblem {
  SplineGrid grid;
  Expression start, factor, solid, values, slope, along;
  double values_weight = 1, slope_weight = 1, smoothness = 0;
  int points = 4;              // Gauss points for each cell and axis, 1 to 16
  std::optional<double> mean;  // of F, cut at its bounds, over the solid by the quadrature
  std::optional<double> at_least, at_most;

  friend bool operator==(const FitProblem&, const FitProblem&) = default;
};

struct FitReport {
  size_t unknowns = 0, quadrature_points = 0;
  int iterations = 0;
  /// Of the linear equations, relative to their right-hand side, scaled by their diagonal.
  double residual = 0;
  /// What is minimised, at Phi = 0 and at the solution; the root of it by the volume: for `values`
  /// or `slope` alone, with weight 1, the root mean square of what is left.
  double energy_before = 0, energy_after = 0, rms_before = 0, rms_after = 0;
  /// Energy of a part of the cells by one more Gauss point along each axis, relative to that by the
  /// points used: 1 where the quadrature is fine enough.
  double finer_energy = 1;
  double volume = 0;        // of the solid (an area in two dimensions)
  double volume_error = 0;  // what the last halving of cells at its boundary changed
  double mean = 0;          // of F, cut at its bounds, over the solid by the quadrature
  /// The most that F is cut by at_least and at_most at points between those of the quadrature.
  double cut = 0;
  double memory = 0;  // bytes, estimated before the work
  double seconds = 0;
};

struct FitResult {
  std::vector<double> coefficients;
  FitReport report;
};

/// Solves. Throws Error: no term at all, a field that depends on z in two dimensions, too much
/// memory, an empty solid, values that are not finite, contradictions between mean, bounds and
/// start, bounds that cut off more than 5 % of the function's range between the points of the
/// quadrature, a quadrature too coarse, equations that do not determine the function. Coefficients
/// of functions that no point of the quadrature sees are 0. The result does not depend on the
/// number of threads.
FitResult fit(const FitProblem& problem, const Progress& progress = {});
/// With another quadrature than that of the solid.
FitResult fit(const FitProblem& problem, const Quadrature& quadrature,
              const Progress& progress = {});

/// fit(), or its result when the same was solved lately in this process: scenes are read more than
/// once.
std::shared_ptr<const FitResult> recent_fit(const FitProblem& problem,
                                            const Progress& progress = {});

/// 16 hexadecimal digits that tell problems apart: of the expressions, the grid, the weights and
/// all other numbers. The same for equal problems in every process and on every machine; numbers
/// count to 12 digits. Of what an expression is made of by data (meshes, curves), every bit counts.
std::string fingerprint_of(const FitProblem& problem);

/// start + factor * Phi, cut at the bounds that the problem has.
Expression fitted_expression(const FitProblem& problem, std::vector<double> coefficients);

}  // namespace sardf

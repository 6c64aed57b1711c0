// Bounds of fitted functions.
#pragma once

#include <algorithm>
#include <string>

#include "sardf/fit_solver.hpp"

namespace sardf {

/// Of a function's range, what bounds may cut off between the points of the quadrature, where they
/// hold. Fits that resolve their bounds stay below a fiftieth (kinks of a minimum at the ends of
/// its contact, on a few splines); one that loses more than a twentieth is another function than
/// the constrained minimum, whose energy and mean were reported.
inline constexpr double largest_cut = 0.05;

/// What at_least and at_most allow; infinite where there is none.
struct Limits {
  explicit Limits(const FitProblem& problem);

  double within(double value) const { return std::min(std::max(value, lower), upper); }
  double violation(double value) const { return std::max({lower - value, value - upper, 0.0}); }
  /// "at_least is 0" or "at_most is 1", whichever the value breaks.
  std::string broken_by(double value) const;

  double lower, upper;
};

/// "0.5 at (0, 1, 2)".
std::string value_at(double value, const Vec3& at);
/// The largest of the values and the bounds.
double magnitude_of(const Limits& limits, const std::vector<double>& values);
/// Of values at the points of the quadrature, cut at the bounds.
double mean_within(const Limits& limits, const std::vector<double>& values,
                   const FitSystem& system);

/// Throws Error where bounds contradict each other, the mean, or the start where factor is 0: that
/// is searched for by search_boxes in all of the solid, with intervals of factor and start, and by
/// Newton's method from there. Throws Cancelled.
void check_bounds(const FitProblem& problem, const FitSystem& system, const Progress& progress);

/// From the minimum without bounds to that with F inside the bounds at every point of the
/// quadrature, to 1e-6 of the largest magnitude. The mean, where it is prescribed, is that of F
/// after it is cut at the bounds, to 1e-7 of its range by the same quadrature. Throws Error where
/// there is none, Cancelled.
SolvedEquations solve_within_bounds(const FitProblem& problem, FitSystem& system,
                                    SolvedEquations free, const Progress& progress);

/// By how much a function leaves its bounds in the solid.
struct Cut {
  double most = 0;
  Vec3 at{};         // where
  double value = 0;  // before the cut, there
  double range = 0;  // of the function that is cut
};
/// Measured at 200 000 points of the box.
Cut measured_cut(const FitProblem& problem, const Expression& uncut, const Progress& progress);
/// Throws Error where a cut is more than largest_cut of the function's range.
void check_cut(const FitProblem& problem, const Cut& cut);

}  // namespace sardf

#include "sardf/shapes_fit.hpp"

#include <cmath>

#include "sardf/spline_operation.hpp"

namespace sardf {

namespace {

void check_number_of(const std::vector<double>& coefficients, const SplineGrid& grid) {
  if (coefficients.size() == grid.size()) return;
  throw Error("there are " + std::to_string(coefficients.size()) + " coefficients; " +
              std::to_string(grid.size()) + ", one for each spline, are accepted");
}

void check_fingerprint(const std::string& given, const FitProblem& problem) {
  const std::string is = fingerprint_of(problem);
  if (given == is) return;
  throw Error("the coefficients solve another problem: their fingerprint is " + given +
              ", that of this one " + is +
              "; remove coefficients and fingerprint, or run `sardf solve` again");
}

Expression expression_of(const std::optional<Field>& field) {
  return field ? field->expression() : nullptr;
}

int points_of(double points) {
  if (points >= 1 && points <= 16 && points == std::floor(points)) return int(points);
  char text[32];
  std::snprintf(text, sizeof text, "%g", points);
  throw Error(std::string("points is ") + text + "; a whole number from 1 to 16 is accepted");
}

}  // namespace

thread_local bool IgnoredCoefficients::active_ = false;

Expression SplineField::expression() const {
  const SplineGrid grid = spline_grid(lower, upper, counts, degree);
  check_number_of(coefficients, grid);
  const std::array<Expression, 3> xyz{coordinate(0), coordinate(1), coordinate(2)};
  return call(spline_operation(grid, coefficients), std::span(xyz.data(), size_t(grid.dimensions)));
}

FitProblem Fitted::problem() const {
  FitProblem p;
  const bool alike = splines.size() == 1;
  p.grid = spline_grid(lower, upper, alike ? std::vector<double>(3, splines[0]) : splines, degree);
  p.start = start.expression();
  p.factor = factor ? factor->expression() : constant(1);
  p.solid = expression_of(solid);
  p.values = expression_of(values);
  p.slope = expression_of(slope);
  p.along = expression_of(along);
  p.values_weight = values_weight;
  p.slope_weight = slope_weight;
  p.smoothness = smoothness;
  p.points = points_of(points);
  p.mean = mean;
  p.at_least = at_least;
  p.at_most = at_most;
  return p;
}

Expression Fitted::expression() const {
  const FitProblem p = problem();
  if (!coefficients.empty() && !IgnoredCoefficients::active()) {
    check_number_of(coefficients, p.grid);
    if (!fingerprint.empty()) check_fingerprint(fingerprint, p);
    return fitted_expression(p, coefficients);
  }
  return fitted_expression(p, recent_fit(p, ProgressScope::current())->coefficients);
}

}  // namespace sardf

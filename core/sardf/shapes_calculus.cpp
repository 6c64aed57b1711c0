#include "sardf/shapes_calculus.hpp"

#include <cmath>

#include "sardf/arithmetic.hpp"
#include "sardf/derivative.hpp"
#include "sardf/formula.hpp"
#include "sardf/short_number.hpp"
#include "sardf/symbol.hpp"
#include "sardf/taylor_series.hpp"

namespace sardf {

Expression At::expression() const {
  if (point.size() != 3) {
    throw Error("point has " + std::to_string(point.size()) + " elements; 3 are accepted");
  }
  return substitute(field.expression(),
                    {point[0].expression(), point[1].expression(), point[2].expression()});
}

Expression Derivative::expression() const {
  return derivative(field.expression(), normalized(axis.direction));
}

Expression GradientLength::expression() const {
  return gradient_length(gradient(field.expression()));
}

Expression NormalDerivative::expression() const {
  const Expression both[] = {field.expression(), distance.expression()};
  const std::vector<std::array<Expression, 3>> slopes = gradients(both);
  Symbol sum;
  for (size_t axis = 0; axis < 3; ++axis) {
    sum = sum + Symbol(slopes[0][axis]) * Symbol(slopes[1][axis]);
  }
  return sum.node;
}

Expression Conditioned::expression() const {
  return substitute(field.expression(), foot(distance.expression()));
}

namespace {

// Σ factors_k u^k.
Expression polynomial(const std::vector<Symbol>& factors, const Expression& u) {
  Symbol sum;
  for (size_t k = 0; k < factors.size(); ++k) {
    sum = sum + factors[k] * pow(Symbol(u), Symbol(double(k)));
  }
  return sum.node;
}

}  // namespace

Expression CanonicalForm::expression() const {
  // 64 derivatives are more than u^k can be computed for.
  constexpr size_t most = 64;
  if (coefficients.size() > most) {
    throw Error("coefficients has " + std::to_string(coefficients.size()) + " elements; at most " +
                std::to_string(most) + " are accepted");
  }
  std::vector<Symbol> factors;
  double factorial = 1;
  for (size_t k = 0; k < coefficients.size(); ++k) {
    if (k > 0) factorial *= double(k);
    factors.push_back(Symbol(1 / factorial) * Symbol(coefficients[k].expression()));
  }
  if (remainder) factors.push_back(Symbol(remainder->expression()));
  return polynomial(factors, distance.expression());
}

Expression Taylor::expression() const {
  constexpr double most = 32;
  const double last = first_term + terms - 1;
  if (last > most) {
    throw Error("the last term is number " + short_number(last, 6) + "; at most 32 are accepted");
  }
  const std::vector<double> series = taylor_coefficients(formula, int(last));
  std::vector<Symbol> factors;
  for (size_t k = 0; k < series.size(); ++k) {
    factors.push_back(double(k + 1) < first_term ? 0.0 : series[k]);
  }
  return polynomial(factors, distance.expression());
}

}  // namespace sardf

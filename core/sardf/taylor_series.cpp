#include "sardf/taylor_series.hpp"

#include <cmath>
#include <unordered_map>

#include "sardf/error.hpp"
#include "sardf/formula.hpp"
#include "sardf/numbers/replay.hpp"
#include "sardf/numbers/series.hpp"

namespace sardf {

namespace {

using Coefficients = Series<double>;

Coefficients applied(const Operation& operation, std::span<const Coefficients> inputs) {
  // The operation's formula has the slope 0 at 0, lest it be infinite. Here it must be.
  if (operation.info().name == "sqrt" && inputs[0][0] == 0) return sqrt(inputs[0]);
  Trace trace(operation.info().arity, Trace::Detail::differentiable);
  operation.record(trace);
  return replay(trace, inputs);
}

// Of an expression of the first coordinate.
Coefficients series_at_zero(const Expression& f, int order) {
  std::unordered_map<const Node*, Coefficients> found;
  for (const Node* node : topological_order({&f, 1})) {
    if (node->type == Node::Type::constant) {
      found[node] = Coefficients(node->value);
    } else if (node->type == Node::Type::coordinate) {
      found[node] = Coefficients({0, 1}, order);
    } else {
      std::vector<Coefficients> inputs;
      for (const Expression& input : node->arguments()) inputs.push_back(found.at(input.get()));
      found[node] = applied(*node->operation, inputs);
    }
  }
  return found.at(f.get());
}

}  // namespace

std::vector<double> taylor_coefficients(const std::string& formula, int count) {
  // With a number for u nothing may vary.
  if (parse_formula(formula, {{"u", Field::number(0.5)}}, {}).expression()->coordinates) {
    throw Error("the formula '" + formula + "' depends on x, y or z; a function of u is accepted");
  }
  const Expression f = parse_formula(formula, {{"u", Field::coordinate(0)}}, {}).expression();
  const Coefficients series = series_at_zero(f, count - 1);
  std::vector<double> out;
  for (int k = 0; k < count; ++k) {
    if (!std::isfinite(series[k])) {
      throw Error("the formula '" + formula + "' is singular at u = 0: its term " +
                  std::to_string(k + 1) + ", of u^" + std::to_string(k) + ", has no finite value");
    }
    out.push_back(series[k]);
  }
  return out;
}

}  // namespace sardf

#include "sardf/polynomial.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <unordered_map>
#include <utility>

namespace sardf {

namespace {

// Longer polynomials are not multiplied out.
constexpr size_t most_terms = 1000;
constexpr double rounding = 1e-12;

// Unknowns with their powers, in the order of their addresses.
using Monomial = std::vector<std::pair<const Node*, int>>;

struct Coefficient {
  double value = 0;
  double largest = 0;  // magnitude of what it was summed from
};

using Polynomial = std::map<Monomial, Coefficient>;

Polynomial of_number(double value) { return {{{}, {value, std::abs(value)}}}; }
Polynomial of_unknown(const Node* node) { return {{{{node, 1}}, {1, 1}}}; }

void add(Polynomial& to, const Monomial& monomial, const Coefficient& by) {
  Coefficient& sum = to[monomial];
  sum.value += by.value;
  sum.largest = std::max({sum.largest, by.largest, std::abs(sum.value)});
}

Polynomial sum(const Polynomial& a, const Polynomial& b, double factor) {
  Polynomial out = a;
  for (const auto& [monomial, c] : b) {
    add(out, monomial, {factor * c.value, std::abs(factor) * c.largest});
  }
  return out;
}

Monomial product(const Monomial& a, const Monomial& b) {
  std::map<const Node*, int> powers(a.begin(), a.end());
  for (const auto& [unknown, power] : b) powers[unknown] += power;
  return {powers.begin(), powers.end()};
}

using Maybe = std::optional<Polynomial>;

Maybe product(const Polynomial& a, const Polynomial& b) {
  if (a.size() * b.size() > most_terms) return std::nullopt;
  Polynomial out;
  for (const auto& [m, c] : a) {
    for (const auto& [n, d] : b) {
      add(out, product(m, n), {c.value * d.value, c.largest * d.largest});
    }
  }
  return out;
}

Maybe power(const Polynomial& a, int exponent) {
  Maybe out = of_number(1);
  for (int i = 0; i < exponent && out; ++i) out = product(*out, a);
  return out;
}

Polynomial affine(const Node& node) {
  const std::vector<double>& numbers = node.operation->numbers();
  Polynomial out = of_number(numbers.at(3));
  for (size_t axis = 0; axis < 3; ++axis) {
    const Expression& input = node.inputs[axis];
    const Polynomial one = is_constant(input) ? of_number(input->value) : of_unknown(input.get());
    out = sum(out, one, numbers.at(axis));
  }
  return out;
}

// Of an operation whose inputs are known; nullopt for one that is an unknown itself.
Maybe of_operation(const Node& node, const std::vector<const Polynomial*>& in) {
  const std::string& name = node.operation->info().name;
  if (name == "add") return sum(*in[0], *in[1], 1);
  if (name == "subtract") return sum(*in[0], *in[1], -1);
  if (name == "negate") return sum({}, *in[0], -1);
  if (name == "multiply") return product(*in[0], *in[1]);
  if (name == "square") return product(*in[0], *in[0]);
  if (name == "integer_power") return power(*in[0], int(node.operation->numbers().at(0)));
  if (name == "affine") return affine(node);
  if (name == "divide" && is_constant(node.inputs[1]) && node.inputs[1]->value != 0) {
    return sum({}, *in[0], 1 / node.inputs[1]->value);
  }
  if (name == "mix") {
    const Maybe part = product(sum(*in[1], *in[0], -1), *in[2]);
    return part ? Maybe(sum(*in[0], *part, 1)) : std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

std::optional<double> proven_constant(const Expression& expression) {
  std::unordered_map<const Node*, Polynomial> known;
  for (const Node* node : topological_order({&expression, 1})) {
    Maybe made;
    if (node->type == Node::Type::constant) made = of_number(node->value);
    if (node->type == Node::Type::operation) {
      std::vector<const Polynomial*> in;
      for (const Expression& input : node->arguments()) in.push_back(&known.at(input.get()));
      made = of_operation(*node, in);
    }
    known[node] = made && made->size() <= most_terms ? std::move(*made) : of_unknown(node);
  }
  double value = 0;
  for (const auto& [monomial, c] : known.at(expression.get())) {
    if (monomial.empty()) {
      value = c.value;
    } else if (!(std::abs(c.value) <= rounding * std::max(1.0, c.largest))) {
      return std::nullopt;
    }
  }
  return value;
}

}  // namespace sardf

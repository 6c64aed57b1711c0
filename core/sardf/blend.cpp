#include "sardf/blend.hpp"

#include <functional>
#include <unordered_map>

#include "sardf/arithmetic.hpp"

namespace sardf {

namespace {

using Inputs = std::span<const Expression>;
/// Makes the node that takes an operation's place.
using Make = std::function<Expression(const OperationPointer&, Inputs)>;

std::vector<Expression> rebuilt(Inputs expressions, const Make& make) {
  std::unordered_map<const Node*, Expression> made;
  for (const Expression& e : expressions) made[e.get()] = e;
  for (const Node* node : topological_order(expressions)) {
    for (const Expression& input : node->arguments()) made.try_emplace(input.get(), input);
    if (node->type != Node::Type::operation) continue;
    std::array<Expression, max_arity> inputs;
    for (int i = 0; i < node->arity; ++i) inputs[i] = made.at(node->inputs[i].get());
    made[node] = make(node->operation, {inputs.data(), node->arity});
  }
  std::vector<Expression> out;
  for (const Expression& e : expressions) out.push_back(made.at(e.get()));
  return out;
}

const OperationPointer& counterpart(const Blend& blend, const OperationPointer& operation) {
  switch (operation->join()) {
    case Join::intersection:
      return blend.intersection;
    case Join::unite:
      return blend.unite;
    case Join::difference:
      return blend.difference;
    default:
      return operation;
  }
}

}  // namespace

std::vector<Expression> joined_by(const Blend& blend, Inputs expressions) {
  return rebuilt(expressions, [&](const OperationPointer& operation, Inputs inputs) {
    return call(counterpart(blend, operation), inputs);
  });
}

Expression joined_by(const Blend& blend, const Expression& expression) {
  return joined_by(blend, {&expression, 1})[0];
}

Expression without_blends(const Expression& expression) {
  const auto plain = [](const OperationPointer& operation, Inputs in) {
    switch (operation->join()) {
      case Join::intersection:
        return min(in[0], in[1]);
      case Join::unite:
        return max(in[0], in[1]);
      case Join::difference:
        return min(in[0], -in[1]);
      default:
        return call(operation, in);
    }
  };
  return rebuilt({&expression, 1}, plain)[0];
}

}  // namespace sardf

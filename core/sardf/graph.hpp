// Immutable, hash-consed expressions: what every field, fraction and colour is lowered to.
//
// Equal expressions are one node, so a shared part is evaluated once. Graphs may be 100 000 levels
// deep: nothing here recurses, destruction included.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <vector>

#include "sardf/operation.hpp"
#include "sardf/vec.hpp"

namespace sardf {

/// Expression (operation.hpp) is a handle to an immutable node; never null in a graph. Equal
/// expressions have equal pointers.

struct Node {
  enum class Type : uint8_t { constant, coordinate, operation };
  Type type = Type::constant;
  uint8_t axis = 0;         // coordinate: 0, 1, 2 for x, y, z
  uint8_t arity = 0;        // operation: number of inputs
  uint8_t coordinates = 0;  // bit i: the value depends on coordinate i
  double value = 0;         // constant
  OperationPointer operation;
  std::array<Expression, max_arity> inputs;

  std::span<const Expression> arguments() const { return {inputs.data(), arity}; }
};

Expression constant(double value);
Expression coordinate(int axis);
/// The operation applied to the inputs (as many as its arity). Constant inputs are folded.
Expression call(const OperationPointer& operation, std::initializer_list<Expression> inputs);
Expression call(const OperationPointer& operation, std::span<const Expression> inputs);

bool is_constant(const Expression& expression);

/// The expression with the coordinates x, y, z replaced.
Expression substitute(const Expression& expression, const std::array<Expression, 3>& coordinates);
/// Several at once: parts they share stay shared.
std::vector<Expression> substitute(std::span<const Expression> expressions,
                                   const std::array<Expression, 3>& coordinates);

/// Every node that the roots need, each once, inputs before their users.
std::vector<const Node*> topological_order(std::span<const Expression> roots);

/// Number of nodes alive in the process; for tests of sharing and of destruction.
size_t live_nodes();

}  // namespace sardf

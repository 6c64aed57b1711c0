// A chosen way to join two fields, with its parameters.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sardf/graph.hpp"

namespace sardf {

struct Blend {
  std::string name;
  std::vector<double> parameters;  // in the order of the blend type's parameters
  OperationPointer intersection, unite, difference;
  /// Whether min and max are joined without any change of the distance.
  bool is_min_max = false;
};
using BlendPointer = std::shared_ptr<const Blend>;

/// The expressions with every union, intersection and difference of two fields joined by `blend`
/// in place of its own; parts they share stay shared. min and max in formulas stay what they are.
std::vector<Expression> joined_by(const Blend& blend, std::span<const Expression> expressions);
Expression joined_by(const Blend& blend, const Expression& expression);
/// The same with plain minima and maxima, which no later joined_by replaces: the tree that an
/// approximate distance is measured against (sardf paper, 3.2).
Expression without_blends(const Expression& expression);

}  // namespace sardf

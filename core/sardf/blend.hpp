// A chosen way to join two fields, with its parameters.
#pragma once

#include <memory>
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

}  // namespace sardf

// The three shapes that evaluation is measured on, as expressions and with their bounds.
#pragma once

#include <string>

#include "sardf/evaluate.hpp"

namespace sardf::bench {

enum class Shape { spheres, block, blended_block };

/// 16 spheres in a plane with a box subtracted (min and max); a block with five holes and a torus
/// (min and max); the same with SARDF of radius 0.5.
Expression shape(Shape which);
/// A box around the shape, 10 % larger.
BoundingBox bounds(Shape which);
std::string name(Shape which);

}  // namespace sardf::bench

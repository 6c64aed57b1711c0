// How far single precision may be off; private to core/sardf/render*.cpp.
#pragma once

#include "sardf/evaluate.hpp"

namespace sardf::rendering {

/// Whether all of it is computed in single precision: what has no formula is in double in any case.
bool is_single(const Evaluator& evaluator);

/// Bounds |value in single precision - value in double| of the first output at points of the box
/// whose coordinates are rounded to single precision. Infinite where nothing is known.
double single_precision_error(const Evaluator& evaluator, const BoundingBox& box);

/// The like for double against real numbers, for a field of this slope: the part that does not
/// grow with the value.
double double_precision_error(const BoundingBox& box, double slope);

}  // namespace sardf::rendering

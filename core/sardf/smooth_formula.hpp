// Formulas without kinks, bounded by their second derivatives.
//
// Interval arithmetic does not know that the terms of a sum vary together: of sin x cos y + ... it
// finds gradients that are too long by a part that shrinks with the box only as fast as the box.
// The mean value form of the squared length g = |grad f|², g(centre) + (box - centre) · grad g with
// grad g = 2 H grad f, is too large by a part that shrinks with the square of the box where the
// gradient is steepest: there grad g vanishes.
#pragma once

#include "sardf/graph.hpp"

namespace sardf {

/// The same values and derivatives, from an expression for bounds: its largest parts that are made
/// of coordinates, numbers, sums, products, quotients, roots, exponentials, logarithms and
/// trigonometry alone, and are not linear, become one operation each, with these bounds.
Expression with_smooth_bounds(const Expression& expression);

}  // namespace sardf

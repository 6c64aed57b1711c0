// Exact derivatives and Taylor coefficients of expressions, as expressions again.
//
// Every operation's formula is replayed in the algebra of derivatives, so what comes out consists
// of the elementary functions of the formula language: it has bounds, gradients, batches and
// POV-Ray text like any field, and can be differentiated again. An operation without a formula
// gives its own first derivative (Operation::derivative): fitted B-splines have them of every
// order, distances that a search finds of the first and the second.
//
// At a kink (min, max, abs, select) the derivative is that of the branch that gives the value, the
// second argument's where both do, as for gradients (numbers/gradient.hpp). Where a length vanishes
// (a feature's points, an axis) there is no direction: NaN. A branch that is not taken has no part.
// Blends are differentiated as they stand: joined_by (blend.hpp) replaces none of a derivative.
//
// The work is linear in the number of nodes, and nothing recurses over them. Errors: an operation
// without a formula whose derivative is not known, as the third one of a searched distance.
#pragma once

#include <span>
#include <vector>

#include "sardf/graph.hpp"

namespace sardf {

/// The derivative by coordinate 0, 1 or 2.
Expression derivative(const Expression& f, int axis);
/// The derivative along a constant vector, times its length.
Expression derivative(const Expression& f, const Vec3& along);
std::array<Expression, 3> gradient(const Expression& f);
/// Several at once: parts they share stay shared.
std::vector<std::array<Expression, 3>> gradients(std::span<const Expression> fs);

/// √(f_x² + f_y² + f_z²).
Expression gradient_length(const std::array<Expression, 3>& gradient);

/// The Taylor coefficients c_0, ..., c_order of s -> f(p + s d(p)) at s = 0: c_k is 1/k! times the
/// k-th derivative along d, whose own change with p does not count. About order² / 2 times as many
/// nodes as f has.
std::vector<Expression> directional_series(const Expression& f,
                                           const std::array<Expression, 3>& direction, int order);

/// p - u ∇u, the point of the feature that is nearest to p; p itself where the distance u is 0, and
/// exactly the nearest point where u is one that a search finds (data_operation.hpp).
std::array<Expression, 3> foot(const Expression& distance);

}  // namespace sardf

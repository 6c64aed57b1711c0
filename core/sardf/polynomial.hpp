// What an expression is as a polynomial: enough algebra to prove that a sum is constant.
#pragma once

#include <optional>

#include "sardf/graph.hpp"

namespace sardf {

/// The number that the expression equals wherever its parts have a value, if that follows from
/// collecting terms: sums, products and whole powers are multiplied out, any other operation is an
/// unknown, and what is left of a term's coefficient below 1e-12 of its largest part counts as
/// rounding. Empty where that proves nothing.
std::optional<double> proven_constant(const Expression& expression);

}  // namespace sardf

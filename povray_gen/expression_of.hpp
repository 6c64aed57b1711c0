// A program as the graph that it was made from, or would be.
#pragma once

#include "sardf/evaluate.hpp"

namespace sardf::povray {

/// The expression of an evaluator's first output; equal parts of two such expressions are shared.
Expression expression_of(const Evaluator& evaluator);

}  // namespace sardf::povray

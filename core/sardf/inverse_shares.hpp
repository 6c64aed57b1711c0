// Shares by inverse distances without logarithms, and sums with factors.
#pragma once

#include <span>
#include <vector>

#include "sardf/graph.hpp"

namespace sardf {

/// ui^-k / Σ uj^-k for the distances u: 2 to 4 of them and an exponent k that is a
/// multiple of 1/2, from 1 on, with k (n - 1) <= 8, so that the products that are formed stay far
/// from the limits of floats; else empty. A distance of at most `least` counts as 0; where some are
/// 0 these share evenly. A distance beyond 1e37, for even k beyond 3e18, counts as that.
std::vector<Expression> inverse_shares(std::vector<Expression> u, double exponent, double least);

/// Σ factor × value, up to four terms in one operation; terms whose factor is 0 are left out.
Expression weighted_sum(std::span<const Expression> values, std::span<const double> factors);

}  // namespace sardf

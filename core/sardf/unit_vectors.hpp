// Vectors of length 1, as the direction of a material's grain.
#pragma once

#include "sardf/fractions.hpp"

namespace sardf {

/// The vector divided by its length. Where no component is larger than 1e-12 of `prescribed`, as
/// where opposed directions cancel, the direction of `fallback` counts. Finite components give a
/// vector of length 1 everywhere, but for rounding.
/// Source: Biswas, Shapiro, Tsukanov 2004, section 4.1.
std::vector<Expression> unit_vector(const std::vector<Expression>& vector,
                                    const Expression& prescribed, const Vec3& fallback);

/// The largest magnitude of any component that any part of a rule for values prescribes.
Expression largest_prescribed(const Fractions& rule);

}  // namespace sardf

// How steep a field is near its surface.
#pragma once

#include <optional>

#include "sardf/evaluate.hpp"

namespace sardf::povray {

/// Bound of |grad min(c, max(-c, f))| over the box, where c is the band: of the gradient of f
/// where |f| <= c. The box is split where the bound is largest, into at most `boxes` parts, until
/// the bound lies within 0.1 % of a gradient that the field attains. Infinity if there is no bound;
/// nothing where it is proven that no value lies in the band.
std::optional<double> band_bound(const Evaluator& field, const BoundingBox& box, double band,
                                 int boxes);

}  // namespace sardf::povray

// A box that is proven to hold a solid.
#pragma once

#include <optional>

#include "sardf/evaluate.hpp"

namespace sardf {

/// An axis-aligned box outside of which the solid (field >= 0; first output) is proven empty by
/// interval arithmetic, for coordinates up to 1e12 scene units. It is tight to about a few ten
/// thousandths of its diagonal and then padded by 1e-4 of it. Throws Error for a solid that is
/// empty, that is unbounded (or whose bounds intervals cannot prove), or that reaches out of the
/// `stated` box; and Cancelled.
BoundingBox certified_bounds(const Evaluator& field, const Progress& progress = {},
                             const std::optional<BoundingBox>& stated = {});

}  // namespace sardf

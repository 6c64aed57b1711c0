// Where a costly part of a formula need not be evaluated because a cheap bound shows that it does
// not count: exact, in contrast to replacing its value by the bound.
#pragma once

#include <optional>

#include "sardf/graph.hpp"

namespace sardf::povray {

/// A cheap field that nowhere is less than that of the node: the signed distance to a box around
/// the solid. Only for costly exact distances of bounded solids, else null.
Expression cheap_upper_bound(const Node& node);

/// What an operation on two values does where one of them is small enough.
enum class Keeps {
  nothing,
  other_or_more,  // it gives the other, as a union does; it never decreases with this one
  other_or_less,  // it gives the other, as a difference does; it never increases with this one
};
/// For the input `small`, 0 or 1.
Keeps keeps_other(const Operation& operation, int small);

}  // namespace sardf::povray

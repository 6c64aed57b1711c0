// The fields that arguments and rules hold: one place for whoever walks over constructions.
#pragma once

#include <vector>

#include "sardf/fractions.hpp"

namespace sardf {

/// Appends the fields of an argument of a constructor, those inside a rule included, in order.
void append_fields(const Value& value, std::vector<Field>& to);
/// The same for a rule, which may be empty.
void append_fields(const Fractions& fractions, std::vector<Field>& to);

/// Whether the field's values are distances in scene units, or estimates of them as blends make.
/// Not so of numbers, formulas, functions, lofts, `blend_error`, and solids that are no distance by
/// themselves, such as quadrics; nor of what joins, changes or moves one of these. `normalized`
/// makes a distance of any.
bool is_distance(const Field& field);

}  // namespace sardf

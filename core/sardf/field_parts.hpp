// The fields that arguments and rules hold: one place for whoever walks over constructions.
#pragma once

#include <vector>

#include "sardf/fractions.hpp"

namespace sardf {

/// Appends the fields of an argument of a constructor, those inside a rule included, in order.
void append_fields(const Value& value, std::vector<Field>& to);
/// The same for a rule, which may be empty.
void append_fields(const Fractions& fractions, std::vector<Field>& to);

}  // namespace sardf

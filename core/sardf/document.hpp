// The reference of all operations as a document, from the registries.
#pragma once

#include <string>

namespace sardf {

/// docs/operations.md: constructors by group, blends, functions of formulas, fraction rules.
std::string operations_document();

}  // namespace sardf

// docs/operations.md, made from the registries.
#pragma once

#include <string>

namespace sardf {

/// Every constructor by group, blend, fraction rule and function of the formula language, with its
/// parameters, units, ranges and defaults, as Markdown.
std::string operations_document();

}  // namespace sardf

// Fields written as a list of elementary steps: the `.vm` files of Fidget's examples.
//
// One step a line: a name, an operation and the names of its operands, separated by blanks. What
// follows a # is a comment. The last line is the result. Operations: `const` with a number; var-x,
// var-y, var-z; of one operand neg, abs, square, sqrt, recip, exp, ln, sin, cos, tan, asin, acos,
// atan, floor, ceil; of two operands add, sub, mul, div, min, max, mod, atan2. Unlike everywhere
// else in sardf, such a field is negative inside.
#pragma once

#include <string>

#include "sardf/graph.hpp"

namespace sardf {

/// The field that a text describes, with the sign of sardf: positive inside. `file` is named in
/// errors. Throws Error with the line of what is wrong.
Expression parse_vm(const std::string& text, const std::string& file = "");
/// The same from a file. Throws Error where it cannot be read.
Expression read_vm(const std::string& path);

}  // namespace sardf

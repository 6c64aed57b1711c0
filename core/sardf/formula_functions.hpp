// What the operators and functions of the formula language stand for.
#pragma once

#include <string>
#include <vector>

#include "sardf/graph.hpp"

namespace sardf {

/// `symbol` is one of + - * / ^ < <= > >= == !=.
Expression apply_operator(const std::string& symbol, const Expression& a, const Expression& b);

bool is_function(const std::string& name);
/// The functions that are offered to users: length stands for length2 and length3.
std::vector<std::string> all_functions();

/// What is wrong with that many arguments, or "".
std::string arguments_message(const std::string& function, size_t count);

}  // namespace sardf

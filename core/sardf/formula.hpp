// The formula language: text over x, y, z, parameters and named fields becomes an expression.
//
//   + - * / ^      ^ binds tighter than a minus sign before it and groups from the right
//   < <= > >= == !=    1 where it holds, else 0
//   functions of function_names(); min and max of two or more; length of two or three;
//                      at(f, a, b, c): f at another point; dx(f), dy(f), dz(f): its derivatives
//   x y z pi, numbers, parameters, named fields
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "sardf/field.hpp"

namespace sardf {

/// Parses a formula. The field's construction holds those of `names` that the text uses, parameters
/// as numbers. Errors say "at character N: ...", N from 1, with the nearest valid name.
Field parse_formula(const std::string& text, const std::map<std::string, Field>& names,
                    const std::map<std::string, double>& parameters);

/// A formula without x, y, z and fields: a finite number.
double parse_number(const std::string& text, const std::map<std::string, double>& parameters);

/// A function of the formula language applied to arguments, as the parser applies it. Throws Error
/// for an unknown name or a wrong number of arguments.
Expression apply_function(const std::string& name, std::span<const Expression> arguments);

/// √a; the length of a vector where a is a sum of squares, whose slope is bounded.
Expression square_root(const Expression& a);

/// The names in a formula that are neither functions nor x, y, z, pi; each once. Does not throw.
std::vector<std::string> names_in_formula(const std::string& text);
/// The formula with names replaced, all else as it stands.
std::string rename_in_formula(const std::string& text,
                              const std::map<std::string, std::string>& new_names);

/// Whether the word can name a field or a parameter: letters, digits and _, not starting with a
/// digit, and not x, y, z or pi.
bool is_name(const std::string& word);

}  // namespace sardf

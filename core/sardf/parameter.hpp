// How an operation or a constructor describes its parameters: one visit of its members, from which
// the scene-file keyword, its schema, the Python function and the documentation are derived.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sardf/vec.hpp"

namespace sardf {

/// A direction; it need not have unit length but must not vanish.
struct Axis {
  Vec3 direction{0, 0, 1};
};

enum class Unit { none, length, angle, direction, ratio };

/// What values are accepted beyond being finite; a count is a whole number from 1.
enum class Range { any, positive, non_negative, count };

struct Parameter {
  const char* name;
  const char* doc;
  Unit unit = Unit::none;
  Range range = Range::any;
  /// Required: the user must give it. Otherwise the member's initial value is its default.
  bool required = false;
  /// Fewest elements of a list.
  int at_least = 0;
};

/// Whether values are measured in what fields and coordinates are, or may be: not an angle, a
/// direction, a count or another pure number.
constexpr bool is_measured(const Parameter& p) {
  return (p.unit == Unit::none || p.unit == Unit::length) && p.range != Range::count;
}

// Short forms for the common parameters.
constexpr Parameter length_of(const char* name, const char* doc) {
  return {name, doc, Unit::length};
}
constexpr Parameter positive_length(const char* name, const char* doc) {
  return {name, doc, Unit::length, Range::positive, true};
}
constexpr Parameter required_length(const char* name, const char* doc) {
  return {name, doc, Unit::length, Range::any, true};
}
constexpr Parameter count_of(const char* name, const char* doc, bool required = false) {
  return {name, doc, Unit::none, Range::count, required};
}
constexpr Parameter direction_of(const char* name, const char* doc) {
  return {name, doc, Unit::direction};
}

/// Appends the numbers that a parameter's value consists of: an operation's identity.
inline void append_numbers(std::vector<double>& to, double a) { to.push_back(a); }
inline void append_numbers(std::vector<double>& to, bool a) { to.push_back(a); }
inline void append_numbers(std::vector<double>& to, int a) { to.push_back(a); }
template <size_t N>
void append_numbers(std::vector<double>& to, const std::array<double, N>& a) {
  to.insert(to.end(), a.begin(), a.end());
}
inline void append_numbers(std::vector<double>& to, const Axis& a) {
  append_numbers(to, a.direction);
}
template <class T>
void append_numbers(std::vector<double>& to, const std::optional<T>& a) {
  to.push_back(a.has_value());
  if (a) append_numbers(to, *a);
}
template <class T>
void append_numbers(std::vector<double>& to, const std::vector<T>& a) {
  to.push_back(double(a.size()));
  for (const T& element : a) append_numbers(to, element);
}

}  // namespace sardf

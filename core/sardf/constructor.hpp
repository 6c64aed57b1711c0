// The constructors: what scene files, Python, Blender and the documentation offer by name.
//
// Every solid, plane and feature operation is one; the others are structs of shapes_*.hpp. All are
// described by data, so that every front end loops over constructors() and none names one.
#pragma once

#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "sardf/field.hpp"
#include "sardf/parameter.hpp"

namespace sardf {

enum class ParameterType {
  boolean,
  number,
  optional_number,
  text,
  vector2,
  vector3,
  optional_vector3,
  optional_vector4,
  axis,
  numbers,
  points2,
  points3,
  point_grid,
  field,
  optional_field,
  fields,
  values,
  sections,
  rule,
  path,
  blend,
};

/// As a scene file says it: "number", "3 numbers", "axis", "field", ...
std::string type_name(ParameterType type);

struct ParameterInfo {
  std::string name, doc;
  Unit unit = Unit::none;
  Range range = Range::any;
  bool required = false;
  int at_least = 0;
  ParameterType type = ParameterType::number;
  Value default_value;
};

struct Constructor {
  std::string name, group, doc;
  std::vector<ParameterInfo> parameters;
  /// Makes the field. One argument for each parameter, in order, already checked.
  std::function<Field(const Constructor&, std::vector<Value>)> make;
  /// Whether making one may take long, and then reports to the ProgressScope.
  bool takes_progress = false;
  /// Place of the list of fields that Python takes as positional arguments, or -1: the first
  /// parameter, where it is one.
  int variadic() const;
};

struct BlendType {
  std::string name, doc;
  std::vector<ParameterInfo> parameters;
  std::function<BlendPointer(const std::vector<Value>&)> make;
};

/// All constructors in the order of the operation list and the shape lists.
const std::deque<Constructor>& constructors();
const std::vector<BlendType>& blend_types();
/// nullptr when there is none of the name.
const Constructor* find_constructor(const std::string& name);
const BlendType* find_blend_type(const std::string& name);
/// Adds one at run time (an extension's or a test's operation). Error when the name is taken.
void add_constructor(Constructor constructor);

/// The operations of the formula language by name; nullptr when there is none.
OperationPointer find_function(const std::string& name);
std::vector<std::string> function_names();
void add_function(OperationPointer operation);

/// Checks a value against its parameter: finite, in range, long enough. Throws Error whose message
/// starts with the parameter's name.
void check_argument(const ParameterInfo& parameter, const Value& value);

/// Checks all arguments and makes the field; those left out at the end have their defaults. Errors
/// name the constructor.
Field make_field(const Constructor& constructor, std::vector<Value> arguments);
/// By name; throws Error with the nearest name when there is none.
Field make_field(const std::string& constructor, std::vector<Value> arguments);
BlendPointer make_blend(const std::string& name, const std::vector<Value>& arguments);
BlendPointer min_max_blend();

}  // namespace sardf

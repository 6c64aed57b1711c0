#include "convert.hpp"

#include <algorithm>

#include "python_progress.hpp"
#include "sardf/error.hpp"
#include "sardf/formula.hpp"
#include "sardf/fractions.hpp"
#include "sardf/number_text.hpp"
#include "sardf/scene_file.hpp"

namespace sardf {

namespace {

std::string shown(const py::handle& value) {
  std::string text = py::repr(value);
  return text.size() > 60 ? text.substr(0, 57) + "..." : text;
}

// "a number is accepted", "3 numbers are accepted".
std::string accepted(ParameterType type) {
  const std::string name = type_name(type);
  return name + (std::isdigit(name[0]) ? " are accepted" : " is accepted");
}

[[noreturn]] void wrong_type(const ParameterInfo& p, const py::handle& value) {
  throw Error(p.name + " is " + shown(value) + "; " + accepted(p.type));
}

bool is_number(const py::handle& value) {
  return !py::isinstance<py::bool_>(value) && PyNumber_Check(value.ptr()) &&
         !py::isinstance<Field>(value) && !py::isinstance<py::str>(value) &&
         !(py::isinstance<py::array>(value) && py::cast<py::array>(value).ndim() > 0);
}

double number_from(const ParameterInfo& p, const py::handle& value) {
  if (!is_number(value)) wrong_type(p, value);
  return py::cast<double>(value);
}

template <size_t N>
std::array<double, N> vector_from(const ParameterInfo& p, const py::handle& value) {
  if (!py::isinstance<py::sequence>(value) && !py::isinstance<py::array>(value)) {
    wrong_type(p, value);
  }
  if (py::isinstance<py::str>(value) || py::len(value) != N) wrong_type(p, value);
  std::array<double, N> out{};
  const auto sequence = py::reinterpret_borrow<py::object>(value);
  for (size_t i = 0; i < N; ++i) {
    const py::object element = sequence[py::int_(i)];
    if (!is_number(element)) wrong_type(p, value);
    out[i] = py::cast<double>(element);
  }
  return out;
}

template <size_t N>
std::vector<std::array<double, N>> points_from(const ParameterInfo& p, const py::handle& value) {
  if (py::isinstance<py::str>(value) || !py::isinstance<py::iterable>(value)) wrong_type(p, value);
  std::vector<std::array<double, N>> out;
  for (const py::handle& element : value) out.push_back(vector_from<N>(p, element));
  return out;
}

bool has_two(const py::handle& value) {
  return py::hasattr(value, "__len__") && !py::isinstance<py::str>(value) && py::len(value) == 2;
}

// Those of two numbers have z = 0.
std::vector<Vec3> points3_from(const ParameterInfo& p, const py::handle& value) {
  if (py::isinstance<py::str>(value) || !py::isinstance<py::iterable>(value)) wrong_type(p, value);
  std::vector<Vec3> out;
  for (const py::handle& element : value) {
    if (has_two(element)) {
      const Vec2 flat = vector_from<2>(p, element);
      out.push_back({flat[0], flat[1], 0});
    } else {
      out.push_back(vector_from<3>(p, element));
    }
  }
  return out;
}

std::vector<double> numbers_from(const ParameterInfo& p, const py::handle& value) {
  if (py::isinstance<py::str>(value) || !py::isinstance<py::iterable>(value)) wrong_type(p, value);
  std::vector<double> out;
  for (const py::handle& element : value) out.push_back(number_from(p, element));
  return out;
}

PointGrid point_grid_from(const ParameterInfo& p, const py::handle& value) {
  if (py::isinstance<py::str>(value) || !py::isinstance<py::iterable>(value)) wrong_type(p, value);
  PointGrid out;
  for (const py::handle& row : value) out.push_back(points_from<3>(p, row));
  return out;
}

// The words of a scene file, with fields in place of their names.
RulePointer rule_from(const py::handle& value) {
  const auto named = py::module_::import("sardf._scene").attr("with_names")(value);
  const auto pair = py::cast<std::pair<std::string, std::map<std::string, Field>>>(named);
  return PythonProgress(py::none()).run([&](const Progress&) {
    return parse_value_rule(pair.first, pair.second).pointer();
  });
}

Vec3 axis_from(const ParameterInfo& p, const py::handle& value) {
  if (py::isinstance<py::str>(value)) {
    const std::string name = py::cast<std::string>(value);
    if (name == "x") return {1, 0, 0};
    if (name == "y") return {0, 1, 0};
    if (name == "z") return {0, 0, 1};
    wrong_type(p, value);
  }
  return vector_from<3>(p, value);
}

std::vector<Field> fields_from(const ParameterInfo& p, const py::handle& value) {
  if (py::isinstance<py::str>(value) || py::isinstance<Field>(value) ||
      !py::isinstance<py::iterable>(value)) {
    wrong_type(p, value);
  }
  std::vector<Field> out;
  for (const py::handle& element : value) out.push_back(field_from(element, p.name));
  return out;
}

// {"field": field, "z": height}, or the pair (field, height).
PlaneSection section_from(const ParameterInfo& p, const py::handle& value) {
  py::object field, z;
  if (py::isinstance<py::dict>(value)) {
    const auto given = py::reinterpret_borrow<py::dict>(value);
    if (given.size() != 2 || !given.contains("field") || !given.contains("z")) wrong_type(p, value);
    field = given["field"];
    z = given["z"];
  } else {
    if (!py::isinstance<py::sequence>(value) || py::isinstance<py::str>(value) ||
        py::len(value) != 2) {
      wrong_type(p, value);
    }
    const auto pair = py::reinterpret_borrow<py::sequence>(value);
    field = pair[0];
    z = pair[1];
  }
  return {field_from(field, p.name), number_from(p, z)};
}

std::vector<PlaneSection> sections_from(const ParameterInfo& p, const py::handle& value) {
  if (py::isinstance<py::str>(value) || !py::isinstance<py::iterable>(value)) wrong_type(p, value);
  std::vector<PlaneSection> out;
  for (const py::handle& element : value) out.push_back(section_from(p, element));
  return out;
}

BlendPointer blend_from(const ParameterInfo& p, const py::handle& value) {
  if (!py::isinstance<Blend>(value)) wrong_type(p, value);
  return py::cast<BlendPointer>(value);
}

struct DefaultText {
  std::string operator()(std::monostate) const { return "None"; }
  std::string operator()(bool b) const { return b ? "True" : "False"; }
  std::string operator()(double a) const { return number_text(a); }
  std::string operator()(const std::string& s) const { return "'" + s + "'"; }
  template <size_t N>
  std::string operator()(const std::array<double, N>& v) const {
    std::string text = "(";
    for (size_t i = 0; i < N; ++i) text += (i ? ", " : "") + number_text(v[i]);
    return text + ")";
  }
  std::string operator()(const BlendPointer&) const { return "None"; }
  template <class T>
  std::string operator()(const T&) const {
    return "()";
  }
};

}  // namespace

BlendPointer& current_blend() {
  static BlendPointer blend = min_max_blend();
  return blend;
}

Field field_from(const py::handle& value, const std::string& parameter) {
  if (py::isinstance<Field>(value)) return py::cast<Field>(value);
  if (py::isinstance<py::str>(value)) return parse_formula(py::cast<std::string>(value), {}, {});
  if (is_number(value)) return Field::number(py::cast<double>(value));
  throw Error(parameter + " is " + shown(value) +
              "; a field, a number or a formula's text is accepted");
}

Value value_from(const ParameterInfo& p, const py::handle& value) {
  switch (p.type) {
    case ParameterType::boolean:
      if (!py::isinstance<py::bool_>(value)) wrong_type(p, value);
      return py::cast<bool>(value);
    case ParameterType::optional_number:
      if (value.is_none()) return {};
      return number_from(p, value);
    case ParameterType::number:
      return number_from(p, value);
    case ParameterType::text:
      if (!py::isinstance<py::str>(value)) wrong_type(p, value);
      return py::cast<std::string>(value);
    case ParameterType::vector2:
      return vector_from<2>(p, value);
    case ParameterType::optional_vector3:
      if (value.is_none()) return {};
      return vector_from<3>(p, value);
    case ParameterType::vector3:
      return vector_from<3>(p, value);
    case ParameterType::optional_vector4:
      if (value.is_none()) return {};
      return vector_from<4>(p, value);
    case ParameterType::axis:
      return axis_from(p, value);
    case ParameterType::numbers:
      return numbers_from(p, value);
    case ParameterType::point_grid:
      return point_grid_from(p, value);
    case ParameterType::rule:
      return rule_from(value);
    case ParameterType::path:
      return FilePath{py::cast<std::string>(py::str(value)), ""};
    case ParameterType::points2:
      return points_from<2>(p, value);
    case ParameterType::points3:
      return points3_from(p, value);
    case ParameterType::optional_field:
      if (value.is_none()) return {};
      [[fallthrough]];
    case ParameterType::field:
      return field_from(value, p.name);
    case ParameterType::fields:
    case ParameterType::values:
      return fields_from(p, value);
    case ParameterType::sections:
      return sections_from(p, value);
    default:
      return value.is_none() ? current_blend() : blend_from(p, value);
  }
}

std::vector<Value> arguments_from(const std::string& takes,
                                  const std::vector<ParameterInfo>& parameters, int variadic,
                                  const py::args& args, const py::kwargs& kwargs) {
  std::vector<Value> values(parameters.size());
  std::vector<bool> given(parameters.size(), false);
  const auto set = [&](size_t i, const py::handle& value) {
    values[i] = value_from(parameters[i], value);
    given[i] = true;
  };
  const bool all_fields = variadic >= 0 && !(args.size() == 1 && !py::isinstance<Field>(args[0]));
  if (all_fields && args.size() > 0) {
    set(size_t(variadic), args);
  } else {
    if (args.size() > parameters.size()) {
      throw Error(takes + " takes " + std::to_string(parameters.size()) + " arguments; " +
                  std::to_string(args.size()) + " were given");
    }
    for (size_t i = 0; i < args.size(); ++i) set(i, args[i]);
  }
  std::vector<std::string> names;
  for (const ParameterInfo& p : parameters) names.push_back(p.name);
  for (const auto& [key, value] : kwargs) {
    const std::string name = py::cast<std::string>(key);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      throw Error(takes + " has no parameter '" + name + "'" + did_you_mean(name, names));
    }
    const size_t i = size_t(found - names.begin());
    if (given[i]) throw Error(takes + ": " + name + " is given twice");
    set(i, value);
  }
  for (size_t i = 0; i < parameters.size(); ++i) {
    if (given[i]) continue;
    if (parameters[i].required) {
      throw Error(takes + ": " + names[i] + " is missing; " + accepted(parameters[i].type));
    }
    values[i] = parameters[i].type == ParameterType::blend ? Value(current_blend())
                                                           : parameters[i].default_value;
  }
  return values;
}

std::string signature(const std::string& name, const std::vector<ParameterInfo>& parameters,
                      int variadic, bool takes_progress) {
  std::string text = name + "(";
  for (size_t i = 0; i < parameters.size(); ++i) {
    if (i) text += ", ";
    if (int(i) == variadic) text += "*";
    text += parameters[i].name;
    if (!parameters[i].required)
      text += "=" + std::visit(DefaultText{}, parameters[i].default_value);
  }
  if (takes_progress) text += ", progress=None";
  return text + ")";
}

std::string docstring(const std::string& name, const std::string& doc,
                      const std::vector<ParameterInfo>& parameters, int variadic,
                      bool takes_progress) {
  std::string text = signature(name, parameters, variadic, takes_progress) + "\n\n" + doc + "\n";
  for (const ParameterInfo& p : parameters) {
    text += "\n" + p.name + ": " + p.doc;
    if (p.unit == Unit::length) text += " (scene units)";
    if (p.unit == Unit::angle) text += " (degrees)";
    if (p.range == Range::positive) text += "; positive";
    if (p.range == Range::non_negative) text += "; not negative";
    if (p.range == Range::count) text += "; a whole number from 1";
  }
  if (takes_progress) {
    text +=
        "\nprogress: called with the share done; may return False to cancel, which raises "
        "Cancelled";
  }
  return text;
}

}  // namespace sardf

#include "sardf/constructor.hpp"

#include "sardf/constructor_of.hpp"
#include "sardf/faces.hpp"
#include "sardf/ops.hpp"
#include "sardf/shapes_calculus.hpp"
#include "sardf/shapes_combine.hpp"
#include "sardf/shapes_contour.hpp"
#include "sardf/shapes_domain.hpp"
#include "sardf/shapes_features.hpp"
#include "sardf/shapes_fit.hpp"
#include "sardf/shapes_interpolation.hpp"
#include "sardf/shapes_mesh.hpp"
#include "sardf/shapes_normalize.hpp"
#include "sardf/shapes_transform.hpp"
#include "sardf/short_number.hpp"

namespace sardf {

namespace {

struct Registry {
  std::deque<Constructor> constructors;
  std::vector<BlendType> blends;
  std::vector<OperationPointer> functions;
};

BlendPointer make_min_max() { return blend_type_of<MinMax>().make({}); }

Registry listed() {
  Registry all;
  Ops::for_each([&]<class Op>(std::type_identity<Op>) {
    if constexpr (Op::kind == Kind::function) {
      all.functions.push_back(make_operation(Op{}));
    } else if constexpr (Op::kind != Kind::internal) {
      all.constructors.push_back(constructor_of_operation<Op>());
    }
  });
  const auto add_shape = [&]<class Shape>(std::type_identity<Shape>) {
    all.constructors.push_back(constructor_of_shape<Shape>());
  };
  CombineShapes::for_each(add_shape);
  FaceShapes::for_each(add_shape);
  ContourShapes::for_each(add_shape);
  FeatureShapes::for_each(add_shape);
  TransformShapes::for_each(add_shape);
  DomainShapes::for_each(add_shape);
  InterpolationShapes::for_each(add_shape);
  NormalizeShapes::for_each(add_shape);
  CalculusShapes::for_each(add_shape);
  FitShapes::for_each(add_shape);
  MeshShapes::for_each(add_shape);
  BlendList::for_each(
      [&]<class B>(std::type_identity<B>) { all.blends.push_back(blend_type_of<B>()); });
  return all;
}

Registry& registry() {
  static Registry all = listed();
  return all;
}

// Magnitudes beyond this leave no room for squares and products of lengths.
constexpr double absurd = 1e100;

void check_number(const ParameterInfo& p, double a) {
  const char* sizes = p.range == Range::positive       ? " a positive number"
                      : p.range == Range::non_negative ? " a number that is not negative"
                      : p.range == Range::count        ? " a whole number from 1"
                                                       : " a finite number";
  if (!std::isfinite(a) || std::abs(a) > absurd || (p.range == Range::positive && !(a > 0)) ||
      (p.range == Range::non_negative && !(a >= 0)) ||
      (p.range == Range::count && !(a >= 1 && a == std::floor(a)))) {
    throw Error(p.name + " is " + short_number(a, 6) + ";" + sizes +
                (std::isfinite(a) && std::abs(a) > absurd ? " of magnitude up to 1e100" : "") +
                " is accepted");
  }
}

struct Check {
  const ParameterInfo& p;
  void operator()(double a) const { check_number(p, a); }
  template <size_t N>
  void operator()(const std::array<double, N>& v) const {
    for (double a : v) check_number(p, a);
    if constexpr (N == 3) {
      if (p.type == ParameterType::axis && v == Vec3{}) {
        throw Error(p.name + " is the zero vector; a direction such as [0, 0, 1] is accepted");
      }
    }
  }
  void operator()(const PlaneSection& section) const {
    ParameterInfo height = p;
    height.name = "the height z of a section";
    check_number(height, section.z);
  }
  template <class T>
  void operator()(const std::vector<T>& list) const {
    if (int(list.size()) < p.at_least) {
      throw Error(p.name + " has " + std::to_string(list.size()) + " elements; at least " +
                  std::to_string(p.at_least) + " are needed");
    }
    if constexpr (!std::is_same_v<T, Field>) {
      for (const T& element : list) (*this)(element);
    }
  }
  template <class T>
  void operator()(const T&) const {}
};

}  // namespace

BlendPointer min_max_blend() {
  static const BlendPointer blend = make_min_max();
  return blend;
}

std::string group_of(Kind kind) {
  switch (kind) {
    case Kind::solid:
      return "solid";
    case Kind::plane:
      return "plane";
    case Kind::feature:
      return "feature";
    case Kind::function:
      return "function";
    default:
      return "internal";
  }
}

std::string type_name(ParameterType type) {
  switch (type) {
    case ParameterType::boolean:
      return "true or false";
    case ParameterType::number:
    case ParameterType::optional_number:
      return "a number";
    case ParameterType::text:
      return "a string";
    case ParameterType::vector2:
      return "2 numbers";
    case ParameterType::vector3:
    case ParameterType::optional_vector3:
      return "3 numbers";
    case ParameterType::optional_vector4:
      return "4 numbers";
    case ParameterType::axis:
      return "\"x\", \"y\", \"z\" or 3 numbers";
    case ParameterType::numbers:
      return "a list of numbers";
    case ParameterType::points2:
      return "a list of points of 2 numbers";
    case ParameterType::points3:
      return "a list of points of 2 or 3 numbers";
    case ParameterType::point_grid:
      return "a list of rows of points of 3 numbers";
    case ParameterType::field:
    case ParameterType::optional_field:
      return "a field or a number";
    case ParameterType::fields:
      return "a list of fields";
    case ParameterType::values:
      return "a list of fields or numbers";
    case ParameterType::sections:
      return "a list of objects such as {\"field\": \"contour\", \"z\": 2}";
    case ParameterType::rule:
      return "a rule that gives a value, such as {\"inverse_distance\": {...}}";
    case ParameterType::path:
      return "the name of a file";
    default:
      return "a blend";
  }
}

int Constructor::variadic() const {
  return !parameters.empty() && parameters[0].type == ParameterType::fields ? 0 : -1;
}

const std::deque<Constructor>& constructors() { return registry().constructors; }
const std::vector<BlendType>& blend_types() { return registry().blends; }

const Constructor* find_constructor(const std::string& name) {
  for (const Constructor& c : registry().constructors) {
    if (c.name == name) return &c;
  }
  return nullptr;
}

const BlendType* find_blend_type(const std::string& name) {
  for (const BlendType& b : registry().blends) {
    if (b.name == name) return &b;
  }
  return nullptr;
}

void add_constructor(Constructor constructor) {
  if (find_constructor(constructor.name)) {
    throw Error("there already is a constructor named '" + constructor.name + "'");
  }
  registry().constructors.push_back(std::move(constructor));
}

OperationPointer find_function(const std::string& name) {
  for (const OperationPointer& f : registry().functions) {
    if (f->info().name == name) return f;
  }
  return nullptr;
}

std::vector<std::string> function_names() {
  std::vector<std::string> names;
  for (const OperationPointer& f : registry().functions) names.push_back(f->info().name);
  return names;
}

void add_function(OperationPointer operation) {
  if (find_function(operation->info().name)) {
    throw Error("there already is a function named '" + operation->info().name + "'");
  }
  registry().functions.push_back(std::move(operation));
}

void check_argument(const ParameterInfo& parameter, const Value& value) {
  std::visit(Check{parameter}, value);
}

Field make_field(const Constructor& constructor, std::vector<Value> arguments) {
  for (size_t i = arguments.size(); i < constructor.parameters.size(); ++i) {
    arguments.push_back(constructor.parameters[i].default_value);
  }
  for (size_t i = 0; i < arguments.size(); ++i) {
    check_argument(constructor.parameters[i], arguments[i]);
  }
  return constructor.make(constructor, std::move(arguments));
}

Field make_field(const std::string& name, std::vector<Value> arguments) {
  if (const Constructor* found = find_constructor(name)) {
    return make_field(*found, std::move(arguments));
  }
  std::vector<std::string> names;
  for (const Constructor& c : registry().constructors) names.push_back(c.name);
  throw Error("there is no constructor '" + name + "'" + did_you_mean(name, names));
}

BlendPointer make_blend(const std::string& name, const std::vector<Value>& arguments) {
  const BlendType* type = find_blend_type(name);
  if (!type) {
    std::vector<std::string> names;
    for (const BlendType& b : registry().blends) names.push_back(b.name);
    throw Error("there is no blend '" + name + "'" + did_you_mean(name, names));
  }
  for (size_t i = 0; i < arguments.size(); ++i) {
    check_argument(type->parameters[i], arguments[i]);
  }
  return type->make(arguments);
}

std::shared_ptr<const Construction> constructed(const Constructor& constructor,
                                                std::vector<Value> arguments) {
  auto made = std::make_shared<Construction>();
  made->constructor = &constructor;
  made->arguments = std::move(arguments);
  return made;
}

}  // namespace sardf

// A constructor's description from a struct: an operation (a primitive), or a shape.
//
// A shape has `name`, `group`, `doc`, `parameters(V&)` as an operation has, and
//   Expression expression() const;   Quality quality() const;   both may throw Error.
// Where `expression` may take long, and reports to the ProgressScope, it has `takes_progress`, too.
#pragma once

#include <type_traits>

#include "sardf/constructor.hpp"
#include "sardf/data_operation.hpp"
#include "sardf/operation_of.hpp"
#include "sardf/ops_blends.hpp"

namespace sardf {

/// A list of fields that may be numbers: values, not solids.
struct FieldValues : std::vector<Field> {};

template <class Member>
constexpr ParameterType parameter_type() {
  if constexpr (std::is_same_v<Member, bool>) return ParameterType::boolean;
  if constexpr (std::is_same_v<Member, double>) return ParameterType::number;
  if constexpr (std::is_same_v<Member, std::optional<double>>)
    return ParameterType::optional_number;
  if constexpr (std::is_same_v<Member, std::string>) return ParameterType::text;
  if constexpr (std::is_same_v<Member, Vec2>) return ParameterType::vector2;
  if constexpr (std::is_same_v<Member, Vec3>) return ParameterType::vector3;
  if constexpr (std::is_same_v<Member, std::optional<Vec3>>) return ParameterType::optional_vector3;
  if constexpr (std::is_same_v<Member, std::optional<std::array<double, 4>>>) {
    return ParameterType::optional_vector4;
  }
  if constexpr (std::is_same_v<Member, Axis>) return ParameterType::axis;
  if constexpr (std::is_same_v<Member, std::vector<double>>) return ParameterType::numbers;
  if constexpr (std::is_same_v<Member, PointGrid>) return ParameterType::point_grid;
  if constexpr (std::is_same_v<Member, std::optional<Field>>) return ParameterType::optional_field;
  if constexpr (std::is_same_v<Member, RulePointer>) return ParameterType::rule;
  if constexpr (std::is_same_v<Member, FilePath>) return ParameterType::path;
  if constexpr (std::is_same_v<Member, std::vector<Vec2>>) return ParameterType::points2;
  if constexpr (std::is_same_v<Member, std::vector<Vec3>>) return ParameterType::points3;
  if constexpr (std::is_same_v<Member, Field>) return ParameterType::field;
  if constexpr (std::is_same_v<Member, std::vector<Field>>) return ParameterType::fields;
  if constexpr (std::is_same_v<Member, FieldValues>) return ParameterType::values;
  if constexpr (std::is_same_v<Member, std::vector<PlaneSection>>) return ParameterType::sections;
  if constexpr (std::is_same_v<Member, BlendPointer>) return ParameterType::blend;
}

template <class Member>
Value to_value(const Member& member) {
  if constexpr (std::is_same_v<Member, Axis>) {
    return member.direction;
  } else if constexpr (std::is_same_v<Member, FieldValues>) {
    return static_cast<const std::vector<Field>&>(member);
  } else if constexpr (requires { member.has_value(); }) {
    return member ? Value(*member) : Value();
  } else {
    return member;
  }
}

template <class Member>
void from_value(const Value& value, Member& member) {
  if constexpr (std::is_same_v<Member, Axis>) {
    member.direction = std::get<Vec3>(value);
  } else if constexpr (std::is_same_v<Member, FieldValues>) {
    static_cast<std::vector<Field>&>(member) = std::get<std::vector<Field>>(value);
  } else if constexpr (requires { member.has_value(); }) {
    if (value.index() != 0) member = std::get<typename Member::value_type>(value);
  } else {
    member = std::get<Member>(value);
  }
}

template <class Struct>
std::vector<ParameterInfo> parameter_infos() {
  std::vector<ParameterInfo> infos;
  const Struct defaults{};
  auto visit = [&](const Parameter& p, auto member) {
    using Member = std::remove_cvref_t<decltype(defaults.*member)>;
    infos.push_back({p.name, p.doc, p.unit, p.range, p.required, p.at_least,
                     parameter_type<Member>(), p.required ? Value() : to_value(defaults.*member)});
  };
  Struct::parameters(visit);
  return infos;
}

template <class Struct>
Struct with_arguments(const std::vector<Value>& arguments) {
  Struct made{};
  size_t next = 0;
  auto visit = [&](const Parameter&, auto member) { from_value(arguments[next++], made.*member); };
  Struct::parameters(visit);
  return made;
}

std::shared_ptr<const Construction> constructed(const Constructor& constructor,
                                                std::vector<Value> arguments);

std::string group_of(Kind kind);

/// The operation, or the distance to the set of points that the struct asks for in its place: it
/// then has `PointSetPointer as_set() const`, null where the formula is to be used.
template <class Op>
OperationPointer operation_for(const Op& op) {
  if constexpr (requires { op.as_set(); }) {
    if (PointSetPointer set = op.as_set()) return distance_operation(std::move(set));
  }
  return make_operation(op);
}

/// For an operation of kind solid, plane or feature: applied to the coordinates.
template <class Op>
Constructor constructor_of_operation() {
  return {Op::name, group_of(Op::kind), Op::doc, parameter_infos<Op>(),
          [](const Constructor& constructor, std::vector<Value> arguments) {
            const std::array<Expression, 3> xyz{coordinate(0), coordinate(1), coordinate(2)};
            const OperationPointer operation = operation_for(with_arguments<Op>(arguments));
            const Exactness how = operation->is_distance() ? Exactness::exact : Exactness::estimate;
            return Field(call(operation, std::span(xyz.data(), Op::arity)), {how, how},
                         constructed(constructor, std::move(arguments)));
          }};
}

template <class Shape>
Constructor constructor_of_shape() {
  return {Shape::name, Shape::group, Shape::doc, parameter_infos<Shape>(),
          [](const Constructor& constructor, std::vector<Value> arguments) {
            const Shape shape = with_arguments<Shape>(arguments);
            return Field(shape.expression(), shape.quality(),
                         constructed(constructor, std::move(arguments)));
          },
          requires {Shape::takes_progress;
}
};  // namespace sardf
}

template <class B>
BlendType blend_type_of() {
  return {B::name, B::doc, parameter_infos<B>(), [](const std::vector<Value>& arguments) {
            const B blend = with_arguments<B>(arguments);
            auto made = std::make_shared<Blend>();
            made->name = B::name;
            auto append = [&](const Parameter&, auto member) {
              append_numbers(made->parameters, blend.*member);
            };
            B::parameters(append);
            made->intersection = make_operation(IntersectionOf<B>(blend));
            made->unite = make_operation(UnionOf<B>(blend));
            made->difference = make_operation(DifferenceOf<B>(blend));
            made->is_min_max = made->intersection->blend_error() == 0;
            return BlendPointer(made);
          }};
}

}  // namespace sardf

// Boolean operations, and what acts on the value of one field.
#pragma once

#include "sardf/constructor_of.hpp"
#include "sardf/op_list.hpp"

namespace sardf {

constexpr Parameter field_parameter(const char* doc, const char* name = "field") {
  return {name, doc, Unit::none, Range::any, true};
}

struct Combination {
  static constexpr const char* group = "boolean";
  std::vector<Field> of;
  BlendPointer blend = min_max_blend();
};

struct Union : Combination {
  static constexpr const char *name = "union",
                              *doc = "All points of any of the solids, joined from the left.";
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"of", "the solids", Unit::none, Range::any, true, 1}, &Union::of);
    v(Parameter{"blend", "how they are joined"}, &Union::blend);
  }
  Expression expression() const;
  Quality quality() const;
};

struct Intersection : Combination {
  static constexpr const char *name = "intersection",
                              *doc = "All points common to the solids, joined from the left.";
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"of", "the solids", Unit::none, Range::any, true, 1}, &Intersection::of);
    v(Parameter{"blend", "how they are joined"}, &Intersection::blend);
  }
  Expression expression() const;
  Quality quality() const;
};

struct Difference : Combination {
  static constexpr const char *name = "difference",
                              *doc = "The first solid without the others, one after the other.";
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"of", "the solid, then what is removed", Unit::none, Range::any, true, 1},
      &Difference::of);
    v(Parameter{"blend", "how they are joined"}, &Difference::blend);
  }
  Expression expression() const;
  Quality quality() const;
};

struct Complement {
  static constexpr const char *name = "complement", *group = "boolean",
                              *doc = "All points outside the solid.";
  Field field;
  template <class V>
  static void parameters(V& v) {
    v(field_parameter("the solid"), &Complement::field);
  }
  Expression expression() const;
  Quality quality() const;
};

struct Offset {
  static constexpr const char *name = "offset", *group = "value",
                              *doc =
                                  "The solid grown by a distance. It acts on the field: where "
                                  "that is no distance, nor is the result.";
  Field field;
  double distance = 0;
  template <class V>
  static void parameters(V& v) {
    v(field_parameter("the solid"), &Offset::field);
    v(required_length("distance", "how far the surface moves outwards; negative: inwards"),
      &Offset::distance);
  }
  Expression expression() const;
  Quality quality() const;
};

struct Shell {
  static constexpr const char *name = "shell", *group = "value",
                              *doc =
                                  "A wall along the solid's surface. It acts on the field, as "
                                  "offset does.";
  Field field;
  double thickness = 1;
  std::string side = "inside";
  template <class V>
  static void parameters(V& v) {
    v(field_parameter("the solid"), &Shell::field);
    v(positive_length("thickness", "thickness of the wall"), &Shell::thickness);
    v(Parameter{"side", "where the wall lies: 'inside', 'outside' or 'centred' on the surface"},
      &Shell::side);
  }
  Expression expression() const;
  Quality quality() const;
};

struct WithBlend {
  static constexpr const char *name = "with_blend", *group = "boolean",
                              *doc =
                                  "A field whose unions, intersections and differences, however "
                                  "deep, are all joined by another blend.";
  Field field;
  BlendPointer blend = min_max_blend();
  template <class V>
  static void parameters(V& v) {
    v(field_parameter("the field"), &WithBlend::field);
    v(Parameter{"blend", "how they are joined"}, &WithBlend::blend);
  }
  Expression expression() const;
  Quality quality() const;
};

/// Source: Fayolle, Pasko, Schmitt, Mirenkov 2004, section 3.2.
struct BlendError {
  static constexpr const char *name = "blend_error", *group = "value",
                              *doc =
                                  "How far blending moves a field: the field minus the same tree "
                                  "with minima and maxima. It is no distance.";
  Field field;
  template <class V>
  static void parameters(V& v) {
    v(field_parameter("the field"), &BlendError::field);
  }
  Expression expression() const;
  Quality quality() const { return {}; }
};

using CombineShapes =
    OpList<Union, Intersection, Difference, Complement, WithBlend, Offset, Shell, BlendError>;

}  // namespace sardf

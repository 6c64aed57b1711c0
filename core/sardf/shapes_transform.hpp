// Rigid motions, uniform scale, and solids from plane fields. They replace coordinates, so they
// cost nothing where a point is not moved and keep distances what they are.
#pragma once

#include "sardf/shapes_combine.hpp"

namespace sardf {

struct Translate {
  static constexpr const char *name = "translate", *group = "transform", *doc = "A field moved.";
  Field field;
  Vec3 by{};
  template <class V>
  static void parameters(V& v) {
    v(field_parameter("what is moved"), &Translate::field);
    v(required_length("by", "the displacement"), &Translate::by);
  }
  Expression expression() const;
  Quality quality() const { return field.quality(); }
};

struct Rotate {
  static constexpr const char *name = "rotate", *group = "transform",
                              *doc =
                                  "A field turned about a point: by an angle about an axis, by "
                                  "a quaternion, or by Euler angles.";
  Field field;
  Axis axis;
  std::optional<double> angle;
  std::optional<std::array<double, 4>> quaternion;
  std::optional<Vec3> euler;
  Vec3 center{};
  template <class V>
  static void parameters(V& v) {
    v(field_parameter("what is turned"), &Rotate::field);
    v(direction_of("axis", "axis of the angle"), &Rotate::axis);
    v(Parameter{"angle", "counter-clockwise, seen against the axis", Unit::angle}, &Rotate::angle);
    v(Parameter{"quaternion", "[w, x, y, z] instead of an angle; it need not have unit length"},
      &Rotate::quaternion);
    v(Parameter{"euler", "angles about x, then y, then z instead of an angle", Unit::angle},
      &Rotate::euler);
    v(length_of("center", "the point that stays"), &Rotate::center);
  }
  Expression expression() const;
  Quality quality() const { return field.quality(); }
};

struct Scale {
  static constexpr const char *name = "scale", *group = "transform",
                              *doc = "A field scaled evenly; distances are scaled with it.";
  Field field;
  double factor = 1;
  Vec3 center{};
  template <class V>
  static void parameters(V& v) {
    v(field_parameter("what is scaled"), &Scale::field);
    v(Parameter{"factor", "the scale", Unit::none, Range::positive, true}, &Scale::factor);
    v(length_of("center", "the point that stays"), &Scale::center);
  }
  Expression expression() const;
  Quality quality() const { return field.quality(); }
};

struct Mirror {
  static constexpr const char *name = "mirror", *group = "transform",
                              *doc = "The mirror image of a field in a plane.";
  Field field;
  Vec3 point{};
  Axis normal{{1, 0, 0}};
  template <class V>
  static void parameters(V& v) {
    v(field_parameter("what is mirrored"), &Mirror::field);
    v(length_of("point", "a point of the plane"), &Mirror::point);
    v(direction_of("normal", "direction perpendicular to the plane"), &Mirror::normal);
  }
  Expression expression() const;
  Quality quality() const { return field.quality(); }
};

struct Extrude {
  static constexpr const char *name = "extrude", *group = "solid",
                              *doc = "A plane field given a height along z, centred on z = 0.";
  Field field;
  double height = 1;
  template <class V>
  static void parameters(V& v) {
    v(field_parameter("a field of x and y"), &Extrude::field);
    v(positive_length("height", "full height"), &Extrude::height);
  }
  Expression expression() const;
  Quality quality() const { return field.quality(); }
};

struct Revolve {
  static constexpr const char *name = "revolve", *group = "solid",
                              *doc =
                                  "A plane field turned about z: its x becomes the radius, its "
                                  "y the height.";
  Field field;
  template <class V>
  static void parameters(V& v) {
    v(field_parameter("a field of x and y"), &Revolve::field);
  }
  Expression expression() const;
  Quality quality() const;
};

using TransformShapes = OpList<Translate, Rotate, Scale, Mirror, Extrude, Revolve>;

}  // namespace sardf

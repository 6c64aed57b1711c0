// What repeats a field in space or deforms the space it lives in.
#pragma once

#include "sardf/shapes_combine.hpp"

namespace sardf {

struct Repeat {
  static constexpr const char
      *name = "repeat",
      *group = "transform",
      *doc =
          "Copies of a solid at equal steps along the axes, joined by their largest value. Without "
          "counts they go on for ever; then the nearest copies are evaluated, two along each axis, "
          "and the distance stays what it is outside if it is proven that a copy fits between its "
          "neighbours.";
  Field field;
  Vec3 spacing{};
  std::optional<Vec3> counts;
  template <class V>
  static void parameters(V& v) {
    v(field_parameter("what is repeated"), &Repeat::field);
    v(Parameter{"spacing", "the step along x, y and z; 0 where nothing is repeated", Unit::length,
                Range::non_negative, true},
      &Repeat::spacing);
    v(Parameter{"counts",
                "whole numbers of copies along x, y and z, from the field itself in the positive "
                "direction; without end in both directions when not given"},
      &Repeat::counts);
  }
  Expression expression() const;
  Quality quality() const;
};

/// The space at height h above the center is turned by rate · h. With k = rate in radians and r the
/// distance from the axis the slope grows by at most (k r + sqrt(k² r² + 4)) / 2, the largest
/// stretch of a shear by k r.
struct Twist {
  static constexpr const char *name = "twist", *group = "transform",
                              *doc =
                                  "A field turned about an axis in proportion to the height "
                                  "along it. It stretches distances: at r from the axis its slope "
                                  "is at most (kr + sqrt(k²r² + 4)) / 2 times the field's, k being "
                                  "the rate in radians.";
  Field field;
  double rate = 0;
  Axis axis;
  Vec3 center{};
  template <class V>
  static void parameters(V& v) {
    v(field_parameter("what is twisted"), &Twist::field);
    v(Parameter{"rate", "degrees for each unit of height", Unit::angle, Range::any, true},
      &Twist::rate);
    v(direction_of("axis", "the axis of the turn"), &Twist::axis);
    v(length_of("center", "a point of the axis, at which nothing turns"), &Twist::center);
  }
  Expression expression() const;
  Quality quality() const { return rate == 0 ? field.quality() : Quality{}; }
};

/// A bar along x is bent in the xz plane towards +z: its fibre z = 0 keeps its length and becomes
/// an arc of the radius about (0, 0, radius). At distance d from that axis slopes grow by radius /
/// d.
struct Bend {
  static constexpr const char *name = "bend", *group = "transform",
                              *doc =
                                  "A field bent about an axis parallel to y, so that what lies "
                                  "along x at z = 0 becomes an arc towards +z of equal length. At "
                                  "d from the axis its slope is at most max(1, radius/d) times the "
                                  "field's; on the axis it is not bounded.";
  Field field;
  double radius = 1;
  template <class V>
  static void parameters(V& v) {
    v(field_parameter("what is bent; it should lie within half a turn of x = 0"), &Bend::field);
    v(positive_length("radius", "of the arc that z = 0 becomes"), &Bend::radius);
  }
  Expression expression() const;
  Quality quality() const { return {}; }
};

using DomainShapes = OpList<Repeat, Twist, Bend>;

}  // namespace sardf

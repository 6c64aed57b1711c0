// Solids with exact signed Euclidean distance, positive inside.
// Source of the formulas: Hart 1996, "Sphere tracing", and elementary geometry.
#pragma once

#include "sardf/frame.hpp"
#include "sardf/op_list.hpp"
#include "sardf/ops_sardf.hpp"

namespace sardf {

struct Solid {
  static constexpr Kind kind = Kind::solid;
  static constexpr int arity = 3;
  static constexpr bool distance = true;
  using FusedWith = JoinOps;
};

struct Sphere : Solid {
  static constexpr const char *name = "sphere", *doc = "A ball.";
  Vec3 center{};
  double radius = 1;
  template <class V>
  static void parameters(V& v) {
    v(length_of("center", "its middle"), &Sphere::center);
    v(positive_length("radius", "its radius"), &Sphere::radius);
  }
  template <class T>
  T eval(T x, T y, T z) const {
    return at_distance(length(x - T(center[0]), y - T(center[1]), z - T(center[2])), x, y, z);
  }

  Vec3 middle() const { return center; }
  bool is_alike(const Sphere& other) const { return radius == other.radius; }
  template <class T>
  T at_distance(T from_middle, T, T, T) const {
    return T(radius) - from_middle;
  }
};

struct HalfSpace : Solid {
  static constexpr const char *name = "half_space",
                              *doc = "All points on one side of a plane: an unbounded solid.";
  Vec3 point{};
  Axis normal;
  template <class V>
  static void parameters(V& v) {
    v(length_of("point", "a point of the plane"), &HalfSpace::point);
    v(direction_of("normal", "direction that points into the solid"), &HalfSpace::normal);
  }
  void prepare() { frame.set(point, normal); }
  template <class T>
  T eval(T x, T y, T z) const {
    return frame.local(x, y, z)[2];
  }

 private:
  Frame frame;
};

/// -distance outside the corner a >= 0, b >= 0 of two perpendicular boundaries, min inside: exact
/// where a and b are exact and vary in perpendicular directions.
template <class T>
T perpendicular_intersection(T a, T b) {
  const T inside = min(a, b);
  return shortcut(inside >= T(0.0), inside,
                  [&] { return -length(max(-a, T(0.0)), max(-b, T(0.0))); });
}

template <class T>
T box_distance(T x, T y, T z, const Vec3& half) {
  const T a = abs(x) - T(half[0]), b = abs(y) - T(half[1]), c = abs(z) - T(half[2]);
  const T outermost = max(max(a, b), c);
  return -shortcut(outermost <= T(0.0), outermost,
                   [&] { return length(max(a, T(0.0)), max(b, T(0.0)), max(c, T(0.0))); });
}

struct Box : Solid {
  static constexpr const char *name = "box", *doc = "A block with its edges along x, y and z.";
  Vec3 center{}, size{1, 1, 1};
  template <class V>
  static void parameters(V& v) {
    v(length_of("center", "its middle"), &Box::center);
    v(positive_length("size", "full edge lengths"), &Box::size);
  }
  template <class T>
  T eval(T x, T y, T z) const {
    return box_distance(x - T(center[0]), y - T(center[1]), z - T(center[2]), 0.5 * size);
  }
};

struct RoundedBox : Solid {
  static constexpr const char *name = "rounded_box",
                              *doc = "A block whose edges and corners are rounded.";
  Vec3 center{}, size{1, 1, 1};
  double radius = 0;
  template <class V>
  static void parameters(V& v) {
    v(length_of("center", "its middle"), &RoundedBox::center);
    v(positive_length("size", "full edge lengths, rounding included"), &RoundedBox::size);
    v(positive_length("radius", "radius of the edges, at most half the shortest edge length"),
      &RoundedBox::radius);
  }
  void prepare() {
    const double most = 0.5 * std::min({size[0], size[1], size[2]});
    if (radius > most) {
      throw Error("radius " + std::to_string(radius) + " is more than half the shortest edge (" +
                  std::to_string(most) + ")");
    }
    core = {0.5 * size[0] - radius, 0.5 * size[1] - radius, 0.5 * size[2] - radius};
  }
  template <class T>
  T eval(T x, T y, T z) const {
    return T(radius) + box_distance(x - T(center[0]), y - T(center[1]), z - T(center[2]), core);
  }

 private:
  Vec3 core{};
};

struct Cylinder : Solid {
  static constexpr const char *name = "cylinder",
                              *doc = "A round bar, capped or, without a height, infinite.";
  Vec3 center{};
  Axis axis;
  double radius = 1;
  std::optional<double> height;
  template <class V>
  static void parameters(V& v) {
    v(length_of("center", "the middle of its axis"), &Cylinder::center);
    v(direction_of("axis", "direction of its axis"), &Cylinder::axis);
    v(positive_length("radius", "its radius"), &Cylinder::radius);
    v(Parameter{"height", "full height; none: infinite", Unit::length, Range::positive},
      &Cylinder::height);
  }
  void prepare() { frame.set(center, axis); }
  template <class T>
  T eval(T x, T y, T z) const {
    const auto [u, v, w] = frame.local(x, y, z);
    return capped(T(radius) - length(u, v), w);
  }

  Vec2 middle() const { return {center[0], center[1]}; }
  bool is_alike(const Cylinder& other) const {
    return frame.is_upright() && other.frame.is_upright() && radius == other.radius &&
           height == other.height && (!height || center[2] == other.center[2]);
  }
  template <class T>
  T at_distance(T from_middle, T, T, T z) const {
    return capped(T(radius) - from_middle, z - T(center[2]));
  }

 private:
  template <class T>
  T capped(T wall, T w) const {
    return height ? perpendicular_intersection(wall, T(0.5 * *height) - abs(w)) : wall;
  }

  Frame frame;
};

struct Torus : Solid {
  static constexpr const char *name = "torus", *doc = "A ring of round section.";
  Vec3 center{};
  Axis axis;
  double major_radius = 2, minor_radius = 1;
  template <class V>
  static void parameters(V& v) {
    v(length_of("center", "its middle"), &Torus::center);
    v(direction_of("axis", "direction of its axis"), &Torus::axis);
    v(positive_length("major_radius", "radius of the circle in the middle of the tube"),
      &Torus::major_radius);
    v(positive_length("minor_radius", "radius of the tube, at most major_radius"),
      &Torus::minor_radius);
  }
  void prepare() {
    if (minor_radius > major_radius) {
      throw Error("minor_radius " + std::to_string(minor_radius) + " is more than major_radius (" +
                  std::to_string(major_radius) + ")");
    }
    frame.set(center, axis);
  }
  template <class T>
  T eval(T x, T y, T z) const {
    const auto [u, v, w] = frame.local(x, y, z);
    return T(minor_radius) - length(length(u, v) - T(major_radius), w);
  }

 private:
  Frame frame;
};

using SolidOps = OpList<Sphere, HalfSpace, Box, RoundedBox, Cylinder, Torus>;

}  // namespace sardf

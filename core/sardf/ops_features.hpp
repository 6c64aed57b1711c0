// Features: unsigned distances to points, curves and planes.
#pragma once

#include <numbers>

#include "sardf/ops_cone.hpp"

namespace sardf {

class PointSet;

/// Formulas with a loop over points or segments have at most this many; beyond, the constructor
/// makes a PointSet with a tree, which is faster in double and with gradients.
inline constexpr size_t most_in_formula = 256;

struct Feature {
  static constexpr Kind kind = Kind::feature;
  static constexpr int arity = 3;
  static constexpr bool distance = true;
};

struct Point : Feature {
  static constexpr const char *name = "point", *doc = "The distance to a point.";
  Vec3 at{};
  template <class V>
  static void parameters(V& v) {
    v(required_length("at", "the point"), &Point::at);
  }
  template <class T>
  T eval(T x, T y, T z) const {
    return length(x - T(at[0]), y - T(at[1]), z - T(at[2]));
  }
};

struct Points : Feature {
  static constexpr const char *name = "points",
                              *doc = "The distance to the nearest of some points.";
  std::vector<Vec3> at;
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"at", "the points", Unit::length, Range::any, true, 1}, &Points::at);
  }
  /// The same with a tree; null where the formula is to be used.
  std::shared_ptr<const PointSet> as_set() const;
  template <class T>
  T eval(T x, T y, T z) const {
    T best(0.0);
    for (size_t i = 0; i < at.size(); ++i) {
      const T squared = square(x - T(at[i][0])) + square(y - T(at[i][1])) + square(z - T(at[i][2]));
      best = i == 0 ? squared : min(best, squared);
    }
    return sqrt(best);
  }
};

struct Segment : Feature {
  static constexpr const char *name = "segment", *doc = "The distance to a straight segment.";
  Vec3 a{}, b{0, 0, 1};
  template <class V>
  static void parameters(V& v) {
    v(required_length("a", "one end"), &Segment::a);
    v(required_length("b", "the other end"), &Segment::b);
  }
  template <class T>
  T eval(T x, T y, T z) const {
    const auto [dx, dy, dz] = from_segment(x - T(a[0]), y - T(a[1]), z - T(a[2]), b - a);
    return length(dx, dy, dz);
  }
};

struct Polyline : Feature {
  static constexpr const char *name = "polyline",
                              *doc = "The distance to a chain of straight segments.";
  std::vector<Vec3> vertices;
  bool closed = false;
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"vertices", "its corners in order", Unit::length, Range::any, true, 2},
      &Polyline::vertices);
    v(Parameter{"closed", "whether the last corner is joined to the first"}, &Polyline::closed);
  }
  /// The same with a tree; null where the formula is to be used.
  std::shared_ptr<const PointSet> as_set() const;
  template <class T>
  T eval(T x, T y, T z) const {
    T best(0.0);
    const size_t n = vertices.size();
    for (size_t i = 0; i + (closed ? 0 : 1) < n; ++i) {
      const Vec3 &a = vertices[i], &b = vertices[i + 1 < n ? i + 1 : 0];
      const auto [dx, dy, dz] = from_segment(x - T(a[0]), y - T(a[1]), z - T(a[2]), b - a);
      const T squared = square(dx) + square(dy) + square(dz);
      best = i == 0 ? squared : min(best, squared);
    }
    return sqrt(best);
  }
};

struct Plane : Feature {
  static constexpr const char *name = "plane",
                              *doc = "The distance to an infinite plane, from either side.";
  Vec3 point{};
  Axis normal;
  template <class V>
  static void parameters(V& v) {
    v(length_of("point", "a point of the plane"), &Plane::point);
    v(direction_of("normal", "direction perpendicular to it"), &Plane::normal);
  }
  void prepare() { frame.set(point, normal); }
  template <class T>
  T eval(T x, T y, T z) const {
    return abs(frame.local(x, y, z)[2]);
  }

 private:
  Frame frame;
};

struct Circle : Feature {
  static constexpr const char *name = "circle", *doc = "The distance to a circular line.";
  Vec3 center{};
  double radius = 1;
  Axis axis;
  template <class V>
  static void parameters(V& v) {
    v(length_of("center", "its middle"), &Circle::center);
    v(positive_length("radius", "its radius"), &Circle::radius);
    v(direction_of("axis", "direction perpendicular to its plane"), &Circle::axis);
  }
  void prepare() { frame.set(center, axis); }
  template <class T>
  T eval(T x, T y, T z) const {
    const auto [u, v, w] = frame.local(x, y, z);
    return length(length(u, v) - T(radius), w);
  }

 private:
  Frame frame;
};

struct Arc : Feature {
  static constexpr const char *name = "arc",
                              *doc = "The distance to a circular arc parallel to the xy plane.";
  Vec3 center{};
  double radius = 1, start = 0, end = 180;
  template <class V>
  static void parameters(V& v) {
    v(length_of("center", "the middle of its circle"), &Arc::center);
    v(positive_length("radius", "its radius"), &Arc::radius);
    v(Parameter{"start", "where it starts, counter-clockwise from +x", Unit::angle, Range::any,
                true},
      &Arc::start);
    v(Parameter{"end", "where it ends: more than start, by at most 360", Unit::angle, Range::any,
                true},
      &Arc::end);
  }
  void prepare() {
    if (!(end > start && end - start <= 360)) {
      throw Error("the arc goes from " + std::to_string(start) + " to " + std::to_string(end) +
                  " degrees; end must be larger than start by at most 360");
    }
    const double degree = std::numbers::pi / 180, middle = 0.5 * (start + end) * degree;
    half_ = 0.5 * (end - start) * degree;
    along_ = {std::cos(middle), std::sin(middle)};
  }
  template <class T>
  T eval(T x, T y, T z) const {
    const T px = x - T(center[0]), py = y - T(center[1]), w = z - T(center[2]);
    // The frame of its symmetry axis: u along the middle, v to either side.
    const T u = T(along_[0]) * px + T(along_[1]) * py;
    const T v = abs(T(along_[0]) * py - T(along_[1]) * px);
    const double c = std::cos(half_), s = std::sin(half_);
    return shortcut(T(c) * v <= T(s) * u, length(length(u, v) - T(radius), w),
                    [&] { return length(u - T(radius * c), v - T(radius * s), w); });
  }

 private:
  double half_ = 1;
  Vec2 along_{1, 0};
};

using FeatureOps = OpList<Point, Points, Segment, Polyline, Plane, Circle, Arc>;

}  // namespace sardf

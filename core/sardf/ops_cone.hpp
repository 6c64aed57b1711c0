// Capsule and cone: solids of revolution about a segment, exact signed distance.
#pragma once

#include "sardf/ops_solids.hpp"

namespace sardf {

/// The vector from the segment a b to the point at `x, y, z` relative to a.
template <class T>
std::array<T, 3> from_segment(T x, T y, T z, const Vec3& edge) {
  const double squared = dot(edge, edge);
  const double scale = squared > 0 ? 1 / squared : 0;
  const T along = T(edge[0] * scale) * x + T(edge[1] * scale) * y + T(edge[2] * scale) * z;
  const T t = min(max(along, T(0.0)), T(1.0));
  return {x - T(edge[0]) * t, y - T(edge[1]) * t, z - T(edge[2]) * t};
}

struct Capsule : Solid {
  static constexpr const char *name = "capsule", *doc = "All points within a radius of a segment.";
  Vec3 a{}, b{0, 0, 1};
  double radius = 1;
  template <class V>
  static void parameters(V& v) {
    v(required_length("a", "one end of the segment"), &Capsule::a);
    v(required_length("b", "the other end"), &Capsule::b);
    v(positive_length("radius", "its radius"), &Capsule::radius);
  }
  template <class T>
  T eval(T x, T y, T z) const {
    const auto [dx, dy, dz] = from_segment(x - T(a[0]), y - T(a[1]), z - T(a[2]), b - a);
    return T(radius) - length(dx, dy, dz);
  }
};

/// In the half-plane (r, w) its section is a convex polygon: inside, the nearest boundary line
/// counts; outside, the nearest of the two discs and of the slanted side.
struct Cone : Solid {
  static constexpr const char *name = "cone", *doc = "A cone or truncated cone with flat ends.";
  Vec3 center{};
  Axis axis;
  double radius_bottom = 1, radius_top = 0, height = 1;
  template <class V>
  static void parameters(V& v) {
    v(length_of("center", "the middle of its axis"), &Cone::center);
    v(direction_of("axis", "direction from the bottom to the top"), &Cone::axis);
    v(Parameter{"radius_bottom", "radius of the lower end", Unit::length, Range::non_negative,
                true},
      &Cone::radius_bottom);
    v(Parameter{"radius_top", "radius of the upper end; 0: a tip", Unit::length,
                Range::non_negative},
      &Cone::radius_top);
    v(positive_length("height", "full height"), &Cone::height);
  }
  void prepare() {
    if (radius_bottom == 0 && radius_top == 0) {
      throw Error("radius_bottom and radius_top are both 0; one must be positive");
    }
    frame.set(center, axis);
    slant = std::hypot(radius_bottom - radius_top, height);
  }
  template <class T>
  T eval(T x, T y, T z) const {
    const auto [u, v, w] = frame.local(x, y, z);
    const T r = length(u, v), cap = T(0.5 * height) - abs(w);
    // The slanted side: from (radius_top, height / 2) downwards, `in` its distance towards the
    // axis.
    const double dr = (radius_bottom - radius_top) / slant, dw = height / slant;
    const T from_r = r - T(radius_top), from_w = w - T(0.5 * height);
    const T in = -(T(dw) * from_r + T(dr) * from_w);
    const T inside = min(in, cap);
    return shortcut(inside >= T(0.0), inside, [&] {
      const T disc = select(w < T(0.0), T(radius_bottom), T(radius_top));
      const T to_disc = length(max(r - disc, T(0.0)), cap);
      const T along = T(dr) * from_r - T(dw) * from_w;
      const T t = min(max(along, T(0.0)), T(slant));
      // Beside the slanted side its line, which has a direction on it and in rounding of it.
      const T to_side = select(along > T(0.0) && along < T(slant), abs(in),
                               length(from_r - T(dr) * t, from_w + T(dw) * t));
      const T nearest = min(to_disc, to_side);
      // On a rim that rounding has outside, a length has no slope.
      return select(nearest <= T(0.0), inside, -nearest);
    });
  }

 private:
  Frame frame;
  double slant = 1;
};

using ConeOps = OpList<Capsule, Cone>;

}  // namespace sardf

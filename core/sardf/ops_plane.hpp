// Solids of the xy plane with exact signed distance; they do not depend on z.
#pragma once

#include "sardf/ops_solids.hpp"

namespace sardf {

struct PlaneSolid {
  static constexpr Kind kind = Kind::plane;
  static constexpr int arity = 2;
  static constexpr bool distance = true;
};

struct Disc : PlaneSolid {
  static constexpr const char *name = "disc", *doc = "A disc in the xy plane.";
  Vec2 center{};
  double radius = 1;
  template <class V>
  static void parameters(V& v) {
    v(length_of("center", "its middle"), &Disc::center);
    v(positive_length("radius", "its radius"), &Disc::radius);
  }
  template <class T>
  T eval(T x, T y) const {
    return T(radius) - length(x - T(center[0]), y - T(center[1]));
  }
};

struct Box2d : PlaneSolid {
  static constexpr const char *name = "box2d", *doc = "A rectangle in the xy plane.";
  Vec2 center{}, size{1, 1};
  template <class V>
  static void parameters(V& v) {
    v(length_of("center", "its middle"), &Box2d::center);
    v(positive_length("size", "full edge lengths"), &Box2d::size);
  }
  template <class T>
  T eval(T x, T y) const {
    return perpendicular_intersection(T(0.5 * size[0]) - abs(x - T(center[0])),
                                      T(0.5 * size[1]) - abs(y - T(center[1])));
  }
};

struct HalfPlane : PlaneSolid {
  static constexpr const char *name = "half_plane",
                              *doc = "All of the xy plane on one side of a line.";
  Vec2 point{}, normal{1, 0};
  template <class V>
  static void parameters(V& v) {
    v(length_of("point", "a point of the line"), &HalfPlane::point);
    v(Parameter{"normal", "perpendicular to the line, pointing inwards; of any length but 0",
                Unit::none, Range::any, true},
      &HalfPlane::normal);
  }
  void prepare();
  template <class T>
  T eval(T x, T y) const {
    return T(unit_[0]) * (x - T(point[0])) + T(unit_[1]) * (y - T(point[1]));
  }

 private:
  Vec2 unit_{1, 0};
};

/// The nearest edge gives the magnitude; the sign is that of the nearest edge's line where the foot
/// lies inside the edge, and the parity of crossings of a ray where it is a corner. At a corner
/// itself the gradient is the normal of one of its two edges, which points inwards.
struct Polygon : PlaneSolid {
  static constexpr const char *name = "polygon",
                              *doc =
                                  "The inside of a closed contour without self-intersections, "
                                  "in the xy plane.";
  std::vector<Vec2> vertices;
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"vertices", "its corners in order, either way round", Unit::length, Range::any,
                true, 3},
      &Polygon::vertices);
  }
  /// Throws Error for repeated vertices and for edges that cross or touch, naming them.
  void prepare();

  template <class T>
  T eval(T x, T y) const {
    T best_squared(0.0), best_line(0.0), at_corner(0.0), parity(1.0);
    const size_t n = vertices.size();
    for (size_t i = 0; i < n; ++i) {
      const Vec2 &a = vertices[i], &b = vertices[i + 1 < n ? i + 1 : 0];
      const double ex = b[0] - a[0], ey = b[1] - a[1], squared = ex * ex + ey * ey;
      const T px = x - T(a[0]), py = y - T(a[1]);
      const T along = T(ex / squared) * px + T(ey / squared) * py;
      // As the foot moves along the edge, neither the distance to it changes nor to its line.
      const T t = freeze(min(max(along, T(0.0)), T(1.0)));
      const T away_x = px - T(ex) * t, away_y = py - T(ey) * t;
      const T edge_squared = square(away_x) + square(away_y);
      // Exactly 0 at both ends of the edge.
      const T line =
          T(turn_ * ex / std::sqrt(squared)) * away_y - T(turn_ * ey / std::sqrt(squared)) * away_x;
      const T corner = select(along > T(0.0) && along < T(1.0), T(0.0), T(1.0));
      if (i == 0) {
        best_squared = edge_squared;
        best_line = line;
        at_corner = corner;
      } else {
        const auto nearer = edge_squared < best_squared;
        best_line = select(nearer, line, best_line);
        at_corner = select(nearer, corner, at_corner);
        best_squared = select(nearer, edge_squared, best_squared);
      }
      const double lower = std::min(a[1], b[1]), upper = std::max(a[1], b[1]);
      if (lower < upper) {
        const double up = b[1] > a[1] ? turn_ : -turn_;
        // Left of an upward edge, right of a downward one, in the edge's half-open span of y.
        const auto crosses = y >= T(lower) && y < T(upper) && T(up) * line > T(0.0);
        parity = select(crosses, -parity, parity);
      }
    }
    // No root has a slope at 0, but an edge's line has one.
    const auto by_line = at_corner < T(0.5) || best_squared <= T(0.0);
    return shortcut(by_line, best_line, [&] { return -parity * sqrt(best_squared); });
  }

 private:
  double turn_ = 1;  // 1: counter-clockwise
};

using PlaneOps = OpList<Disc, Box2d, HalfPlane, Polygon>;

}  // namespace sardf

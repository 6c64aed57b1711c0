// Solids of the xy plane with exact signed distance; they do not depend on z.
#pragma once

#include <optional>

#include "sardf/numbers/choice.hpp"
#include "sardf/ops_solids.hpp"

namespace sardf {

struct PlaneSolid {
  static constexpr Kind kind = Kind::plane;
  static constexpr int arity = 2;
  static constexpr bool distance = true;
  using FusedWith = JoinOps;
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
    return at_distance(length(x - T(center[0]), y - T(center[1])), x, y);
  }

  Vec2 middle() const { return center; }
  bool is_alike(const Disc& other) const { return radius == other.radius; }
  template <class T>
  T at_distance(T from_middle, T, T) const {
    return T(radius) - from_middle;
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
  /// The same in every bit for points in a box, in fewer edges; nothing where most of them matter.
  std::optional<Polygon> near(const Choice& x, const Choice& y) const;
  /// What tells polygons for boxes from the whole one.
  void append_edges(std::vector<double>& numbers) const;

  template <class T>
  T eval(T x, T y) const {
    T best_squared(0.0), best_line(0.0), at_corner(0.0), parity(parity_);
    bool is_first = true;
    for (const Edge& edge : edges_) {
      const Foot<T> foot = foot_on(edge, x, y);
      if (edge.measures && is_first) {
        best_squared = foot.squared;
        best_line = foot.line;
        at_corner = foot.corner;
        is_first = false;
      } else if (edge.measures) {
        const auto nearer = foot.squared < best_squared;
        best_line = select(nearer, foot.line, best_line);
        at_corner = select(nearer, foot.corner, at_corner);
        best_squared = select(nearer, foot.squared, best_squared);
      }
      if (edge.crosses) parity = select(is_crossed(edge, y, foot.line), -parity, parity);
    }
    if (!has_corners_) return best_line;
    // No root has a slope at 0, but an edge's line has one.
    const auto by_line = at_corner < T(0.5) || best_squared <= T(0.0);
    return shortcut(by_line, best_line, [&] { return -parity * sqrt(best_squared); });
  }

 private:
  struct Edge {
    int number = 0;
    Vec2 from{}, along{}, line{};  // the first corner, to the next one, factors of its line
    double squared = 0, lower = 0, upper = 0, up = 1;
    bool measures = true;  // whether it may be the nearest one
    bool crosses = false;  // whether a ray along x may cross it
  };
  template <class T>
  struct Foot {
    T squared, line, corner;
  };

  template <class T>
  static Foot<T> foot_on(const Edge& edge, const T& x, const T& y) {
    const double ex = edge.along[0], ey = edge.along[1];
    const T px = x - T(edge.from[0]), py = y - T(edge.from[1]);
    const T along = T(ex / edge.squared) * px + T(ey / edge.squared) * py;
    // As the foot moves along the edge, neither the distance to it changes nor to its line.
    const T t = freeze(min(max(along, T(0.0)), T(1.0)));
    const T away_x = px - T(ex) * t, away_y = py - T(ey) * t;
    const T squared = square(away_x) + square(away_y);
    // Exactly 0 at both ends of the edge.
    const T line = T(edge.line[0]) * away_y - T(edge.line[1]) * away_x;
    return {squared, line, select(along > T(0.0) && along < T(1.0), T(0.0), T(1.0))};
  }
  /// Left of an upward edge, right of a downward one, in the edge's half-open span of y.
  template <class T>
  static auto is_crossed(const Edge& edge, const T& y, const T& line) {
    return y >= T(edge.lower) && y < T(edge.upper) && T(edge.up) * line > T(0.0);
  }

  std::vector<Edge> edges_;
  double parity_ = 1;        // of the crossings that are the same all over the box
  bool has_corners_ = true;  // whether a corner may be the nearest point
};

using PlaneOps = OpList<Disc, Box2d, HalfPlane, Polygon>;

}  // namespace sardf

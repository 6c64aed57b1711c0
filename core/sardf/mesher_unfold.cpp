// Faces that turned over because a vertex left its room: its neighbours make room for it, or else
// the vertex is placed again within its own.
//
// A vertex on an edge of the solid often has to lie outside of its cell, where the edge cuts the
// corner of a neighbour without crossing a grid edge there. Within its room (room_of) it cannot
// turn a face over; outside it may, which is looked at here.
#include <algorithm>
#include <utility>

#include "sardf/mesher_stages.hpp"

namespace sardf::mesher {

namespace {

// Least area of the triangles of a face, in cells squared, and distance of its vertices, in cells.
constexpr double least_area = 1e-5, least_distance = 1e-3;

class Faces {
 public:
  Faces(const Grid& grid, const Net& net, const Places& places, const Vertices& vertices)
      : grid_(grid), net_(net), places_(places), vertices_(vertices) {}

  bool is_good(uint32_t face) const {
    const auto& v = net_.faces[face];
    for (int a = 0; a < 4; ++a) {
      for (int b = a + 1; b < 4; ++b) {
        if (norm(at(v[a]) - at(v[b])) < least_distance * grid_.cell) return false;
      }
    }
    return faces_along(v, places_.direction(face)) || faces_along(v, places_.normal(face));
  }

 private:
  const Vec3& at(uint32_t vertex) const { return vertices_.at[vertex]; }

  // Whether both triangles of the face, split along one of the diagonals, are seen from outside.
  bool faces_along(const std::array<uint32_t, 4>& v, const Vec3& outward) const {
    const auto area = [&](int a, int b, int c) {
      return 0.5 * dot(cross(at(v[b]) - at(v[a]), at(v[c]) - at(v[a])), outward);
    };
    const double least = least_area * grid_.cell * grid_.cell;
    return std::max(std::min(area(0, 1, 2), area(0, 2, 3)),
                    std::min(area(0, 1, 3), area(1, 2, 3))) > least;
  }

  const Grid& grid_;
  const Net& net_;
  const Places& places_;
  const Vertices& vertices_;
};

// Moves the smooth neighbours of a vertex that left its room out of its way.
class RoomMaker {
 public:
  RoomMaker(const Field& field, const Grid& grid, const Net& net, const Places& places,
            Vertices& vertices)
      : field_(field),
        grid_(grid),
        net_(net),
        places_(places),
        vertices_(vertices),
        faces_(grid, net, places, vertices) {}

  /// Whether all faces around the vertex and those that were moved are good now; otherwise nothing
  /// has changed.
  bool make_room_for(uint32_t v) {
    before_.clear();
    const BoundingBox room = places_.room(v);
    for (const uint32_t w : neighbours(v)) {
      if (!vertices_.is_smooth(w)) continue;
      Vec3 to = vertices_.at[w];
      for (int axis = 0; axis < 3; ++axis) {
        const double at = vertices_.at[v][axis];
        if (at >= room.lo[axis] && at <= room.hi[axis]) continue;
        to[axis] = beyond(at, at > room.hi[axis], places_.cell_box(w), axis, to[axis]);
      }
      move(w, to);
    }
    if (!before_.empty() && is_good_around(v) &&
        std::all_of(before_.begin(), before_.end(),
                    [&](const Before& b) { return is_good_around(b.vertex); })) {
      return true;
    }
    for (const Before& b : before_) {
      vertices_.at[b.vertex] = b.at;
      vertices_.normal[b.vertex] = b.normal;
    }
    return false;
  }

 private:
  struct Before {
    uint32_t vertex;
    Vec3 at;
    std::array<float, 3> normal;
  };

  std::vector<uint32_t> neighbours(uint32_t v) const {
    std::vector<uint32_t> result;
    for (const uint32_t use : places_.uses(v)) {
      for (const uint32_t w : net_.faces[use / 4]) {
        if (w != v) result.push_back(w);
      }
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }

  // The coordinate of a neighbour in whose cell the vertex came: farther from where that came from
  // than halfway from it to the cell's other side.
  static double beyond(double vertex, bool above, const BoundingBox& cell, int axis, double at) {
    if (!(vertex > cell.lo[axis] && vertex < cell.hi[axis])) return at;
    return above ? std::max(at, 0.5 * (vertex + cell.hi[axis]))
                 : std::min(at, 0.5 * (vertex + cell.lo[axis]));
  }

  // Moves a smooth vertex to the surface near a point, if the normal there is that of its
  // crossings. Its own one may be that of an edge's other side.
  void move(uint32_t w, Vec3 to) {
    constexpr double near = 1e-6, like = 0.9;
    const Vec3 wanted = places_.normal(*places_.uses(w).begin() / 4);
    const BoundingBox room = places_.room(w);
    Points<double> points;
    for (int step = 0; step < 4; ++step) {
      points.set(0, to);
      field_.differentiate(points, 1);
      const Vec3 normal = outward_normal(points.gradient_at(0));
      const Vec3 by = newton_step(points.value[0], points.gradient_at(0));
      if (dot(normal, wanted) < like) return;
      if (norm(by) <= near * grid_.cell) {
        if (norm(to - vertices_.at[w]) <= near * grid_.cell) return;
        before_.push_back({w, vertices_.at[w], vertices_.normal[w]});
        vertices_.at[w] = to;
        for (size_t axis = 0; axis < 3; ++axis) vertices_.normal[w][axis] = float(normal[axis]);
        return;
      }
      to = clamped(to + by, room);
    }
  }

  bool is_good_around(uint32_t v) const {
    const Uses uses = places_.uses(v);
    return std::all_of(uses.begin(), uses.end(),
                       [&](uint32_t use) { return faces_.is_good(use / 4); });
  }

  const Field& field_;
  const Grid& grid_;
  const Net& net_;
  const Places& places_;
  Vertices& vertices_;
  const Faces faces_;
  std::vector<Before> before_;
};

}  // namespace

bool make_room(const Field& field, const Grid& grid, const Net& net, const Places& places,
               const std::vector<uint32_t>& numbers, Vertices& vertices) {
  RoomMaker maker(field, grid, net, places, vertices);
  bool any = false;
  for (const uint32_t v : numbers) any = maker.make_room_for(v) || any;
  return any;
}

std::vector<uint32_t> vertices_to_take_back(const Grid& grid, const Net& net, const Places& places,
                                            const Vertices& vertices, Work& work) {
  const Faces faces(grid, net, places, vertices);
  const auto outside = [&](uint32_t v) {
    return norm(vertices.at[v] - clamped(vertices.at[v], places.room(v)));
  };
  const auto add_farthest = [&](size_t i, std::vector<uint32_t>& to) {
    const uint32_t v = vertices.sharp[i];
    if (outside(v) == 0) return;
    for (const uint32_t use : places.uses(v)) {
      const uint32_t face = use / 4;
      if (faces.is_good(face)) continue;
      const auto& corners = net.faces[face];
      to.push_back(*std::max_element(corners.begin(), corners.end(), [&](uint32_t a, uint32_t b) {
        return outside(a) < outside(b);
      }));
    }
  };
  auto result = collected<uint32_t>(vertices.sharp.size(), 256, work, add_farthest);
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

}  // namespace sardf::mesher

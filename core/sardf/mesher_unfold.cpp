// Faces that turned over because a vertex left its room: the vertex is placed again within it.
//
// A vertex on an edge of the solid often has to lie outside of its cell, where the edge cuts the
// corner of a neighbour without crossing a grid edge there. Within its room (mesher_net.cpp) it
// cannot turn a face over; outside it may, which is looked at here.
#include <algorithm>

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

}  // namespace

std::vector<uint32_t> vertices_to_take_back(const Grid& grid, const Net& net, const Places& places,
                                            const Vertices& vertices) {
  const Faces faces(grid, net, places, vertices);
  const auto outside = [&](uint32_t v) {
    return norm(vertices.at[v] - clamped(vertices.at[v], places.room(v)));
  };
  std::vector<uint32_t> result;
  for (const uint32_t v : vertices.sharp) {
    if (outside(v) == 0) continue;
    for (const uint32_t use : places.uses(v)) {
      const uint32_t face = use / 4;
      if (faces.is_good(face)) continue;
      const auto& corners = net.faces[face];
      result.push_back(
          *std::max_element(corners.begin(), corners.end(),
                            [&](uint32_t a, uint32_t b) { return outside(a) < outside(b); }));
    }
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

}  // namespace sardf::mesher

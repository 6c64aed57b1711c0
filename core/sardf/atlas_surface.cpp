// The atlas's first stage: neighbours, normals and areas of the faces.
#include <algorithm>
#include <cmath>
#include <utility>

#include "sardf/atlas_stages.hpp"
#include "sardf/error.hpp"

namespace sardf::atlas {
namespace {

void check(const Mesh& mesh) {
  if (mesh.faces.empty()) throw Error("an atlas needs a mesh with at least one face, found none");
  const size_t corners = 4 * mesh.faces.size();
  if (corners >= none) throw Error("the mesh has too many faces for an atlas");
  if (!mesh.corner_normals.empty() && mesh.corner_normals.size() != corners)
    throw Error("found " + std::to_string(mesh.corner_normals.size()) +
                " corner normals, accepted are 0 or 4 per face: " + std::to_string(corners));
  for (const auto& face : mesh.faces)
    for (const uint32_t v : face)
      if (v >= mesh.vertices.size())
        throw Error("a face has vertex " + std::to_string(v) + ", but the mesh has only " +
                    std::to_string(mesh.vertices.size()) + " vertices");
  for (const Vec3& p : mesh.vertices)
    if (!std::isfinite(p[0] + p[1] + p[2])) throw Error("a vertex of the mesh is not finite");
}

struct Side {
  uint64_t edge;
  uint32_t half_edge;
  bool forward;
};

/// All half-edges sorted by the edge they lie on.
std::vector<Side> sorted_sides(const Surface& surface) {
  std::vector<Side> sides;
  sides.reserve(4 * surface.face_count());
  for (uint32_t h = 0; h < 4 * surface.face_count(); ++h) {
    const uint32_t a = surface.vertex(h), b = surface.vertex(surface.next(h));
    if (a == b) continue;
    const uint64_t edge = (static_cast<uint64_t>(std::min(a, b)) << 32) | std::max(a, b);
    sides.push_back({edge, h, a < b});
  }
  std::sort(sides.begin(), sides.end(), [](const Side& p, const Side& q) {
    return p.edge != q.edge ? p.edge < q.edge : p.half_edge < q.half_edge;
  });
  return sides;
}

void find_twins(Surface& surface) {
  surface.twin.assign(4 * surface.face_count(), none);
  std::vector<uint64_t> creases;
  for (const auto& [a, b] : surface.mesh->creases)
    creases.push_back((static_cast<uint64_t>(std::min(a, b)) << 32) | std::max(a, b));
  std::sort(creases.begin(), creases.end());
  const std::vector<Side> sides = sorted_sides(surface);
  for (size_t i = 0; i < sides.size();) {
    size_t end = i + 1;
    while (end < sides.size() && sides[end].edge == sides[i].edge) ++end;
    if (end - i == 2 && sides[i].forward != sides[i + 1].forward &&
        !std::binary_search(creases.begin(), creases.end(), sides[i].edge)) {
      surface.twin[sides[i].half_edge] = sides[i + 1].half_edge;
      surface.twin[sides[i + 1].half_edge] = sides[i].half_edge;
    }
    i = end;
  }
}

}  // namespace

Surface build_surface(const Mesh& mesh) {
  check(mesh);
  Surface surface{&mesh, {}, {}, {}, {}};
  const size_t count = mesh.faces.size();
  surface.normal.resize(count);
  surface.centre.resize(count);
  surface.area.resize(count);
  for (size_t f = 0; f < count; ++f) {
    const auto& face = mesh.faces[f];
    const Vec3 &a = mesh.vertices[face[0]], &b = mesh.vertices[face[1]];
    const Vec3 &c = mesh.vertices[face[2]], &d = mesh.vertices[face[3]];
    const Vec3 first = cross(b - a, c - a), second = cross(c - a, d - a);
    surface.area[f] = 0.5 * (norm(first) + norm(second));
    surface.centre[f] = 0.25 * (a + b + c + d);
    // Corner normals come from the field and are right even on slivers.
    Vec3 normal = first + second;
    if (!mesh.corner_normals.empty()) {
      const Vec3* corner = &mesh.corner_normals[4 * f];
      normal = corner[0] + corner[1] + corner[2] + corner[3];
    }
    const double length = norm(normal);
    surface.normal[f] = length > 0 && std::isfinite(length) ? (1 / length) * normal : Vec3{0, 0, 1};
  }
  find_twins(surface);
  return surface;
}

}  // namespace sardf::atlas

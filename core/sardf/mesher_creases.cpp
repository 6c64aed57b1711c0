// Edges across which the normal jumps.
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sardf/mesher_stages.hpp"

namespace sardf::mesher {

namespace {

constexpr double crease_angle = 22 * std::numbers::pi / 180;

// An edge of a face: its vertices, smaller first, in one number, and the uses there.
struct FaceEdge {
  uint64_t vertices;
  std::array<uint32_t, 2> uses;
};

double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(norm(cross(a, b)), dot(a, b));
}

// Those with a sharp vertex, sorted: an edge of two smooth vertices has one normal at either end
// and is no crease.
std::vector<FaceEdge> edges_of(const Mesh& mesh, const Vertices& vertices,
                               const std::vector<uint32_t>& faces, Work& work) {
  const auto add_edges = [&](size_t i, std::vector<FaceEdge>& to) {
    const uint32_t face = faces[i];
    std::array<bool, 4> smooth;
    for (size_t k = 0; k < 4; ++k) smooth[k] = vertices.is_smooth(mesh.faces[face][k]);
    for (uint32_t k = 0; k < 4; ++k) {
      if (smooth[k] && smooth[(k + 1) % 4]) continue;
      uint32_t a = 4 * face + k, b = 4 * face + (k + 1) % 4;
      if (mesh.faces[face][a % 4] > mesh.faces[face][b % 4]) std::swap(a, b);
      to.push_back({uint64_t(mesh.faces[face][a % 4]) << 32 | mesh.faces[face][b % 4], {a, b}});
    }
  };
  auto edges = collected<FaceEdge>(faces.size(), 1024, work, add_edges);
  tbb::parallel_sort(edges.begin(), edges.end(), [](const FaceEdge& a, const FaceEdge& b) {
    return a.vertices != b.vertices ? a.vertices < b.vertices : a.uses < b.uses;
  });
  return edges;
}

}  // namespace

std::vector<std::array<uint32_t, 2>> find_creases(const Mesh& mesh, const Vertices& vertices,
                                                  const std::vector<uint32_t>& sharp_faces,
                                                  Work& work) {
  using Crease = std::array<uint32_t, 2>;
  const std::vector<FaceEdge> edges = edges_of(mesh, vertices, sharp_faces, work);
  const auto add_crease = [&](size_t i, std::vector<Crease>& to) {
    if (i + 1 == edges.size()) return;
    const FaceEdge &a = edges[i], &b = edges[i + 1];
    if (a.vertices != b.vertices) return;
    double sum = 0;
    for (int end = 0; end < 2; ++end) {
      sum += angle_between(mesh.corner_normals[a.uses[end]], mesh.corner_normals[b.uses[end]]);
    }
    if (sum > 2 * crease_angle) to.push_back({uint32_t(a.vertices >> 32), uint32_t(a.vertices)});
  };
  return collected<Crease>(edges.size(), 4096, work, add_crease);
}

}  // namespace sardf::mesher

#include <algorithm>
#include <unordered_map>

#include "sardf/mesh_file_formats.hpp"

namespace sardf::mesh_file {

namespace {

struct CornerHash {
  size_t operator()(const Corners::Corner& corner) const {
    uint64_t hash = corner.vertex;
    const auto mix = [&hash](float value) {
      hash = (hash ^ std::bit_cast<uint32_t>(value)) * 0x9E3779B97F4A7C15u;
      hash ^= hash >> 32;
    };
    for (const float value : corner.normal) mix(value);
    for (const float value : corner.uv) mix(value);
    return size_t(hash);
  }
};

// Adding 0 makes one zero of the two.
template <size_t N>
std::array<float, N> to_float(const std::array<double, N>& from) {
  std::array<float, N> result;
  for (size_t i = 0; i < N; ++i) result[i] = float(from[i]) + 0.0f;
  return result;
}

bool has_area(const Mesh& mesh, const std::array<uint32_t, 4>& face, int second) {
  const Vec3& a = mesh.vertices[face[0]];
  return norm(cross(mesh.vertices[face[second]] - a, mesh.vertices[face[second + 1]] - a)) > 0;
}

}  // namespace

bool is_triangle(const std::array<uint32_t, 4>& face) { return face[3] == face[2]; }

Corners unique_corners(const Mesh& mesh) {
  Corners result;
  std::unordered_map<Corners::Corner, uint32_t, CornerHash> known;
  known.reserve(mesh.vertices.size());
  result.index.resize(4 * mesh.faces.size());
  for (uint32_t i = 0; i < result.index.size(); ++i) {
    Corners::Corner corner{mesh.faces[i / 4][i % 4], {}, {}};
    if (!mesh.corner_normals.empty()) corner.normal = to_float(mesh.corner_normals[i]);
    if (!mesh.corner_uv.empty()) corner.uv = to_float(mesh.corner_uv[i]);
    const auto [at, is_new] = known.emplace(corner, uint32_t(result.unique.size()));
    if (is_new) result.unique.push_back(corner);
    result.index[i] = at->second;
  }
  return result;
}

std::vector<std::array<uint32_t, 3>> triangulate(const Mesh& mesh) {
  std::vector<std::array<uint32_t, 3>> triangles;
  for (uint32_t f = 0; f < mesh.faces.size(); ++f) {
    for (const int second : {1, 2}) {
      if (!has_area(mesh, mesh.faces[f], second)) continue;
      triangles.push_back({4 * f, 4 * f + second, 4 * f + second + 1});
    }
  }
  return triangles;
}

}  // namespace sardf::mesh_file

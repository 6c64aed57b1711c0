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

// How well a triangle of corners agrees with their normals: the cosine; -2 without area.
double agreement(const Mesh& mesh, uint32_t face, const std::array<uint32_t, 3>& k) {
  const auto& v = mesh.faces[face];
  const Vec3 &a = mesh.vertices[v[k[0]]], &b = mesh.vertices[v[k[1]]], &c = mesh.vertices[v[k[2]]];
  const Vec3 normal = cross(b - a, c - a);
  if (!(norm(normal) > 0)) return -2;
  if (mesh.corner_normals.empty()) return 0;
  double least = 1;
  for (const uint32_t corner : k) {
    least = std::min(least, dot(normalized(normal), mesh.corner_normals[4 * face + corner]));
  }
  return least;
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
  using Triangle = std::array<uint32_t, 3>;
  constexpr Triangle splits[2][2] = {{{0, 1, 2}, {0, 2, 3}}, {{0, 1, 3}, {1, 2, 3}}};
  std::vector<Triangle> triangles;
  for (uint32_t f = 0; f < mesh.faces.size(); ++f) {
    const auto worst = [&](const Triangle* split) {
      return std::min(agreement(mesh, f, split[0]), agreement(mesh, f, split[1]));
    };
    const bool other = !is_triangle(mesh.faces[f]) && worst(splits[1]) > worst(splits[0]);
    for (const Triangle& t : splits[other]) {
      if (agreement(mesh, f, t) < -1.5) continue;
      triangles.push_back({4 * f + t[0], 4 * f + t[1], 4 * f + t[2]});
    }
  }
  return triangles;
}

}  // namespace sardf::mesh_file

// Private to core/sardf/mesh_file*.cpp.
#pragma once

#include <bit>
#include <cstdint>

#include "sardf/mesh_file.hpp"

namespace sardf::mesh_file {

/// The mesh's corners with equal ones (vertex, normal and texture coordinates) taken together.
struct Corners {
  struct Corner {
    uint32_t vertex;
    std::array<float, 3> normal;
    std::array<float, 2> uv;
    bool operator==(const Corner&) const = default;
  };
  std::vector<Corner> unique;   // in the order of their first use
  std::vector<uint32_t> index;  // of each corner of each face, into `unique`
};

Corners unique_corners(const Mesh& mesh);

bool is_triangle(const std::array<uint32_t, 4>& face);

/// Corner numbers (4 * face + k) of triangles; those without area are left out.
std::vector<std::array<uint32_t, 3>> triangulate(const Mesh& mesh);

/// The little-endian bytes of a number.
template <class T>
void append(std::string& to, T value) {
  if constexpr (std::is_same_v<T, float>) {
    append(to, std::bit_cast<uint32_t>(value));
  } else {
    for (size_t i = 0; i < sizeof(T); ++i) to.push_back(char(value >> (8 * i) & 0xFF));
  }
}

std::string ply(const Mesh& mesh, const MeshAttributes& attributes, double metres_per_unit);
std::string obj(const Mesh& mesh, const MeshAttributes& attributes, double metres_per_unit);
std::string glb(const Mesh& mesh, const MeshAttributes& attributes, double metres_per_unit);

}  // namespace sardf::mesh_file

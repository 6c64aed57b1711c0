// Triangle meshes from files: PLY, OBJ and STL.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "sardf/progress.hpp"
#include "sardf/vec.hpp"

namespace sardf {

struct TriangleMesh {
  /// In the file's order, without those equal to an earlier one; some may be in no triangle.
  std::vector<Vec3> vertices;
  /// Counter-clockwise seen from outside. Some may have no area, or name a vertex twice.
  std::vector<std::array<uint32_t, 3>> triangles;
  /// Of each triangle, the polygon of the file that it is a part of, counted from 0; rising.
  std::vector<uint32_t> polygons;
  size_t polygon_count = 0;
};

/// Reads a file whose ending is .ply (text, or binary of either byte order), .obj or .stl (text or
/// binary); in STL the facets are the polygons. Polygons are cut into triangles, concave ones too.
/// Throws Error that names the file and the line (in binary files, the byte) of what is wrong: a
/// file that cannot be read or ends too early, an unknown ending, a corner that is no vertex, a
/// coordinate that is not finite or beyond 1e100, a mesh without triangles.
TriangleMesh read_triangle_mesh(const std::string& path, const Progress& progress = {});

}  // namespace sardf

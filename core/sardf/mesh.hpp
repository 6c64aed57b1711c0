// The surface mesh that mesher, atlas, baker and exporters share.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "sardf/vec.hpp"

namespace sardf {

/// A polygon mesh of quads, wound counter-clockwise seen from outside (where the field is
/// negative), to be split from their first corner to their third. A triangle repeats its last
/// index. Lengths are in scene units.
struct Mesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<uint32_t, 4>> faces;
  /// Unit outward normals, one for each corner of each face (-grad f of the face's side of a
  /// crease); empty or 4 * faces.size().
  std::vector<Vec3> corner_normals;
  /// Texture coordinates in [0, 1]², one for each corner of each face, v upwards; empty until an
  /// atlas is made.
  std::vector<Vec2> corner_uv;
  /// Edges (vertex pairs, smaller index first, sorted) across which the normal jumps.
  std::vector<std::array<uint32_t, 2>> creases;
};

}  // namespace sardf

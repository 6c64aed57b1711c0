// Tangents of texture coordinates: the frames that tangent-space normal maps are read in.
#pragma once

#include <array>
#include <vector>

#include "sardf/mesh.hpp"
#include "sardf/progress.hpp"

namespace sardf {

/// One tangent for each corner of each face: x, y, z of a unit vector perpendicular to the corner's
/// normal, and the sign s of the bitangent s (normal x tangent), -1 where the texture is mirrored.
///
/// They are those of MikkTSpace (M. Mikkelsen, "Simulation of wrinkled surfaces revisited", 2008,
/// and its mikktspace.c, called with triangles and its default threshold of 180 degrees), which
/// Cycles and most other renderers compute for a mesh: at a corner the direction of growing u of
/// the triangles that share its vertex, normal and texture coordinates, and hang together there by
/// common edges with one sign, weighted by their angles. Positions, normals and coordinates are
/// taken in float, as renderers have them. Only where a triangle has no area, in space or in the
/// texture, MikkTSpace's answer may be another: such a triangle has no say here, and a corner that
/// no other triangle shares gets any perpendicular direction and the sign 1.
///
/// Throws Error: corner_normals or corner_uv are missing. Throws Cancelled.
std::vector<std::array<float, 4>> corner_tangents(const Mesh& mesh, const Progress& progress = {});

}  // namespace sardf

// What a bake needs to know of a mesh that it did not make: its UV map's faults and scale, and how
// far its vertices lie off the solid.
#pragma once

#include <cstddef>

#include "sardf/bake.hpp"
#include "sardf/graph.hpp"
#include "sardf/mesh.hpp"
#include "sardf/progress.hpp"

namespace sardf {

struct UvReport {
  /// Texels whose centres lie on the mesh.
  size_t texels = 0;
  /// Of them, those at least 1/50 of a texel inside of more than one triangle: a texel holds one
  /// value, which is wrong on all triangles but one.
  size_t overlapping = 0;
  /// Faces with a texture coordinate outside [0, 1] by more than 1/50 of a texel: no texel is
  /// there.
  size_t outside = 0;
  size_t faces = 0;
  double texels_per_unit = 0;
};

/// Looks at the map's mesh, on all threads. Throws Cancelled.
UvReport check_uv(const TexelMap& texels, const Progress& progress = {});

/// Square root of texels per square scene unit over the whole mesh, for an image of size²; 0 for a
/// mesh without area. Throws Error: not 4 texture coordinates for each face.
double texels_per_unit(const Mesh& mesh, int size);

struct SurfaceReport {
  size_t vertices = 0;
  /// Vertices farther than the tolerance from the solid's surface.
  size_t off = 0;
  /// The largest such distance, in scene units; infinite where a vertex has none.
  double farthest = 0;
};

/// How far the vertices lie off the zero set of `solid`: |f| / |grad f|, which for a distance is
/// the distance, and |f| where the gradient is 0 or has no direction. `tolerance` in scene units.
SurfaceReport check_surface(const Mesh& mesh, const Expression& solid, double tolerance);

}  // namespace sardf

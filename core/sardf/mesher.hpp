// The surface of a solid as a watertight mesh of quads.
//
// Manifold dual contouring on a uniform grid (Ju, Losasso, Schaefer, Warren 2002; Schaefer, Ju,
// Warren 2007): one vertex for each piece of surface in each cell, one quad for each grid edge that
// the surface crosses. Every edge has two faces and every vertex one fan. Sharp edges and corners
// are kept. Only blocks of cells that may hold surface, by certified bounds, are sampled.
#pragma once

#include <cstddef>

#include "sardf/evaluate.hpp"
#include "sardf/mesh.hpp"

namespace sardf {

struct MeshOptions {
  /// Cells along the longest side of the bounds, 4 to 1 000 000.
  int resolution = 128;
  /// Edge length of a cell in scene units; not 0: it replaces the resolution.
  double cell_size = 0;
  /// Most bytes to use; 0: what the machine has free.
  size_t memory_limit = 0;
  Progress progress = {};
};

/// The surface of the part of the solid (field >= 0; first output) that lies in the bounds; where
/// they cut the solid, the mesh is closed by their faces. Vertices, faces, corner normals and
/// creases are set. The result does not depend on the number of threads. Throws Error when there
/// is no surface, when an option is out of range, and, before the work starts, when the mesh would
/// not fit into memory; throws Cancelled.
Mesh make_mesh(const Evaluator& field, const BoundingBox& bounds, const MeshOptions& options = {});

}  // namespace sardf

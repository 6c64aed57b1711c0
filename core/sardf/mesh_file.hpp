// Meshes as PLY, OBJ and GLB files.
//
//         lengths      faces      normals            colours                fractions
//   ply   scene units  quads      mean, per vertex   sRGB, 8 bit            fraction_NAME, float
//   obj   scene units  quads      per corner         sRGB, after x y z      -
//   glb   metres, y up triangles  per corner         COLOR_0, linear float  _MATERIAL_NAME, float
//
// PLY and OBJ keep the mesh's vertices, so their indices alone make a watertight surface. GLB has
// one normal for each vertex: vertices are repeated at creases and at the borders of charts.
// Texture coordinates: `texcoord` lists of the faces (PLY), vt (OBJ), TEXCOORD_0 (GLB).
#pragma once

#include <string>
#include <vector>

#include "sardf/mesh.hpp"

namespace sardf {

/// Values at the vertices; each list may be empty.
struct MeshAttributes {
  std::vector<std::string> fraction_names;
  std::vector<float> fractions;  // vertices × fraction_names, row-major
  std::vector<float> colors;     // vertices × 3, linear base colour in [0, 1]
};

/// Throws Error unless the path ends in .ply, .obj or .glb (in any case).
void check_mesh_path(const std::string& path);

/// Writes the format that the path's extension names. The file appears when it is complete. Throws
/// Error for another extension, for attributes that do not fit the mesh, for a GLB file of more
/// than 4 GiB, and when the file cannot be written.
void write_mesh(const std::string& path, const Mesh& mesh, const MeshAttributes& attributes,
                double metres_per_unit);

}  // namespace sardf

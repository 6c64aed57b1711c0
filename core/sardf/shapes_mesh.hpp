// Triangle meshes from files: as a solid, and as a feature.
#pragma once

#include "sardf/mesh_set.hpp"
#include "sardf/op_list.hpp"
#include "sardf/parameter.hpp"

namespace sardf {

/// Sources: Bærentzen and Aanæs 2005 (normals); Jacobson, Kavan, Sorkine 2013 and Barill et al.
/// 2018 (winding). See solid_of_mesh.
struct MeshSolid {
  static constexpr const char *name = "mesh_solid", *group = "solid",
                              *doc =
                                  "The solid inside a triangle mesh from a file (.ply, .obj or "
                                  ".stl), with its exact distance where the mesh is sound. A "
                                  "closed mesh may be oriented either way round. With holes the "
                                  "field jumps across them, and its slope is infinite near there.";
  FilePath path;
  std::string sign = "auto";
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"path", "the file, relative to the scene file's folder", Unit::none, Range::any,
                true},
      &MeshSolid::path);
    v(Parameter{"sign",
                "how the inside is found: 'normals' of a closed mesh without faults, 'winding' "
                "number of any mesh, or 'auto': the first where it is possible"},
      &MeshSolid::sign);
  }
  Expression expression() const;
  Quality quality() const;

 private:
  const MeshSolidSet& made() const;
  mutable MeshSolidSet made_;
};

struct MeshSurface {
  static constexpr const char *name = "mesh_surface", *group = "feature",
                              *doc =
                                  "The distance to the triangles of a mesh from a file (.ply, "
                                  ".obj or .stl), or to some of its faces.";
  FilePath path;
  std::vector<double> faces;
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"path", "the file, relative to the scene file's folder", Unit::none, Range::any,
                true},
      &MeshSurface::path);
    v(Parameter{"faces", "the faces to take, counted from 0 as in the file; none: all"},
      &MeshSurface::faces);
  }
  Expression expression() const;
  Quality quality() const { return {Exactness::exact, Exactness::exact}; }
};

using MeshShapes = OpList<MeshSolid, MeshSurface>;

}  // namespace sardf

#include "sardf/shapes_mesh.hpp"

#include "sardf/error.hpp"

namespace sardf {

namespace {

// A scene file's reader puts its own place before a message, so the mesh's goes into it.
MeshDataPointer data_of(const FilePath& path, const Progress& progress) {
  try {
    return mesh_data(path.full(), progress);
  } catch (const Error& error) {
    throw Error(error.what());
  }
}

Expression distance_to(const PointSetPointer& set) {
  return call(distance_operation(set), {coordinate(0), coordinate(1), coordinate(2)});
}

}  // namespace

// Both the field and its label need it.
const MeshSolidSet& MeshSolid::made() const {
  if (made_.set) return made_;
  const Progress& progress = ProgressScope::current();
  const MeshDataPointer data = data_of(path, part_of(progress, 0, 0.6));
  made_ = solid_of_mesh(data, sign, part_of(progress, 0.6, 1));
  return made_;
}

Expression MeshSolid::expression() const { return distance_to(made().set); }
Quality MeshSolid::quality() const { return made().quality; }

Expression MeshSurface::expression() const {
  const Progress& progress = ProgressScope::current();
  const MeshDataPointer data = data_of(path, part_of(progress, 0, faces.empty() ? 1 : 0.8));
  return distance_to(surface_of_mesh(data, faces, part_of(progress, 0.8, 1)));
}

}  // namespace sardf

#include "sardf/shapes_mesh.hpp"

#include "sardf/error.hpp"

namespace sardf {

namespace {

// A scene file's reader puts its own place before a message, so the mesh's goes into it.
MeshDataPointer data_of(const FilePath& path) {
  try {
    return mesh_data(path.full());
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
  if (!made_.set) made_ = solid_of_mesh(data_of(path), sign);
  return made_;
}

Expression MeshSolid::expression() const { return distance_to(made().set); }
Quality MeshSolid::quality() const { return made().quality; }

Expression MeshSurface::expression() const {
  return distance_to(surface_of_mesh(data_of(path), faces));
}

}  // namespace sardf

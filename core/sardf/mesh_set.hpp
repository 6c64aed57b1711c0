// Triangle meshes as sets of points: the distance to their triangles, signed and unsigned.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "sardf/data_operation.hpp"
#include "sardf/field.hpp"
#include "sardf/mesh_read.hpp"
#include "sardf/mesh_topology.hpp"
#include "sardf/triangle_tree.hpp"
#include "sardf/winding_number.hpp"

namespace sardf {

/// What is known of a mesh as the boundary of a solid.
struct MeshSolidity {
  /// Throws Cancelled where the pulse does.
  explicit MeshSolidity(const TriangleTree& tree, Pulse& pulse = Pulse::none());

  MeshTopology topology;
  /// Whether it is closed and encloses a negative volume: then its triangles are turned over.
  bool turned;
  WindingNumber winding;

  /// What keeps pseudonormals from giving the sign: a fault of the topology, triangles that meet
  /// beside common corners and edges, parts inside out. `triangle` is in the tree's order.
  std::optional<MeshTopology::Fault> fault;
};

/// A mesh with what all searches of it share.
class MeshData {
 public:
  /// At least one triangle.
  explicit MeshData(TriangleMesh mesh, const Progress& progress = {});

  const TriangleMesh& mesh() const { return mesh_; }
  const TriangleTree& tree() const { return tree_; }
  /// Equal for equal meshes.
  const std::vector<double>& identity() const { return identity_; }
  /// Made when it is first asked for, and again if that was cancelled.
  const MeshSolidity& solidity(const Progress& progress = {}) const;
  /// The triangle's polygon in the file, for messages.
  uint32_t polygon(uint32_t tree_triangle) const;

 private:
  MeshData(TriangleMesh mesh, Pulse&& pulse);

  TriangleMesh mesh_;
  TriangleTree tree_;
  std::vector<double> identity_;
  mutable std::once_flag once_;
  mutable std::unique_ptr<MeshSolidity> solidity_;
};

using MeshDataPointer = std::shared_ptr<const MeshData>;

/// Reads the file, unless a field still holds what was read of it at the same size and time of
/// modification. Throws Error as read_triangle_mesh does.
MeshDataPointer mesh_data(const std::string& path, const Progress& progress = {});

struct MeshSolidSet {
  PointSetPointer set;
  Quality quality;
};

/// The solid that the mesh encloses. `sign` is how inside and outside are told apart:
/// "normals" by the angle-weighted pseudonormal at the nearest point, for closed, oriented meshes
/// that do not run into themselves, else Error with the first fault; "winding" by the generalised
/// winding number, inside above 1/2; "auto" by the first where it is possible.
///
/// Closed meshes may be oriented either way round. The distance is exact for meshes that "normals"
/// takes. For other closed meshes the winding number is a whole number: the sign changes at
/// triangles only, but some triangles may lie inside the solid, or outside, so the distance is a
/// bound. For open meshes the sign also changes across the holes, where the distance is not 0: the
/// field is an estimate, it jumps there, and its slope is infinite near there.
MeshSolidSet solid_of_mesh(const MeshDataPointer& data, const std::string& sign,
                           const Progress& progress = {});

/// All triangles, or those of the polygons (counted from 0 as in the file) in `faces`. Throws Error
/// when there is no such polygon.
PointSetPointer surface_of_mesh(const MeshDataPointer& data, const std::vector<double>& faces,
                                const Progress& progress = {});

}  // namespace sardf

// How the triangles of a mesh hang together: neighbours, faults, and normals that give signs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sardf/triangle_tree.hpp"

namespace sardf {

/// Half-edge 3 * t + k runs from corner k of the tree's triangle t to the next corner.
class MeshTopology {
 public:
  static constexpr uint32_t none = ~0u;

  /// Throws Cancelled where the pulse does, as `fault` and `parts` do.
  explicit MeshTopology(const TriangleTree& tree, Pulse& pulse = Pulse::none());

  /// The half-edge that runs back along this one where these two are the edge's only ones, else
  /// `none`.
  uint32_t twin(uint32_t half_edge) const { return twins_[half_edge]; }
  /// Whether every edge is run along as often in either direction. Then the winding number is a
  /// whole number wherever there is no triangle.
  bool is_closed() const { return closed_; }

  struct Fault {
    std::string text;   // of a face: "has an edge ..."
    uint32_t triangle;  // in the tree's order
  };
  /// What keeps the mesh from being an oriented closed surface without singular points: an edge
  /// without exactly two triangles that run along it in opposite directions, a corner where several
  /// fans of triangles meet, a triangle without area. The first one as given.
  std::optional<Fault> fault(Pulse& pulse = Pulse::none()) const;

  /// One triangle of each part that hangs together over edges, in the tree's order.
  std::vector<uint32_t> parts(Pulse& pulse = Pulse::none()) const;

 private:
  uint32_t start(uint32_t half_edge) const;
  std::string edge_fault(uint32_t half_edge) const;

  const TriangleTree& tree_;
  std::vector<uint32_t> twins_;
  bool closed_ = true;
};

/// The next half-edge around the triangle.
inline uint32_t next_half_edge(uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }

/// Of each vertex, the sum of the outward unit normals of its triangles, weighted by their angles
/// there. Source: Bærentzen and Aanæs 2005, "Signed distance computation using the angle weighted
/// pseudonormal".
std::vector<Vec3> vertex_pseudonormals(const TriangleTree& tree, Pulse& pulse = Pulse::none());

}  // namespace sardf

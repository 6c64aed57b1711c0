// A tree of boxes over triangles, and the exact nearest point of the triangles.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sardf/pulse.hpp"
#include "sardf/vec.hpp"

namespace sardf {

/// The point of a triangle that is nearest to another.
struct TrianglePoint {
  Vec3 point{};
  double squared = 0;     // the distance's square
  uint32_t triangle = 0;  // in the tree's order
  /// Where on the triangle: 0 inside, 1 + k on the edge from corner k to the next, 4 + k at corner
  /// k.
  uint32_t part = 0;
};

/// Four-fold tree of boxes, split by the surface area heuristic over bins (Wald 2007, "On fast
/// construction of SAH-based bounding volume hierarchies"). Everything it gives and takes is in
/// local coordinates, in which the mesh lies within about 1 of the origin: (x - centre) / unit, the
/// unit a power of two. The tree does not depend on the number of threads.
class TriangleTree {
 public:
  /// Most triangles in a leaf.
  static constexpr size_t leaf_size = 4;

  struct Triangle {
    std::array<uint32_t, 3> corners;
    uint32_t tag;  // 2 * the triangle as given + whether it is narrow

    uint32_t given() const { return tag >> 1; }
    /// Whether its height is below a hundredth of its longest edge.
    bool narrow() const { return tag & 1; }
  };
  /// Boxes of up to four children, in floats rounded outwards; of a missing one, empty.
  struct alignas(64) Node {
    std::array<float, 4> lo[3], hi[3];
    std::array<uint32_t, 4> first{};  // a leaf's first triangle, or a node
    std::array<uint32_t, 4> count{};  // a leaf's triangles; 0: a node or missing
    bool missing(size_t child) const { return lo[0][child] > hi[0][child]; }
  };

  /// At least one triangle, fewer than 2^31; corners are places in `vertices`. All finite.
  /// Throws Cancelled where the pulse does.
  TriangleTree(std::span<const Vec3> vertices, std::span<const std::array<uint32_t, 3>> triangles,
               Pulse& pulse = Pulse::none());

  /// The nearest of all points of the triangles; of several triangles equally near, the first as
  /// given. `point` is finite. A `guess`, a triangle that may be near, saves time and changes
  /// nothing.
  TrianglePoint nearest(const Vec3& point, uint32_t guess = 0) const;

  Vec3 to_local(const Vec3& at) const;
  Vec3 from_local(const Vec3& at) const;
  double unit() const { return unit_; }

  /// In the tree's order: those of a leaf are neighbours.
  const std::vector<Triangle>& triangles() const { return triangles_; }
  /// Those that triangles have.
  const std::vector<Vec3>& vertices() const { return vertices_; }
  /// The first is the root; children follow their parents.
  const std::vector<Node>& nodes() const { return nodes_; }
  const Vec3& corner(const Triangle& triangle, size_t k) const {
    return vertices_[triangle.corners[k]];
  }
  /// Corners' cross product: twice the area vector.
  Vec3 area_vector(const Triangle& triangle) const;
  /// Whether its corners are not on a line, as far as rounding can tell.
  bool has_area(const Triangle& triangle) const;
  /// Corners of the smallest box, local.
  const std::array<Vec3, 2>& bounds() const { return bounds_; }

 private:
  // Whether the height is more than this share of the longest edge.
  bool is_higher(const Triangle& triangle, double share) const;
  TrianglePoint on(const Vec3& point, uint32_t triangle) const;
  TrianglePoint nearest_to_near(const Vec3& point, uint32_t guess) const;
  TrianglePoint nearest_to_far(const Vec3& from) const;

  Vec3 centre_{};
  double unit_ = 1;
  std::array<Vec3, 2> bounds_{};
  std::vector<Vec3> vertices_;
  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace sardf

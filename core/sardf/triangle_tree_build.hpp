// Builds the nodes of a TriangleTree.
#pragma once

#include <vector>

#include "sardf/triangle_tree.hpp"

namespace sardf {

/// A triangle's box, and its number in two halves that floats hold exactly: whole vectors of four
/// floats are read and written.
struct TriangleBox {
  alignas(16) std::array<float, 4> lo, hi;

  static TriangleBox around(const Vec3& a, const Vec3& b, const Vec3& c, uint32_t number);
  uint32_t number() const { return uint32_t(hi[3]) << 16 | uint32_t(lo[3]); }
};

/// Sorts the boxes so that each leaf's are neighbours, and returns the nodes. Throws Cancelled
/// where the pulse does.
std::vector<TriangleTree::Node> build_nodes(std::vector<TriangleBox>& boxes, Pulse& pulse);

}  // namespace sardf

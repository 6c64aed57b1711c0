// Shorter programs for the octree of blocks: private to core/sardf/mesher*.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "sardf/evaluate.hpp"

namespace sardf::mesher {

using Index3 = std::array<int32_t, 3>;
using ProgramPointer = std::shared_ptr<const Evaluator>;

/// For each node of an octree over blocks the solid's evaluator shortened for its box
/// (shorten.hpp). Level 0 are the blocks; a node of level l is a cube of 2^l blocks along its edge.
/// Adding needs one thread; finding any number.
class Programs {
 public:
  /// `room`: how far beyond its node a program is good.
  Programs(const Vec3& origin, double cell, double room);
  /// Cells along the edge of a node of level 0.
  static constexpr int least_cells = 2;

  BoundingBox box(const Index3& node, int level) const;
  /// The box in which the node's program is good.
  BoundingBox valid_box(const Index3& node, int level) const;

  void add(const Index3& node, int level, ProgramPointer program);

  struct Found {
    const ProgramPointer* program = nullptr;  // null: none is known
    BoundingBox valid;
  };
  /// The program of the smallest known node that holds the point.
  Found find(const Vec3& point) const;
  /// Of this node, or else of the smallest known one that holds it.
  Found find(Index3 node, int level) const;

 private:
  Vec3 origin_;
  double edge_, room_;
  std::vector<std::unordered_map<uint64_t, ProgramPointer>> levels_;
};

/// A number for each place in a grid of up to 2^21 along each axis.
inline uint64_t key(const Index3& at) {
  return uint64_t(uint32_t(at[0])) | uint64_t(uint32_t(at[1])) << 21 |
         uint64_t(uint32_t(at[2])) << 42;
}

}  // namespace sardf::mesher

// A tree of boxes that finds the parts of a set that are nearest to a point.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sardf/data_operation.hpp"
#include "sardf/vec.hpp"

namespace sardf {

/// Encloses part of a set.
struct Extent {
  Vec3 lo{infinity, infinity, infinity}, hi{-infinity, -infinity, -infinity};

  void add(const Vec3& point) {
    for (size_t k = 0; k < 3; ++k) {
      lo[k] = min(lo[k], point[k]);
      hi[k] = max(hi[k], point[k]);
    }
  }
  void add(const Extent& other) {
    add(other.lo);
    add(other.hi);
  }
  /// Largest magnitude of a coordinate.
  double magnitude() const;
  std::array<Interval, 3> intervals() const;
  double squared_distance(const Vec3& point) const {
    double squared = 0;
    for (size_t k = 0; k < 3; ++k) {
      const double out = max(max(lo[k] - point[k], point[k] - hi[k]), 0.0);
      squared += out * out;
    }
    return squared;
  }
};

class BoxTree {
 public:
  /// At least one box; leaves hold up to `leaf` of them.
  BoxTree(std::span<const Extent> boxes, size_t leaf);

  /// The boxes in the tree's order: whoever stores the parts in it reads memory in one direction.
  const std::vector<uint32_t>& order() const { return order_; }
  const Extent& extent() const { return nodes_[0].box; }

  /// visit(place in order()), nearer boxes first, of every part whose box is nearer than the square
  /// root of `squared`, which `visit` lowers.
  template <class Visit>
  void visit_near(const Vec3& point, const double& squared, Visit visit) const {
    struct Waiting {
      uint32_t node;
      double squared;
    };
    // Halves are even: the tree is no deeper than the bits of a count.
    std::array<Waiting, 40> waiting;
    size_t count = 0;
    waiting[count++] = {0, nodes_[0].box.squared_distance(point)};
    while (count > 0) {
      const Waiting next = waiting[--count];
      if (!(next.squared < squared)) continue;
      const Node& node = nodes_[next.node];
      if (node.count > 0) {
        for (uint32_t i = node.first; i < node.first + node.count; ++i) visit(size_t(i));
        continue;
      }
      Waiting near{next.node + 1, nodes_[next.node + 1].box.squared_distance(point)};
      Waiting far{node.first, nodes_[node.first].box.squared_distance(point)};
      if (far.squared < near.squared) std::swap(near, far);
      waiting[count++] = far;
      waiting[count++] = near;
    }
  }

 private:
  struct Node {
    Extent box;
    uint32_t first = 0;  // leaf: place of its first part; else: the second child
    uint32_t count = 0;  // parts of a leaf; 0: the first child is the next node
  };
  void build(std::span<const Extent> boxes, size_t first, size_t last, size_t leaf);

  std::vector<uint32_t> order_;
  std::vector<Node> nodes_;
};

/// Where coordinates are so large, infinite or NaN that squares say nothing.
bool is_out_of_range(const Vec3& point);
/// The nearest point of a set for such a point: any of the set's.
Nearest nearest_out_of_range(const Vec3& point, const Vec3& of_set);

/// From a point, the vector to the nearest point of the set: distance and gradient. A distance
/// within `rounding` is 0.
Nearest nearest_at(const Vec3& point, const Vec3& toward, double rounding);

}  // namespace sardf

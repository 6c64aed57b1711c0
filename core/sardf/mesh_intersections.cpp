#include "sardf/mesh_intersections.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <mutex>

#include "sardf/numbers/lanes.hpp"

namespace sardf {

namespace {

using Float4 = Lanes<Baseline>;

// Rounding of a projection, relative to the lengths that it is a product of, and more.
constexpr double rounding = 4e-15;

double sum_of(const Vec3& a) { return std::abs(a[0]) + std::abs(a[1]) + std::abs(a[2]); }

/// A product of edges, with the product of their lengths.
struct Direction {
  Vec3 vector;
  double scale;
  friend Direction cross(const Direction& a, const Direction& b) {
    return {sardf::cross(a.vector, b.vector), a.scale * b.scale};
  }
};

/// Two triangles. Common corners come first in both, in the same order.
class Pair {
 public:
  Pair(const TriangleTree& tree, uint32_t i, uint32_t j) {
    const auto &s = tree.triangles()[i].corners, &t = tree.triangles()[j].corners;
    const auto in = [](const auto& corners, uint32_t v) {
      return std::find(corners.begin(), corners.end(), v) != corners.end();
    };
    for (const uint32_t v : s) {
      if (in(t, v)) a_[common_] = b_[common_] = tree.vertices()[v], ++common_;
    }
    size_t next_a = common_, next_b = common_;
    for (const uint32_t v : s) {
      if (!in(t, v)) a_[next_a++] = tree.vertices()[v];
    }
    for (const uint32_t v : t) {
      if (!in(s, v)) b_[next_b++] = tree.vertices()[v];
    }
  }

  /// Whether a plane proves that they have only common corners, and the edge between, in common.
  bool is_apart() const {
    const Direction a = cross(edge(a_, 0, 1), edge(a_, 0, 2)),
                    b = cross(edge(b_, 0, 1), edge(b_, 0, 2));
    switch (common_) {
      case 0:
        return are_apart_without_corners(a, b);
      case 1:
        return are_apart_at_corner(a, b);
      case 2:
        return splits(a, 7, 3) || splits(b, 3, 7) || splits(cross(a, edge(a_, 0, 1)), 3, 3);
      default:
        return false;
    }
  }

 private:
  using Corners = std::array<Vec3, 3>;

  static Direction edge(const Corners& of, size_t from, size_t to) {
    const Vec3 along = of[to] - of[from];
    return {along, quick_norm(along)};
  }

  // The common corner is on all planes; what else is on one are edges that end there, at most one
  // of each triangle and these not parallel, or one triangle.
  bool are_apart_at_corner(const Direction& a, const Direction& b) const {
    if (splits(a, 7, 1) || splits(b, 1, 7)) return true;
    for (unsigned i = 1; i < 3; ++i) {
      const Direction along_a = edge(a_, 0, i), along_b = edge(b_, 0, i);
      const unsigned on = 1 | 1u << i;
      if (splits(cross(a, along_a), on, 1) || splits(cross(b, along_b), 1, on)) return true;
      for (unsigned k = 1; k < 3; ++k) {
        if (splits(cross(along_a, edge(b_, 0, k)), on, 1 | 1u << k)) return true;
      }
    }
    return false;
  }

  // The separating axes of two triangles, with those of triangles in one plane.
  bool are_apart_without_corners(const Direction& a, const Direction& b) const {
    if (separates(a) || separates(b)) return true;
    for (size_t i = 0; i < 3; ++i) {
      const Direction along_a = edge(a_, i, (i + 1) % 3), along_b = edge(b_, i, (i + 1) % 3);
      if (separates(cross(a, along_a)) || separates(cross(b, along_b))) return true;
      for (size_t k = 0; k < 3; ++k) {
        if (separates(cross(along_a, edge(b_, k, (k + 1) % 3)))) return true;
      }
    }
    return false;
  }

  // Whether the corners that are not (bits) on the plane through the first corner, across the
  // direction, lie off it, one triangle's on one side and the other's on the other.
  bool splits(const Direction& across, unsigned a_on, unsigned b_on) const {
    int side = 0;
    for (unsigned k = 0; k < 3; ++k) {
      if (!(a_on >> k & 1) && !is_on_side(across, a_[k], 1, side)) return false;
      if (!(b_on >> k & 1) && !is_on_side(across, b_[k], -1, side)) return false;
    }
    return true;
  }

  bool is_on_side(const Direction& across, const Vec3& corner, int sign, int& side) const {
    const Vec3 from = corner - a_[0];
    const double height = sign * dot(across.vector, from);
    if (!(std::abs(height) > rounding * across.scale * sum_of(from))) return false;
    const int found = height > 0 ? 1 : -1;
    if (side == 0) side = found;
    return side == found;
  }

  bool separates(const Direction& across) const {
    double lo[2] = {0, 0}, hi[2] = {0, 0}, most = 0;
    for (size_t of = 0; of < 2; ++of) {
      for (size_t k = 0; k < 3; ++k) {
        const Vec3 from = (of == 0 ? a_ : b_)[k] - a_[0];
        const double height = dot(across.vector, from);
        lo[of] = k == 0 ? height : std::min(lo[of], height);
        hi[of] = k == 0 ? height : std::max(hi[of], height);
        most = std::max(most, sum_of(from));
      }
    }
    const double least = rounding * across.scale * most;
    return hi[0] + least < lo[1] || hi[1] + least < lo[0];
  }

  Corners a_{}, b_{};
  unsigned common_ = 0;
};

using Bounds = std::array<Vec3, 2>;

Bounds bounds_of(const TriangleTree& tree, uint32_t i) {
  const TriangleTree::Triangle& t = tree.triangles()[i];
  const Vec3 &a = tree.corner(t, 0), &b = tree.corner(t, 1), &c = tree.corner(t, 2);
  Bounds bounds;
  for (size_t k = 0; k < 3; ++k) {
    bounds[0][k] = min(a[k], min(b[k], c[k]));
    bounds[1][k] = max(a[k], max(b[k], c[k]));
  }
  return bounds;
}

bool meet(const Bounds& a, const Bounds& b) {
  bool apart = false;
  for (size_t k = 0; k < 3; ++k) apart |= a[0][k] > b[1][k] || b[0][k] > a[1][k];
  return !apart;
}

struct Leaf {
  uint32_t first, last;
};

/// The leaves, at and after one of them, whose boxes meet that one's.
template <class Found>
void for_meeting_leaves(const TriangleTree& tree, const TriangleTree::Node& of, size_t child,
                        const Found& found) {
  std::array<uint32_t, 256> stack;
  size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const TriangleTree::Node& node = tree.nodes()[stack[--size]];
    Float4 gap = -std::numeric_limits<float>::infinity();
    for (size_t k = 0; k < 3; ++k) {
      gap = max(gap, max(Float4::load(node.lo[k].data()) - Float4(double(of.hi[k][child])),
                         Float4(double(of.lo[k][child])) - Float4::load(node.hi[k].data())));
    }
    for (size_t i = 0; i < 4; ++i) {
      if (gap.v[i] > 0) continue;
      if (node.count[i] == 0) {
        stack[size++] = node.first[i];
      } else if (node.first[i] >= of.first[child]) {
        found(Leaf{node.first[i], node.first[i] + node.count[i]});
      }
    }
  }
}

/// The first pair, by its first triangle and then its second, that meets, with its first triangle
/// in a leaf; `none` twice when there is none.
class LeafSearch {
 public:
  static constexpr uint32_t none = ~0u;
  using Found = std::pair<uint32_t, uint32_t>;

  explicit LeafSearch(const TriangleTree& tree) : tree_(tree) {}

  Found first_pair(const TriangleTree::Node& node, size_t child) const {
    const Leaf leaf{node.first[child], node.first[child] + node.count[child]};
    std::array<Bounds, TriangleTree::leaf_size> own;
    for (uint32_t i = leaf.first; i < leaf.last; ++i) own[i - leaf.first] = bounds_of(tree_, i);
    Found best{none, none};
    for_meeting_leaves(tree_, node, child, [&](const Leaf& other) {
      for (uint32_t j = other.first; j < other.last; ++j) {
        const Bounds bounds = bounds_of(tree_, j);
        for (uint32_t i = leaf.first; i < std::min(leaf.last, j); ++i) {
          if (!meet(own[i - leaf.first], bounds) || Found(i, j) > best) continue;
          if (!Pair(tree_, i, j).is_apart()) best = {i, j};
        }
      }
    });
    return best;
  }

 private:
  const TriangleTree& tree_;
};

}  // namespace

std::optional<std::array<uint32_t, 2>> meeting_triangles(const TriangleTree& tree, Pulse& pulse) {
  const std::vector<TriangleTree::Node>& nodes = tree.nodes();
  const LeafSearch search(tree);
  std::mutex mutex;
  LeafSearch::Found best{LeafSearch::none, LeafSearch::none};
  std::atomic<uint32_t> first{LeafSearch::none};
  const auto search_leaf = [&](const TriangleTree::Node& node, size_t child) {
    // After a pair that comes before all of this leaf's, they do not matter.
    if (node.count[child] == 0 || node.first[child] > first) return;
    const LeafSearch::Found found = search.first_pair(node, child);
    if (found.first == LeafSearch::none) return;
    const std::lock_guard lock(mutex);
    best = std::min(best, found);
    first = best.first;
  };
  tbb::this_task_arena::isolate([&] {
    tbb::parallel_for(size_t(0), nodes.size(), [&](size_t i) {
      // Each may take many steps.
      pulse(double(i) / double(nodes.size()));
      for (size_t child = 0; child < 4; ++child) search_leaf(nodes[i], child);
    });
  });
  if (best.first == LeafSearch::none) return std::nullopt;
  return std::array<uint32_t, 2>{best.first, best.second};
}

}  // namespace sardf

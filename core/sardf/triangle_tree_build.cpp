#include "sardf/triangle_tree_build.hpp"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <atomic>
#include <limits>

#include "sardf/numbers/lanes.hpp"

namespace sardf {

namespace {

using Node = TriangleTree::Node;
using Float4 = Lanes<Baseline>;

constexpr size_t leaf_size = TriangleTree::leaf_size;
// Smaller parts are built by one thread.
constexpr size_t grain = 8192;
constexpr int bins = 16;
// Below this level triangles are split by number, so that no tree is deeper than a stack.
constexpr int deepest_by_area = 24;

struct Box {
  Float4 lo = std::numeric_limits<float>::infinity(), hi = -std::numeric_limits<float>::infinity();

  void add(const Float4& other_lo, const Float4& other_hi) {
    lo = min(lo, other_lo);
    hi = max(hi, other_hi);
  }
  float half_area() const {
    const Float4 size = hi - lo;
    return size.v[0] * size.v[1] + size.v[1] * size.v[2] + size.v[2] * size.v[0];
  }
};

struct Range {
  size_t first, last;
  size_t size() const { return last - first; }
};

struct Split {
  int axis = -1;  // none: all centres are equal
  int bin = 0;    // the first one on the right
};

/// Which bin a box's centre is in, along each axis.
class Binning {
 public:
  explicit Binning(const Box& centres) : lo_(centres.lo) {
    const Float4 size = centres.hi - centres.lo;
    for (int axis = 0; axis < 3; ++axis) {
      const float scale = float(bins) * 0.9999f / size.v[axis];
      scale_.v[axis] = size.v[axis] > 0 && scale < 1e30f ? scale : 0;
    }
    scale_.v[3] = 0;
  }
  bool separates(int axis) const { return scale_.v[axis] > 0; }
  std::array<int, 3> bins_of(const Float4& lo, const Float4& hi) const {
    const Float4 at = (lo + hi - lo_) * scale_;
    return {int(at.v[0]), int(at.v[1]), int(at.v[2])};
  }

 private:
  Float4 lo_, scale_;
};

class Builder {
 public:
  Builder(std::vector<TriangleBox>& boxes, Pulse& pulse) : boxes_(boxes), pulse_(pulse) {}

  // Appends the part's nodes; its root comes first.
  void build(Range range, int level, std::vector<Node>& out) {
    std::array<Range, 4> parts{};
    const size_t count = split_in_four(range, level, parts);
    const size_t root = out.size();
    out.emplace_back();
    for (size_t i = 0; i < 4; ++i) set_box(out[root], i, i < count ? parts[i] : Range{0, 0});
    if (range.size() > grain) {
      std::array<std::vector<Node>, 4> made;
      const auto build_part = [&](size_t i) {
        if (i < count && parts[i].size() > leaf_size) build(parts[i], level + 1, made[i]);
        if (parts[i].size() <= grain) done_ += parts[i].size();
      };
      tbb::parallel_invoke([&] { build_part(0); }, [&] { build_part(1); }, [&] { build_part(2); },
                           [&] { build_part(3); });
      for (size_t i = 0; i < count; ++i) append(made[i], root, i, out);
      return;
    }
    for (size_t i = 0; i < count; ++i) {
      if (parts[i].size() <= leaf_size) continue;
      out[root].first[i] = uint32_t(out.size());
      build(parts[i], level + 1, out);
    }
  }

 private:
  static void append(const std::vector<Node>& part, size_t root, size_t child,
                     std::vector<Node>& out) {
    if (part.empty()) return;
    const uint32_t shift = uint32_t(out.size());
    out[root].first[child] = shift;
    for (Node node : part) {
      for (size_t i = 0; i < 4; ++i) {
        if (node.count[i] == 0 && !node.missing(i)) node.first[i] += shift;
      }
      out.push_back(node);
    }
  }

  static Float4 lo(const TriangleBox& box) { return Float4::load(box.lo.data()); }
  static Float4 hi(const TriangleBox& box) { return Float4::load(box.hi.data()); }

  void set_box(Node& node, size_t child, Range range) const {
    Box box;
    for (size_t i = range.first; i < range.last; ++i) {
      poll(i);
      box.add(lo(boxes_[i]), hi(boxes_[i]));
    }
    for (int axis = 0; axis < 3; ++axis) {
      node.lo[axis][child] = box.lo.v[axis];
      node.hi[axis][child] = box.hi.v[axis];
    }
    if (range.size() > leaf_size) return;
    node.first[child] = uint32_t(range.first);
    node.count[child] = uint32_t(range.size());
  }

  size_t split_in_four(Range range, int level, std::array<Range, 4>& parts) {
    if (range.size() <= leaf_size) {
      parts[0] = range;
      return 1;
    }
    const size_t middle = split(range, level);
    const std::array<Range, 2> halves{Range{range.first, middle}, Range{middle, range.last}};
    std::array<size_t, 2> at{middle, range.last};
    const auto split_half = [&](size_t i) {
      if (halves[i].size() > leaf_size) at[i] = split(halves[i], level);
    };
    if (range.size() > grain) {
      tbb::parallel_invoke([&] { split_half(0); }, [&] { split_half(1); });
    } else {
      split_half(0);
      split_half(1);
    }
    size_t count = 0;
    for (size_t i = 0; i < 2; ++i) {
      parts[count++] = {halves[i].first, at[i]};
      if (at[i] < halves[i].last) parts[count++] = {at[i], halves[i].last};
    }
    return count;
  }

  // Sorts the range into a left and a right part, neither empty; returns the right one's first.
  size_t split(Range range, int level) {
    Box centres;
    for (size_t i = range.first; i < range.last; ++i) {
      poll(i);
      const Float4 centre = lo(boxes_[i]) + hi(boxes_[i]);
      centres.add(centre, centre);
    }
    const Binning binning(centres);
    const Split best = level < deepest_by_area ? best_split(range, binning) : Split{};
    if (best.axis < 0) return range.first + range.size() / 2;
    const auto right =
        std::partition(boxes_.begin() + long(range.first), boxes_.begin() + long(range.last),
                       [&](const TriangleBox& b) {
                         poll(size_t(&b - boxes_.data()));
                         return binning.bins_of(lo(b), hi(b))[size_t(best.axis)] < best.bin;
                       });
    return size_t(right - boxes_.begin());
  }

  Split best_split(Range range, const Binning& binning) const {
    std::array<std::array<Box, bins>, 3> box;
    std::array<std::array<uint32_t, bins>, 3> count{};
    for (size_t i = range.first; i < range.last; ++i) {
      poll(i);
      const Float4 from = lo(boxes_[i]), to = hi(boxes_[i]);
      const std::array<int, 3> at = binning.bins_of(from, to);
      for (size_t axis = 0; axis < 3; ++axis) {
        box[axis][size_t(at[axis])].add(from, to);
        ++count[axis][size_t(at[axis])];
      }
    }
    Split best;
    float least = std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      if (!binning.separates(axis)) continue;
      cheapest(box[size_t(axis)], count[size_t(axis)], axis, best, least);
    }
    return best;
  }

  static void cheapest(const std::array<Box, bins>& box, const std::array<uint32_t, bins>& count,
                       int axis, Split& best, float& least) {
    std::array<float, bins> right_half_area{};
    std::array<uint32_t, bins> count_on_right{};
    Box right, left;
    uint32_t on_right = 0, on_left = 0;
    for (size_t b = bins; b-- > 1;) {
      right.add(box[b].lo, box[b].hi);
      on_right += count[b];
      count_on_right[b] = on_right;
      right_half_area[b] = right.half_area();
    }
    for (size_t b = 1; b < bins; ++b) {
      left.add(box[b - 1].lo, box[b - 1].hi);
      on_left += count[b - 1];
      if (on_left == 0 || count_on_right[b] == 0) continue;
      const float cost =
          left.half_area() * float(on_left) + right_half_area[b] * float(count_on_right[b]);
      if (cost < least) {
        least = cost;
        best = {axis, int(b)};
      }
    }
  }

  // For each box that is looked at.
  void poll(size_t i) const {
    if (i % 1024 == 0) pulse_(double(done_) / double(boxes_.size()));
  }

  std::vector<TriangleBox>& boxes_;
  Pulse& pulse_;
  std::atomic<size_t> done_{0};  // boxes in parts of one thread that are built
};

float rounded_down_to_float(double a) {
  const float f = float(a);
  return double(f) > a ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}

}  // namespace

TriangleBox TriangleBox::around(const Vec3& a, const Vec3& b, const Vec3& c, uint32_t number) {
  TriangleBox box{};
  for (size_t k = 0; k < 3; ++k) {
    box.lo[k] = rounded_down_to_float(std::min({a[k], b[k], c[k]}));
    box.hi[k] = -rounded_down_to_float(-std::max({a[k], b[k], c[k]}));
  }
  box.lo[3] = float(number & 0xFFFF);
  box.hi[3] = float(number >> 16);
  return box;
}

std::vector<Node> build_nodes(std::vector<TriangleBox>& boxes, Pulse& pulse) {
  std::vector<Node> nodes;
  Builder(boxes, pulse).build({0, boxes.size()}, 0, nodes);
  return nodes;
}

}  // namespace sardf

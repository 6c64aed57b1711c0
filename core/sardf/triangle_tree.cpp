#include "sardf/triangle_tree.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <limits>

#include "sardf/numbers/interval.hpp"
#include "sardf/numbers/lanes.hpp"
#include "sardf/triangle_tree_build.hpp"

namespace sardf {

namespace {

using Float4 = Lanes<Baseline>;

// Triangles of less height, by their longest edge, lose accuracy to their normal's rounding.
constexpr double narrowest = 0.01;
// Those of even less are lines.
constexpr double no_height = 1e-14;

struct OnEdge {
  Vec3 point;
  double squared, share;
};

OnEdge on_edge(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double length = dot(along, along);
  const double share = length > 0 ? std::clamp(dot(p - a, along) / length, 0.0, 1.0) : 0;
  const Vec3 point = share == 1 ? b : a + share * along;
  return {point, dot(p - point, p - point), share};
}

// The nearest point of the edges alone.
TrianglePoint on_edges(const Vec3& p, const std::array<Vec3, 3>& corners, uint32_t triangle) {
  TrianglePoint best{{}, infinity, triangle, 0};
  for (uint32_t k = 0; k < 3; ++k) {
    const OnEdge found = on_edge(p, corners[k], corners[(k + 1) % 3]);
    if (!(found.squared < best.squared)) continue;
    const uint32_t part = found.share == 0 ? 4 + k : found.share == 1 ? 4 + (k + 1) % 3 : 1 + k;
    best = {found.point, found.squared, triangle, part};
  }
  return best;
}

// With the longest edge as base, the height's direction has an error of 1e-16 base / height, which
// moves points of the triangle by 1e-16 of the base only.
TrianglePoint on_narrow(const Vec3& p, const std::array<Vec3, 3>& corners, uint32_t triangle) {
  size_t k = 0;
  double longest = 0;
  for (size_t i = 0; i < 3; ++i) {
    const Vec3 edge = corners[(i + 1) % 3] - corners[i];
    if (!(dot(edge, edge) > longest)) continue;
    longest = dot(edge, edge);
    k = i;
  }
  const Vec3 &a = corners[k], base = corners[(k + 1) % 3] - a, side = corners[(k + 2) % 3] - a;
  const double foot = longest > 0 ? dot(side, base) / longest : 0;
  const Vec3 height = side - foot * base;
  const double height_squared = dot(height, height);
  if (!(height_squared > square(no_height) * longest)) return on_edges(p, corners, triangle);
  const double along = dot(p - a, base) / longest;
  const double up = dot(p - a - along * base, height) / height_squared;
  const double share = along - up * foot;
  if (up < 0 || share < 0 || up + share > 1) return on_edges(p, corners, triangle);
  const Vec3 point = a + along * base + up * height;
  return {point, dot(p - point, p - point), triangle, 0};
}

// Source: Ericson 2005, "Real-time collision detection", section 5.1.5.
TrianglePoint on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c,
                          uint32_t triangle) {
  const auto found = [&](const Vec3& q, uint32_t part) {
    const Vec3 from = p - q;
    return TrianglePoint{q, dot(from, from), triangle, part};
  };
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double ab_a = dot(ab, ap), ac_a = dot(ac, ap);
  if (ab_a <= 0 && ac_a <= 0) return found(a, 4);
  const Vec3 bp = p - b;
  const double ab_b = dot(ab, bp), ac_b = dot(ac, bp);
  if (ab_b >= 0 && ac_b <= ab_b) return found(b, 5);
  if (ab_a * ac_b - ab_b * ac_a <= 0 && ab_a >= 0 && ab_b <= 0) {
    return found(a + (ab_a / (ab_a - ab_b)) * ab, 1);
  }
  const Vec3 cp = p - c;
  const double ab_c = dot(ab, cp), ac_c = dot(ac, cp);
  if (ac_c >= 0 && ab_c <= ac_c) return found(c, 6);
  if (ab_c * ac_a - ab_a * ac_c <= 0 && ac_a >= 0 && ac_c <= 0) {
    return found(a + (ac_a / (ac_a - ac_c)) * ac, 3);
  }
  const double to_c = ac_b - ab_b, to_b = ab_c - ac_c;
  if (ab_b * ac_c - ab_c * ac_b <= 0 && to_c >= 0 && to_b >= 0) {
    return found(b + (to_c / (to_c + to_b)) * (c - b), 2);
  }
  const Vec3 normal = cross(ab, ac);
  const double height = dot(normal, ap), length = dot(normal, normal);
  return {p - (height / length) * normal, height * (height / length), triangle, 0};
}

// Whether a comes before b, by distance and then by number as given.
bool is_nearer(double a, double b, uint32_t a_given, uint32_t b_given) {
  return a < b || (a == b && a_given < b_given);
}

struct Pending {
  double bound;
  uint32_t first, count;
};

// At most three wait on each level: a tree's levels by area, and those by number.
class Stack {
 public:
  void push(const Pending& pending) { all_[size_++] = pending; }
  bool pop(Pending& pending) {
    if (size_ == 0) return false;
    pending = all_[--size_];
    return true;
  }
  // The nearest of those pushed since comes first.
  size_t size() const { return size_; }
  void sort_from(size_t first) {
    for (size_t i = first + 1; i < size_; ++i) {
      for (size_t k = i; k > first && all_[k].bound > all_[k - 1].bound; --k) {
        std::swap(all_[k], all_[k - 1]);
      }
    }
  }

 private:
  std::array<Pending, 256> all_;
  size_t size_ = 0;
};

/// Lower bounds of the squared distances to a node's boxes, in floats.
class BoxBounds {
 public:
  // The slack covers the rounding of the point, of the differences, and of nearest points in
  // double; the factor that of the sum of squares.
  explicit BoxBounds(const Vec3& point) {
    for (size_t k = 0; k < 3; ++k) {
      at_[k] = point[k];
      slack_[k] = 2.5e-7 * std::abs(point[k]) + 1e-14;
    }
  }
  Float4 squared(const TriangleTree::Node& node) const {
    Float4 sum = 0;
    for (size_t k = 0; k < 3; ++k) {
      const Float4 below = Float4::load(node.lo[k].data()) - at_[k];
      const Float4 above = at_[k] - Float4::load(node.hi[k].data());
      sum = sum + square(max(max(below, above) - slack_[k], Float4(0)));
    }
    return sum * Float4(0.999999);
  }

 private:
  std::array<Float4, 3> at_, slack_;
};

/// Which point of a mesh is nearest to a far one at distance D in direction u: the squared distance
/// without its large constant part, and by 2D, |q|² / (2D) - q·u, which rounding leaves intact.
class FarOrder {
 public:
  explicit FarOrder(const Vec3& point) {
    const double far = norm(point);
    half_curvature_ = 0.5 / far;
    direction_ = (1 / far) * point;
    turn_ = point;
  }
  double at(const Vec3& q) const { return half_curvature_ * dot(q, q) - dot(q, direction_); }
  double least(const TriangleTree::Node& node, size_t child) const {
    Vec3 q{};
    for (size_t k = 0; k < 3; ++k) {
      q[k] = std::clamp(turn_[k], double(node.lo[k][child]), double(node.hi[k][child]));
    }
    return at(q) - 1e-14;
  }

 private:
  double half_curvature_;
  Vec3 direction_, turn_;
};

// Beyond this many units floats no longer tell the boxes' distances apart.
constexpr double far_away = 64, farthest = 1e8;

}  // namespace

TriangleTree::TriangleTree(std::span<const Vec3> vertices,
                           std::span<const std::array<uint32_t, 3>> triangles, Pulse& pulse) {
  Vec3 lo = vertices[triangles[0][0]], hi = lo;
  pulse.stage(0.1);
  for (size_t i = 0; i < triangles.size(); ++i) {
    pulse.step(i, triangles.size());
    for (const uint32_t corner : triangles[i]) {
      for (size_t k = 0; k < 3; ++k) {
        lo[k] = std::min(lo[k], vertices[corner][k]);
        hi[k] = std::max(hi[k], vertices[corner][k]);
      }
    }
  }
  const double half = 0.5 * std::max({hi[0] - lo[0], hi[1] - lo[1], hi[2] - lo[2]});
  unit_ = half > 0x1p-600 ? std::exp2(std::ceil(std::log2(half))) : half > 0 ? 0x1p-600 : 1;
  // A multiple of the unit, so that local coordinates of round numbers are round.
  for (size_t k = 0; k < 3; ++k) {
    centre_[k] = unit_ * std::round((lo[k] + 0.5 * (hi[k] - lo[k])) / unit_);
  }
  bounds_ = {to_local(lo), to_local(hi)};

  std::vector<TriangleBox> boxes(triangles.size());
  std::vector<Vec3> local(vertices.size());
  tbb::this_task_arena::isolate([&] {
    tbb::parallel_for(size_t(0), vertices.size(), [&](size_t i) {
      pulse.step(i, vertices.size());
      local[i] = to_local(vertices[i]);
    });
    tbb::parallel_for(size_t(0), triangles.size(), [&](size_t i) {
      pulse.step(i, triangles.size());
      const auto& [a, b, c] = triangles[i];
      boxes[i] = TriangleBox::around(local[a], local[b], local[c], uint32_t(i));
    });
    pulse.stage(0.8);
    nodes_ = build_nodes(boxes, pulse);
  });

  // Vertices in the order of their first use: those of near triangles lie near in memory.
  constexpr uint32_t unused = ~0u;
  std::vector<uint32_t> number(vertices.size(), unused);
  triangles_.reserve(triangles.size());
  pulse.stage(1);
  for (const TriangleBox& box : boxes) {
    pulse.step(triangles_.size(), triangles.size());
    Triangle made{triangles[box.number()], box.number() << 1};
    for (uint32_t& corner : made.corners) {
      if (number[corner] == unused) {
        number[corner] = uint32_t(vertices_.size());
        vertices_.push_back(local[corner]);
      }
      corner = number[corner];
    }
    if (!is_higher(made, narrowest)) made.tag |= 1;
    triangles_.push_back(made);
  }
}

Vec3 TriangleTree::to_local(const Vec3& at) const {
  return {(at[0] - centre_[0]) / unit_, (at[1] - centre_[1]) / unit_, (at[2] - centre_[2]) / unit_};
}

Vec3 TriangleTree::from_local(const Vec3& at) const { return centre_ + unit_ * at; }

Vec3 TriangleTree::area_vector(const Triangle& t) const {
  return cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0));
}

bool TriangleTree::is_higher(const Triangle& t, double share) const {
  const Vec3 area = area_vector(t);
  double longest = 0;
  for (size_t k = 0; k < 3; ++k) {
    const Vec3 edge = corner(t, (k + 1) % 3) - corner(t, k);
    longest = std::max(longest, dot(edge, edge));
  }
  return dot(area, area) > square(share * longest);
}

bool TriangleTree::has_area(const Triangle& t) const { return is_higher(t, 10 * no_height); }

TrianglePoint TriangleTree::on(const Vec3& point, uint32_t triangle) const {
  const Triangle& t = triangles_[triangle];
  const Vec3 &a = corner(t, 0), &b = corner(t, 1), &c = corner(t, 2);
  return t.narrow() ? on_narrow(point, {a, b, c}, triangle) : on_triangle(point, a, b, c, triangle);
}

TrianglePoint TriangleTree::nearest(const Vec3& point, uint32_t guess) const {
  for (const double a : point) {
    if (std::abs(a) > far_away) return nearest_to_far(point);
  }
  return nearest_to_near(point, guess < triangles_.size() ? guess : 0);
}

TrianglePoint TriangleTree::nearest_to_near(const Vec3& point, uint32_t guess) const {
  const BoxBounds bounds(point);
  TrianglePoint best = on(point, guess);
  // The bounds are below the squared distances by more than this rounding.
  float limit = float(best.squared) * 1.000001f + 1e-37f;
  Stack stack;
  Pending now{0, 0, 0};
  do {
    if (float(now.bound) > limit) continue;
    if (now.count > 0) {
      for (uint32_t i = now.first; i < now.first + now.count; ++i) {
        const TrianglePoint found = on(point, i);
        if (!is_nearer(found.squared, best.squared, triangles_[i].given(),
                       triangles_[best.triangle].given())) {
          continue;
        }
        best = found;
        limit = float(best.squared) * 1.000001f + 1e-37f;
      }
      continue;
    }
    const Node& node = nodes_[now.first];
    const Float4 squared = bounds.squared(node);
    const size_t before = stack.size();
    for (size_t i = 0; i < 4; ++i) {
      if (squared.v[i] <= limit) stack.push({double(squared.v[i]), node.first[i], node.count[i]});
    }
    stack.sort_from(before);
  } while (stack.pop(now));
  return best;
}

TrianglePoint TriangleTree::nearest_to_far(const Vec3& from) const {
  // What is nearest from farther off is nearest from here to 1e-16 of the distance, and here the
  // edges' lengths are not lost in the distance.
  const double far = norm(from);
  const Vec3 point = far > farthest ? (farthest / far) * from : from;
  const FarOrder order(point);
  TrianglePoint best = on(point, 0);
  double least = order.at(best.point);
  Stack stack;
  Pending now{-infinity, 0, 0};
  do {
    if (now.bound > least) continue;
    if (now.count > 0) {
      for (uint32_t i = now.first; i < now.first + now.count; ++i) {
        const TrianglePoint found = on(point, i);
        const double value = order.at(found.point);
        if (!is_nearer(value, least, triangles_[i].given(), triangles_[best.triangle].given())) {
          continue;
        }
        best = found;
        least = value;
      }
      continue;
    }
    const Node& node = nodes_[now.first];
    const size_t before = stack.size();
    for (size_t i = 0; i < 4; ++i) {
      if (node.missing(i)) continue;
      const double bound = order.least(node, i);
      if (bound <= least) stack.push({bound, node.first[i], node.count[i]});
    }
    stack.sort_from(before);
  } while (stack.pop(now));
  const Vec3 away = from - best.point;
  best.squared = dot(away, away);
  return best;
}

}  // namespace sardf

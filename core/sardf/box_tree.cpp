#include "sardf/box_tree.hpp"

#include <limits>
#include <numeric>

namespace sardf {

double Extent::magnitude() const {
  double most = 0;
  for (size_t k = 0; k < 3; ++k) most = max(most, max(std::abs(lo[k]), std::abs(hi[k])));
  return most;
}

std::array<Interval, 3> Extent::intervals() const {
  return {Interval{lo[0], hi[0]}, Interval{lo[1], hi[1]}, Interval{lo[2], hi[2]}};
}

BoxTree::BoxTree(std::span<const Extent> boxes, size_t leaf) : order_(boxes.size()) {
  std::iota(order_.begin(), order_.end(), 0u);
  build(boxes, 0, boxes.size(), leaf);
}

void BoxTree::build(std::span<const Extent> boxes, size_t first, size_t last, size_t leaf) {
  const size_t node = nodes_.size();
  nodes_.emplace_back();
  Extent all, middles;
  for (size_t i = first; i < last; ++i) {
    const Extent& box = boxes[order_[i]];
    all.add(box);
    middles.add(0.5 * (box.lo + box.hi));
  }
  nodes_[node].box = all;
  if (last - first <= leaf) {
    nodes_[node].first = uint32_t(first);
    nodes_[node].count = uint32_t(last - first);
    return;
  }
  const Vec3 sides = middles.hi - middles.lo;
  const size_t axis = size_t(std::max_element(sides.begin(), sides.end()) - sides.begin());
  const size_t half = first + (last - first) / 2;
  const auto at = [&](size_t i) { return order_.begin() + std::ptrdiff_t(i); };
  std::nth_element(at(first), at(half), at(last), [&](uint32_t a, uint32_t b) {
    const double left = boxes[a].lo[axis] + boxes[a].hi[axis];
    const double right = boxes[b].lo[axis] + boxes[b].hi[axis];
    return left != right ? left < right : a < b;
  });
  build(boxes, first, half, leaf);
  nodes_[node].first = uint32_t(nodes_.size());
  build(boxes, half, last, leaf);
}

bool is_out_of_range(const Vec3& point) {
  // Squares and sums of squares of what is smaller are finite.
  constexpr double most = 1e140;
  return !(std::abs(point[0]) < most && std::abs(point[1]) < most && std::abs(point[2]) < most);
}

Nearest nearest_out_of_range(const Vec3& point, const Vec3& of_set) {
  Nearest found;
  found.point = of_set;
  const Vec3 away = point - of_set;
  const bool is_nan = std::isnan(point[0]) || std::isnan(point[1]) || std::isnan(point[2]);
  // hypot of two numbers is infinite if one of them is; that of three divides infinities.
  found.distance = is_nan ? std::numeric_limits<double>::quiet_NaN()
                          : std::hypot(std::hypot(away[0], away[1]), away[2]);
  const double most = max(max(std::abs(away[0]), std::abs(away[1])), std::abs(away[2]));
  found.gradient = normalized((1 / most) * away);
  return found;
}

Nearest nearest_at(const Vec3& point, const Vec3& toward, double rounding) {
  Nearest found;
  found.distance = std::sqrt(dot(toward, toward));
  if (found.distance <= rounding) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    found.point = point;
    found.distance = 0;
    found.gradient = {none, none, none};
    return found;
  }
  found.point = point + toward;
  found.gradient = (-1 / found.distance) * toward;
  return found;
}

}  // namespace sardf

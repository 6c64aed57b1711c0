#include "povray_gen/band_bound.hpp"

#include <algorithm>
#include <queue>

namespace sardf::povray {

namespace {

/// A part of the box with its bound, ordered by the bound.
struct Part {
  BoundingBox box;
  double length = 0;
  bool operator<(const Part& other) const { return length < other.length; }
};

// 0 where the field is not in the band, or its gradient is not known.
double attained_at(const Evaluator& field, const Vec3& point, double band) {
  if (!field.has_gradients()) return 0;
  double value = 0;
  Vec3 gradient;
  field.gradients(point.data(), 1, &value, gradient.data());
  const double length = norm(gradient);
  return std::abs(value) <= band && length < infinity ? length : 0;
}

}  // namespace

std::optional<double> band_bound(const Evaluator& field, const BoundingBox& box, double band,
                                 int boxes) {
  constexpr double close_enough = 1.001;
  // At an edge of the solid the bound stays as it is however small the parts are.
  const double smallest = box.diagonal() / 100;
  std::priority_queue<Part> parts;
  double attained = 0;
  const auto add = [&](const BoundingBox& part, double most) {
    const Slope slope = field.slope(part);
    // A part is never worse than the whole.
    const double length = std::min(most, slope.length);
    if (slope.value.lo > band || slope.value.hi < -band) return;
    parts.push({part, length});
    attained = std::max(attained, attained_at(field, part.center(), band));
  };
  add(box, infinity);
  for (int used = 1; used < boxes && !parts.empty(); ++used) {
    const Part worst = parts.top();
    if (worst.length <= close_enough * attained || worst.box.diagonal() < smallest) break;
    parts.pop();
    const Vec3 size = worst.box.size();
    const auto axis = size_t(std::max_element(size.begin(), size.end()) - size.begin());
    BoundingBox low = worst.box, high = worst.box;
    low.hi[axis] = high.lo[axis] = worst.box.center()[axis];
    add(low, worst.length);
    add(high, worst.length);
  }
  if (parts.empty()) return {};
  return parts.top().length;
}

}  // namespace sardf::povray

#include "sardf/box_search.hpp"

#include <algorithm>
#include <deque>

namespace sardf {

namespace {

// Of the diagonal: boxes this small are not halved.
constexpr double smallest_box = 1.0 / 256;
// Halvings between two descents.
constexpr int descend_every = 6;

struct Box {
  BoundingBox box;
  int level;
};

}  // namespace

ValueAndGradient value_and_gradient(const Evaluator& field, const Vec3& point) {
  ValueAndGradient at;
  field.gradients(point.data(), 1, &at.value, at.gradient.data());
  if (!(norm(at.gradient) < infinity)) at.gradient = {};
  return at;
}

Vec3 newton_step(const ValueAndGradient& at) {
  return -at.value / std::max(dot(at.gradient, at.gradient), 1e-30) * at.gradient;
}

Vec3 common_newton_step(const ValueAndGradient& a, const ValueAndGradient& b) {
  const double aa = dot(a.gradient, a.gradient), bb = dot(b.gradient, b.gradient);
  const double ab = dot(a.gradient, b.gradient), determinant = aa * bb - ab * ab;
  if (!(determinant > 1e-14 * aa * bb)) return 0.5 * (newton_step(a) + newton_step(b));
  const double p = (-a.value * bb + b.value * ab) / determinant;
  const double q = (-b.value * aa + a.value * ab) / determinant;
  return p * a.gradient + q * b.gradient;
}

std::vector<BoundingBox> search_boxes(const BoundingBox& whole, int most, const Progress& progress,
                                      const LookIntoBox& look) {
  std::deque<Box> open{{whole, 0}};
  for (int used = 0; !open.empty() && used < most; ++used) {
    if (progress && !progress(double(used) / most)) throw Cancelled();
    const Box box = open.front();
    open.pop_front();
    const Vec3 size = box.box.size();
    const size_t axis = size_t(std::max_element(size.begin(), size.end()) - size.begin());
    const bool last = size[axis] < smallest_box * whole.diagonal();
    if (!look(box.box, last || box.level % descend_every == 0) || last) continue;
    for (const bool upper : {false, true}) {
      Box half{box.box, box.level + 1};
      (upper ? half.box.lo : half.box.hi)[axis] = box.box.center()[axis];
      open.push_back(half);
    }
  }
  std::vector<BoundingBox> left;
  for (const Box& box : open) left.push_back(box.box);
  return left;
}

}  // namespace sardf

#include "sardf/mesher_field.hpp"

#include <limits>

namespace sardf::mesher {

namespace {

// The distance to the nearest face of the bounds, positive inside, and that face: axis, or
// 3 + axis for the upper one.
template <class T>
T clip_value(const BoundingBox& bounds, const Points<T>& points, size_t i, int& face) {
  T nearest = std::numeric_limits<T>::max();
  for (int axis = 0; axis < 3; ++axis) {
    const T below = points.xyz[axis][i] - T(bounds.lo[axis]);
    const T above = T(bounds.hi[axis]) - points.xyz[axis][i];
    if (below < nearest) {
      nearest = below;
      face = axis;
    }
    if (above < nearest) {
      nearest = above;
      face = 3 + axis;
    }
  }
  return nearest;
}

bool contains(const BoundingBox& box, const Vec3& p) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!(box.lo[axis] <= p[axis] && p[axis] <= box.hi[axis])) return false;
  }
  return true;
}

}  // namespace

const Evaluator& Field::program(const Index3& node, int level) const {
  if (!programs_) return solid_;
  const Programs::Found found = programs_->find(node, level);
  return found.program ? **found.program : solid_;
}

template <class T, class Run>
void Field::for_runs(const Points<T>& points, size_t n, Run run) const {
  if (!programs_) return run(solid_, size_t(0), n);
  const auto at = [&](size_t i) {
    return Vec3{double(points.xyz[0][i]), double(points.xyz[1][i]), double(points.xyz[2][i])};
  };
  for (size_t first = 0, last; first < n; first = last) {
    const Programs::Found found = programs_->find(at(first));
    const auto is_good = [&](const Vec3& p) { return found.program && contains(found.valid, p); };
    const bool is_short = is_good(at(first));
    for (last = first + 1; last < n && is_good(at(last)) == is_short; ++last) {
      // The full program is dear: the next point may have a shorter one.
      if (!is_short && programs_->find(at(last)).program) break;
    }
    run(is_short ? **found.program : solid_, first, last - first);
  }
}

template <class T>
void Field::evaluate(Points<T>& points, size_t n) const {
  for_runs(points, n, [&](const Evaluator& solid, size_t first, size_t count) {
    T* out = points.value + first;
    solid.block(points.xyz[0] + first, points.xyz[1] + first, points.xyz[2] + first, count, &out);
  });
  T* out = points.value;
  for (size_t i = 0; i < n; ++i) {
    int face;
    const T clip = clip_value(bounds_, points, i, face);
    if (clip < out[i]) out[i] = clip;
  }
}

template <class T>
void Field::differentiate(Points<T>& points, size_t n) const {
  for_runs(points, n, [&](const Evaluator& solid, size_t first, size_t count) {
    T* to[3];
    for (int axis = 0; axis < 3; ++axis) to[axis] = points.gradient[axis] + first;
    solid.gradient_block(points.xyz[0] + first, points.xyz[1] + first, points.xyz[2] + first, count,
                         points.value + first, to);
  });
  for (size_t i = 0; i < n; ++i) {
    int face;
    const T clip = clip_value(bounds_, points, i, face);
    if (!(clip < points.value[i])) continue;
    points.value[i] = clip;
    for (int axis = 0; axis < 3; ++axis) {
      points.gradient[axis][i] = T(axis == face ? 1 : axis + 3 == face ? -1 : 0);
    }
  }
}

template void Field::evaluate(Points<float>&, size_t) const;
template void Field::evaluate(Points<double>&, size_t) const;
template void Field::differentiate(Points<float>&, size_t) const;
template void Field::differentiate(Points<double>&, size_t) const;

Interval Field::clipped(const Interval& solid, const BoundingBox& box) const {
  Interval result = solid;
  for (int axis = 0; axis < 3; ++axis) {
    const Interval at{box.lo[axis], box.hi[axis]};
    result = min(result, min(at - Interval(bounds_.lo[axis]), Interval(bounds_.hi[axis]) - at));
  }
  return result;
}

double Field::lipschitz(const BoundingBox& box) const {
  const double bound = solid_.slope(box).length;
  return bound >= 1 ? bound : bound < 1 ? 1 : infinity;
}

Vec3 outward_normal(const Vec3& gradient) {
  const double length = norm(gradient);
  if (!(length > 0) || !(length < infinity)) return {0, 0, 0};
  return (-1 / length) * gradient;
}

Vec3 newton_step(double value, const Vec3& gradient) {
  const double squared = dot(gradient, gradient);
  if (!(squared > 0) || !(squared < infinity) || !(std::abs(value) < infinity)) return {0, 0, 0};
  return (-value / squared) * gradient;
}

}  // namespace sardf::mesher

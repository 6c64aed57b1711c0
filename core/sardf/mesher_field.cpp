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

}  // namespace

template <class T>
void Field::evaluate(Points<T>& points, size_t n) const {
  T* out = points.value;
  solid_.block(points.xyz[0], points.xyz[1], points.xyz[2], n, &out);
  for (size_t i = 0; i < n; ++i) {
    int face;
    const T clip = clip_value(bounds_, points, i, face);
    if (clip < out[i]) out[i] = clip;
  }
}

template <class T>
void Field::differentiate(Points<T>& points, size_t n) const {
  T* gradient[3] = {points.gradient[0], points.gradient[1], points.gradient[2]};
  solid_.gradient_block(points.xyz[0], points.xyz[1], points.xyz[2], n, points.value, gradient);
  for (size_t i = 0; i < n; ++i) {
    int face;
    const T clip = clip_value(bounds_, points, i, face);
    if (!(clip < points.value[i])) continue;
    points.value[i] = clip;
    for (int axis = 0; axis < 3; ++axis) {
      gradient[axis][i] = T(axis == face ? 1 : axis + 3 == face ? -1 : 0);
    }
  }
}

template void Field::evaluate(Points<float>&, size_t) const;
template void Field::evaluate(Points<double>&, size_t) const;
template void Field::differentiate(Points<float>&, size_t) const;
template void Field::differentiate(Points<double>&, size_t) const;

Interval Field::interval(const BoundingBox& box) const {
  Interval result = solid_.interval(box);
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

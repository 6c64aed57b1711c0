#include "sardf/mesher_field.hpp"

#include <algorithm>
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

// Whether the bounds cut off any of the points' values; most often they are far from all.
template <class T>
bool any_clipped(const BoundingBox& bounds, const Points<T>& points, size_t n) {
  int clipped = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const T lo = T(bounds.lo[axis]), hi = T(bounds.hi[axis]);
    const T* at = points.xyz[axis];
    for (size_t i = 0; i < n; ++i) {
      const T below = at[i] - lo, above = hi - at[i];
      clipped |= int((above < below ? above : below) < points.value[i]);
    }
  }
  return clipped != 0;
}

template <class T>
bool contains_all(const BoundingBox& box, const Points<T>& points, size_t n) {
  int out = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const T* at = points.xyz[axis];
    for (size_t i = 0; i < n; ++i) {
      out |= int(!(box.lo[axis] <= double(at[i]) && double(at[i]) <= box.hi[axis]));
    }
  }
  return out == 0;
}

template <class T>
void differentiate_solid(const Evaluator& program, Points<T>& points, size_t n) {
  T* to[3] = {points.gradient[0], points.gradient[1], points.gradient[2]};
  program.gradient_block(points.xyz[0], points.xyz[1], points.xyz[2], n, points.value, to);
}

bool contains(const BoundingBox& box, const Vec3& p) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!(box.lo[axis] <= p[axis] && p[axis] <= box.hi[axis])) return false;
  }
  return true;
}

template <class T>
void copy_point(const Points<T>& from, size_t i, Points<T>& to, size_t k) {
  for (int axis = 0; axis < 3; ++axis) to.xyz[axis][k] = from.xyz[axis][i];
}

template <class T>
void copy_result(const Points<T>& from, size_t i, Points<T>& to, size_t k) {
  for (int axis = 0; axis < 3; ++axis) to.gradient[axis][k] = from.gradient[axis][i];
  to.value[k] = from.value[i];
}

}  // namespace

const Evaluator& Field::program(const Index3& node, int level) const {
  if (!programs_) return solid_;
  const Programs::Found found = programs_->find(node, level);
  return found.program ? **found.program : solid_;
}

template <class T>
bool Field::find_programs(const Points<T>& points, size_t n, const Evaluator** found) const {
  bool is_one = true;
  Programs::Found last;
  for (size_t i = 0; i < n; ++i) {
    const Vec3 at{double(points.xyz[0][i]), double(points.xyz[1][i]), double(points.xyz[2][i])};
    // Points beside one another mostly lie in one node.
    if (!last.program || !contains(last.valid, at)) {
      last = programs_->find(at);
      if (last.program && !contains(last.valid, at)) last.program = nullptr;
    }
    found[i] = last.program ? last.program->get() : &solid_;
    is_one = is_one && found[i] == found[0];
  }
  return is_one;
}

template <class T, class Run>
void Field::for_programs(Points<T>& points, size_t n, Run run) const {
  const Evaluator* found[Points<T>::capacity];
  if (!programs_ || n == 0) return run(solid_, points, n);
  if (find_programs(points, n, found)) return run(*found[0], points, n);
  Points<T> group;
  uint16_t member[Points<T>::capacity];
  for (size_t begin = 0; begin < n; ++begin) {
    const Evaluator* program = found[begin];
    if (!program) continue;
    size_t count = 0;
    for (size_t i = begin; i < n; ++i) {
      if (found[i] != program) continue;
      found[i] = nullptr;
      member[count] = uint16_t(i);
      copy_point(points, i, group, count++);
    }
    run(*program, group, count);
    for (size_t i = 0; i < count; ++i) copy_result(group, i, points, member[i]);
  }
}

template <class T>
void Field::evaluate(Points<T>& points, size_t n) const {
  for_programs(points, n, [this](const Evaluator& program, Points<T>& at, size_t count) {
    evaluate(program, at, count);
  });
}

template <class T>
void Field::evaluate(const Evaluator& program, Points<T>& points, size_t n) const {
  T* out = points.value;
  program.block(points.xyz[0], points.xyz[1], points.xyz[2], n, &out);
  for (int axis = 0; axis < 3; ++axis) {
    const T lo = T(bounds_.lo[axis]), hi = T(bounds_.hi[axis]);
    const T* at = points.xyz[axis];
    for (size_t i = 0; i < n; ++i) {
      const T below = at[i] - lo, above = hi - at[i];
      const T clip = above < below ? above : below;
      out[i] = clip < out[i] ? clip : out[i];
    }
  }
}

template <class T>
void Field::differentiate(Points<T>& points, size_t n) const {
  for_programs(points, n, differentiate_solid<T>);
  clip(points, n);
}

template <class T>
void Field::differentiate(const Evaluator& program, Points<T>& points, size_t n) const {
  differentiate_solid(program, points, n);
  clip(points, n);
}

template <class T>
void Field::clip(Points<T>& points, size_t n) const {
  if (!any_clipped(bounds_, points, n)) return;
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

Field::Local Field::local(const Index3& node, int level) const {
  const Vec3 all{infinity, infinity, infinity};
  if (programs_) {
    const Programs::Found found = programs_->find(node, level);
    if (found.program) return {found.program->get(), found.valid};
  }
  return {&solid_, {-1.0 * all, all}};
}

template <class T>
void Field::evaluate(const Local& local, Points<T>& points, size_t n) const {
  if (contains_all(local.valid, points, n)) return evaluate(*local.program, points, n);
  evaluate(points, n);
}

template <class T>
void Field::differentiate(const Local& local, Points<T>& points, size_t n) const {
  if (contains_all(local.valid, points, n)) return differentiate(*local.program, points, n);
  differentiate(points, n);
}

template void Field::evaluate(Points<float>&, size_t) const;
template void Field::evaluate(Points<double>&, size_t) const;
template void Field::evaluate(const Evaluator&, Points<float>&, size_t) const;
template void Field::evaluate(const Evaluator&, Points<double>&, size_t) const;
template void Field::differentiate(Points<float>&, size_t) const;
template void Field::differentiate(Points<double>&, size_t) const;
template void Field::differentiate(const Evaluator&, Points<float>&, size_t) const;
template void Field::differentiate(const Evaluator&, Points<double>&, size_t) const;
template void Field::evaluate(const Local&, Points<float>&, size_t) const;
template void Field::evaluate(const Local&, Points<double>&, size_t) const;
template void Field::differentiate(const Local&, Points<float>&, size_t) const;
template void Field::differentiate(const Local&, Points<double>&, size_t) const;

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

}  // namespace sardf::mesher

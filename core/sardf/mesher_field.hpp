// The field that is meshed: the solid's, clipped by the bounds. Private to core/sardf/mesher*.cpp.
#pragma once

#include <cmath>
#include <optional>

#include "sardf/mesher_programs.hpp"

namespace sardf::mesher {

/// Coordinates, values and derivatives of up to `capacity` points as arrays.
template <class T>
struct Points {
  static constexpr size_t capacity = Evaluator::block_size;
  T xyz[3][capacity], value[capacity], gradient[3][capacity];
  void set(size_t i, const Vec3& p) {
    for (int axis = 0; axis < 3; ++axis) xyz[axis][i] = T(p[axis]);
  }
  Vec3 gradient_at(size_t i) const {
    return {double(gradient[0][i]), double(gradient[1][i]), double(gradient[2][i])};
  }
};

class Field {
 public:
  Field(const Evaluator& solid, const BoundingBox& bounds) : solid_(solid), bounds_(bounds) {}

  /// Shorter programs to evaluate by; until then there are none. They change no value.
  void use(Programs programs) { programs_ = std::move(programs); }
  std::optional<Programs>& programs() { return programs_; }
  const std::optional<Programs>& programs() const { return programs_; }
  /// The solid's program for a node of the octree.
  const Evaluator& program(const Index3& node, int level) const;

  /// Values of the first n points. NaN counts as outside everywhere.
  template <class T>
  void evaluate(Points<T>& points, size_t n) const;
  /// The same by a program that is good for all of them.
  template <class T>
  void evaluate(const Evaluator& program, Points<T>& points, size_t n) const;
  /// Values and gradients of the first n points.
  template <class T>
  void differentiate(Points<T>& points, size_t n) const;
  template <class T>
  void differentiate(const Evaluator& program, Points<T>& points, size_t n) const;

  /// A program and where it is good.
  struct Local {
    const Evaluator* program;
    BoundingBox valid;
  };
  /// For the points in a node of the octree, most of all.
  Local local(const Index3& node, int level) const;
  /// Values by the local program, of points out of its box by those that are good there.
  template <class T>
  void evaluate(const Local& local, Points<T>& points, size_t n) const;
  template <class T>
  void differentiate(const Local& local, Points<T>& points, size_t n) const;

  /// Encloses the values over the box, where the solid's are in this range.
  Interval clipped(const Interval& solid, const BoundingBox& box) const;
  /// Bounds the length of the gradient over the box; may be infinite.
  double lipschitz(const BoundingBox& box) const;

 private:
  // run(evaluator, points, count) on all points, those together that one program is good for.
  template <class T, class Run>
  void for_programs(Points<T>& points, size_t n, Run run) const;
  // The program for each point, and whether it is one for all.
  template <class T>
  bool find_programs(const Points<T>& points, size_t n, const Evaluator** found) const;

  template <class T>
  void clip(Points<T>& points, size_t n) const;

  const Evaluator& solid_;
  BoundingBox bounds_;
  std::optional<Programs> programs_;
};

/// The unit outward normal for a gradient; 0 where the gradient is 0 or not finite.
inline Vec3 outward_normal(const Vec3& gradient) {
  const double length = norm(gradient);
  if (!(length > 0) || !(length < infinity)) return {0, 0, 0};
  return (-1 / length) * gradient;
}

/// One by the length of each of n gradients; 0 where that is 0 or not finite.
template <class T>
void inverse_lengths(const Points<T>& points, size_t n, T* inverse) {
  // Squares of shorter and longer ones may be rounded away.
  constexpr T least = T(1e-30), most = T(1e30);
  bool all = true;
  for (size_t i = 0; i < n; ++i) {
    const T x = points.gradient[0][i], y = points.gradient[1][i], z = points.gradient[2][i];
    const T square = x * x + y * y + z * z;
    all &= (square > least) & (square < most);
    inverse[i] = 1 / std::sqrt(square);
  }
  if (all) return;
  for (size_t i = 0; i < n; ++i) {
    const double length = norm(points.gradient_at(i));
    const bool good = length > 0 && length < infinity && T(1 / length) < T(infinity);
    inverse[i] = good ? T(1 / length) : 0;
  }
}

/// From a point to the surface by one step of Newton's method; 0 where there is no gradient.
inline Vec3 newton_step(double value, const Vec3& gradient) {
  const double squared = dot(gradient, gradient);
  if (!(squared > 0) || !(squared < infinity) || !(std::abs(value) < infinity)) return {0, 0, 0};
  return (-value / squared) * gradient;
}

}  // namespace sardf::mesher

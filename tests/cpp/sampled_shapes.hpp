// Operations without a formula whose values are known by one, for tests.
#pragma once

#include <cmath>
#include <numbers>

#include "sardf/data_operation.hpp"

namespace sardf {

/// The nearest of a few points. With kind solid: the ball of radius `radius` around the first one.
class TestPoints final : public PointSet {
 public:
  TestPoints(std::string name, std::vector<Vec3> points, double radius = 0)
      : PointSet(std::move(name), "For tests.", {points[0].data(), 3 * points.size()}),
        points_(std::move(points)),
        radius_(radius) {}

  Kind kind() const override { return radius_ > 0 ? Kind::solid : Kind::feature; }

  Nearest nearest(const Vec3& at) const override {
    const Vec3* best = &points_[0];
    for (const Vec3& p : points_) {
      if (norm(at - p) < norm(at - *best)) best = &p;
    }
    const double d = norm(at - *best);
    const Vec3 away = (1 / d) * (at - *best);
    if (radius_ > 0) return {*best + radius_ * away, radius_ - d, -1.0 * away};
    return {*best, d, away};
  }
  std::array<Vec3, 3> jacobian(const Vec3&, const Nearest&) const override { return {}; }
  std::array<Interval, 3> bounds() const override {
    std::array<Interval, 3> out;
    for (int k = 0; k < 3; ++k) {
      out[size_t(k)] = {infinity, -infinity};
      for (const Vec3& p : points_) {
        out[size_t(k)] = hull(out[size_t(k)], {p[size_t(k)] - radius_, p[size_t(k)] + radius_});
      }
    }
    return out;
  }

 private:
  std::vector<Vec3> points_;
  double radius_;
};

/// A smooth function of `arity` values: the product of sin(1.5 x + 1), cos(2 y), 1 + z² / 4.
class TestWave : public DataOperation {
 public:
  explicit TestWave(int arity)
      : DataOperation({"wave", arity == 2 ? Kind::plane : Kind::internal, arity, "For tests."},
                      {double(arity)}) {}

  using DataOperation::evaluate;
  void evaluate(const double* const* in, double* out, size_t n) const override {
    for (size_t i = 0; i < n; ++i)
      out[i] = factor(0, in[0][i]) * factor(1, in[1][i]) * third(in, i);
  }
  void partials(const double* const* in, double* out, double* const* partial,
                size_t n) const override {
    evaluate(in, out, n);
    for (size_t i = 0; i < n; ++i) {
      const double x = in[0][i], y = in[1][i];
      partial[0][i] = 1.5 * std::cos(1.5 * x + 1) * factor(1, y) * third(in, i);
      partial[1][i] = -2 * std::sin(2 * y) * factor(0, x) * third(in, i);
      if (info().arity > 2) partial[2][i] = 0.5 * in[2][i] * factor(0, x) * factor(1, y);
    }
  }
  Interval interval(const Interval* in) const override {
    const double most = 1 + (info().arity > 2 ? square(in[2]).hi / 4 : 0);
    return {-most, most};
  }
  Slope slope(const Slope* in) const override {
    std::array<Interval, max_arity> values;
    for (int k = 0; k < info().arity; ++k) values[size_t(k)] = in[k].value;
    const double most = interval(values.data()).hi;
    std::array<Interval, 3> partials{Interval{-1.5 * most, 1.5 * most},
                                     Interval{-2 * most, 2 * most}, Interval{}};
    if (info().arity > 2) {
      const double z = 0.5 * values[2].magnitude();
      partials[2] = {-z, z};
    }
    return slope_from(in, interval(values.data()), {partials.data(), size_t(info().arity)},
                      infinity);
  }

 private:
  static double factor(int k, double a) { return k == 0 ? std::sin(1.5 * a + 1) : std::cos(2 * a); }
  double third(const double* const* in, size_t i) const {
    return info().arity > 2 ? 1 + in[2][i] * in[2][i] / 4 : 1;
  }
};

}  // namespace sardf

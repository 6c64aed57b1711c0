// What every exact distance to a set of points has to do, checked on random points.
#pragma once

#include <gtest/gtest.h>

#include <random>

#include "sardf/constructor.hpp"
#include "sardf/data_operation.hpp"
#include "sardf/evaluate.hpp"

namespace sardf::features {

class Draw {
 public:
  explicit Draw(uint64_t seed) : engine_(seed) {}
  double uniform(double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(engine_);
  }
  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(engine_); }
  Vec3 point(double size) {
    return {uniform(-size, size), uniform(-size, size), uniform(-size, size)};
  }
  std::vector<Vec3> points(int n, double size) {
    std::vector<Vec3> all(static_cast<size_t>(n));
    for (Vec3& p : all) p = point(size);
    return all;
  }

 private:
  std::mt19937_64 engine_;
};

/// The arguments in the constructor's order: those named, and the defaults.
inline std::vector<Value> arguments(const Constructor& constructor,
                                    const std::map<std::string, Value>& given) {
  std::vector<Value> all;
  for (const ParameterInfo& p : constructor.parameters) {
    const auto found = given.find(p.name);
    all.push_back(found == given.end() ? p.default_value : found->second);
  }
  return all;
}

inline Field feature(const std::string& name, const std::map<std::string, Value>& given) {
  const Constructor* constructor = find_constructor(name);
  if (!constructor) throw std::runtime_error("no constructor " + name);
  return make_field(*constructor, arguments(*constructor, given));
}

inline double value(const Field& field, const Vec3& at) {
  return Evaluator(field.expression()).value({at[0], at[1], at[2]});
}

inline Vec3 gradient(const Evaluator& evaluator, const Vec3& at) {
  double d;
  Vec3 g;
  evaluator.gradients(at.data(), 1, &d, g.data());
  return g;
}

/// Bounds over boxes, |f(p) - f(q)| <= |p - q|, gradients and floats.
inline void expect_distance_laws(const Field& field, Draw& draw, double size, int count) {
  const Evaluator f(field.expression());
  const Operation& operation = *field.expression()->operation;
  int smooth = 0;
  for (int i = 0; i < count; ++i) {
    const Vec3 p = draw.point(size);
    const double d = f.value({p[0], p[1], p[2]});
    const Vec3 q = p + draw.uniform(0, 1) * draw.point(1), apart = p - q;
    EXPECT_LE(std::abs(d - f.value({q[0], q[1], q[2]})), norm(apart) + 1e-11 * size);

    const double half = std::pow(10, draw.uniform(-6, 0));
    std::array<Interval, 3> box;
    for (size_t k = 0; k < 3; ++k) box[k] = {p[k] - half, p[k] + half};
    const Interval bound = operation.interval(box.data());
    EXPECT_LE(bound.hi - bound.lo, 4 * half + 1e-8 * size);
    for (int k = 0; k < 4; ++k) {
      const Vec3 in = p + half * draw.point(1);
      EXPECT_TRUE(bound.contains(f.value({in[0], in[1], in[2]})));
    }

    const std::array<float, 3> rounded{float(p[0]), float(p[1]), float(p[2])};
    float in_float;
    f.values(rounded.data(), 1, &in_float);
    const double there = f.value({rounded[0], rounded[1], rounded[2]});
    EXPECT_NEAR(in_float, there, operation.has_formula() ? 1e-5 * size : 6e-8 * there);

    const Vec3 g = gradient(f, p);
    EXPECT_NEAR(norm(g), 1, 1e-9);
    const double h = 1e-5 * size;
    for (size_t k = 0; k < 3; ++k) {
      Vec3 after = p, before = p;
      after[k] += h;
      before[k] -= h;
      const double right = (f.value({after[0], after[1], after[2]}) - d) / h;
      const double left = (d - f.value({before[0], before[1], before[2]})) / h;
      // At a kink the one-sided slopes differ.
      if (!(std::abs(right - left) < 1e-3)) continue;
      ++smooth;
      EXPECT_NEAR(g[k], 0.5 * (left + right), 0.02 * std::abs(right - left) + 1e-6) << i;
    }
  }
  EXPECT_GT(smooth, 2 * count);
}

/// The derivatives of the nearest point against its differences.
inline void expect_jacobians(const PointSet& set, Draw& draw, double size, int count) {
  int compared = 0;
  for (int i = 0; i < count; ++i) {
    const Vec3 p = draw.point(size);
    const Nearest at = set.nearest(p);
    const std::array<Vec3, 3> rows = set.jacobian(p, at);
    const double h = 1e-5 * size;
    for (size_t k = 0; k < 3; ++k) {
      Vec3 after = p, before = p;
      after[k] += h;
      before[k] -= h;
      const Vec3 right = (1 / h) * (set.nearest(after).point - at.point);
      const Vec3 left = (1 / h) * (at.point - set.nearest(before).point);
      const double doubt = norm(right - left);
      if (!(doubt < 0.01)) continue;
      ++compared;
      for (size_t row = 0; row < 3; ++row) {
        EXPECT_NEAR(rows[row][k], 0.5 * (left[row] + right[row]), 0.1 * doubt + 1e-5) << i;
      }
    }
  }
  EXPECT_GT(compared, 2 * count);
}

}  // namespace sardf::features

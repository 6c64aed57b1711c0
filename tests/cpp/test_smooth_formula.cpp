// Bounds of formulas by their second derivatives: true, and near the truth in few boxes.
#include "sardf/smooth_formula.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sardf/arithmetic.hpp"
#include "sardf/certify.hpp"

namespace sardf {
namespace {

const Expression x = coordinate(0), y = coordinate(1), z = coordinate(2);

Expression sine(const Expression& a) { return function("sin", {a}); }
Expression cosine_of(const Expression& a) { return function("cos", {a}); }

const Expression gyroid = sine(x) * cosine_of(y) + sine(y) * cosine_of(z) + sine(z) * cosine_of(x);

TEST(SmoothFormula, ComesNearTheTruthInFewBoxes) {
  // The steepest gradient of the gyroid is sqrt(3), at the origin.
  const BoundingBox period{{-3.2, -3.2, -3.2}, {3.2, 3.2, 3.2}};
  const double bound = lipschitz_bound(Evaluator(with_smooth_bounds(gyroid)), period, 10'000);
  EXPECT_GE(bound, std::sqrt(3.0));
  EXPECT_LT(bound, 1.2 * std::sqrt(3.0));
}

std::vector<Expression> formulas() {
  const Expression ball = x * x + y * y + z * z;
  return {
      gyroid,
      abs(gyroid) - constant(0.3),
      min(gyroid * x, sine(x * y) / (constant(3) + z)),
      exp(x * y) - z,
      function("sqrt", {ball}) - constant(1),
      constant(1) / (constant(0.2) + ball),
      max(log(constant(9) + x * z), constant(2) * x + y),
      function("tan", {constant(0.2) * x * y}),
      function("mix", {x * y, z, sine(x)}),
      function("mix", {x, z, y}) + length(x, y),
  };
}

class Points {
 public:
  explicit Points(unsigned seed) : random_(seed) {}
  double uniform(double lo, double hi) { return std::uniform_real_distribution(lo, hi)(random_); }
  Vec3 in(const BoundingBox& box) {
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis) p[axis] = uniform(box.lo[axis], box.hi[axis]);
    return p;
  }
  BoundingBox box() {
    const Vec3 middle = in({{-2, -2, -2}, {2, 2, 2}});
    const double half = std::pow(10, uniform(-3, 0.3));
    return {middle - Vec3{half, half, half}, middle + Vec3{half, half, half}};
  }

 private:
  std::mt19937 random_;
};

TEST(SmoothFormula, HasTheSameValuesAndGradients) {
  Points points(1);
  for (const Expression& f : formulas()) {
    const Evaluator plain(f), bounded(with_smooth_bounds(f));
    for (int k = 0; k < 100; ++k) {
      const Vec3 p = points.in({{-2, -2, -2}, {2, 2, 2}});
      double value = 0, again = 0;
      Vec3 gradient, other;
      plain.gradients(p.data(), 1, &value, gradient.data());
      bounded.gradients(p.data(), 1, &again, other.data());
      EXPECT_EQ(value, again);
      EXPECT_EQ(bounded.value(p), plain.value(p));
      EXPECT_LE(norm(gradient - other), 1e-12 * (1 + norm(gradient)));
    }
  }
}

TEST(SmoothFormula, BoundsHold) {
  Points points(2);
  for (const Expression& f : formulas()) {
    const Evaluator plain(f), bounded(with_smooth_bounds(f));
    for (int i = 0; i < 100; ++i) {
      const BoundingBox box = points.box();
      const Slope slope = bounded.slope(box);
      const Interval values = bounded.interval(box);
      for (int k = 0; k < 50; ++k) {
        const Vec3 p = points.in(box);
        Vec3 gradient;
        double value = 0;
        plain.gradients(p.data(), 1, &value, gradient.data());
        EXPECT_TRUE(slope.value.contains(value));
        EXPECT_TRUE(values.contains(value));
        EXPECT_LE(norm(gradient), slope.length * (1 + 1e-12));
        for (int axis = 0; axis < 3; ++axis) {
          const double error = 1e-12 * (1 + std::abs(gradient[axis]));
          EXPECT_GE(gradient[axis], slope.partial[axis].lo - error);
          EXPECT_LE(gradient[axis], slope.partial[axis].hi + error);
        }
      }
    }
  }
}

TEST(SmoothFormula, IsNeverWorseThanIntervals) {
  Points points(3);
  for (const Expression& f : formulas()) {
    const Evaluator plain(f), bounded(with_smooth_bounds(f));
    for (int i = 0; i < 100; ++i) {
      const BoundingBox box = points.box();
      EXPECT_LE(bounded.slope(box).length, plain.slope(box).length * (1 + 1e-12));
    }
  }
}

TEST(SmoothFormula, LeavesWhatIsLinearAlone) {
  const Expression plane = constant(2) * x - y / constant(3) + constant(1);
  EXPECT_EQ(with_smooth_bounds(plane), plane);
  EXPECT_EQ(with_smooth_bounds(max(plane, z)), max(plane, z));
}

TEST(SmoothFormula, HasNoBoundAtAPole) {
  const BoundingBox box{{-1, -1, -1}, {1, 1, 1}};
  EXPECT_EQ(Evaluator(with_smooth_bounds(constant(1) / x)).slope(box).length, infinity);
  EXPECT_EQ(Evaluator(with_smooth_bounds(function("sqrt", {x * y}))).slope(box).length, infinity);
}

}  // namespace
}  // namespace sardf

// Laws of derivatives as expressions, on random trees of every constructor.
#include <gtest/gtest.h>

#include "laws.hpp"
#include "sardf/derivative.hpp"

namespace sardf {
namespace {

using laws::Random;

// Equal to the gradients that evaluation gives, which come from the number type Gradient.
// A field whose derivatives up to that order are known: of those found by a search, the first two.
Expression differentiable_field(Random& r, int depth, int order) {
  return laws::retried([&] {
    const Expression f = laws::random_field(r, depth).expression();
    Expression next = f;
    for (int i = 0; i < order; ++i) next = derivative(next, i);
    return f;
  });
}

TEST(DerivativeLawsSlow, EqualGradients) {
  Random r(41);
  size_t compared = 0, undefined = 0;
  for (int i = 0; i < laws::effort(200); ++i) {
    const Expression f = differentiable_field(r, 1 + r.below(2), 1);
    const std::array<Expression, 3> slopes = gradient(f);
    const Evaluator value(f), slope(slopes);
    for (int k = 0; k < 10; ++k) {
      const std::vector<double> at = r.values(3, 0.05, 100);
      double expected[3], found[3];
      value.gradients(at.data(), 1, nullptr, expected);
      slope.values(at.data(), 1, found);
      for (size_t axis = 0; axis < 3; ++axis) {
        if (std::isnan(expected[axis])) continue;
        // Evaluation leaves out a product of 0 with a slope that does not exist.
        undefined += std::isnan(found[axis]);
        if (std::isnan(found[axis])) continue;
        ++compared;
        EXPECT_NEAR(found[axis], expected[axis], 1e-9 * (1 + std::abs(expected[axis])))
            << "axis " << axis << " at " << testing::PrintToString(at) << ", seed " << laws::seed()
            << ", tree " << i;
      }
    }
  }
  EXPECT_LT(undefined, compared / 100);
}

// Second derivatives equal differences of first ones, away from kinks.
TEST(DerivativeLawsSlow, SecondDerivativesEqualDifferences) {
  Random r(43);
  size_t compared = 0, tried = 0;
  for (int i = 0; i < laws::effort(300); ++i) {
    const Expression f = differentiable_field(r, 1, 2);
    const int first = r.below(3), second = r.below(3);
    const Expression once = derivative(f, first);
    const Evaluator slope(once), curvature(derivative(once, second));
    for (int k = 0; k < 10; ++k) {
      const std::vector<double> p = r.values(3, 0);
      const Vec3 at{p[0], p[1], p[2]};
      const auto difference = [&](double h) {
        Vec3 left = at, right = at;
        left[size_t(second)] -= h;
        right[size_t(second)] += h;
        return (slope.value(right) - slope.value(left)) / (2 * h);
      };
      ++tried;
      const double wide = difference(1e-4), expected = difference(5e-5);
      const double size = 1 + std::abs(expected), doubt = 2 * std::abs(wide - expected);
      // Differences that do not settle are a kink's or a jump's.
      if (!(doubt < 1e-3 * size)) continue;
      ++compared;
      EXPECT_NEAR(curvature.value(at), expected, doubt + 1e-6 * size)
          << "axes " << first << ' ' << second << " at " << testing::PrintToString(p) << ", seed "
          << laws::seed() << ", tree " << i;
    }
  }
  EXPECT_GT(compared, tried / 2);
}

TEST(DerivativeLawsSlow, IntervalsHoldEverySample) {
  Random r(47);
  size_t boxes = 0, finite = 0;
  for (int i = 0; i < laws::effort(200); ++i) {
    const Expression f = differentiable_field(r, 1, 1);
    const Evaluator slope(derivative(f, r.below(3)));
    for (int k = 0; k < 5; ++k) {
      BoundingBox box;
      for (size_t axis = 0; axis < 3; ++axis) {
        const double half = r.decades(-3, 0.5), centre = r.ordinary();
        box.lo[axis] = centre - half;
        box.hi[axis] = centre + half;
      }
      const Interval bound = slope.interval(box);
      ASSERT_FALSE(std::isnan(bound.lo) || std::isnan(bound.hi));
      ++boxes;
      finite += bound.lo > -infinity && bound.hi < infinity;
      for (int n = 0; n < 8; ++n) {
        Vec3 at;
        for (size_t axis = 0; axis < 3; ++axis) {
          at[axis] = laws::number_in(r, {box.lo[axis], box.hi[axis]});
        }
        const double value = slope.value(at);
        if (std::isnan(value)) continue;
        EXPECT_TRUE(bound.contains(value)) << value << " not in [" << bound.lo << ", " << bound.hi
                                           << "], seed " << laws::seed() << ", tree " << i;
      }
    }
  }
  EXPECT_GT(finite, boxes / 2);
}

}  // namespace
}  // namespace sardf

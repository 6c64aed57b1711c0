// B-spline fields against B-splines by their textbook definition, and the laws of every operation.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "error_of.hpp"
#include "laws.hpp"
#include "sardf/constructor.hpp"
#include "sardf/evaluate.hpp"
#include "sardf/spline_operation.hpp"

namespace sardf {
namespace {

using laws::Random;
using testing::HasSubstr;

// Cox and de Boor: function i of a degree on the knots i, i + 1, ..., at s.
double basis(int i, int degree, double s) {
  if (degree == 0) return i <= s && s < i + 1;
  return (s - i) / degree * basis(i, degree - 1, s) +
         (i + degree + 1 - s) / degree * basis(i + 1, degree - 1, s);
}

struct Sample {
  SplineGrid grid;
  std::vector<double> coefficients;
  Expression expression() const {
    const std::array<Expression, 3> xyz{coordinate(0), coordinate(1), coordinate(2)};
    return call(spline_operation(grid, coefficients), std::span(xyz.data(), grid.dimensions));
  }
  // By the definition, at a point inside the box.
  double value(const Vec3& at) const {
    double sum = 0;
    std::array<std::vector<double>, 3> by{{{1}, {1}, {1}}};
    for (int k = 0; k < grid.dimensions; ++k) {
      const double s = (at[k] - grid.lower[k]) * grid.spans(k) / (grid.upper[k] - grid.lower[k]);
      by[k].clear();
      for (int i = 0; i < grid.counts[k]; ++i) {
        by[k].push_back(basis(i - grid.degrees[k], grid.degrees[k], s));
      }
    }
    size_t next = 0;
    for (const double x : by[0]) {
      for (const double y : by[1]) {
        for (const double z : by[2]) sum += x * y * z * coefficients[next++];
      }
    }
    return sum;
  }
};

Sample random_sample(Random& r, int most = 9) {
  const int degree = 1 + r.below(5);
  std::vector<double> counts(size_t(2 + r.below(2)));
  for (double& n : counts) n = degree + 1 + r.below(most);
  Vec3 lower, upper;
  for (int k = 0; k < 3; ++k) {
    lower[k] = r.uniform(-3, 2);
    upper[k] = lower[k] + r.uniform(0.5, 4);
  }
  Sample made{spline_grid(lower, upper, counts, degree), {}};
  made.coefficients.resize(made.grid.size());
  for (double& c : made.coefficients) c = r.uniform(-2, 2);
  return made;
}

Vec3 random_point(Random& r, const SplineGrid& grid, double beyond) {
  Vec3 at;
  for (int k = 0; k < 3; ++k) {
    const double side = grid.upper[k] - grid.lower[k];
    at[k] = grid.lower[k] + r.uniform(-beyond, 1 + beyond) * side;
  }
  return at;
}

TEST(SplineField, HasTheValuesOfTheDefinition) {
  Random r(1);
  for (int i = 0; i < laws::effort(400); ++i) {
    const Sample sample = random_sample(r);
    const Evaluator evaluator(sample.expression());
    for (int j = 0; j < 5; ++j) {
      const Vec3 at = random_point(r, sample.grid, 0);
      EXPECT_NEAR(evaluator.value(at), sample.value(at), 1e-12);
    }
  }
}

TEST(SplineField, IsContinuedByTheNearestPointOfItsBox) {
  Random r(2);
  for (int i = 0; i < laws::effort(200); ++i) {
    const Sample sample = random_sample(r);
    const Evaluator evaluator(sample.expression());
    const Vec3 at = random_point(r, sample.grid, 1);
    Vec3 nearest, gradient;
    for (int k = 0; k < 3; ++k)
      nearest[k] = std::clamp(at[k], sample.grid.lower[k], sample.grid.upper[k]);
    EXPECT_EQ(evaluator.value(at), evaluator.value(nearest));
    evaluator.gradients(at.data(), 1, nullptr, gradient.data());
    for (int k = 0; k < 3; ++k) {
      if (at[k] != nearest[k]) {
        EXPECT_EQ(gradient[k], 0);
      }
    }
  }
}

TEST(SplineField, GradientsAreCentralDifferences) {
  Random r(3);
  for (int i = 0; i < laws::effort(300); ++i) {
    const Sample sample = random_sample(r);
    if (sample.grid.degrees[0] == 1) continue;  // differences across a kink
    const Evaluator evaluator(sample.expression());
    const Vec3 at = random_point(r, sample.grid, -0.05);
    Vec3 gradient;
    double value;
    evaluator.gradients(at.data(), 1, &value, gradient.data());
    EXPECT_EQ(value, evaluator.value(at));
    for (int k = 0; k < 3; ++k) {
      Vec3 before = at, after = at;
      before[k] -= 1e-5;
      after[k] += 1e-5;
      const double difference = (evaluator.value(after) - evaluator.value(before)) / 2e-5;
      EXPECT_NEAR(gradient[k], difference, 1e-3 * (1 + std::abs(difference)));
    }
  }
}

// The derivative as an operation, of every order up to the degree, is the gradient of the one
// before.
TEST(SplineField, DerivativesAreSplinesOfADegreeLess) {
  Random r(4);
  for (int i = 0; i < laws::effort(100); ++i) {
    const Sample sample = random_sample(r);
    Expression now = sample.expression();
    const Vec3 at = random_point(r, sample.grid, 0.2);
    for (int order = 0; order < sample.grid.degrees[0]; ++order) {
      const int k = order % 2;
      Vec3 gradient;
      Evaluator(now).gradients(at.data(), 1, nullptr, gradient.data());
      const Expression next = now->operation->derivative(k, now->arguments());
      ASSERT_NE(next, nullptr);
      const double value = Evaluator(next).value(at);
      EXPECT_NEAR(value, gradient[k], 1e-9 * (1 + std::abs(value)));
      if (is_constant(next)) break;
      now = next;
    }
  }
  const Sample linear{spline_grid({0, 0, 0}, {1, 1, 0}, {2, 2}, 1), {0, 1, 2, 3}};
  const Expression by_x =
      linear.expression()->operation->derivative(0, linear.expression()->arguments());
  EXPECT_EQ(Evaluator(by_x).value({0.5, 0.5, 0}), 2);
  EXPECT_EQ(by_x->operation->derivative(0, by_x->arguments()), nullptr);
}

void expect_bounds(Random& r, const Evaluator& evaluator, const BoundingBox& box) {
  const Interval bound = evaluator.interval(box);
  const Slope slope = evaluator.slope(box);
  for (int j = 0; j < 8; ++j) {
    Vec3 at, gradient;
    double value;
    for (int k = 0; k < 3; ++k) at[k] = laws::number_in(r, {box.lo[k], box.hi[k]});
    evaluator.gradients(at.data(), 1, &value, gradient.data());
    EXPECT_TRUE(bound.contains(value)) << value << " in " << bound.lo << ", " << bound.hi;
    EXPECT_LE(norm(gradient), slope.length * (1 + 1e-12));
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(slope.partial[k].contains(gradient[k]));
  }
}

TEST(SplineField, BoundsHoldOverBoxesOfAnySize) {
  Random r(5);
  for (int i = 0; i < laws::effort(600); ++i) {
    // Every fifth has enough coefficients for the table of blocks.
    const Sample sample = random_sample(r, i % 5 ? 9 : 40);
    Expression f = sample.expression();
    if (i % 3 == 0) {
      const Expression by = f->operation->derivative(r.below(2), f->arguments());
      if (by && !is_constant(by)) f = by;
    }
    const Evaluator evaluator(f);
    for (int j = 0; j < 4; ++j) {
      const Vec3 a = random_point(r, sample.grid, 0.3);
      Vec3 b = r.chance(0.2) ? a : random_point(r, sample.grid, 0.3);
      if (r.chance(0.5)) b = a + r.decades(-6, 0) * (b - a);
      BoundingBox box;
      for (int k = 0; k < 3; ++k) {
        box.lo[k] = std::min(a[k], b[k]);
        box.hi[k] = std::max(a[k], b[k]);
      }
      expect_bounds(r, evaluator, box);
    }
  }
}

TEST(SplineField, BoundsAreTight) {
  Random r(6);
  for (int i = 0; i < laws::effort(100); ++i) {
    const Sample sample = random_sample(r);
    const Evaluator evaluator(sample.expression());
    const Vec3 lo = random_point(r, sample.grid, -0.1), hi = lo + Vec3{1e-4, 1e-4, 1e-4};
    const Interval bound = evaluator.interval({lo, hi});
    EXPECT_LE(bound.hi - bound.lo,
              1.01e-4 * std::sqrt(3) * evaluator.slope({lo, hi}).length + 1e-9);
    // Of the whole box: never beyond the coefficients.
    EXPECT_LE(evaluator.interval({sample.grid.lower, sample.grid.upper}).magnitude(), 2.001);
  }
}

TEST(SplineField, StrangeInputHasValuesAndBounds) {
  Random r(7);
  const Sample sample = random_sample(r);
  const Evaluator evaluator(sample.expression());
  EXPECT_TRUE(std::isnan(evaluator.value({std::nan(""), 0, 0})));
  EXPECT_EQ(evaluator.value({infinity, -infinity, infinity}), evaluator.value({1e9, -1e9, 1e9}));
  const Vec3 all{infinity, infinity, infinity};
  EXPECT_LE(evaluator.interval({-1.0 * all, all}).magnitude(), 2.001);
  EXPECT_FALSE(std::isnan(evaluator.slope({-1.0 * all, all}).length));
}

TEST(SplineField, MovesWithItsInputs) {
  const std::vector<double> c{0, 1, 2, 3, 4, 5, 6, 7, 8};
  const Field f =
      make_field("spline_field", {Vec3{0, 0, 0}, Vec3{1, 1, 0}, std::vector<double>{3, 3}, c, 1.0});
  const Field moved = make_field("translate", {f, Vec3{10, 0, 0}});
  // Degree 1: linear between the coefficients.
  EXPECT_DOUBLE_EQ(Evaluator(f.expression()).value({0.25, 0.25, 7}), 2);
  EXPECT_DOUBLE_EQ(Evaluator(moved.expression()).value({10.25, 0.25, 7}), 2);
  const float at[3] = {0.25f, 0.25f, 0};
  float out;
  Evaluator(f.expression()).values(at, 1, &out);
  EXPECT_FLOAT_EQ(out, 2);
}

TEST(SplineField, SaysWhatIsWrong) {
  const auto make = [](Vec3 upper, std::vector<double> counts, std::vector<double> c, double d) {
    return error_of([&] { make_field("spline_field", {Vec3{}, upper, counts, c, d}); });
  };
  EXPECT_THAT(make({1, 1, 1}, {4, 4}, {1, 2}, 3), HasSubstr("2 coefficients; 16"));
  EXPECT_THAT(make({1, 1, 1}, {4, 3}, {1}, 3), HasSubstr("is 3; whole numbers from 4"));
  EXPECT_THAT(make({1, 1, 1}, {4.5, 4}, {1}, 3), HasSubstr("is 4.5"));
  EXPECT_THAT(make({1, 1, 1}, {4, 4, 4, 4}, {1}, 3), HasSubstr("4 numbers of splines"));
  EXPECT_THAT(make({1, 0, 1}, {4, 4}, {1}, 3), HasSubstr("along y lower is 0"));
  EXPECT_THAT(make({1, 1, 1}, {9, 9}, {1}, 6), HasSubstr("the degree is 6"));
  EXPECT_THAT(make({1, 1, 1}, {9, 9}, {1}, 2.5), HasSubstr("the degree is 2.5"));
  EXPECT_THAT(make({1, 1, 1}, {1e5, 1e5, 1e5}, {1}, 3), HasSubstr("7.45e+06 GiB"));
  EXPECT_THAT(make({1, 1, 1}, {4, 4}, std::vector<double>(16, std::nan("")), 3),
              HasSubstr("finite"));
}

}  // namespace
}  // namespace sardf

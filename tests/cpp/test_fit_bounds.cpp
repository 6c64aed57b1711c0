// Bounds of fitted functions: what they cut off, what the start contradicts, and the mean.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "error_of.hpp"
#include "sanitized.hpp"
#include "sardf/arithmetic.hpp"
#include "sardf/constructor.hpp"
#include "sardf/fit.hpp"

namespace sardf {
namespace {

using testing::HasSubstr;

const Expression x = coordinate(0), y = coordinate(1), z = coordinate(2);
Expression number(double a) { return constant(a); }
Expression gauss(const Expression& a, double width) {
  const Expression s = number(1 / width) * a;
  return exp(-(s * s));
}

FitProblem square(double splines_x, double splines_y) {
  FitProblem p;
  p.grid = spline_grid({0, 0, 0}, {1, 1, 0}, {splines_x, splines_y}, 3);
  p.start = number(0);
  p.factor = x * (number(1) - x);
  p.smoothness = 1;
  return p;
}

// Minimises the integral of F'² over [0, 1] with F = 0 at the ends, the mean m and F <= M. F'' is
// constant off the contact; F = M and F' = 0 at its ends s and 1 - s:
// F = M - M (1 - x / s)² for x < s, whose mean is M - 2 M s / 3: s = 3 (1 - m / M) / 2.
struct HeldArch {
  double mean, most;
  double contact() const { return 1.5 * (1 - mean / most); }
  double at(double t) const {
    const double rest = std::max(0.0, 1 - std::min(t, 1 - t) / contact());
    return most * (1 - rest * rest);
  }
  double energy() const { return 8 * most * most / (3 * contact()); }
};

FitProblem arch_problem(const HeldArch& arch, double offset) {
  FitProblem p = square(60, 4);
  p.start = number(offset);
  p.mean = arch.mean + offset;
  p.at_most = arch.most + offset;
  return p;
}

// By the problem's own rule, whose cells are all full; independent of the product's sums.
double mean_by_the_rule(const FitProblem& p, const Expression& f) {
  const GaussRule rule = gauss_rule(p.points);
  const Evaluator evaluator(f);
  double sum = 0;
  const int nx = p.grid.spans(0), ny = p.grid.spans(1);
  for (int cell = 0; cell < nx * ny; ++cell) {
    for (size_t i = 0; i < size_t(p.points); ++i) {
      for (size_t j = 0; j < size_t(p.points); ++j) {
        const Vec3 at{(cell / ny + rule.at[i]) / nx, (cell % ny + rule.at[j]) / ny, 0};
        sum += rule.weight[i] * rule.weight[j] * evaluator.value(at) / (nx * ny);
      }
    }
  }
  return sum;
}

void expect_arch(const HeldArch& arch, double offset) {
  const FitProblem p = arch_problem(arch, offset);
  const FitResult result = fit(p);
  const Expression f = fitted_expression(p, result.coefficients);
  const Evaluator evaluator(f);
  for (double t = 0.01; t < 1; t += 0.02) {
    EXPECT_NEAR(evaluator.value({t, 0.4, 0}) - offset, arch.at(t), 2e-3 * arch.most) << t;
  }
  EXPECT_NEAR(result.report.energy_after, arch.energy(), 2e-3 * arch.energy());
  // The range is that of the arch: from 0 to its bound.
  EXPECT_NEAR(mean_by_the_rule(p, f), *p.mean, 1e-6 * arch.most);
  EXPECT_NEAR(result.report.mean, *p.mean, 1e-6 * arch.most);
}

TEST(FitBounds, MeanAndBoundHoldTogether) { expect_arch({0.8, 1}, 0); }

// Values a thousand times the range: what bounds may be left by, relative to the values, is then
// a part of the range.
TEST(FitBounds, MeanHoldsRelativeToTheRange) {
  expect_arch({0.8, 1}, 1000);
  expect_arch({0.02, 0.025}, -100);
}

TEST(FitBounds, MeanNearItsBound) { expect_arch({0.9, 1}, 10); }

TEST(FitBounds, RefuseAMeanThatTheyContradict) {
  FitProblem p = arch_problem({0.8, 1}, 0);
  p.mean = 1.1;
  EXPECT_THAT(error_of([&] { fit(p); }), HasSubstr("the mean is 1.1; at_most is 1"));
  // F is 0 at the ends, and splines cannot rise to 1 at once.
  p.mean = 0.9999;
  EXPECT_THAT(error_of([&] { fit(p); }), HasSubstr("cannot hold together with"));
}

// The start leaves its bound by a bump between two cells, where no rule of Gauss has a point: only
// the measurement of the cut sees it. Without it F = x is the minimum, of energy 1e-3.
FitProblem bump_between_points(double height) {
  FitProblem p = square(9, 4);
  p.points = 2;
  p.smoothness = 1e-3;
  p.values = x;
  p.start = x + number(height) * gauss(x - number(0.5), 0.005);
  p.at_most = 1;
  return p;
}

TEST(FitBounds, RefuseACutThatIsLarge) {
  // F is 0.5 at the bump; its range is 1.
  const auto fitted = [](double cut) { return fit(bump_between_points(0.5 + cut)); };
  EXPECT_NEAR(fitted(0.045).report.cut, 0.045, 1e-3);
  EXPECT_THAT(error_of([&] { fitted(0.055); }), HasSubstr("would be cut off"));
  const std::string error = error_of([&] { fitted(0.25); });
  EXPECT_THAT(error, HasSubstr("the function is 1.25"));
  EXPECT_THAT(error, HasSubstr("at (0.50"));
  EXPECT_THAT(error, HasSubstr("but at_most is 1: 0.25 would be cut off"));
  EXPECT_THAT(error, HasSubstr("whose range is 1; up to 5 % are accepted"));
  EXPECT_THAT(error, HasSubstr("More splines or points, or wider bounds"));
}

// A bump of the start on the feature x = 0 of width 0.004, at a place where no point of the
// quadrature and no middle of a cell is.
TEST(FitBounds, FindWhereTheStartBreaksThemOnTheFeature) {
  FitProblem p = square(7, 7);
  p.at_most = 0.5;
  p.start = gauss(y - number(0.3137), 0.004) * (number(1) - x);
  const std::string error = error_of([&] { fit(p); });
  EXPECT_THAT(error, HasSubstr("where factor is 0"));
  EXPECT_THAT(error, HasSubstr("at (0, 0.31"));
  EXPECT_THAT(error, HasSubstr("at_most is 0.5"));
  // Nothing is wrong where that part of the feature lies outside of the solid.
  p.solid = y - number(0.4);
  EXPECT_EQ(error_of([&] { fit(p); }), "no error");
}

// The same in space, with a factor of third order on a curved feature.
TEST(FitBounds, FindASmallBumpOnASphere) {
  const Expression u = length(length(x, y), z) - number(0.7);
  const Expression off = length(length(x - number(0.42), y - number(0.42)), z - number(0.37));
  FitProblem p;
  p.grid = spline_grid({-1, -1, -1}, {1, 1, 1}, {7, 7, 7}, 3);
  p.start = number(0.5) - gauss(off, 0.03);
  p.factor = u * u * u;
  p.values = number(0.5) + x;
  p.at_least = 0;
  EXPECT_THAT(error_of([&] { fit(p); }), HasSubstr("where factor is 0"));
  p.at_least = -2;
  EXPECT_EQ(error_of([&] { fit(p); }), "no error");
}

// The start touches its bound on all of the feature, and intervals cannot exclude that it breaks
// it.
FitProblem touching_problem() {
  const Expression u = length(length(x, y), z) - number(0.5);
  FitProblem p;
  p.grid = spline_grid({-1, -1, -1}, {1, 1, 1}, {7, 7, 7}, 3);
  p.start = number(1) + u - u * u - u;
  p.factor = u * u * u;
  p.values = number(1) - u * u + number(0.01) * x;
  p.at_most = 1;
  return p;
}

TEST(FitBounds, AcceptAStartThatTouchesThem) {
  EXPECT_EQ(error_of([] { fit(touching_problem()); }), "no error");
}

TEST(FitBoundsSlow, SearchIsCancelledAtOnce) {
  using Clock = std::chrono::steady_clock;
  const FitProblem p = touching_problem();
  // The search reports from 0.28 to 0.325.
  for (const double at : {0.285, 0.3, 0.31}) {
    Clock::time_point asked{};
    const auto stop = [&](double share) {
      if (share < at) return true;
      asked = Clock::now();
      return false;
    };
    EXPECT_THROW(fit(p, stop), Cancelled);
    EXPECT_LT(std::chrono::duration<double>(Clock::now() - asked).count(), at_once) << at;
  }
}

}  // namespace
}  // namespace sardf

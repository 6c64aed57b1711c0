// Fitted functions: exact solutions, constraints, what cannot be, and how the work behaves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <chrono>
#include <cmath>
#include <random>

#include "error_of.hpp"
#include "sanitized.hpp"
#include "sardf/arithmetic.hpp"
#include "sardf/constructor.hpp"
#include "sardf/fit.hpp"
#include "sardf/scene_file.hpp"
#include "sardf/scene_solution.hpp"
#include "sardf/shapes_fit.hpp"

namespace sardf {
namespace {

using testing::HasSubstr;

const Expression x = coordinate(0), y = coordinate(1), z = coordinate(2);
Expression number(double a) { return constant(a); }

// F = 0 on x = 0 and 1 on x = 1 of the unit cube: exactly x.
FitProblem slab(double n) {
  FitProblem p;
  p.grid = spline_grid({0, 0, 0}, {1, 1, 1}, {n, n, n}, 3);
  const Expression rest = number(1) - x;
  p.start = x * x / (x * x + rest * rest);
  p.factor = x * rest;
  p.smoothness = 1;
  return p;
}

Expression annulus_solid(double a, double b) {
  const Expression r = length(x, y);
  return min(r - number(a), number(b) - r);
}

FitProblem annulus(double n) {
  FitProblem p;
  p.grid = spline_grid({-1.5, -1.5, 0}, {1.5, 1.5, 0}, {n, n}, 3);
  const Expression r = length(x, y), u1 = r - number(0.5), u2 = number(1.5) - r;
  p.start = u2 / (u1 + u2);
  p.factor = u1 * u2;
  p.solid = annulus_solid(0.5, 1.5);
  p.smoothness = 1;
  return p;
}

// Value targets with an active lower and upper bound: F wants to be 2 sin, may be -0.5 to 1.
FitProblem bounded() {
  FitProblem p;
  p.grid = spline_grid({0, 0, 0}, {1, 1, 0}, {24, 24}, 3);
  p.start = number(0.25);
  p.factor = x * (number(1) - x);
  p.values = number(2) * function("sin", {number(9) * x + number(2) * y});
  p.smoothness = 1e-3;
  p.at_least = -0.5;
  p.at_most = 1;
  return p;
}

std::vector<Vec3> random_points(const SplineGrid& grid, size_t count) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> share(0, 1);
  std::vector<Vec3> points(count);
  for (Vec3& at : points) {
    for (size_t k = 0; k < size_t(grid.dimensions); ++k) {
      at[k] = grid.lower[k] + share(random) * (grid.upper[k] - grid.lower[k]);
    }
  }
  return points;
}

TEST(Fit, FindsTheLinearFunctionOfASlab) {
  const FitProblem p = slab(12);
  const FitResult result = fit(p);
  const Evaluator f(fitted_expression(p, result.coefficients));
  for (const Vec3& at : random_points(p.grid, 1000)) EXPECT_NEAR(f.value(at), at[0], 1e-4);
  EXPECT_NEAR(result.report.energy_after, 1, 1e-5);
  EXPECT_GE(result.report.energy_after, 1 - 1e-12);  // the exact minimum is 1
  EXPECT_NEAR(result.report.finer_energy, 1, 1e-4);
  EXPECT_DOUBLE_EQ(result.report.volume, 1);
}

// The whole way by the product's own quadrature of a solid.
TEST(Fit, FindsTheLogarithmOfAnAnnulus) {
  const FitProblem p = annulus(24);
  const FitResult result = fit(p);
  const Evaluator f(fitted_expression(p, result.coefficients));
  for (const Vec3& at : random_points(p.grid, 4000)) {
    const double r = norm(at);
    if (r < 0.5 || r > 1.5) continue;
    EXPECT_NEAR(f.value(at), 1 - std::log(r / 0.5) / std::log(3), 1e-4);
  }
  const double pi = std::acos(-1.0);
  EXPECT_NEAR(result.report.energy_after, 2 * pi / std::log(3), 1e-3);
  EXPECT_NEAR(result.report.volume, pi * (1.5 * 1.5 - 0.25), 1e-4);
  EXPECT_LE(std::abs(result.report.volume - 2 * pi), 10 * result.report.volume_error + 1e-6);
}

TEST(Fit, MeasuresABall) {
  const SplineGrid grid = spline_grid({-1.1, -1.2, -1.3}, {1.1, 1.2, 1.3}, {9, 9, 9}, 3);
  const Expression ball = number(1) - length(length(x, y), z);
  const Quadrature q = quadrature_over(grid, ball, 4, {});
  const double exact = 4.0 / 3 * std::acos(-1.0);
  EXPECT_NEAR(q.volume, exact, 2e-3 * exact);
  FitProblem p;
  p.grid = grid;
  p.start = number(0);
  p.factor = number(1);
  p.solid = ball;
  p.values = x;
  // The integral of x² is a fifth of the volume.
  EXPECT_NEAR(fit(p).report.energy_before, exact / 5, 3e-3 * exact / 5);
}

// With factor 1 and polynomials of the splines' degree as values, nothing is left.
TEST(FitSlow, ReproducesWhatSplinesCan) {
  for (const double degree : {1.0, 2.0, 3.0, 4.0, 5.0}) {
    FitProblem p;
    p.grid = spline_grid({-1, 0, 2}, {1, 1, 3}, {8, 7, 9}, degree);
    p.start = number(0.5);
    p.factor = number(1);
    p.values = number(1) + x;
    for (int k = 1; k < degree; ++k) p.values = p.values * (k % 2 ? y + number(1) : z);
    p.points = 6;
    const FitResult result = fit(p);
    const Evaluator f(fitted_expression(p, result.coefficients)), wanted(p.values);
    for (const Vec3& at : random_points(p.grid, 100)) {
      EXPECT_NEAR(f.value(at), wanted.value(at), 1e-9) << degree;
    }
    EXPECT_LE(result.report.rms_after, 1e-6);
  }
}

// grad F . grad u = -2 with u = x and F = 1 on x = 0: F = 1 - 2x.
TEST(Fit, FollowsSlopes) {
  FitProblem p;
  p.grid = spline_grid({0, 0, 0}, {1, 1, 0}, {6, 6}, 3);
  p.start = number(1) - x * x;
  p.factor = x;
  p.along = x;
  p.slope = number(-2);
  const FitResult result = fit(p);
  const Evaluator f(fitted_expression(p, result.coefficients));
  for (const Vec3& at : random_points(p.grid, 100)) EXPECT_NEAR(f.value(at), 1 - 2 * at[0], 1e-9);
  // -2x + 2 was left: its mean square is 4 / 3.
  EXPECT_NEAR(result.report.rms_before, std::sqrt(4.0 / 3), 1e-12);
}

double mean_of(const Expression& f, const SplineGrid& grid, int points) {
  const Quadrature q = quadrature_over(grid, constant(1), 1, {});
  double sum = 0, weights = 0;
  const GaussRule rule = gauss_rule(points);
  const Evaluator evaluator(f);
  for (const size_t cell : q.full) {
    const std::array<int, 3> at = grid.cell(cell);
    for (size_t i = 0; i < rule.at.size(); ++i) {
      for (size_t j = 0; j < rule.at.size(); ++j) {
        const Vec3 p{grid.lower[0] + (at[0] + rule.at[i]) / grid.per_length(0),
                     grid.lower[1] + (at[1] + rule.at[j]) / grid.per_length(1), 0};
        sum += rule.weight[i] * rule.weight[j] * evaluator.value(p);
        weights += rule.weight[i] * rule.weight[j];
      }
    }
  }
  return sum / weights;
}

TEST(Fit, PrescribesTheMean) {
  FitProblem p = bounded();
  p.at_least = p.at_most = std::nullopt;
  p.mean = 0.3;
  p.points = 6;
  const FitResult result = fit(p);
  EXPECT_NEAR(mean_of(fitted_expression(p, result.coefficients), p.grid, 6), 0.3, 1e-12);
  EXPECT_LE(result.report.residual, 1e-10);
  // Alone with smoothness and a free boundary the mean decides: a constant.
  FitProblem flat;
  flat.grid = p.grid;
  flat.start = x * y;
  flat.factor = number(1);
  flat.smoothness = 1;
  flat.mean = 5;
  const Evaluator f(fitted_expression(flat, fit(flat).coefficients));
  for (const Vec3& at : random_points(p.grid, 100)) EXPECT_NEAR(f.value(at), 5, 1e-8);
}

TEST(FitSlow, BoundsHoldEverywhereAndTheMeanToo) {
  FitProblem p = bounded();
  FitProblem free = p;
  free.at_least = free.at_most = std::nullopt;
  const FitResult without = fit(free), result = fit(p);
  const Evaluator f(fitted_expression(p, result.coefficients));
  const std::vector<Vec3> points = random_points(p.grid, 1000000);
  std::vector<double> values(points.size());
  f.values(points[0].data(), points.size(), values.data());
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  EXPECT_GE(*least, -0.5);
  EXPECT_LE(*most, 1);
  EXPECT_NEAR(*least, -0.5, 1e-6);  // both are reached
  EXPECT_NEAR(*most, 1, 1e-6);
  const Interval proven = f.interval({{0, 0, 0}, {1, 1, 0}});
  EXPECT_GE(proven.lo, -0.5 - 1e-15);  // rounded outwards
  EXPECT_LE(proven.hi, 1 + 1e-15);
  // Between the points of the quadrature little was cut.
  EXPECT_LE(result.report.cut, 0.02);
  EXPECT_GT(result.report.energy_after, without.report.energy_after);
  EXPECT_LT(result.report.energy_after, result.report.energy_before);
  p.mean = 0.2;
  const FitResult both = fit(p);
  const Expression held = fitted_expression(p, both.coefficients);
  EXPECT_NEAR(mean_of(held, p.grid, p.points), 0.2, 1e-6 * 1.5);
  // By a finer rule what is cut between the points shows.
  EXPECT_NEAR(mean_of(held, p.grid, 10), 0.2, 1e-4);
}

// No other function with the bounds has less energy: the directional derivative towards any
// feasible function is not negative.
TEST(Fit, BoundsGiveTheConstrainedMinimum) {
  FitProblem p;  // one dimension in two: exact obstacle problem
  p.grid = spline_grid({0, 0, 0}, {1, 1, 0}, {60, 4}, 3);
  p.start = number(0);
  p.factor = x * (number(1) - x);
  p.smoothness = 1;
  p.values = number(1);
  p.values_weight = 8;
  p.at_most = 0.25;
  const Evaluator f(fitted_expression(p, fit(p).coefficients));
  // -F'' + 8 (F - 1) = 0 off the contact, F = 0.25 and F' = 0 at its ends s.
  const double k = std::sqrt(8.0), s = std::acosh(1 / 0.75) / k;
  for (double at = 0.01; at < 0.5; at += 0.02) {
    const double exact = at < s ? 1 - 0.75 * std::cosh(k * (s - at)) : 0.25;
    EXPECT_NEAR(f.value({at, 0.3, 0}), exact, 1e-3) << at;
  }
}

TEST(FitSlow, DoesNotDependOnTheNumberOfThreads) {
  const FitProblem flat = annulus(12), deep = slab(15), held = bounded();
  for (const FitProblem& p : {flat, deep, held}) {
    std::vector<std::vector<double>> results;
    for (const size_t threads : {size_t(1), size_t(2), size_t(5)}) {
      tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      results.push_back(fit(p).coefficients);
    }
    EXPECT_EQ(results[0], results[1]);
    EXPECT_EQ(results[0], results[2]);
  }
}

TEST(FitSlow, IsCancelledAtOnce) {
  using Clock = std::chrono::steady_clock;
  const FitProblem p = slab(24);
  for (const double at : {0.0, 0.15, 0.25, 0.4}) {
    Clock::time_point asked{};
    double shown = 0;
    EXPECT_THROW(fit(p,
                     [&](double share) {
                       EXPECT_GE(share, shown);
                       shown = share;
                       if (share < at) return true;
                       asked = Clock::now();
                       return false;
                     }),
                 Cancelled);
    EXPECT_LT(std::chrono::duration<double>(Clock::now() - asked).count(), at_once) << at;
  }
}

TEST(Fit, SaysWhatCannotBe) {
  const auto error = [](FitProblem p) { return error_of([&] { fit(p); }); };
  FitProblem p = slab(6);
  p.smoothness = 0;
  EXPECT_THAT(error(p), HasSubstr("nothing is to be minimised"));
  p.slope = x;
  EXPECT_THAT(error(p), HasSubstr("slope is given without along"));
  p = slab(6);
  p.solid = number(-1);
  EXPECT_THAT(error(p), HasSubstr("the solid is empty"));
  p = slab(6);
  p.at_least = 1;
  p.at_most = 0;
  EXPECT_THAT(error(p), HasSubstr("at_least is 1 and at_most only 0"));
  p.at_most = std::nullopt;
  p.mean = 0.5;
  EXPECT_THAT(error(p), HasSubstr("the mean is 0.5; at_least is 1"));
  p.mean = std::nullopt;
  p.at_least = 0.5;  // but F is 0 on x = 0
  EXPECT_THAT(error(p), HasSubstr("where factor is 0"));
  EXPECT_THAT(error(p), HasSubstr("at (0, "));
  p = slab(6);
  p.start = number(1) / (x - x);
  EXPECT_THAT(error(p), HasSubstr("start is not a finite number at ("));
  p = slab(6);
  p.factor = number(0);
  p.mean = 3;
  EXPECT_THAT(error(p), HasSubstr("factor is 0 on all of the solid"));
  p = annulus(8);
  p.start = z;
  EXPECT_THAT(error(p), HasSubstr("start depends on z"));
  p = slab(6);
  p.grid = spline_grid({0, 0, 0}, {1, 1, 1}, {200, 200, 200}, 3);
  EXPECT_THAT(error(p), HasSubstr("200 x 200 x 200 splines needs about 6"));
}

// One point for each cell is less than there are splines: an energy far below the minimum.
TEST(Fit, RefusesAQuadratureThatIsTooCoarse) {
  FitProblem p;
  p.grid = spline_grid({0, 0, 0}, {1, 1, 0}, {20, 20}, 3);
  p.start = number(0);
  p.factor = number(1);
  p.values = function("sin", {number(40) * x * y});
  p.smoothness = 1e-12;
  p.points = 1;
  EXPECT_THAT(error_of([&] { fit(p); }), HasSubstr("the quadrature is too coarse"));
}

// circle's distance depends on z; a plane ring does not.
const std::string ring = "\"=abs(length(x, y) - 1)\"";
const std::string circle_in_space = R"json({"circle": {"radius": 1}})json";

std::string scene_with(const std::string& distance) {
  return R"json({
  "sardf": 1,
  "fields": {
    "u": )json" +
         distance + R"json(,
    "F": {"fitted": {"start": "=1 - u^2", "factor": "=u^3", "lower": [-2, -2, 0],
                     "upper": [2, 2, 0], "splines": [9, 9], "values": "=1 - u/(1 + u)"}},
    "part": {"sphere": {"radius": 1}}},
  "solid": "part",
  "materials": {"a": {}},
  "attributes": {"density": {"value": "F"}}})json";
}
std::string plane_scene() { return scene_with(ring); }

TEST(FittedScene, CarriesItsSolution) {
  EXPECT_THAT(error_of([] { parse_scene(scene_with(circle_in_space), "s"); }),
              HasSubstr("depends on z"));
  const SceneDescription read = parse_scene(plane_scene(), "s");
  const std::vector<SolvedField> solved = solve_fields(read);
  ASSERT_EQ(solved.size(), 1u);
  EXPECT_EQ(solved[0].name, "F");
  EXPECT_EQ(solved[0].result->coefficients.size(), 81u);
  const std::string text = scene_text(read, solved_arguments(read));
  EXPECT_THAT(text, HasSubstr("\"coefficients\""));
  const SceneDescription again = parse_scene(text, "s");
  EXPECT_EQ(again.fields[1].field.expression(), read.fields[1].field.expression());
  EXPECT_EQ(scene_text(again), text);
}

TEST(FittedScene, IsSolvedOnceAndReportsToTheScope) {
  std::string text = plane_scene();
  text.replace(text.find("[9, 9]"), 6, "[11, 10]");
  int calls = 0;
  {
    const ProgressScope outer([&](double) { return ++calls > 0; });
    parse_scene(text, "s");
    EXPECT_GT(calls, 0);
    calls = 0;
    parse_scene(text, "s");
    EXPECT_EQ(calls, 0);
    const ProgressScope inner([](double) { return false; });
    text.replace(text.find("[11, 10]"), 8, "[10, 11]");
    EXPECT_THROW(parse_scene(text, "s"), Cancelled);
  }
  EXPECT_FALSE(ProgressScope::current());
}

TEST(FittedScene, RefusesWhatNoMemoryHolds) {
  std::string text = plane_scene();
  text.replace(text.find("[9, 9]"), 6, "[100000, 100000, 100000]");
  EXPECT_THAT(error_of([&] { parse_scene(text, "s"); }), HasSubstr("GiB"));
}

}  // namespace
}  // namespace sardf

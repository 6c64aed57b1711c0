// Fitted functions along the S curve and in the cube with the spiral, against golden
// values.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "golden_fields.hpp"
#include "golden_helix.hpp"
#include "sardf/arithmetic.hpp"
#include "sardf/constructor.hpp"
#include "sardf/fit.hpp"

namespace sardf {
namespace {

using golden::Table;

class GoldenFitFeatures : public golden::InEachFolder {};
INSTANTIATE_TEST_SUITE_P(Each, GoldenFitFeatures, golden::each_folder(), golden::folder_name);

// Makes a constructor with these arguments by name, the others at their defaults.
Field make(const std::string& name, const std::map<std::string, Value>& given) {
  const Constructor& constructor = *find_constructor(name);
  std::vector<Value> arguments;
  for (const ParameterInfo& info : constructor.parameters) {
    const auto found = given.find(info.name);
    arguments.push_back(found == given.end() ? info.default_value : found->second);
  }
  return make_field(constructor, std::move(arguments));
}

// In the plane z = 0: the fit is a function of x and y.
Expression s_curve(const Table& table) {
  std::vector<Vec3> points;
  for (const Vec2& p : table.parameter("S_control_points").get<std::vector<Vec2>>()) {
    points.push_back({p[0], p[1], 0});
  }
  const Expression u = make("bspline_curve", {{"control_points", points}}).expression();
  return substitute(u, {coordinate(0), coordinate(1), constant(0)});
}

FitProblem plane_problem(const Table& table, const Expression& u) {
  const double n = table.header.at("N");
  const auto domain = table.header.at("domain").get<std::vector<Vec2>>();
  FitProblem p;
  p.grid = spline_grid({domain[0][0], domain[0][1], 0}, {domain[1][0], domain[1][1], 0}, {n, n}, 3);
  p.start = constant(1) - constant(table.parameter("c")) * u * u;
  p.factor = u * u * u;
  return p;
}

void expect_least_squares(const Table& table) {
  const Expression u = s_curve(table);
  FitProblem p = plane_problem(table, u);
  p.values = constant(1) - u / (constant(1) + u);
  const FitResult result = fit(p);
  EXPECT_NEAR(result.report.rms_before, table.header.at("rms_before"), 1e-8);
  EXPECT_NEAR(result.report.rms_after, table.header.at("rms_after"), 1e-8);
  golden::expect_field(table, fitted_expression(p, result.coefficients), "F", {1e-5});
}

TEST_P(GoldenFitFeatures, LeastSquares21) { expect_least_squares(read("fig_bst_09c_lsq_21")); }
TEST_P(GoldenFitFeatures, LeastSquares81) { expect_least_squares(read("fig_bst_09c_lsq_81")); }

TEST_P(GoldenFitFeatures, Slopes21) {
  const Table table = read("fig_bst_09d_gradient_21");
  const Expression u = s_curve(table);
  FitProblem p = plane_problem(table, u);
  p.along = u;
  p.slope = constant(table.parameter("slope"));
  const FitResult result = fit(p);
  EXPECT_NEAR(result.report.rms_before, table.header.at("rms_before"), 1e-8);
  EXPECT_NEAR(result.report.rms_after, table.header.at("rms_after"), 1e-8);
  golden::expect_field(table, fitted_expression(p, result.coefficients), "F", {1e-5});
}

// The reference's quadrature: Gauss points on equal boxes, those outside the solid left out.
Quadrature masked(const SplineGrid& grid, const Expression& solid, int boxes, int points) {
  const GaussRule rule = gauss_rule(points);
  const Evaluator inside(solid);
  std::vector<Vec3> at;
  std::vector<double> weight;
  const int n = boxes * points;
  for (int i = 0; i < n * n * n; ++i) {
    const int place[3] = {i / n / n, i / n % n, i % n};
    Vec3 p;
    double w = 1;
    for (size_t k = 0; k < 3; ++k) {
      const double side = (grid.upper[k] - grid.lower[k]) / boxes;
      const size_t q = size_t(place[k] % points);
      p[k] = grid.lower[k] + (place[k] / points + rule.at[q]) * side;
      w *= rule.weight[q] * side;
    }
    if (!(inside.value(p) > 0)) continue;
    at.push_back(p);
    weight.push_back(w);
  }
  return quadrature_of(grid, at, weight);
}

TEST_P(GoldenFitFeatures, CubeWithSpiral) {
  Table table = read("fig_bst_14b_ritz_7");
  const double a = table.parameter("cube_half"), hole = table.parameter("hole_r");
  const Expression x = coordinate(0), y = coordinate(1), z = coordinate(2);
  const auto number = [](double v) { return constant(v); };
  const std::vector<Expression> walls{number(a) + x, number(a) - x, number(a) + y, number(a) - y,
                                      length(x, y) - number(hole)};
  // The r-equivalence of order 1 of the distances to walls and hole.
  Expression reciprocals = number(0), solid = min(number(a) + z, number(a) - z);
  for (const Expression& wall : walls) {
    reciprocals = reciprocals + number(1) / abs(wall);
    solid = min(solid, wall);
  }
  const Expression u1 = number(1) / reciprocals;
  // From -360 to 360 degrees; z = pitch * angle / 360.
  const double turns = 2;
  const Expression helix = make("helix", {{"center", Vec3{0, 0, 0}},
                                          {"axis", Vec3{0, 0, 1}},
                                          {"radius", table.parameter("helix_rad").get<double>()},
                                          {"pitch", 2 * a / turns},
                                          {"start", -180 * turns},
                                          {"end", 180 * turns}})
                               .expression();
  const Expression u2 = max(number(0), helix - number(table.parameter("tube_r")));
  const Expression p1 = number(1) - number(table.parameter("P1_coef")) * u1 * u1;
  const Expression p2 = number(table.parameter("P2_coef")) * exp(-(u2 * u2));
  FitProblem p;
  p.grid = spline_grid({-a, -a, -a}, {a, a, a}, {7, 7, 7}, 3);
  p.start = (p1 * u2 + p2 * u1) / (u1 + u2);
  p.factor = u1 * u2;
  p.smoothness = 1;
  const Quadrature quadrature =
      masked(p.grid, solid, table.header.at("cells"), table.header.at("quad"));
  EXPECT_EQ(quadrature.at.size(), table.header.at("quad_points").get<size_t>());
  const FitResult result = fit(p, quadrature);
  // Where the file's helix is not the nearest turn its gradient is another, hence the energy.
  const golden::HelixSearch search{{}, table.parameter("helix_rad"), 2 * a / turns};
  const auto others = double(std::ranges::count_if(
      quadrature.at, [&](const Vec3& point) { return search.misses_the_nearest(point); }));
  EXPECT_LT(others, 0.001 * double(quadrature.at.size()));
  const double energy_slack = 1e-6 + 2 * quadrature.weight[0] * others;
  EXPECT_NEAR(result.report.energy_before, table.header.at("energy_before"), energy_slack);
  EXPECT_NEAR(result.report.energy_after, table.header.at("energy_after"), energy_slack);
  const double value_slack = 1e-3 * others;
  search.remove_missed(table);
  golden::expect_field(table, fitted_expression(p, result.coefficients), "F", {1e-6}, value_slack);
}

}  // namespace
}  // namespace sardf

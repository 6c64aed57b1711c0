// Fitted functions against golden values: Ritz's method where the exact solution is known.
#include <gtest/gtest.h>

#include <cmath>

#include "golden_fields.hpp"
#include "sardf/arithmetic.hpp"
#include "sardf/constructor.hpp"
#include "sardf/fit.hpp"
#include "sardf/shapes_fit.hpp"

namespace sardf {
namespace {

using golden::Table;

class GoldenFits : public golden::InEachFolder {};
INSTANTIATE_TEST_SUITE_P(Each, GoldenFits, golden::each_folder(), golden::folder_name);

// A derivative of cubics on spans of a quarter loses about their reciprocal.
void expect_rows(const Table& table, const Expression& f) {
  golden::expect_field(table, f, "F", {10 * table.tolerance()});
}

Expression squared(const Expression& a) { return a * a; }

// F = 0 on x = 0, 1 on x = 1; from inverse distances with exponent 2.
TEST_P(GoldenFits, SlabByRitz) {
  const Table table = read("bst_ritz_slab3d");
  const Expression x = coordinate(0), rest = constant(1) - x;
  FitProblem p;
  p.grid = spline_grid({0, 0, 0}, {1, 1, 1}, {7, 7, 7}, 3);
  p.start = squared(x) / (squared(x) + squared(rest));
  p.factor = x * rest;
  p.smoothness = 1;
  const FitResult result = fit(p);
  EXPECT_NEAR(result.report.energy_before, table.header.at("energy_before"), 1e-10);
  EXPECT_NEAR(result.report.energy_after, table.header.at("energy_after"), 1e-10);
  EXPECT_EQ(result.report.quadrature_points, 4096u);
  EXPECT_LE(result.report.residual, 1e-10);
  expect_rows(table, fitted_expression(p, result.coefficients));
}

// The reference's quadrature: Gauss points along the radius, equal angles.
Quadrature polar_quadrature(const SplineGrid& grid, double inner, double outer) {
  constexpr int radii = 48, angles = 256;
  const GaussRule rule = gauss_rule(radii);
  std::vector<Vec3> at;
  std::vector<double> weight;
  for (size_t i = 0; i < radii; ++i) {
    const double r = inner + (outer - inner) * rule.at[i];
    for (int j = 0; j < angles; ++j) {
      const double t = 2 * std::acos(-1.0) * (j + 0.5) / angles;
      at.push_back({r * std::cos(t), r * std::sin(t), 0});
      weight.push_back(rule.weight[i] * (outer - inner) * r * 2 * std::acos(-1.0) / angles);
    }
  }
  return quadrature_of(grid, at, weight);
}

TEST_P(GoldenFits, AnnulusByRitz) {
  const Table table = read("bst_ritz_annulus");
  const double a = table.parameter("a"), b = table.parameter("b");
  const double fa = table.parameter("F_a"), fb = table.parameter("F_b");
  const Expression r = length(coordinate(0), coordinate(1));
  const Expression u1 = r - constant(a), u2 = constant(b) - r;
  FitProblem p;
  p.grid = spline_grid({-b, -b, 0}, {b, b, 0}, {12, 12}, 3);
  p.start = (constant(fa) * u2 + constant(fb) * u1) / (u1 + u2);
  p.factor = u1 * u2;
  p.smoothness = 1;
  const FitResult result = fit(p, polar_quadrature(p.grid, a, b));
  EXPECT_NEAR(result.report.energy_before, table.header.at("energy_before"), 1e-9);
  EXPECT_NEAR(result.report.energy_after, table.header.at("energy_after"), 1e-9);
  EXPECT_GE(result.report.energy_after, table.header.at("exact_energy"));
  expect_rows(table, fitted_expression(p, result.coefficients));
}

}  // namespace
}  // namespace sardf

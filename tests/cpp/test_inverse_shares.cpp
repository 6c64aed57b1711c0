// Shares by inverse distances through products, against the formula with powers in long double.
#include "sardf/inverse_shares.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sardf/arithmetic.hpp"
#include "sardf/evaluate.hpp"

namespace sardf {
namespace {

std::vector<Expression> distances(size_t n) {
  std::vector<Expression> u{abs(coordinate(0)), abs(coordinate(1)), abs(coordinate(2))};
  u.push_back(constant(2));
  u.resize(n);
  return u;
}

/// Weights relative to the nearest, so that none overflows; even powers go through squares, which
/// are limited to 1e37.
std::vector<long double> expected(const Vec3& p, size_t n, double k, double least) {
  const double most = std::fmod(k, 2) == 0 ? std::sqrt(1e37) : 1e37;
  long double u[] = {std::abs(p[0]), std::abs(p[1]), std::abs(p[2]), 2};
  for (long double& each : u) each = std::min<long double>(each, most);
  std::vector<long double> w(n);
  const long double nearest = *std::min_element(u, u + n);
  long double total = 0;
  for (size_t i = 0; i < n; ++i) {
    w[i] = nearest <= least ? (u[i] <= least ? 1 : 0) : std::pow(nearest / u[i], k);
    total += w[i];
  }
  for (long double& each : w) each /= total;
  return w;
}

std::vector<Vec3> places() {
  std::vector<Vec3> all{{0, 1, 2},          {0, 0, 3},       {0, 0, 0},         {1e-13, 1, 1},
                        {1e-13, 0, 1},      {1e-7, 2e-7, 1}, {1e-11, 2e-11, 1}, {1e12, 1, 1e-3},
                        {1e18, 2e18, 3e18}, {1e30, 2e30, 1}, {5, 5, 5}};
  std::mt19937 random(7);
  std::uniform_real_distribution<double> decade(-9, 9);
  for (int i = 0; i < 3000; ++i)
    all.push_back(
        {std::pow(10, decade(random)), std::pow(10, decade(random)), std::pow(10, decade(random))});
  return all;
}

TEST(InverseShares, AreThoseOfTheFormula) {
  constexpr double least = 1e-12;
  const std::vector<Vec3> points = places();
  for (size_t n = 2; n <= 4; ++n)
    for (const double k : {1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 7.5, 8.0}) {
      const std::vector<Expression> shares = inverse_shares(distances(n), k, least);
      if (k * double(n - 1) > 8) {
        EXPECT_TRUE(shares.empty()) << n << ' ' << k;
        continue;
      }
      ASSERT_EQ(shares.size(), n);
      const Evaluator evaluator(shares);
      for (const Vec3& p : points) {
        const Vec3 rounded{float(p[0]), float(p[1]), float(p[2])};
        double exact[4];
        float fast[4];
        evaluator.values(p, exact);
        const float q[] = {float(p[0]), float(p[1]), float(p[2])};
        evaluator.values(q, 1, fast);
        const std::vector<long double> w = expected(p, n, k, least);
        const std::vector<long double> v = expected(rounded, n, k, least);
        for (size_t i = 0; i < n; ++i) {
          EXPECT_NEAR(exact[i], double(w[i]), 1e-14) << n << ' ' << k << ' ' << p[0];
          EXPECT_NEAR(fast[i], double(v[i]), 4e-6) << n << ' ' << k << ' ' << p[0];
        }
      }
    }
}

TEST(InverseShares, AreLeftToLogarithmsElsewhere) {
  EXPECT_TRUE(inverse_shares(distances(3), 1.6, 1e-12).empty());
  EXPECT_TRUE(inverse_shares(distances(3), 0.5, 1e-12).empty());
  EXPECT_TRUE(inverse_shares(distances(1), 1, 1e-12).empty());
  EXPECT_TRUE(inverse_shares(std::vector<Expression>(5, coordinate(0)), 1, 1e-12).empty());
}

TEST(WeightedSum, TakesEachValueWithItsFactor) {
  std::vector<Expression> values;
  for (int i = 0; i < 8; ++i) values.push_back(pow(coordinate(0), constant(i)));
  const std::vector<double> factors{3, 0, -2, 5, 0.5, 0, 7, -1};
  const double x = 1.25;
  double sum = 0;
  for (int i = 0; i < 8; ++i) sum += factors[i] * std::pow(x, i);
  EXPECT_NEAR(Evaluator(weighted_sum(values, factors)).value({x, 0, 0}), sum, 1e-13);
  EXPECT_EQ(weighted_sum(values, std::vector<double>(8, 0.0)), constant(0));
}

}  // namespace
}  // namespace sardf

// Taylor coefficients in double against known ones.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "sardf/numbers/series.hpp"

namespace sardf {
namespace {

constexpr int order = 14;
using Real = Series<double>;

Real variable(double at) { return {{at, 1}, order}; }

void expect_coefficients(const Real& series, const std::function<double(int)>& expected) {
  for (int k = 0; k <= order; ++k) {
    const double e = expected(k);
    EXPECT_NEAR(series[k], e, 1e-13 * (1 + std::abs(e))) << "coefficient " << k;
  }
}

double factorial(int n) { return std::tgamma(n + 1.0); }
double binomial(double a, int k) {
  double b = 1;
  for (int i = 0; i < k; ++i) b *= (a - i) / (i + 1);
  return b;
}
double sign(int k) { return k % 2 ? -1 : 1; }

TEST(Series, Exponential) {
  expect_coefficients(exp(Real(-1.5) * variable(0.4)),
                      [](int k) { return std::exp(-0.6) * std::pow(-1.5, k) / factorial(k); });
  // exp(exp(s)): e times Bell numbers over k!.
  const double bell[] = {1,    1,     2,      5,      15,      52,       203,      877,
                         4140, 21147, 115975, 678570, 4213597, 27644437, 190899322};
  expect_coefficients(exp(exp(variable(0))),
                      [&](int k) { return std::exp(1.0) * bell[k] / factorial(k); });
}

TEST(Series, SineCosineTangent) {
  const double a = 0.7;
  expect_coefficients(sin(variable(a)),
                      [&](int k) { return std::sin(a + k * 1.5707963267948966) / factorial(k); });
  expect_coefficients(cos(variable(a)),
                      [&](int k) { return std::cos(a + k * 1.5707963267948966) / factorial(k); });
  const double tangent[] = {0, 1,          0, 1. / 3,         0, 2. / 15,          0, 17. / 315,
                            0, 62. / 2835, 0, 1382. / 155925, 0, 21844. / 6081075, 0};
  expect_coefficients(tan(variable(0)), [&](int k) { return tangent[k]; });
  const Real one = square(sin(variable(a))) + square(cos(variable(a)));
  expect_coefficients(one, [](int k) { return k == 0; });
}

TEST(Series, QuotientRootAndLogarithm) {
  const Real one(1.0), u = variable(0);
  expect_coefficients(one / (one - u), [](int) { return 1; });
  expect_coefficients(sqrt(one + u), [](int k) { return binomial(0.5, k); });
  expect_coefficients(log(one + u), [](int k) { return k ? -sign(k) / k : 0; });
  expect_coefficients(length(one, u), [](int k) { return k % 2 ? 0 : binomial(0.5, k / 2); });
  expect_coefficients(
      length(variable(3), Real(4.0), Real(12.0)) * length(variable(3), Real(4.0), Real(12.0)),
      [](int k) {
        return k == 0 ? 169 : k == 1 ? 6 : k == 2 ? 1 : 0;
      });
}

TEST(Series, Powers) {
  const Real one(1.0), u = variable(0);
  for (const double a : {-2.5, -1.0, 0.3, 1.7}) {
    expect_coefficients(pow(one + u, Real(a)), [&](int k) { return binomial(a, k); });
  }
  // Whole powers, of 0 and of negative numbers, too.
  for (const double at : {0.0, -2.0}) {
    expect_coefficients(pow(variable(at), Real(3)),
                        [&](int k) { return k > 3 ? 0 : binomial(3, k) * std::pow(at, 3 - k); });
  }
  // 2^s and s^s against their logarithms.
  expect_coefficients(pow(Real(2.0), variable(1)),
                      [](int k) { return 2 * std::pow(std::log(2.0), k) / factorial(k); });
  const Real x = variable(1.5), power = pow(x, x), by_logarithm = exp(x * log(x));
  expect_coefficients(power, [&](int k) { return by_logarithm[k]; });
}

TEST(Series, ArcFunctions) {
  const Real u = variable(0);
  const auto of_asin = [](int k) {
    if (k % 2 == 0) return 0.0;
    const int n = k / 2;
    return factorial(2 * n) / (std::pow(4, n) * std::pow(factorial(n), 2) * k);
  };
  expect_coefficients(asin(u), of_asin);
  expect_coefficients(acos(u), [&](int k) { return k ? -of_asin(k) : 1.5707963267948966; });
  expect_coefficients(atan2(u, Real(1.0)), [](int k) { return k % 2 ? sign(k / 2) / k : 0; });
  // The angle of (cos, sin) is the argument.
  const Real t = variable(0.3);
  expect_coefficients(atan2(sin(t), cos(t)), [](int k) { return k == 0 ? 0.3 : k == 1; });
}

TEST(Series, KinksTakeTheBranchOfTheValue) {
  const Real u = variable(-2), v = square(u);
  expect_coefficients(abs(u), [](int k) { return k == 0 ? 2 : k == 1 ? -1 : 0; });
  expect_coefficients(min(u, v), [&](int k) { return u[k]; });
  expect_coefficients(max(u, v), [&](int k) { return v[k]; });
  expect_coefficients(min(v, v + Real(0.0)), [&](int k) { return v[k]; });
  expect_coefficients(floor(variable(2.5)), [](int k) { return k == 0 ? 2 : 0; });
  // The branch that is not taken may be NaN.
  const Real root = select(u < Real(0.0), v, sqrt(u));
  expect_coefficients(root, [&](int k) { return v[k]; });
  expect_coefficients(smaller(v, -Real(1.0) * v + Real(8.0)), [](int k) { return k == 0 ? 4 : 0; });
}

}  // namespace
}  // namespace sardf

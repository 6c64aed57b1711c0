// Ritz's method against walks on spheres, which know nothing of splines: the mean of what random
// walks find at the boundary is the harmonic function (Muller 1956).
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sardf/arithmetic.hpp"
#include "sardf/evaluate.hpp"
#include "sardf/fit.hpp"

namespace sardf {
namespace {

constexpr double hole = 0.4;

// The cube of side 2 with a round hole; 1 on the hole, x / 2 on the faces.
FitProblem cube_with_hole() {
  const Expression x = coordinate(0), y = coordinate(1), z = coordinate(2), one = constant(1);
  const Expression r = length(length(x, y), z);
  const Expression u1 = r * r - constant(hole * hole);
  const Expression u2 = (one - x * x) * (one - y * y) * (one - z * z);
  FitProblem p;
  p.grid = spline_grid({-1, -1, -1}, {1, 1, 1}, {13, 13, 13}, 3);
  p.start = (u2 + constant(0.5) * x * u1) / (u1 + u2);
  p.factor = u1 * u2;
  p.solid = r - constant(hole);
  p.smoothness = 1;
  return p;
}

class Walker {
 public:
  // Mean and standard error of n walks.
  std::pair<double, double> mean(const Vec3& from, int n) {
    double sum = 0, squares = 0;
    for (int i = 0; i < n; ++i) {
      const double found = walk(from);
      sum += found;
      squares += found * found;
    }
    const double mean = sum / n;
    return {mean, std::sqrt((squares / n - mean * mean) / n)};
  }

 private:
  double walk(Vec3 at) {
    for (;;) {
      const double to_hole = norm(at) - hole;
      double to_face = 2;
      for (const double a : at) to_face = std::min(to_face, 1 - std::abs(a));
      if (to_hole < 1e-4) return 1;
      if (to_face < 1e-4) return 0.5 * at[0];
      Vec3 direction{normal_(random_), normal_(random_), normal_(random_)};
      at = at + std::min(to_hole, to_face) / norm(direction) * direction;
    }
  }

  std::mt19937_64 random_{20040315};
  std::normal_distribution<double> normal_;
};

TEST(FitWalksSlow, RitzAgreesWithWalksOnSpheres) {
  const FitProblem p = cube_with_hole();
  const FitResult result = fit(p);
  const Evaluator f(fitted_expression(p, result.coefficients));
  Walker walker;
  for (const Vec3& at : {Vec3{0.6, 0, 0}, Vec3{-0.7, 0.1, 0.2}, Vec3{0.5, 0.5, 0.5},
                         Vec3{0, -0.8, 0.3}, Vec3{0.1, 0.2, 0.5}, Vec3{-0.8, -0.8, 0.8}}) {
    const auto [mean, error] = walker.mean(at, 40000);
    // The walks stop 1e-4 before the boundary, where the slope is below 3.
    EXPECT_NEAR(f.value(at), mean, 4 * error + 3e-4) << testing::PrintToString(at);
  }
  EXPECT_LT(result.report.energy_after, result.report.energy_before);
}

}  // namespace
}  // namespace sardf

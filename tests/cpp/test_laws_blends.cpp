// Laws of the blends: signs, symmetry, bounds and smoothness, and the SARDF formulas against two
// independent ways to compute them.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "laws.hpp"

namespace sardf {
namespace {

using laws::Random;

struct Blended {
  OperationPointer intersection, unite, difference;
  double radius;

  Blended(const std::string& name, double width) : radius(width) {
    const bool has_radius = !find_blend_type(name)->parameters.empty();
    const BlendPointer blend = has_radius ? make_blend(name, {width}) : make_blend(name, {});
    intersection = blend->intersection;
    unite = blend->unite;
    difference = blend->difference;
  }
  static double apply(const OperationPointer& op, double x, double y) {
    const double in[2] = {x, y};
    return op->evaluate(in);
  }
  double meet(double x, double y) const { return apply(intersection, x, y); }
  double join(double x, double y) const { return apply(unite, x, y); }
  double minus(double x, double y) const { return apply(difference, x, y); }
  Vec2 gradient(double x, double y) const {
    const double* in[2] = {&x, &y};
    double value, by[2];
    double* to[2] = {&by[0], &by[1]};
    intersection->partials(in, &value, to, 1);
    return {by[0], by[1]};
  }
};

/// A pair of values in or near the band of the radius, on the edge, or anywhere.
Vec2 random_pair(Random& r, double radius) {
  if (r.chance(0.1)) return {r.spicy(), r.spicy()};
  const double x = r.uniform(-5, 5) * radius;
  if (r.chance(0.1)) return {x, x};
  return {x, r.chance(0.7) ? x + r.uniform(-1.2, 1.2) * radius : r.uniform(-5, 5) * radius};
}

class BlendLaws : public testing::TestWithParam<const char*> {
 protected:
  /// law(blend, x, y) for random radii and pairs.
  void for_pairs(int count, const std::function<void(const Blended&, double, double)>& law) {
    Random r(17);
    for (int i = 0; i < laws::effort(count) / 50 + 1; ++i) {
      const Blended blend(GetParam(), r.decades(-2, 1));
      for (int k = 0; k < 50; ++k) {
        const Vec2 at = random_pair(r, blend.radius);
        SCOPED_TRACE(testing::Message() << GetParam() << ' ' << at[0] << ' ' << at[1] << " R "
                                        << blend.radius << " seed " << laws::seed());
        law(blend, at[0], at[1]);
      }
    }
  }
};

double slack(double x, double y) {
  return 32 * 0x1p-52 * std::max(std::abs(x), std::abs(y)) + 1e-150;
}

TEST_P(BlendLaws, UnionAndDifferenceFollowFromIntersection) {
  for_pairs(20000, [](const Blended& b, double x, double y) {
    EXPECT_EQ(b.join(x, y), -b.meet(-x, -y));
    EXPECT_EQ(b.minus(x, y), b.meet(x, -y));
  });
}

TEST_P(BlendLaws, Commute) {
  for_pairs(20000, [](const Blended& b, double x, double y) {
    EXPECT_NEAR(b.meet(x, y), b.meet(y, x), slack(x, y));
  });
}

TEST_P(BlendLaws, NeverAboveMin) {
  for_pairs(20000, [](const Blended& b, double x, double y) {
    EXPECT_LE(b.meet(x, y), std::min(x, y) + slack(x, y));
  });
}

INSTANTIATE_TEST_SUITE_P(All, BlendLaws,
                         testing::Values("sardf", "sardf_c1", "min_max", "r_function", "smooth"));

double sign(double a) { return a > 0 ? 1 : a < 0 ? -1 : 0; }

/// Blends that keep the surface where min and max have it.
class SurfaceKeepingBlendLaws : public BlendLaws {};

TEST_P(SurfaceKeepingBlendLaws, SignAndZeroSetAreMinsAndMaxs) {
  const bool vanishes = GetParam() == std::string("r_function");
  for_pairs(50000, [=](const Blended& b, double x, double y) {
    const double most = std::max({std::abs(x), std::abs(y)}), lo = std::min(x, y);
    // The squares in r_function vanish, and with them the sign.
    if (vanishes && most < 1e-150) return;
    // Rounding may lose a sign only where the value is nothing beside the arguments.
    if (std::abs(lo) <= 1e-14 * std::max(most, b.radius) && lo != 0) return;
    EXPECT_EQ(sign(b.meet(x, y)), sign(lo));
    EXPECT_EQ(sign(b.join(-x, -y)), -sign(lo));
  });
}

INSTANTIATE_TEST_SUITE_P(All, SurfaceKeepingBlendLaws,
                         testing::Values("sardf", "sardf_c1", "r_function"));

class SardfLaws : public BlendLaws {};

TEST_P(SardfLaws, ErrorIsBoundedAndReached) {
  const double most = 1 - 1 / std::sqrt(2.0);
  double reached = 0;
  for_pairs(50000, [&](const Blended& b, double x, double y) {
    const double error = std::min(x, y) - b.meet(x, y);
    EXPECT_GE(error, -slack(x, y));
    EXPECT_LE(error, most * b.radius + slack(x, y) + 4 * 0x1p-52 * b.radius);
    if (std::abs(x) + std::abs(y) < 100 * b.radius) reached = std::max(reached, error / b.radius);
  });
  EXPECT_NEAR(reached, most, 1e-12);
}

TEST_P(SardfLaws, OppositeSignsAndZerosGiveMinAndMaxExactly) {
  for_pairs(20000, [](const Blended& b, double x, double y) {
    const double p = std::abs(x), n = -std::abs(y);
    EXPECT_EQ(b.meet(p, n), n);
    EXPECT_EQ(b.join(p, n), p);
    EXPECT_EQ(b.meet(p, 0), 0);
    EXPECT_EQ(b.join(0, n), 0);
  });
}

TEST_P(SardfLaws, PartialsAreNeverNegativeAndSumIsBounded) {
  const double most = GetParam() == std::string("sardf") ? 4 - 2 * std::sqrt(2.0) : std::sqrt(2.0);
  double largest = 0;
  for_pairs(50000, [&](const Blended& b, double x, double y) {
    const Vec2 by = b.gradient(x, y);
    EXPECT_FALSE(std::isnan(by[0]) || std::isnan(by[1]));
    EXPECT_GE(std::min(by[0], by[1]), -1e-9);
    EXPECT_LE(by[0] + by[1], most + 1e-9);
    largest = std::max(largest, by[0] + by[1]);
  });
  EXPECT_NEAR(largest, most, 0.02);
}

INSTANTIATE_TEST_SUITE_P(All, SardfLaws, testing::Values("sardf", "sardf_c1"));

// The first paper's zones, each with its own quadratic (2.2, with its typos put right).
double larger_root(double a, double b, double c) {
  return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
}

double zones(double x, double y, double R) {
  const double q = x * x + y * y, s = x + y;
  if (x * y <= 0) return std::min(x, y);
  const auto band = [&](double otherwise) {
    // Centre (d + R, d + R), radius R.
    return std::abs(x - y) < R ? larger_root(2, 4 * R - 2 * s, R * R - 2 * R * s + q) : otherwise;
  };
  if (x > 0) {
    const bool under_arc = (x - 2 * R) * (x - 2 * R) + (y - 2 * R) * (y - 2 * R) > R * R;
    const bool first = x < R || y < R || (x < 2 * R && y < 2 * R && under_arc);
    if (!first) return band(std::min(x, y));
    if (y / x <= 0.5) return y;
    if (y / x >= 2) return x;
    return larger_root(7, -4 * s, q);  // centre (2d, 2d), radius d
  }
  const bool over_arc = (x + R) * (x + R) + (y + R) * (y + R) < R * R;
  const bool third = x > -R || y > -R || over_arc;
  if (!third) return band(std::min(x, y));
  if (y / x <= 0.5) return x;
  if (y / x >= 2) return y;
  return larger_root(1.0 / 4, -s, q);  // centre (d/2, d/2), radius -d/2
}

TEST(SardfFormula, EqualsThePapersZones) {
  Random r(23);
  for (int i = 0; i < laws::effort(200000); ++i) {
    const Blended blend("sardf", r.decades(-2, 1));
    for (int k = 0; k < 10; ++k) {
      const double R = blend.radius, x = r.uniform(-5, 5) * R;
      const double y = r.chance(0.7) ? x + r.uniform(-1.2, 1.2) * R : r.uniform(-5, 5) * R;
      ASSERT_NEAR(blend.meet(x, y), zones(x, y, R), 2e-14 * R) << x << ' ' << y << " R " << R;
    }
    i += 9;
  }
}

/// The level d of the corner {min = d}, rounded by a circle of radius profile(d), that passes
/// through (x, y): by bisection, from the picture alone.
double geometric(double x, double y, const std::function<double(double)>& profile) {
  double low = -20, high = 20;
  for (int step = 0; step < 80; ++step) {
    const double d = 0.5 * (low + high), r = profile(d), dx = d + r - x, dy = d + r - y;
    const bool in_corner = dx > 0 && dy > 0;
    const bool above = x >= d && y >= d && (!in_corner || dx * dx + dy * dy <= r * r);
    (above ? low : high) = d;
  }
  return low;
}

double sardf_profile(double d) { return d > 0 ? std::min(d, 1.0) : std::min(-d / 2, 1.0); }
double sardf_c1_profile(double d) {
  if (d >= 0) return d < 1 ? 2 * std::sqrt(d) - d : 1;
  return d > -2 ? -d - d * d / 4 : 1;
}

TEST(SardfFormula, IsTheRoundedCorner) {
  Random r(29);
  const Blended sardf("sardf", 1), sardf_c1("sardf_c1", 1);
  for (int i = 0; i < laws::effort(20000); ++i) {
    const double x = r.uniform(-5, 5),
                 y = r.chance(0.7) ? x + r.uniform(-1.2, 1.2) : r.uniform(-5, 5);
    EXPECT_NEAR(sardf.meet(x, y), geometric(x, y, sardf_profile), 1e-13) << x << ' ' << y;
    EXPECT_NEAR(sardf_c1.meet(x, y), geometric(x, y, sardf_c1_profile), 1e-12) << x << ' ' << y;
  }
}

/// Largest jump of the gradient across the arc of centre (c, c), radius 1, towards the edge.
double largest_jump(const Blended& blend, double centre) {
  double most = 0;
  for (int i = 1; i < 2000; ++i) {
    const double angle = i * (std::acos(0.0) / 2000), step = 1e-9;
    const Vec2 toward{std::cos(angle), std::sin(angle)};
    const auto at = [&](double radius) {
      return blend.gradient(centre - radius * toward[0], centre - radius * toward[1]);
    };
    const Vec2 inner = at(1 - step), outer = at(1 + step);
    most = std::max(most, std::hypot(inner[0] - outer[0], inner[1] - outer[1]));
  }
  return most;
}

// The paper calls its function C1 except at the origin; across the arcs d = R and d = -2R it is
// not.
TEST(SardfFormula, GradientJumpsAcrossTwoArcs) {
  const Blended sardf("sardf", 1), sardf_c1("sardf_c1", 1);
  EXPECT_NEAR(largest_jump(sardf, 2), 0.160189, 1e-5);
  EXPECT_NEAR(largest_jump(sardf, -1), 0.121320, 1e-5);
  EXPECT_LT(largest_jump(sardf_c1, 2), 1e-6);
  EXPECT_LT(largest_jump(sardf_c1, -1), 1e-6);
}

}  // namespace
}  // namespace sardf

// Certified error and Lipschitz bounds: true, tight where the truth is known, and explained when
// infinite.
#include "sardf/certify.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "laws.hpp"
#include "sardf/arithmetic.hpp"
#include "sardf/blend.hpp"
#include "sardf/shapes_contour.hpp"

namespace sardf {
namespace {

using laws::Random;

const Expression x = coordinate(0), y = coordinate(1), z = coordinate(2);
const double corner = 1 - 1 / std::sqrt(2.0);

Field sphere(double at, double radius) { return make_field("sphere", {Vec3{at, 0, 0}, radius}); }
Field joined(const std::vector<Field>& of, const BlendPointer& blend) {
  return make_field("union", {of, blend});
}

TEST(ErrorBound, IsZeroWithoutBlends) {
  const Field plain = joined({sphere(0, 1), sphere(1, 2)}, min_max_blend());
  EXPECT_EQ(error_bound(plain.expression()), 0);
  // 1/x has an infinite slope, but nothing to enlarge.
  EXPECT_EQ(error_bound(constant(1) / plain.expression()), 0);
}

TEST(ErrorBound, AddsUpAlongTheDeepestPath) {
  const BlendPointer blend = make_blend("sardf", {0.5});
  const std::vector<Field> four{sphere(0, 1), sphere(1, 1), sphere(2, 1), sphere(3, 1)};
  EXPECT_NEAR(error_bound(joined(four, blend).expression()), 3 * corner * 0.5, 1e-12);
  const Field left = joined({four[0], four[1]}, blend), right = joined({four[2], four[3]}, blend);
  EXPECT_NEAR(error_bound(joined({left, right}, blend).expression()), 2 * corner * 0.5, 1e-12);
  EXPECT_NEAR(error_bound(joined({four[0], four[1]}, make_blend("smooth", {0.8})).expression()),
              0.2, 1e-12);
}

TEST(ErrorBound, ScalesWithWhatFollows) {
  const Field whole = joined({sphere(0, 1), sphere(1, 1)}, make_blend("sardf", {1.0}));
  const double once = error_bound(whole.expression());
  const Field scaled = make_field("scale", {whole, 3.0, Vec3{}});
  EXPECT_NEAR(error_bound(scaled.expression()), 3 * once, 1e-12);
  const Field moved = make_field("translate", {whole, Vec3{1, 2, 3}});
  EXPECT_NEAR(error_bound(moved.expression()), once, 1e-12);
  const Field shell = make_field("shell", {whole, 0.2, std::string("inside")});
  EXPECT_NEAR(error_bound(shell.expression()), once, 1e-12);
}

TEST(ErrorBound, NamesWhatMakesItInfinite) {
  const BlendPointer r_function = make_blend("r_function", {});
  const Field rounded = joined({sphere(0, 1), sphere(1, 1)}, r_function);
  EXPECT_EQ(error_bound(rounded.expression()), infinity);
  EXPECT_EQ(certified_error(rounded.expression()).infinite_at, "r_function_union");
  const Expression smooth =
      joined({sphere(0, 1), sphere(1, 1)}, make_blend("sardf", {1.0})).expression();
  EXPECT_EQ(certified_error(exp(smooth * y)).infinite_at, "multiply");
  EXPECT_EQ(certified_error(smooth).infinite_at, "");
}

/// The tree of the seed with one blend throughout.
Expression tree(uint64_t stream, const BlendPointer& blend) {
  Random r(stream);
  std::vector<Field> parts;
  for (int i = 0; i < 6; ++i) {
    parts.push_back(make_field("box", {Vec3{r.ordinary(), r.ordinary(), r.ordinary()},
                                       Vec3{r.uniform(1, 5), r.uniform(1, 5), r.uniform(1, 5)}}));
  }
  const char* joins[] = {"union", "intersection", "difference"};
  while (parts.size() > 1) {
    const Field last = parts.back();
    parts.pop_back();
    Field& other = parts[size_t(r.below(int(parts.size())))];
    other = make_field(r.one_of(joins), {std::vector<Field>{other, last}, blend});
    if (r.chance(0.3)) other = make_field("scale", {other, r.uniform(0.5, 2), Vec3{1, 2, 3}});
    if (r.chance(0.3)) other = make_field("offset", {other, r.uniform(-0.3, 0.3)});
  }
  return parts[0].expression();
}

TEST(ErrorBound, HoldsOnRandomTrees) {
  double closest = 0;
  for (int i = 0; i < laws::effort(300); ++i) {
    Random r(uint64_t(i) + 1000);
    const char* names[] = {"sardf", "sardf_c1", "smooth"};
    const Expression blended = tree(uint64_t(i), make_blend(r.one_of(names), {r.decades(-1, 0.5)}));
    const Evaluator with(blended), without(tree(uint64_t(i), min_max_blend()));
    const double bound = error_bound(blended);
    EXPECT_LT(bound, infinity);
    for (int k = 0; k < 200; ++k) {
      const Vec3 at{r.ordinary(), r.ordinary(), r.ordinary()};
      const double error = std::abs(with.value(at) - without.value(at));
      EXPECT_LE(error, bound * (1 + 1e-12)) << i << ' ' << testing::PrintToString(at);
      closest = std::max(closest, error / bound);
    }
  }
  EXPECT_GT(closest, 0.3);
}

TEST(LipschitzBound, IsOneForDistances) {
  const BoundingBox box{{-10, -10, -10}, {10, 10, 10}};
  for (const Field& field :
       {sphere(1, 2), make_field("box", {Vec3{}, Vec3{2, 3, 4}}),
        make_field("rotate", {make_field("torus", {Vec3{}, Vec3{1, 1, 0}, 3.0, 1.0}),
                              Vec3{1, 2, 3},
                              33.0,
                              {},
                              {},
                              Vec3{}})}) {
    const double bound = lipschitz_bound(Evaluator(field.expression()), box);
    EXPECT_GE(bound, 1);
    EXPECT_LE(bound, 1 + 1e-9);
  }
}

TEST(LipschitzBound, ComesNearTheTruthBySplitting) {
  // The steepest gradient of the gyroid's field sin x cos y + ... in a period is sqrt(3).
  const Expression gyroid = function("sin", {x}) * function("cos", {y}) +
                            function("sin", {y}) * function("cos", {z}) +
                            function("sin", {z}) * function("cos", {x});
  const Evaluator evaluator(gyroid);
  const BoundingBox period{{-3.2, -3.2, -3.2}, {3.2, 3.2, 3.2}};
  const double once = evaluator.slope(period).length;
  const double split = lipschitz_bound(evaluator, period, 4096);
  double attained = 0;
  Random r(3);
  for (int i = 0; i < 20000; ++i) {
    const double at[3] = {r.uniform(-3.2, 3.2), r.uniform(-3.2, 3.2), r.uniform(-3.2, 3.2)};
    double gradient[3];
    evaluator.gradients(at, 1, nullptr, gradient);
    attained = std::max(attained, std::hypot(gradient[0], gradient[1], gradient[2]));
  }
  EXPECT_GE(split, attained);
  EXPECT_LT(split, 1.5 * attained);
  EXPECT_LT(split, 0.9 * once);
}

Expression half_plane_at(double angle) {
  return constant(std::cos(angle)) * x + constant(std::sin(angle)) * y;
}

// The result's gradient on a level line's arc of radius r(d) around (d + r, d + r) is
// (C g1 + S g2) / ((1 + r') (C + S) - r') with the direction's cosine C and sine S (sardf paper,
// 2.2). It is longest at the ends or in the middle of an arc outside, where r' = -1/2 for sardf and
// -1 at the edge for sardf_c1.
TEST(LipschitzBound, OfABlendDependsOnTheAngle) {
  const BoundingBox box{{-0.6, -0.6, -1}, {0.6, 0.6, 1}};
  for (const double degrees : {0.0, 20.0, 45.0, 62.0, 90.0, 120.0, 170.0}) {
    const double angle = degrees / 180 * std::acos(-1);
    const double cosine = std::cos(angle);
    const Expression a = half_plane_at(0), b = half_plane_at(angle);
    const double in_the_middle = std::sqrt(1 + cosine) / ((std::sqrt(2.0) + 1) / 2);
    for (const auto& [name, truth] :
         {std::pair("sardf", std::max(1.0, in_the_middle)),
          std::pair("sardf_c1", std::sqrt(1 + std::max(0.0, cosine)))}) {
      const BlendPointer blend = make_blend(name, {1.0});
      const Expression joined[] = {call(blend->intersection, {a, b}), call(blend->unite, {a, b}),
                                   call(blend->difference, {a, constant(-1) * b})};
      for (const Expression& f : joined) {
        const double bound = lipschitz_bound(Evaluator(f), box, 2000);
        EXPECT_LE(bound, truth * (1 + 1e-9)) << name << ' ' << degrees;
        EXPECT_GE(bound, 0.999) << name << ' ' << degrees;
      }
    }
  }
}

TEST(LipschitzBound, OfBlendsHoldsForGradientsOfAnyLength) {
  Random r(17);
  for (int i = 0; i < laws::effort(400); ++i) {
    const auto plane = [&] {
      return constant(r.uniform(-2, 2)) * x + constant(r.uniform(-2, 2)) * y +
             constant(r.uniform(-2, 2)) * z + constant(r.uniform(-0.2, 0.2));
    };
    const char* names[] = {"sardf", "sardf_c1", "smooth"};
    const BlendPointer blend =
        r.chance(0.2) ? min_max_blend() : make_blend(r.one_of(names), {r.decades(-1, 0.5)});
    const OperationPointer of[] = {blend->intersection, blend->unite, blend->difference};
    const Evaluator f(call(of[r.below(3)], {plane(), plane()}));
    const BoundingBox box{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}};
    const double bound = lipschitz_bound(f, box, 8);
    for (int k = 0; k < 300; ++k) {
      const Vec3 at{r.uniform(-0.5, 0.5), r.uniform(-0.5, 0.5), r.uniform(-0.5, 0.5)};
      Vec3 gradient;
      f.gradients(at.data(), 1, nullptr, gradient.data());
      EXPECT_LE(norm(gradient), bound * (1 + 1e-9)) << f.value(at);
    }
  }
}

// Two profiles of slope 1 whose values differ by up to 1 over a height of 2: the sides' slope is
// sqrt(1 + 1/4), and where sections meet it is no more.
TEST(LipschitzBound, OfALoftIsThatOfItsSteepestPart) {
  const auto disc = [](double radius) { return make_field("disc", {Vec2{}, radius}); };
  const Field loft =
      make_field("loft", {std::vector<PlaneSection>{{disc(3), -2}, {disc(2), 0}, {disc(2.5), 2}},
                          std::string("linear")});
  const BoundingBox around{{1, 1, -1.9}, {3, 3, 1.9}};
  const double truth = std::sqrt(1.25);
  const double bound = lipschitz_bound(Evaluator(loft.expression()), around, 4000);
  EXPECT_GE(bound, truth * 0.999);
  EXPECT_LE(bound, truth * 1.15);
}

// Biswas and Shapiro's joint distance is no steeper than the distances that it joins.
TEST(LipschitzBound, OfREquivalenceIsOne) {
  std::vector<Field> points;
  for (const Vec3& at : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 2, 0}}) {
    points.push_back(make_field("point", {at}));
  }
  for (const double order : {0.5, 1.0, 12.0}) {
    const Field joined = make_field("r_equivalence", {points, order});
    const double bound = lipschitz_bound(Evaluator(joined.expression()), {{-1, -1, -1}, {3, 3, 1}});
    EXPECT_LE(bound, 1 + 1e-9) << order;
  }
}

TEST(BandLipschitzBound, CountsOnlyWhatIsNearTheSurface) {
  // |grad (r² - 1)| = 2 r, and r² is at most 1.21 where the value is at most 0.21.
  const Expression ball = x * x + y * y + z * z - constant(1);
  const BoundingBox box{{0.1, 0.1, 0.1}, {3, 3, 3}};
  const auto bound = band_lipschitz_bound(Evaluator(ball), box, 0.21, {20'000});
  ASSERT_TRUE(bound.has_value());
  EXPECT_GE(*bound, 2.2 * 0.999);
  EXPECT_LE(*bound, 2.2 * 1.05);
  EXPECT_FALSE(
      band_lipschitz_bound(Evaluator(ball), {{2, 2, 2}, {3, 3, 3}}, 0.21, {10}).has_value());
}

TEST(LipschitzBound, HoldsOnRandomFields) {
  Random r(5);
  for (int i = 0; i < laws::effort(300); ++i) {
    const Evaluator evaluator(laws::random_field(r, 1 + r.below(2)).expression());
    BoundingBox box;
    for (int axis = 0; axis < 3; ++axis) {
      box.lo[axis] = r.ordinary();
      box.hi[axis] = box.lo[axis] + r.decades(-2, 1);
    }
    const CertifiedBound bound = certified_lipschitz(evaluator, box, 64);
    EXPECT_LE(bound.value, evaluator.slope(box).length);
    EXPECT_EQ(bound.infinite_at.empty(), bound.value < infinity);
    const auto inside = [&] {
      Vec3 at;
      for (int axis = 0; axis < 3; ++axis) at[axis] = r.uniform(box.lo[axis], box.hi[axis]);
      return at;
    };
    for (int k = 0; k < 50; ++k) {
      const Vec3 p = inside(), q = inside();
      EXPECT_LE(std::abs(evaluator.value(p) - evaluator.value(q)),
                bound.value * norm(p - q) + 1e-10);
    }
  }
}

TEST(LipschitzBound, NamesWhatMakesItInfinite) {
  const BoundingBox box{{-1, -1, -1}, {1, 1, 1}};
  EXPECT_EQ(certified_lipschitz(Evaluator(constant(1) / x + y), box).infinite_at, "divide");
  EXPECT_EQ(certified_lipschitz(Evaluator(function("sqrt", {x})), box).infinite_at, "sqrt");
  // Steps jump; away from the jump they are flat.
  EXPECT_EQ(certified_lipschitz(Evaluator(function("floor", {x})), box).infinite_at, "floor");
  EXPECT_LT(lipschitz_bound(Evaluator(function("floor", {x})), {{0.1, 0, 0}, {0.9, 1, 1}}), 1e-300);
  EXPECT_LT(lipschitz_bound(Evaluator(less(x, y)), {{1, 0, 0}, {2, 0.5, 1}}), 1e-300);
  EXPECT_EQ(lipschitz_bound(Evaluator(select(less(x, y), x, z)), box), infinity);
}

TEST(LipschitzBound, OfUnboundedBoxesIsTheSlopes) {
  const BoundingBox everywhere{{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}};
  EXPECT_NEAR(lipschitz_bound(Evaluator(sphere(0, 1).expression()), everywhere), 1, 1e-9);
  EXPECT_EQ(lipschitz_bound(Evaluator(x * y), everywhere), infinity);
}

TEST(LipschitzBound, OfAnExtrusionIsThatOfItsProfile) {
  // The profile's gradient turns by 90 degrees at its corners: only its length is known there.
  const Field profile =
      make_field("polygon", {std::vector<Vec2>{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}});
  const Field block = make_field("extrude", {profile, 2.0});
  const BoundingBox around_a_corner{{0.9, 0.8, 0.7}, {1.2, 1.1, 1.3}};
  EXPECT_NEAR(lipschitz_bound(Evaluator(block.expression()), around_a_corner), 1, 1e-9);
}

}  // namespace
}  // namespace sardf

// Fields with the surfaces of others: signs are the same everywhere, values where that is said.
#include <gtest/gtest.h>

#include <cmath>

#include "laws.hpp"
#include "povray_gen/sharp_edges.hpp"
#include "sardf/arithmetic.hpp"
#include "sardf/certify.hpp"
#include "sardf/operation_of.hpp"
#include "sardf/ops.hpp"

namespace sardf {
namespace {

using laws::Random;
using povray::with_sharp_edges;

const Expression X = coordinate(0), Y = coordinate(1), Z = coordinate(2);

Expression box(const Vec3& center, const Vec3& size) {
  Box op;
  op.center = center;
  op.size = size;
  return call(make_operation(op), {X, Y, Z});
}
Expression bar(const Vec3& center, const Vec3& axis, double radius, double height) {
  Cylinder op;
  op.center = center;
  op.axis.direction = axis;
  op.radius = radius;
  op.height = height;
  return call(make_operation(op), {X, Y, Z});
}
Expression ball(const Vec3& center, double radius) {
  Sphere op;
  op.center = center;
  op.radius = radius;
  return call(make_operation(op), {X, Y, Z});
}
template <template <class> class Of>
Expression sardf_of(double radius, const Expression& a, const Expression& b) {
  return call(make_operation(Of<Sardf>(Sardf{.radius = radius})), {a, b});
}

/// A block with a bored boss, rounded, beside a flat bar.
Expression part() {
  const Expression block = box({0.1, -0.2, 0.3}, {2, 1.4, 1});
  const Expression boss = bar({0.3, 0.1, 0.5}, {0, 0.6, 0.8}, 0.4, 1.5);
  const Expression bored =
      sardf_of<DifferenceOf>(0.2, sardf_of<UnionOf>(0.3, block, boss), ball({0.5, 0.2, 0.9}, 0.5));
  Box2d profile;
  profile.size = {0.5, 0.3};
  const Expression flat =
      call(make_operation(PerpendicularIntersection{}),
           {call(make_operation(profile), {X + constant(1.2), Z}), constant(0.4) - abs(Y)});
  return max(bored, -max(-flat, -(constant(2) * ball({-1.2, 0, 0}, 0.2))));
}

Vec3 random_point(Random& r, double most) {
  return {r.uniform(-most, most), r.uniform(-most, most), r.uniform(-most, most)};
}

int sign_of(double a) { return (a > 0) - (a < 0); }

TEST(PovraySharpEdges, HaveTheSameSignsAndSurface) {
  const Evaluator exact(part()), sharp(with_sharp_edges(part()));
  Random r(1);
  int crossings = 0;
  for (int i = 0; i < laws::effort(20000); ++i) {
    Vec3 a = random_point(r, 2), b = a + random_point(r, 0.5);
    ASSERT_EQ(sign_of(exact.value(a)), sign_of(sharp.value(a))) << testing::PrintToString(a);
    if ((exact.value(a) >= 0) == (exact.value(b) >= 0)) continue;
    ++crossings;
    const bool inside = exact.value(a) >= 0;
    for (int halving = 0; halving < 40; ++halving) {
      const Vec3 middle = 0.5 * (a + b);
      ((exact.value(middle) >= 0) == inside ? a : b) = middle;
      // Distances are rounded, too.
      if (std::abs(exact.value(middle)) < 1e-13) break;
      ASSERT_EQ(sign_of(exact.value(middle)), sign_of(sharp.value(middle)));
    }
  }
  EXPECT_GT(crossings, laws::effort(20000) / 100);
}

// As normals are found: by differences over 1e-4 at the surface, farther than that from an edge.
TEST(PovraySharpEdges, HaveTheSameNormalsAwayFromEdges) {
  const Evaluator exact(part()), sharp(with_sharp_edges(part()));
  Random r(2);
  int equal = 0, all = 0;
  for (int i = 0; i < laws::effort(20000); ++i) {
    Vec3 a = random_point(r, 2), b = a + random_point(r, 0.5);
    const bool inside = exact.value(a) >= 0;
    if (inside == (exact.value(b) >= 0)) continue;
    for (int halving = 0; halving < 40; ++halving) {
      const Vec3 middle = 0.5 * (a + b);
      ((exact.value(middle) >= 0) == inside ? a : b) = middle;
    }
    ++all;
    bool same = true;
    for (size_t axis = 0; axis < 3; ++axis) {
      Vec3 beside = a;
      beside[axis] += 1e-4;
      same = same && exact.value(beside) == sharp.value(beside);
    }
    equal += same;
  }
  // The edges are about 20 long, the surface is about 12, and 2e-4 beside an edge counts.
  EXPECT_GT(all, laws::effort(20000) / 100);
  EXPECT_GE(equal, 0.99 * all);
}

TEST(PovraySharpEdges, KeepAllBitsInside) {
  const Expression shapes[] = {box({0.1, -0.2, 0.3}, {2, 1.4, 1}),
                               bar({0, 0, 0.25}, {0, 0, 1}, 0.8, 1.5)};
  Random r(3);
  for (const Expression& shape : shapes) {
    const Evaluator exact(shape), sharp(with_sharp_edges(shape));
    int inside = 0;
    for (int i = 0; i < 2000; ++i) {
      const Vec3 p = random_point(r, 1.5);
      if (exact.value(p) < 0) continue;
      ++inside;
      ASSERT_EQ(exact.value(p), sharp.value(p)) << testing::PrintToString(p);
    }
    EXPECT_GT(inside, 100);
  }
}

// There the values count, or edges are rounded.
TEST(PovraySharpEdges, LeaveAloneWhatIsNotAsSharp) {
  const Expression block = box({}, {2, 1, 1}), hole = ball({1, 0, 0}, 0.5);
  RoundedBox rounded;
  rounded.radius = 0.2;
  for (const Expression& solid :
       {call(make_operation(UnionOf<Smooth>(Smooth{.k = 0.2})), {block, hole}),
        call(make_operation(UnionOf<RFunction>()), {block, hole}),
        sardf_of<UnionOf>(0.3, block, hole) + constant(0.1), -(abs(block) - constant(0.1)),
        call(make_operation(rounded), {X, Y, Z}), constant(-2) * block, X, constant(1)}) {
    const Expression sharp = with_sharp_edges(solid);
    const Evaluator exact(solid), other(sharp);
    Random r(4);
    for (int i = 0; i < 1000; ++i) {
      const Vec3 p = random_point(r, 2);
      ASSERT_EQ(exact.value(p), other.value(p));
    }
  }
}

TEST(PovraySharpEdges, AreNoSteeperThanTheirFaces) {
  const BoundingBox all{{-2, -2, -2}, {2, 2, 2}};
  const Expression both = sardf_of<UnionOf>(0.5, ball({-0.5, 0, 0}, 1), ball({0.5, 0, 0}, 1));
  EXPECT_GT(lipschitz_bound(Evaluator(both), all), 1.01);
  EXPECT_LE(lipschitz_bound(Evaluator(with_sharp_edges(both)), all), 1 + 1e-9);
}

TEST(PovraySharpEdges, HaveTheSignsOfRandomFields) {
  Random r(5);
  for (int i = 0; i < laws::effort(400); ++i) {
    const Expression solid = laws::random_field(r, 1 + r.below(3)).expression();
    const Evaluator exact(solid), sharp(with_sharp_edges(solid));
    for (int k = 0; k < 40; ++k) {
      const Vec3 p{r.ordinary(), r.ordinary(), r.ordinary()};
      const double value = exact.value(p);
      // What rounds to 0 in one may not in the other.
      if (!(std::abs(value) > 1e-9 && std::abs(value) < 1e9)) continue;
      EXPECT_EQ(sign_of(value), sign_of(sharp.value(p)))
          << testing::PrintToString(p) << ' ' << value << ' ' << sharp.value(p);
    }
  }
}

}  // namespace
}  // namespace sardf

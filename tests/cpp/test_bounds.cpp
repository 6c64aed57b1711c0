#include "sardf/bounds.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "mesh_checks.hpp"
#include "sardf/error.hpp"

namespace sardf {
namespace {

using namespace checks;
using testing::HasSubstr;

std::string error_of(const Expression& field, const std::optional<BoundingBox>& stated = {}) {
  try {
    certified_bounds(Evaluator(field), {}, stated);
  } catch (const Error& error) {
    return error.message;
  }
  return "no error";
}

// The bounds hold the true ones with the padding and are tight.
void expect_bounds(const Expression& field, const Vec3& lo, const Vec3& hi) {
  const BoundingBox found = certified_bounds(Evaluator(field));
  const double diagonal = norm(hi - lo);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LE(found.lo[axis], lo[axis] - 1e-4 * diagonal) << axis;
    EXPECT_GE(found.hi[axis], hi[axis] + 1e-4 * diagonal) << axis;
    EXPECT_GE(found.lo[axis], lo[axis] - 1e-3 * diagonal) << axis;
    EXPECT_LE(found.hi[axis], hi[axis] + 1e-3 * diagonal) << axis;
  }
}

TEST(Bounds, OfSolidsWhoseExtentIsKnown) {
  expect_bounds(box({20, 12, 8}), {-10, -6, -4}, {10, 6, 4});
  expect_bounds(sphere(5, {1, 2, 3}), {-4, -3, -2}, {6, 7, 8});
  expect_bounds(torus(5, 1), {-6, -6, -1}, {6, 6, 1});
  expect_bounds(block_with_holes({0, 1, 0}), {-10, -6, -6}, {10, 6, 6});
  const auto rows = rotation({1, 2, 3}, 0.7);
  Vec3 reach{};
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < 3; ++i) reach[axis] += std::abs(rows[i][axis]) * Vec3{10, 6, 4}[i];
  }
  expect_bounds(rotated(box({20, 12, 8}), rows), -1.0 * reach, reach);
}

TEST(Bounds, FarFromTheOriginAndOfAnySize) {
  expect_bounds(sphere(1e-3, {1000, 3, -20}), {999.999, 2.999, -20.001},
                {1000.001, 3.001, -19.999});
  expect_bounds(sphere(1e8), {-1e8, -1e8, -1e8}, {1e8, 1e8, 1e8});
}

TEST(Bounds, OfFormulas) {
  const auto squared = [](int axis) { return call(make_operation(Square()), {coordinate(axis)}); };
  // 1 - x²/4 - y² - z²
  const Expression quarter = of(Multiply(), constant(0.25), squared(0));
  const Expression sum = of(Add(), quarter, of(Add(), squared(1), squared(2)));
  expect_bounds(of(Subtract(), constant(1), sum), {-2, -1, -1}, {2, 1, 1});
  const Expression lattice = of(IntersectionOf<MinMax>(), gyroid(1.2, 0.4), box({6, 6, 6}));
  expect_bounds(lattice, {-3, -3, -3}, {3, 3, 3});
}

// Random solids: no point of the solid lies outside, looked for far and near.
TEST(Bounds, NothingIsOutside) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int trial = 0; trial < 30; ++trial) {
    Expression field = sphere(1.5 + unit(random), {unit(random), unit(random), unit(random)});
    for (int part = 0; part < 4; ++part) {
      const Vec3 at{3 * unit(random), 3 * unit(random), 3 * unit(random)};
      const auto rows = rotation({unit(random), unit(random), 1}, 3 * unit(random));
      Smooth blend;
      blend.k = 0.4;
      field = of(UnionOf<Smooth>(blend), field, rotated(box({1, 2, 0.3}, at), rows));
    }
    const Evaluator evaluator(field);
    const BoundingBox found = certified_bounds(evaluator);
    size_t inside = 0;
    for (int i = 0; i < 20000; ++i) {
      const double scale = i % 2 ? 0.7 : 20;
      Vec3 p = found.center();
      bool outside = false;
      for (int axis = 0; axis < 3; ++axis) {
        p[axis] += scale * found.size()[axis] * unit(random);
        outside = outside || p[axis] < found.lo[axis] || p[axis] > found.hi[axis];
      }
      const bool solid = evaluator.value(p) >= 0;
      EXPECT_FALSE(outside && solid);
      inside += solid;
    }
    EXPECT_GT(inside, 10u);
  }
}

TEST(Bounds, ErrorsForUnboundedAndEmptySolids) {
  HalfSpace half_space;
  for (const Expression& field : {cylinder(3), at_point(half_space), gyroid(1, 0.3), constant(1),
                                  call(make_operation(Negate()), {box({1, 1, 1})})}) {
    EXPECT_THAT(error_of(field), HasSubstr("intersect it with a box or a half_space"));
  }
  EXPECT_THAT(error_of(constant(-1)), HasSubstr("the solid is empty"));
  const Expression apart = of(IntersectionOf<MinMax>(), sphere(1), sphere(1, {5, 0, 0}));
  EXPECT_THAT(error_of(apart), HasSubstr("the solid is empty"));
  EXPECT_THAT(error_of(of(Subtract(), sphere(1), constant(1))), HasSubstr("no volume"));
}

TEST(Bounds, StatedOnesAreProven) {
  const Expression field = box({20, 12, 8});
  const BoundingBox found =
      certified_bounds(Evaluator(field), {}, BoundingBox{{-10, -6, -4}, {10, 6, 4}});
  EXPECT_NEAR(found.hi[0], 10, 1e-3 * 25);
  EXPECT_EQ(error_of(field, BoundingBox{{-20, -20, -20}, {20, 20, 20}}), "no error");
  const std::string message = error_of(field, BoundingBox{{-20, -20, -20}, {9, 20, 20}});
  EXPECT_THAT(message, HasSubstr("stated bounds: x goes up to 10"));
  EXPECT_THAT(message, HasSubstr("stated is 9"));
}

TEST(Bounds, Cancels) {
  const Progress never = [](double) { return false; };
  EXPECT_THROW(certified_bounds(Evaluator(block_with_holes()), never), Cancelled);
}

}  // namespace
}  // namespace sardf

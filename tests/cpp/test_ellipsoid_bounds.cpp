// Bounds of ellipsoids and ellipses over boxes, held to points on parallel surfaces: at surface
// point + t normal, within the centres of curvature, the distance is -t and its gradient -normal.
#include <gtest/gtest.h>

#include <cmath>

#include "laws.hpp"
#include "sardf/certify.hpp"
#include "sardf/constructor.hpp"
#include "sardf/field.hpp"
#include "sardf/operation_of.hpp"
#include "sardf/ops.hpp"

namespace sardf {
namespace {

using laws::Random;

OperationPointer ellipsoid(const Vec3& center, const Vec3& radii) {
  Ellipsoid op;
  op.center = center;
  op.radii = radii;
  return make_operation(op);
}
OperationPointer ellipse(const Vec2& center, const Vec2& radii) {
  Ellipse op;
  op.center = center;
  op.radii = radii;
  return make_operation(op);
}

struct Known {
  Vec3 at{}, normal{};
  double distance = 0;
};

// The last axis of an ellipse is left out: its radius is 0.
Known random_known(Random& r, const Vec3& radii) {
  Vec3 u{r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1)};
  // Also in and near the planes and on and near the axes.
  for (double& a : u) a *= r.one_of(std::vector<double>{1, 1, 1, 0, 1e-3, 1e-9});
  double least = infinity, most = 0;
  for (size_t k = 0; k < 3; ++k) {
    if (radii[k] == 0) u[k] = 0;
    if (radii[k] > 0) least = std::min(least, radii[k]);
    most = std::max(most, radii[k]);
  }
  if (norm(u) == 0) u[0] = 1;
  u = (1 / norm(u)) * u;
  Known out;
  for (size_t k = 0; k < 3; ++k) out.normal[k] = radii[k] > 0 ? u[k] / radii[k] : 0;
  out.normal = (1 / norm(out.normal)) * out.normal;
  // The least radius of curvature of all is least² / most.
  const double t = r.chance(0.4)   ? -r.uniform(0, 0.999) * least * least / most
                   : r.chance(0.5) ? r.uniform(0, 2) * most
                                   : r.uniform(0, 1e-3) * most;
  for (size_t k = 0; k < 3; ++k) out.at[k] = radii[k] * u[k] + t * out.normal[k];
  out.distance = -t;
  return out;
}

Slope slope_over(const Operation& op, const std::array<Interval, 3>& box) {
  std::array<Slope, max_arity> in;
  for (size_t axis = 0; axis < 3; ++axis) {
    in[axis].value = box[axis];
    in[axis].partial[axis] = 1;
    in[axis].length = 1;
  }
  return op.slope(in.data());
}

void expect_known_values_in_bounds(const Operation& op, const Vec3& center, const Vec3& radii,
                                   Random& r) {
  const Known known = random_known(r, radii);
  std::array<Interval, 3> box;
  for (size_t axis = 0; axis < 3; ++axis) {
    const double size = r.one_of(std::vector<double>{0, 1e-12, 1e-6, 0.01, 0.3, 3});
    const double at = center[axis] + known.at[axis];
    // The point is rounded, and so are its distance and its normal.
    box[axis] = {at - r.uniform(0, size) - 1e-13, at + r.uniform(0, size) + 1e-13};
  }
  const Slope slope = slope_over(op, box);
  const std::string place = testing::PrintToString(known.at) + " in radii " +
                            testing::PrintToString(radii) + " box " +
                            testing::PrintToString(std::array{box[0].lo, box[0].hi, box[1].lo,
                                                              box[1].hi, box[2].lo, box[2].hi});
  EXPECT_LE(slope.value.lo, known.distance + 1e-12) << place;
  EXPECT_GE(slope.value.hi, known.distance - 1e-12) << place;
  EXPECT_LE(slope.length, 1 + 1e-9) << place;
  for (size_t axis = 0; axis < 3; ++axis) {
    EXPECT_LE(slope.partial[axis].lo, -known.normal[axis] + 1e-9) << axis << " at " << place;
    EXPECT_GE(slope.partial[axis].hi, -known.normal[axis] - 1e-9) << axis << " at " << place;
  }
}

TEST(EllipsoidBounds, HoldTheNormalsOfParallelSurfaces) {
  Random r(11);
  for (int i = 0; i < laws::effort(3000); ++i) {
    Vec3 radii{r.uniform(0.1, 4), r.uniform(0.1, 4), r.uniform(0.1, 4)};
    if (r.chance(0.3)) radii[1] = radii[0];
    if (r.chance(0.2)) radii[2] = radii[0];
    if (r.chance(0.1)) radii[2] = std::max(radii[0], radii[1]) / 150;
    const Vec3 center{r.uniform(-3, 3), r.uniform(-3, 3), r.uniform(-3, 3)};
    expect_known_values_in_bounds(*ellipsoid(center, radii), center, radii, r);
  }
}

TEST(EllipsoidBounds, OfAnEllipseHoldThemToo) {
  Random r(12);
  for (int i = 0; i < laws::effort(3000); ++i) {
    const Vec2 radii{r.uniform(0.1, 4), r.chance(0.1) ? 0.05 : r.uniform(0.1, 4)};
    const Vec2 center{r.uniform(-3, 3), r.uniform(-3, 3)};
    expect_known_values_in_bounds(*ellipse(center, radii), {center[0], center[1], 0},
                                  {radii[0], radii[1], 0}, r);
  }
}

// The gradient turns by at most the box's diagonal over the radius of curvature there, on parallel
// surfaces that of the ellipsoid changed by the distance: at least least² / most - depth.
TEST(EllipsoidBounds, AreAsTightAsCurvatureAllows) {
  Random r(13);
  const Vec3 radii{5, 2, 1.5};
  const OperationPointer op = ellipsoid({}, radii);
  const double least = 1.5 * 1.5 / 5;
  for (int i = 0; i < laws::effort(1000); ++i) {
    const Known known = random_known(r, radii);
    if (known.distance > 0.5 * least) continue;
    const double size = r.one_of(std::vector<double>{1e-6, 1e-4, 0.01});
    std::array<Interval, 3> box;
    for (size_t axis = 0; axis < 3; ++axis) {
      box[axis] = {known.at[axis] - size / 2, known.at[axis] + size / 2};
    }
    const Slope slope = slope_over(*op, box);
    for (const Interval& partial : slope.partial) {
      EXPECT_LE(partial.hi - partial.lo, 3 * size * std::sqrt(3) / (0.5 * least) + 1e-9)
          << testing::PrintToString(known.at) << " size " << size;
    }
    // The value changes by no more than the diagonal.
    EXPECT_LE(slope.value.hi - slope.value.lo, 1.0001 * std::sqrt(3) * size + 1e-11);
  }
}

TEST(EllipsoidBounds, KnowNothingOfDirectionsAtTheCentre) {
  const Slope slope =
      slope_over(*ellipsoid({1, 2, 3}, {3, 2, 1}), {Interval{0.9, 1.1}, {1.9, 2.1}, {2.9, 3.1}});
  EXPECT_LE(slope.partial[2].lo, -1 + 1e-9);
  EXPECT_GE(slope.partial[2].hi, 1 - 1e-9);
  EXPECT_LE(slope.length, 1 + 1e-9);
}

TEST(EllipsoidBounds, AreNoNumbersNowhere) {
  const OperationPointer op = ellipsoid({}, {3, 2, 1});
  const std::vector<Interval> sides{Interval::all(), {0, infinity},  {-infinity, -7}, 0,
                                    {0, 1e-320},     {1e300, 1e301}, {-1e-9, 1e-9},   {5, 5}};
  for (const Interval& a : sides) {
    for (const Interval& b : sides) {
      for (const Interval& c : sides) {
        const Slope slope = slope_over(*op, {a, b, c});
        EXPECT_LE(slope.value.lo, slope.value.hi);
        EXPECT_LE(slope.length, 1 + 1e-12);
        for (const Interval& partial : slope.partial) EXPECT_LE(partial.lo, partial.hi);
      }
    }
  }
}

// Two ellipsoids of the paper's section 5: where they meet their normals are far enough apart.
TEST(EllipsoidBounds, LetABlendKnowTheAngle) {
  const auto solid = [](const Vec3& center, const Vec3& radii) {
    return call(ellipsoid(center, radii), {coordinate(0), coordinate(1), coordinate(2)});
  };
  UnionOf<Sardf> join;
  join.radius = 0.5;
  const Expression both =
      call(make_operation(join), {solid({5, 0, 0}, {5, 2, 2}), solid({5, 0, -5}, {2, 2, 5})});
  const BoundingBox near{{6.6, -0.3, -2.3}, {7.2, 0.3, -1.7}};
  EXPECT_LE(lipschitz_bound(Evaluator(both), near, 2000), 1.001);
}

}  // namespace
}  // namespace sardf

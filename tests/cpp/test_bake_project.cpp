// Points of texels moved onto the surface, against Newton's steps of each point in double.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "bake_scenes.hpp"
#include "sardf/bake_stages.hpp"

namespace sardf::test {
namespace {

struct Case {
  const char* name;
  Expression (*solid)();
  BoundingBox bounds;
};

void PrintTo(const Case& each, std::ostream* out) { *out << each.name; }

Expression sharp_block() {
  Expression f = min(box({0, 0, 0}, {20, 12, 8}), -cylinder({0, 0, 0}, 3));
  for (const double x : {-8.0, 8.0})
    for (const double y : {-4.0, 4.0}) f = min(f, -cylinder({x, y, 0}, 1));
  return f;
}
Expression ellipsoid() {
  Ellipsoid op;
  op.radii = {3, 2, 1};
  return solid(op);
}
/// A shell of 0.4, open above.
Expression thin_shell() {
  return min(min(sphere({0, 0, 0}, 3), -sphere({0, 0, 0}, 2.6)), constant(1) - coordinate(2));
}
/// A roof whose two planes meet at 150 degrees, on a bent floor.
Expression obtuse_edge() {
  const double slope = std::tan(M_PI / 12);
  return min(min(constant(1) - coordinate(2) - constant(slope) * coordinate(0),
                 constant(1) - coordinate(2) + constant(slope) * coordinate(0)),
             cylinder({0, 0, 0}, 2));
}

class Projection : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Bake, Projection,
                         testing::ValuesIn(std::vector<Case>{
                             {"blended_block", block_with_bores, block_bounds()},
                             {"sharp_block", sharp_block, block_bounds()},
                             {"ellipsoid", ellipsoid, {{-3.1, -2.1, -1.1}, {3.1, 2.1, 1.1}}},
                             {"thin_shell", thin_shell, {{-3.1, -3.1, -3.1}, {3.1, 3.1, 3.1}}},
                             {"obtuse_edge", obtuse_edge, {{-2.1, -2.1, -2.1}, {2.1, 2.1, 2.1}}}}),
                         [](const auto& each) { return std::string(each.param.name); });

struct Place {
  Vec3 at;
  double field;
};

/// Where up to three steps along the point's own gradients lead, in double, by the rules of
/// bake.hpp.
Place by_own_steps(const Evaluator& solid, const Vec3& start, const baking::PointSurface& on,
                   double tolerance) {
  const Vec3 normal{on.normal[0], on.normal[1], on.normal[2]};
  double from;
  Vec3 at = start, gradient;
  solid.gradients(at.data(), 1, &from, gradient.data());
  double field = from;
  for (int step = 0; step < 3 && std::abs(field) > tolerance; ++step) {
    const double squared = dot(gradient, gradient), cosine = dot(gradient, normal);
    if (!(cosine * cosine >= 0.5 * squared)) break;
    const Vec3 to = at - (field / squared) * gradient;
    if (norm(to - start) > on.limit) return {start, from};
    at = to;
    solid.gradients(at.data(), 1, &field, gradient.data());
  }
  return std::abs(field) <= std::abs(from) ? Place{at, field} : Place{start, from};
}

Vec3 point_of(const baking::TilePoints& points, size_t k) {
  return {points.point[0][k], points.point[1][k], points.point[2][k]};
}

double field_at(const Evaluator& solid, const Vec3& at) {
  double field;
  solid.values(at, &field);
  return field;
}

/// Whether own steps end off the surface, since another face is nearer at the start, but `to` lies
/// on the surface and on the right face.
bool is_better(const Evaluator& solid, const Vec3& to, const Place& own,
               const baking::PointSurface& on, double tolerance) {
  double field;
  Vec3 gradient;
  solid.gradients(to.data(), 1, &field, gradient.data());
  const double cosine = dot(gradient, Vec3{on.normal[0], on.normal[1], on.normal[2]});
  return std::abs(own.field) > tolerance && std::abs(field) <= 2 * tolerance &&
         cosine * cosine >= 0.5 * dot(gradient, gradient);
}

TEST_P(Projection, IsAsGoodAsOwnStepsAndOnTheSameFace) {
  constexpr int size = 2048;
  const Part p(GetParam().solid(), GetParam().bounds, 32, size);
  const TexelMap texels(p.mesh, size, p.atlas.gutter);
  const Evaluator solid(p.solid);
  const LocalEvaluator local(solid, GetParam().bounds);
  const double tolerance = 2e-7 * GetParam().bounds.diagonal(), texel = 1 / p.atlas.texels_per_unit;
  const double rounding = 1e-6;  // of the field in single precision, at coordinates of a few units
  const auto before = std::make_unique<baking::TilePoints>();
  const auto after = std::make_unique<baking::TilePoints>();
  baking::Guides guides;
  size_t bent = 0, moved = 0;
  for (size_t tile = 0; tile < texels.layout().tiles(); tile += 9) {
    baking::find_texels(texels.layout(), tile, *before);
    baking::find_guides(local, *before, float(tolerance), guides);
    bent += guides.bends.size();
    *after = *before;
    baking::project(local, *after, float(tolerance));
    for (size_t k = 0; k < before->count; ++k) {
      const Vec3 from = point_of(*before, k), to = point_of(*after, k);
      const baking::PointSurface& on = before->surfaces[before->on[k]];
      const Place own = by_own_steps(solid, from, on, tolerance);
      ASSERT_LE(std::abs(field_at(solid, to)), std::max(std::abs(own.field), tolerance) + rounding)
          << "at x, y, z = " << from[0] << ", " << from[1] << ", " << from[2];
      ASSERT_TRUE(norm(to - own.at) <= 0.05 * texel || is_better(solid, to, own, on, tolerance))
          << "at x, y, z = " << from[0] << ", " << from[1] << ", " << from[2];
      moved += to != from;
    }
  }
  EXPECT_GT(bent, 100u);
  EXPECT_GT(moved, 50000u);
}

// A ball under one triangle, with a groove between the nodes of the triangle's bend: the points in
// the groove, whose gradients point sideways, stay where they are.
TEST(BakeBend, LeavesPointsOfAGrooveToTheirOwnSteps) {
  Mesh mesh;
  mesh.vertices = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.faces = {{0, 1, 2, 2}};
  mesh.corner_uv = {{0.1, 0.1}, {0.9, 0.1}, {0.1, 0.9}, {0.1, 0.9}};
  const TexelMap texels(mesh, 64, 0);
  const double radius = 20, c = (1 - std::sqrt(3 * radius * radius - 2)) / 3, third = 1. / 3;
  const Expression ball = sphere({c, c, c}, radius);
  const Expression groove = sphere({third + 0.03, third + 0.06, third - 0.09}, 0.06);
  const float tolerance = 5e-6f;
  const auto points_that_stay = [&](const Expression& f) {
    const Evaluator solid(f);
    const LocalEvaluator local(solid, {{0, 0, 0}, {1, 1, 1}});
    const auto before = std::make_unique<baking::TilePoints>();
    baking::find_texels(texels.layout(), 0, *before);
    const auto after = std::make_unique<baking::TilePoints>(*before);
    baking::Guides guides;
    baking::find_guides(local, *before, tolerance, guides);
    EXPECT_EQ(guides.bends.size(), 1u);
    baking::project(local, *after, tolerance);
    size_t staying = 0;
    for (size_t k = 0; k < before->triangles[0].texels; ++k) {
      const Vec3 from = point_of(*before, k), to = point_of(*after, k);
      const baking::PointSurface& on = before->surfaces[before->on[k]];
      const Place own = by_own_steps(solid, from, on, tolerance);
      EXPECT_TRUE(norm(to - own.at) <= 2 * tolerance || is_better(solid, to, own, on, tolerance))
          << k;
      staying += std::abs(own.field) > 1e-3 && to == from;
    }
    return staying;
  };
  EXPECT_EQ(points_that_stay(ball), 0u);
  EXPECT_GT(points_that_stay(min(ball, -groove)), 5u);
}

}  // namespace
}  // namespace sardf::test

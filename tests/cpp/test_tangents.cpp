// Tangents of texture coordinates, and normal maps baked in their frames.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "bake_scenes.hpp"
#include "error_of.hpp"
#include "sardf/error.hpp"
#include "sardf/formula.hpp"
#include "sardf/tangents.hpp"

namespace sardf::test {
namespace {

/// A flat grid over [-1, 1]² at z = 0, with u and v given as functions of x and y.
template <class Uv>
Mesh grid(int cells, Uv uv) {
  Mesh mesh;
  const auto index = [cells](int i, int j) { return static_cast<uint32_t>(j * (cells + 1) + i); };
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i)
      mesh.vertices.push_back({2. * i / cells - 1, 2. * j / cells - 1, 0});
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i)
      mesh.faces.push_back({index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)});
  for (const auto& face : mesh.faces)
    for (const uint32_t v : face) {
      mesh.corner_uv.push_back(uv(mesh.vertices[v][0], mesh.vertices[v][1]));
      mesh.corner_normals.push_back({0, 0, 1});
    }
  return mesh;
}
Vec2 upright(double x, double y) { return {0.5 + 0.45 * x, 0.5 + 0.45 * y}; }
Vec2 mirrored(double x, double y) { return {0.5 - 0.45 * x, 0.5 + 0.45 * y}; }
Vec2 turned(double x, double y) { return {0.5 + 0.45 * y, 0.5 - 0.45 * x}; }

/// Solid below a wavy surface near z = 0; its outward unit normal is that of the height field.
Expression waves() {
  return parse_formula("0.02*sin(3*x) + 0.03*sin(2*y) - z", {}, {}).expression();
}
Vec3 normal_of_waves(double x, double y) {
  return normalized({-0.06 * std::cos(3 * x), -0.06 * std::cos(2 * y), 1});
}

const BakeChannel normal_channel{"normal", {}, true};

Image bake_normals(const Mesh& mesh, const Expression& solid, int size) {
  const TexelMap texels(mesh, size);
  return bake_images(texels, solid, std::span(&normal_channel, 1))[0];
}

/// The largest difference of a map of waves() from expected(n), over the texels inside the map.
template <class Uv, class Expected>
double error_on_waves(Uv uv, Expected expected) {
  const int size = 96;
  const Image image = bake_normals(grid(4, uv), waves(), size);
  double worst = 0;
  for (int j = 8; j < size - 8; ++j)
    for (int i = 8; i < size - 8; ++i) {
      // Each of the three maps is linear and its own inverse up to a turn.
      const double u = ((i + 0.5) / size - 0.5) / 0.45, v = (0.5 - (j + 0.5) / size) / 0.45;
      Vec2 at{u, v};
      if (uv(1., 0.)[0] < 0.5 - 1e-9) at = {-u, v};
      if (std::abs(uv(1., 0.)[0] - 0.5) < 1e-9) at = {-v, u};
      const Vec3 wanted = expected(normal_of_waves(at[0], at[1]));
      for (int c = 0; c < 3; ++c)
        worst = std::max(worst, std::abs(image.at(i, j)[c] - (0.5 + 0.5 * wanted[size_t(c)])));
    }
  return worst;
}

void expect_tangents(const Mesh& mesh, const std::array<float, 4>& expected) {
  for (const auto& t : corner_tangents(mesh))
    for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(t[i], expected[i], 1e-6);
}

TEST(Tangents, FollowUAndTellMirroredTextures) {
  expect_tangents(grid(3, upright), {1, 0, 0, 1});
  expect_tangents(grid(3, mirrored), {-1, 0, 0, -1});
  expect_tangents(grid(3, turned), {0, 1, 0, 1});
}

TEST(Tangents, OfOneTriangleAreWeighedByNothingButItself) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}};
  mesh.faces = {{0, 1, 2, 2}};
  mesh.corner_normals.assign(4, {0, 0, 1});
  mesh.corner_uv = {{0, 0}, {1, 1}, {0, 1}, {0, 1}};
  // p = u e1' + v e2' with e1' = (2, -1), e2' = (0, 1): u grows along (2, -1).
  expect_tangents(mesh, {2 / std::sqrt(5.f), -1 / std::sqrt(5.f), 0, 1});
}

TEST(Tangents, WithoutAreaInTheTextureAreStillUnitAndPerpendicular) {
  const Mesh mesh = grid(2, [](double x, double) { return Vec2{0.5 + 0.4 * x, 0.5}; });
  for (const auto& t : corner_tangents(mesh)) {
    EXPECT_NEAR(std::hypot(t[0], t[1], t[2]), 1, 1e-6);
    EXPECT_NEAR(t[2], 0, 1e-6);
    EXPECT_EQ(t[3], 1);
  }
}

TEST(Tangents, NeedNormalsAndCoordinates) {
  Mesh mesh = grid(1, upright);
  mesh.corner_normals.clear();
  EXPECT_THAT(error_of([&] { corner_tangents(mesh); }), testing::HasSubstr("tangents need"));
  EXPECT_THROW(corner_tangents(grid(1, upright), [](double) { return false; }), Cancelled);
}

TEST(NormalMap, OfFlatFacesIsTheColorOfNoBend) {
  const Image image = bake_normals(grid(4, turned), -xyz()[2], 64);
  for (size_t i = 0; i < image.samples.size(); i += 3) {
    ASSERT_NEAR(image.samples[i], 0.5, 1e-6);
    ASSERT_NEAR(image.samples[i + 1], 0.5, 1e-6);
    ASSERT_NEAR(image.samples[i + 2], 1, 1e-6);
  }
}

TEST(NormalMap, SaysTheSolidsNormalAlongUAndV) {
  EXPECT_LT(error_on_waves(upright, [](const Vec3& n) { return n; }), 1e-3);
  EXPECT_LT(error_on_waves(mirrored, [](const Vec3& n) { return Vec3{-n[0], n[1], n[2]}; }), 1e-3);
  EXPECT_LT(error_on_waves(turned, [](const Vec3& n) { return Vec3{n[1], -n[0], n[2]}; }), 1e-3);
}

TEST(NormalMap, KeepsTheMeshsNormalWhereTheSolidsIsAnothers) {
  const Image image = bake_normals(grid(4, upright), -xyz()[0], 64);
  EXPECT_FLOAT_EQ(image.at(32, 32)[2], 1);
}

TEST(NormalMap, NeedsASolid) {
  const Mesh mesh = grid(1, upright);
  EXPECT_THAT(error_of([&] { bake_normals(mesh, {}, 32); }), testing::HasSubstr("of a solid"));
}

}  // namespace
}  // namespace sardf::test

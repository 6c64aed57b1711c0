// The baker on any UV map, its errors, and what it does with values that are not finite.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <atomic>
#include <chrono>
#include <random>
#include <thread>

#include "bake_scenes.hpp"
#include "error_of.hpp"
#include "sanitized.hpp"
#include "sardf/bake_stages.hpp"
#include "sardf/error.hpp"

namespace sardf::test {
namespace {

/// A cube of edge 2 whose six faces are squares of `side` in a 3 x 2 grid of the image.
Mesh unwrapped_cube(double side) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back({i & 1 ? 1. : -1., i & 2 ? 1. : -1., i & 4 ? 1. : -1.});
  mesh.faces = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (int f = 0; f < 6; ++f) {
    const double u = 0.05 + f % 3 / 3., v = 0.05 + f / 3 / 2.;
    for (const Vec2& p :
         {Vec2{u, v}, Vec2{u + side, v}, Vec2{u + side, v + side}, Vec2{u, v + side}})
      mesh.corner_uv.push_back(p);
  }
  return mesh;
}

BakeChannel coordinates() {
  const auto [x, y, z] = xyz();
  return {"xyz", {x, y, z}};
}

struct Baked {
  Image image;
  std::vector<unsigned char> covered;
  BakeReport report;
};

Baked bake_one(const TexelMap& texels, const Expression& solid, const BakeChannel& channel) {
  Baked baked;
  baked.report = bake(texels, solid, std::span(&channel, 1),
                      [&](size_t, Image&& image, const std::vector<unsigned char>& covered) {
                        baked.image = std::move(image);
                        baked.covered = covered;
                      });
  return baked;
}

double largest_error(const Mesh& mesh, const Image& image) {
  double worst = 0;
  for (const SurfacePoint& p : random_points(mesh, 5000, 4)) {
    const Lookup lookup(p.uv, image.width);
    for (int c = 0; c < 3; ++c)
      worst = std::max(worst, std::abs(lookup.of(image, c) - p.position[c]));
  }
  return worst;
}

TEST(BakeMap, TexelsAreWhereTheConventionSays) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};
  mesh.faces = {{0, 1, 2, 3}};
  mesh.corner_uv = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const Baked baked = bake_one(TexelMap(mesh, 4), nullptr, coordinates());
  EXPECT_EQ(baked.report.covered, 16u);
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) {
      EXPECT_FLOAT_EQ(baked.image.at(i, j)[0], float(i) + 0.5f);
      EXPECT_FLOAT_EQ(baked.image.at(i, j)[1], 3.5f - float(j));
    }
}

TEST(BakeMap, AnyMapWithoutOverlapsWillDo) {
  const Mesh cube = unwrapped_cube(0.21);
  const Baked baked = bake_one(TexelMap(cube, 500), nullptr, coordinates());
  EXPECT_LT(largest_error(cube, baked.image), 1e-5);

  Mesh mirrored = cube;
  for (Vec2& uv : mirrored.corner_uv) uv[0] = 1 - uv[0];
  EXPECT_LT(
      largest_error(mirrored, bake_one(TexelMap(mirrored, 500), nullptr, coordinates()).image),
      1e-5);
}

TEST(BakeMap, GutterContinuesTheSurface) {
  const Mesh cube = unwrapped_cube(0.2);
  for (const int gutter : {0, 4, 8}) {
    const Baked baked = bake_one(TexelMap(cube, 300, gutter), nullptr, coordinates());
    // Face 0, at u, v from 0.05 to 0.25 and so from texel 15 to 75, is the plane z = -1 with
    // x = -1 at its lower border, y = -1 at its left one and 30 texels to one unit.
    const double reach = std::max(gutter, 1);
    const auto at = [&](double i) { return static_cast<int>(i); };
    const float* left = baked.image.at(at(15 - reach), 300 - 45);
    EXPECT_NEAR(left[1], -1 - (reach - 0.5) / 30, 1e-5);
    EXPECT_NEAR(left[2], -1, 1e-6);
    EXPECT_EQ(baked.covered[size_t(300 - 45) * 300 + at(15 - std::max(gutter, 2) - 1)], 0);
  }
}

TEST(BakeMap, CoordinatesOutsideTheImageAreLeftOut) {
  Mesh cube = unwrapped_cube(0.2);
  for (size_t i = 0; i < 4; ++i) cube.corner_uv[i] = {cube.corner_uv[i][0] - 1e9, 0.5};
  for (size_t i = 4; i < 8; ++i) cube.corner_uv[i][0] -= 0.45;
  const Baked baked = bake_one(TexelMap(cube, 200), nullptr, coordinates());
  EXPECT_GT(baked.report.covered, size_t(0.16 * 200 * 200));
  for (Vec2& uv : cube.corner_uv) uv[0] += 7;
  EXPECT_THAT(error_of([&] { bake_one(TexelMap(cube, 200), nullptr, coordinates()); }),
              testing::HasSubstr("no texel lies on the mesh"));
}

TEST(BakeMap, DegenerateFacesDoNoHarm) {
  Mesh cube = unwrapped_cube(0.2);
  cube.faces.push_back({0, 2, 3, 3});
  cube.faces.push_back({0, 0, 0, 0});
  for (int i = 0; i < 8; ++i) cube.corner_uv.push_back({0.97, 0.97});
  const Baked baked = bake_one(TexelMap(cube, 200), nullptr, coordinates());
  for (const float a : baked.image.samples) ASSERT_TRUE(std::isfinite(a));
}

// Faces as thin as rounding through centres of texels: what lies on them lies within their corners,
// whatever rounding does to weights.
TEST(BakeMap, PointsOfThinFacesLieOnThem) {
  constexpr int size = 64;
  std::mt19937_64 random(41);
  std::uniform_real_distribution<double> any(0, 1);
  size_t on_face = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec2 centre{(20 + 0.5) / size, (30 + 0.5) / size};
    const double angle = 6.283 * any(random), x = std::cos(angle), y = std::sin(angle);
    const double before = 0.3 * any(random), behind = 0.3 * any(random);
    const double thickness = std::pow(10, -11 - 6 * any(random));
    Mesh mesh;
    mesh.vertices = {{1, 1, 1}, {2, 1, 1}, {2, 2, 1}, {1, 2, 1}};
    mesh.faces = {{0, 1, 2, 3}};
    for (const auto& [along, across] : {Vec2{-before, -thickness}, Vec2{behind, -thickness},
                                        Vec2{behind, thickness}, Vec2{-before, thickness}})
      mesh.corner_uv.push_back(
          {centre[0] + along * x - across * y, centre[1] + along * y + across * x});
    const TexelMap map(mesh, size, 0);
    baking::TilePoints points;
    baking::find_texels(map.layout(), 0, points);
    for (size_t k = 0; k < points.count; ++k) {
      // Beside the face the limit is larger than half of its longest edge.
      if (points.surfaces[points.on[k]].limit != 0.5f) continue;
      ++on_face;
      for (size_t axis = 0; axis < 2; ++axis) {
        ASSERT_GE(points.point[axis][k], 1 - 1e-6) << thickness;
        ASSERT_LE(points.point[axis][k], 2 + 1e-6) << thickness;
      }
    }
  }
  EXPECT_GT(on_face, 100u);
}

/// Whether a point lies in a triangle, whichever way round its corners are.
bool lies_in(const std::array<Vec2, 3>& corner, const Vec2& p) {
  int left = 0;
  for (size_t k = 0; k < 3; ++k) {
    const Vec2 &a = corner[k], &b = corner[(k + 1) % 3];
    left += (b[0] - a[0]) * (p[1] - a[1]) > (b[1] - a[1]) * (p[0] - a[0]);
  }
  return left == 0 || left == 3;
}

TEST(BakeMap, OfFacesThatOverlapTheFirstIsSeen) {
  constexpr int size = 64;
  std::mt19937_64 random(43);
  std::uniform_real_distribution<double> any(0, 1);
  for (int i = 0; i < 200; ++i) {
    // Each at its own height.
    Mesh mesh;
    for (uint32_t f = 0; f < 6; ++f) {
      for (int k = 0; k < 3; ++k) mesh.vertices.push_back({any(random), any(random), double(f)});
      mesh.faces.push_back({3 * f, 3 * f + 1, 3 * f + 2, 3 * f + 2});
      for (const uint32_t v : mesh.faces.back())
        mesh.corner_uv.push_back({mesh.vertices[v][0], mesh.vertices[v][1]});
    }
    std::vector<float> expected(size * size, -1);
    for (size_t f = 6; f-- > 0;)
      for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
          if (lies_in({mesh.corner_uv[4 * f], mesh.corner_uv[4 * f + 1], mesh.corner_uv[4 * f + 2]},
                      {(x + 0.5) / size, 1 - (y + 0.5) / size}))
            expected[size_t(y) * size + size_t(x)] = float(f);
    baking::TilePoints points;
    const TexelMap map(mesh, size, 0);
    baking::find_texels(map.layout(), 0, points);
    std::vector<float> found(size * size, -1);
    for (const baking::TexelRun& run : points.runs)
      for (size_t k = 0; k < run.count; ++k)
        found[size_t(run.y) * size + run.x + k] = points.point[2][run.first + k];
    ASSERT_EQ(found, expected);
  }
}

TEST(BakeMap, SaysWhatIsWrong) {
  const Mesh cube = unwrapped_cube(0.2);
  Mesh bad = cube;
  bad.corner_uv.clear();
  EXPECT_THAT(error_of([&] { TexelMap(bad, 64); }), testing::HasSubstr("found 0 for 6 faces"));
  bad = cube;
  bad.corner_uv[9][1] = NAN;
  EXPECT_THAT(error_of([&] { TexelMap(bad, 64); }), testing::HasSubstr("face 2 is not finite"));
  bad = cube;
  bad.faces[3][1] = 8;
  EXPECT_THAT(error_of([&] { TexelMap(bad, 64); }), testing::HasSubstr("there are 8"));
  bad = cube;
  bad.vertices[3][0] = INFINITY;
  EXPECT_THAT(error_of([&] { TexelMap(bad, 64); }), testing::HasSubstr("vertex of face 0"));
  bad = cube;
  for (size_t i = 0; i < 24; ++i)
    bad.corner_uv[i] = {i % 4 == 1 || i % 4 == 2 ? 1. : 0., i % 4 > 1 ? 1. : 0.};
  EXPECT_THAT(error_of([&] { TexelMap(bad, 64); }), testing::HasSubstr("covers the image 6 times"));
  EXPECT_THAT(error_of([&] { TexelMap(Mesh{}, 64); }), testing::HasSubstr("without faces"));
  EXPECT_THAT(error_of([&] { TexelMap(cube, 0); }), testing::HasSubstr("texture of 0 texels"));
  EXPECT_THAT(error_of([&] { TexelMap(cube, 64, 65); }), testing::HasSubstr("gutter of 65"));
  EXPECT_THAT(error_of([&] {
                bake_one(TexelMap(cube, 64), nullptr, {"empty", {}});
              }),
              testing::HasSubstr("'empty' has no components"));
}

TEST(BakeValues, SingularPointsTakeTheValueCloseBy) {
  const Mesh cube = unwrapped_cube(0.2);
  const Expression f = box({0, 0, 0}, {2, 2, 2});
  // 0/0 everywhere on the surface, 1 elsewhere.
  const Baked baked = bake_one(TexelMap(cube, 200, 0), f, {"ratio", {f / f}});
  EXPECT_EQ(baked.report.undefined, std::vector<size_t>{0});
  for (size_t i = 0; i < baked.covered.size(); ++i)
    ASSERT_EQ(baked.image.samples[i], baked.covered[i] ? 1 : 0);
}

TEST(BakeValues, WhatIsNowhereFiniteIsZeroAndCounted) {
  const Mesh cube = unwrapped_cube(0.2);
  const Expression x = coordinate(0);
  const Baked baked = bake_one(TexelMap(cube, 200), nullptr,
                               {"half", {constant(1) / max(x, constant(0)), log(x), x}});
  EXPECT_GT(baked.report.undefined[0], baked.report.covered / 3);
  EXPECT_LT(baked.report.undefined[0], baked.report.covered * 2 / 3);
  for (const float a : baked.image.samples) ASSERT_TRUE(std::isfinite(a));
}

TEST(BakeValues, ASolidWithoutGradientLeavesThePointsWhereTheyAre) {
  const Mesh cube = unwrapped_cube(0.2);
  // Its value is 0.1 off the cube's surface and its gradient not a number: |(0, 0)|.
  const Expression zero = coordinate(0) - coordinate(0);
  const Expression f = box({0, 0, 0}, {2.1, 2.1, 2.1}) + length(zero, zero);
  float at[3] = {1, 0.2f, 0.3f}, gradient[3];
  Evaluator(f).gradients(at, 1, nullptr, gradient);
  ASSERT_TRUE(std::isnan(gradient[0]));
  EXPECT_LT(largest_error(cube, bake_one(TexelMap(cube, 300), f, coordinates()).image), 1e-5);
}

TEST(BakeValues, NoPointIsMovedFarOrSideways) {
  const Mesh cube = unwrapped_cube(0.2);
  // The zero set is three edges away, and beside the faces whose normal is not x.
  for (const Expression& f : {sphere({0, 0, 0}, 8), constant(0.1) - coordinate(0)}) {
    const Baked baked = bake_one(TexelMap(cube, 300), f, coordinates());
    EXPECT_LT(largest_error(cube, baked.image), 0.9001) << "at most half an edge";
    const float* on_top = baked.image.at(15 + 100 + 20, 300 - 40);
    EXPECT_NEAR(on_top[2], 1, 1e-6);
  }
}

TEST(BakeValues, PointsBeyondAFlatCreaseStayInTheirFacesPlane) {
  // A roof with the ridge along y at x = 0: z = 0 on the left, 30 degrees downhill on the right.
  const double slope = std::tan(M_PI / 6);
  Mesh roof;
  roof.vertices = {{-2, 0, 0}, {0, 0, 0},          {0, 2, 0},
                   {-2, 2, 0}, {2, 0, -2 * slope}, {2, 2, -2 * slope}};
  roof.faces = {{0, 1, 2, 3}, {1, 4, 5, 2}};
  roof.corner_uv = {{0.1, 0.1}, {0.3, 0.1}, {0.3, 0.3}, {0.1, 0.3},
                    {0.6, 0.1}, {0.8, 0.1}, {0.8, 0.3}, {0.6, 0.3}};
  roof.creases = {{1, 2}};
  const Expression f = min(-coordinate(2), -coordinate(2) - constant(slope) * coordinate(0));
  const Baked baked = bake_one(TexelMap(roof, 100), f, coordinates());
  for (int beyond = 0; beyond < 8; ++beyond) {
    const float* at = baked.image.at(30 + beyond, 80);
    EXPECT_NEAR(at[0], 0.1 * (beyond + 0.5), 1e-5);
    EXPECT_NEAR(at[2], 0, 1e-6);
  }
}

TEST(BakeValues, DoNotDependOnThreadsOrOnMemory) {
  const Expression f = block_with_bores();
  const Part p(f, block_bounds(), 48, 512);
  const TexelMap texels(p.mesh, 512);
  const std::vector<BakeChannel> channels{
      {"fractions_1", inverse_distance({distance_to({9, 5, 4}), abs(torus(5, 1))}, 2)},
      coordinates(),
      {"field", {f}}};
  const auto made = [&](size_t threads, size_t memory) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    std::vector<ImageSamples> images;
    std::vector<size_t> order;
    bake(
        texels, f, channels,
        [&](size_t k, Image&& image, const std::vector<unsigned char>&) {
          order.push_back(k);
          images.push_back(std::move(image.samples));
        },
        {}, memory);
    EXPECT_EQ(order, (std::vector<size_t>{0, 1, 2}));
    return images;
  };
  const auto once = made(1, size_t(1) << 30);
  EXPECT_EQ(made(4, size_t(1) << 30), once);
  EXPECT_EQ(made(2, 1), once);
}

/// Seconds from the user's cancel, 0.1 s after the start, to the end of the bake.
double lateness(const TexelMap& texels, const Expression& f, const BakeChannel& channel) {
  std::atomic<bool> wanted{true};
  std::chrono::steady_clock::time_point cancelled;
  std::thread user([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    cancelled = std::chrono::steady_clock::now();
    wanted = false;
  });
  double last = 0;
  const auto progress = [&](double share) {
    EXPECT_GE(share, last);
    EXPECT_LE(share, 1);
    last = share;
    return wanted.load();
  };
  const auto ignore = [](size_t, Image&&, const std::vector<unsigned char>&) {};
  EXPECT_THROW(bake(texels, f, std::span(&channel, 1), ignore, progress), Cancelled);
  const auto ended = std::chrono::steady_clock::now();
  user.join();
  return std::chrono::duration<double>(ended - cancelled).count();
}

TEST(BakeValues, ProgressRisesAndCancelStopsWithinATenthOfASecond) {
  const Expression f = block_with_bores();
  const Part p(f, block_bounds(), 48, 512);
  const TexelMap texels(p.mesh, 8192);
  const BakeChannel channel{"fractions_1", inverse_distance({distance_to({9, 5, 4}), f}, 3)};
  // The best of three: other work on the machine may take the processor away.
  double best = 1;
  for (int attempt = 0; attempt < 3; ++attempt) best = std::min(best, lateness(texels, f, channel));
  EXPECT_LT(best, at_once);
  RecordProperty("seconds", std::to_string(best));
  EXPECT_THROW(TexelMap(p.mesh, 512, 8, [](double) { return false; }), Cancelled);
}

TEST(BakeFill, MeanOfTheCovered) {
  Image image{2, 2, 2, {1, 10, 3, 30, 0, 0, 0, 0}};
  fill_with_mean(image, {1, 1, 0, 0});
  EXPECT_EQ(image.samples, (ImageSamples{1, 10, 3, 30, 2, 20, 2, 20}));
  EXPECT_THAT(error_of([&] {
                fill_with_mean(image, {0, 0, 0, 0});
              }),
              testing::HasSubstr("no texel of the texture is covered"));
}

}  // namespace
}  // namespace sardf::test

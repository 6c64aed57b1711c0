#include "sardf/mesher.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "mesh_checks.hpp"
#include "sardf/error.hpp"

namespace sardf {
namespace {

using namespace checks;
using testing::HasSubstr;

Mesh mesh_of(const Expression& field, const BoundingBox& bounds, int resolution = 48) {
  MeshOptions options;
  options.resolution = resolution;
  return make_mesh(Evaluator(field), bounds, options);
}

std::string error_of(const Expression& field, const BoundingBox& bounds,
                     const MeshOptions& options) {
  try {
    make_mesh(Evaluator(field), bounds, options);
  } catch (const Error& error) {
    return error.message;
  }
  return "no error";
}

struct Known {
  const char* name;
  Expression field;
  BoundingBox bounds;
  long euler;
};

std::vector<Known> known_solids() {
  return {
      {"sphere", sphere(1), padded({1, 1, 1}), 2},
      {"two spheres", joined(sphere(1, {-2, 0, 0}), sphere(1, {2, 0, 0})), padded({3, 1, 1}), 4},
      {"torus", torus(3, 1), padded({4, 4, 1}), 0},
      {"box", box({20, 12, 8}), padded({10, 6, 4}), 2},
      {"block with 5 holes", block_with_holes(), padded({10, 6, 4}), -8},
      {"turned block", rotated(block_with_holes(), rotation({1, 2, 3}, 0.7)),
       padded({12.3, 10.92, 8.05}), -8},
      {"hollow ball", cut(sphere(2), sphere(1.6)), padded({2, 2, 2}), 4}};
}

TEST(Mesher, ClosedManifoldOfTheRightTopologyOnTheSurface) {
  for (const Known& solid : known_solids()) {
    for (const int resolution : {32, 67, 128}) {
      SCOPED_TRACE(solid.name + (" at " + std::to_string(resolution)));
      const Mesh mesh = mesh_of(solid.field, solid.bounds, resolution);
      const Count counted = count(mesh);
      EXPECT_EQ(counted.open_edges, 0u);
      EXPECT_EQ(counted.bad_vertices, 0u);
      EXPECT_EQ(counted.bad_faces, 0u);
      EXPECT_EQ(counted.euler, solid.euler);
      EXPECT_EQ(turned_faces(mesh), 0u);
      EXPECT_LE(distance_from_surface(mesh, solid.field),
                0.005 * cell_of(solid.bounds, resolution));
    }
  }
}

// Waves shorter than two cells make every kind of cell, ambiguous faces among them.
TEST(Mesher, ManifoldWhereTheGridCannotResolveTheSolid) {
  for (const double frequency : {1.7, 2.9, 4.3, 7.7}) {
    for (const double thickness : {0.1, 0.5, 1.0}) {
      SCOPED_TRACE(std::to_string(frequency) + " " + std::to_string(thickness));
      const Mesh mesh = mesh_of(gyroid(frequency, thickness), cube(10), 24);
      EXPECT_GT(mesh.faces.size(), 3000u);
      EXPECT_TRUE(count(mesh).closed());
    }
  }
}

// Vertices of two cells on the same tip of the solid.
TEST(Mesher, NoTwoVerticesAtTheSamePlace) {
  const Mesh mesh = mesh_of(gyroid(4.3, 1.0), cube(10), 32);
  std::set<std::array<float, 3>> places;
  for (const Vec3& p : mesh.vertices) places.insert({float(p[0]), float(p[1]), float(p[2])});
  EXPECT_EQ(places.size(), mesh.vertices.size());
}

// A ball whose field is three times as steep as it claims to be: blocks with surface are dropped.
struct WrongBall : Sphere {
  static constexpr const char* name = "wrong_ball";
  template <class T>
  T eval(T x, T y, T z) const {
    return T(3.0) * (T(1.0) - length(x, y, z));
  }
};

TEST(Mesher, BlocksNextToCrossedEdgesAreSampledWhateverWasProven) {
  const Mesh mesh = mesh_of(at_point(WrongBall()), padded({1, 1, 1}), 128);
  EXPECT_TRUE(count(mesh).closed());
  EXPECT_EQ(count(mesh).euler, 2);
}

TEST(Mesher, VolumeConvergesToTheExactOne) {
  EXPECT_NEAR(volume(mesh_of(box({20, 12, 8}), padded({10, 6, 4}))), 1920, 1e-3);
  const double ball = 4 * std::numbers::pi / 3;
  const double coarse = ball - volume(mesh_of(sphere(1), padded({1, 1, 1}), 32));
  const double fine = ball - volume(mesh_of(sphere(1), padded({1, 1, 1}), 64));
  EXPECT_NEAR(coarse / fine, 4, 0.5);
  EXPECT_NEAR(fine / ball, 0, 1e-3);
}

// A wall as thin as two cells, turned so that it meets the grid at all angles; and a hollow ball.
TEST(Mesher, KeepsWallsOfTwoCells) {
  const auto rows = rotation({1, -2, 0.5}, 1.1);
  const BoundingBox bounds = cube(10);
  const double cell = cell_of(bounds, 48);
  const Expression wall = rotated(box({16, 16, 2 * cell}), rows);
  const Mesh plate = mesh_of(wall, bounds);
  EXPECT_TRUE(count(plate).closed());
  EXPECT_EQ(count(plate).euler, 2);
  EXPECT_NEAR(volume(plate), 16 * 16 * 2 * cell, 0.2);
  EXPECT_EQ(count(mesh_of(cut(sphere(8), sphere(8 - 2 * cell)), bounds)).euler, 4);
}

// All of space within bounds is a box; so is a half-space, whose cut faces get the bounds' normals.
TEST(Mesher, ClosesTheSolidAtTheBounds) {
  const Mesh all = mesh_of(constant(1), {{-1, -2, -3}, {1, 2, 3}}, 32);
  EXPECT_TRUE(count(all).closed());
  EXPECT_NEAR(volume(all), 48, 1e-3);
  HalfSpace below;
  below.normal.direction = {0, 0.6, -0.8};
  const Mesh half = mesh_of(at_point(below), cube(1), 32);
  EXPECT_TRUE(count(half).closed());
  EXPECT_NEAR(volume(half), 4, 1e-3);
  std::set<int> sides;
  for (const Vec3& normal : half.corner_normals) {
    const Vec3 possible[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, 0, -1}, {0, -0.6, 0.8}};
    for (int i = 0; i < 5; ++i) {
      if (norm(normal - possible[i]) < 1e-6) sides.insert(i);
    }
  }
  EXPECT_EQ(sides.size(), 5u);
}

// Zero is inside, here and there exactly on grid points: planes through multiples of the cell.
TEST(Mesher, ZeroOnGridPointsIsInside) {
  const double cell = 20.0 / (40 - 0.8);
  for (const double shift : {0.0, 0.11, 0.5, 0.61}) {
    const double half = (12 + shift) * cell;
    const Mesh mesh = mesh_of(box({2 * half, 2 * half, 2 * half}), cube(10), 40);
    EXPECT_TRUE(count(mesh).closed()) << shift;
    EXPECT_EQ(count(mesh).euler, 2);
    EXPECT_NEAR(volume(mesh), std::pow(2 * half, 3), 0.05);
  }
  // Zero all over the inside: no sign but no gradient either.
  const Expression flat = of(Min(), sphere(1), constant(0));
  EXPECT_TRUE(count(mesh_of(flat, padded({1, 1, 1}), 32)).closed());
}

TEST(Mesher, NanIsOutsideAndHarmsNothing) {
  // log(x) is NaN for x < 0, so half of the ball is left.
  const Expression log = call(make_operation(Logarithm()), {coordinate(0)});
  const Expression half_ball = of(Add(), sphere(1), of(Multiply(), constant(1e-30), log));
  const Mesh mesh = mesh_of(half_ball, padded({1, 1, 1}), 32);
  EXPECT_TRUE(count(mesh).closed());
  for (const Vec3& vertex : mesh.vertices) EXPECT_TRUE(std::isfinite(norm(vertex)));
  for (const Vec3& normal : mesh.corner_normals) EXPECT_NEAR(norm(normal), 1, 1e-9);
  EXPECT_NEAR(volume(mesh), 2 * std::numbers::pi / 3, 0.1);
}

TEST(Mesher, FarFromTheOriginInDoublePrecision) {
  const Vec3 center{1e6, -2e6, 3e5};
  const BoundingBox bounds{center - Vec3{1.01, 1.01, 1.01}, center + Vec3{1.01, 1.01, 1.01}};
  const Mesh mesh = mesh_of(sphere(1, center), bounds, 64);
  EXPECT_EQ(count(mesh).euler, 2);
  EXPECT_LE(distance_from_surface(mesh, sphere(1, center)), 1e-3 * cell_of(bounds, 64));
}

TEST(Mesher, SameForAnyNumberOfThreads) {
  const auto mesh_with = [](int threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return mesh_of(block_with_holes(), padded({10, 6, 4}), 96);
  };
  const Mesh one = mesh_with(1), four = mesh_with(4);
  EXPECT_EQ(one.vertices, four.vertices);
  EXPECT_EQ(one.faces, four.faces);
  EXPECT_EQ(one.corner_normals, four.corner_normals);
  EXPECT_EQ(one.creases, four.creases);
}

TEST(Mesher, WorkGrowsWithTheSurface) {
  // 512³ samples would take half a gigabyte and longer than this test's whole suite.
  const BoundingBox bounds = cube(100);
  MeshOptions options;
  options.resolution = 4096;
  const Mesh mesh = make_mesh(Evaluator(sphere(2)), bounds, options);
  EXPECT_EQ(count(mesh).euler, 2);
}

TEST(Mesher, CellSizeReplacesTheResolution) {
  MeshOptions options;
  options.cell_size = 0.25;
  const Mesh mesh = make_mesh(Evaluator(box({20, 12, 8})), padded({10, 6, 4}), options);
  double longest = 0;
  for (const auto& face : mesh.faces) {
    const Vec3 edge = mesh.vertices[face[1]] - mesh.vertices[face[0]];
    longest = std::max(longest, norm(edge));
  }
  EXPECT_GT(longest, 0.2);
  EXPECT_LT(longest, 0.75);
}

TEST(Mesher, ErrorsSayWhatIsAccepted) {
  const Expression ball = sphere(1);
  const BoundingBox bounds = padded({1, 1, 1});
  MeshOptions options;
  options.resolution = 3;
  EXPECT_EQ(error_of(ball, bounds, options), "resolution 3 is not between 4 and 1000000");
  options.resolution = 64;
  EXPECT_THAT(error_of(sphere(1, {5, 5, 5}), bounds, options), HasSubstr("no surface within"));
  EXPECT_THAT(error_of(ball, {{0, 0, 0}, {1, 1, infinity}}, options), HasSubstr("finite"));
  for (const double wrong : {-1.0, 1e-9, 1e9, std::nan("")}) {
    options.cell_size = wrong;
    EXPECT_THAT(error_of(ball, bounds, options), HasSubstr("is not between")) << wrong;
  }
}

TEST(Mesher, SaysBeforeTheWorkThatMemoryIsShort) {
  MeshOptions options;
  options.resolution = 1'000'000;
  const std::string message = error_of(sphere(1), padded({1, 1, 1}), options);
  EXPECT_THAT(message, HasSubstr("GiB of memory"));
  options.resolution = 256;
  options.memory_limit = 1 << 20;
  EXPECT_THAT(error_of(sphere(1), padded({1, 1, 1}), options), HasSubstr("fit"));
  options.memory_limit = size_t(1) << 30;
  EXPECT_EQ(error_of(sphere(1), padded({1, 1, 1}), options), "no error");
}

TEST(Mesher, ReportsRisingSharesAndCancels) {
  MeshOptions options;
  std::vector<double> shares;
  options.progress = [&](double share) {
    shares.push_back(share);
    return true;
  };
  make_mesh(Evaluator(block_with_holes()), padded({10, 6, 4}), options);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_GT(shares.size(), 20u);
  EXPECT_NEAR(shares.back(), 1, 0.01);
  for (const double stop : {0.0, 0.3, 0.6, 0.9}) {
    options.progress = [&](double share) { return share < stop; };
    EXPECT_THROW(make_mesh(Evaluator(block_with_holes()), padded({10, 6, 4}), options), Cancelled);
  }
}

}  // namespace
}  // namespace sardf

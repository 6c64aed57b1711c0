#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "sardf/constructor.hpp"
#include "sardf/evaluate.hpp"
#include "sardf/mesh_set.hpp"
#include "triangle_meshes.hpp"

namespace sardf {
namespace {

using Triangle = std::array<uint32_t, 3>;

MeshDataPointer data_of(TriangleMesh mesh) {
  return std::make_shared<const MeshData>(std::move(mesh));
}

// Independent of the product: in long double, the foot on the plane where it is inside, and the
// nearest points of the edges.
namespace brute {

using Real = long double;
struct Real3 {
  Real x, y, z;
};
Real3 real(const Vec3& a) { return {a[0], a[1], a[2]}; }
Real3 operator-(Real3 a, Real3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Real3 operator+(Real3 a, Real3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Real3 operator*(Real s, Real3 a) { return {s * a.x, s * a.y, s * a.z}; }
Real dot(Real3 a, Real3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Real3 cross(Real3 a, Real3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Real length(Real3 a) { return std::sqrt(dot(a, a)); }

Real segment_distance(Real3 p, Real3 a, Real3 b) {
  const Real squared = dot(b - a, b - a);
  const Real t = squared > 0 ? std::clamp<Real>(dot(p - a, b - a) / squared, 0, 1) : 0;
  return length(p - (a + t * (b - a)));
}

Real triangle_distance(Real3 p, Real3 a, Real3 b, Real3 c) {
  Real best =
      std::min({segment_distance(p, a, b), segment_distance(p, b, c), segment_distance(p, c, a)});
  const Real3 n = cross(b - a, c - a);
  if (dot(n, n) > 0) {
    const auto left_of = [&](Real3 from, Real3 to) {
      return dot(cross(to - from, p - from), n) >= 0;
    };
    if (left_of(a, b) && left_of(b, c) && left_of(c, a)) {
      best = std::min(best, std::abs(dot(p - a, n)) / length(n));
    }
  }
  return best;
}

}  // namespace brute

double brute_distance(const TriangleMesh& mesh, const Vec3& p) {
  using brute::real;
  brute::Real best = std::numeric_limits<brute::Real>::infinity();
  for (const auto& [a, b, c] : mesh.triangles) {
    best = std::min(best, brute::triangle_distance(real(p), real(mesh.vertices[a]),
                                                   real(mesh.vertices[b]), real(mesh.vertices[c])));
  }
  return double(best);
}

/// Everywhere, on the mesh, just beside it, and far away.
std::vector<Vec3> points_for(const TriangleMesh& mesh, size_t count, uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> at(-1.5, 1.5), share(0, 1);
  std::vector<Vec3> points;
  for (size_t i = 0; i < count; ++i) {
    const Triangle& t = mesh.triangles[engine() % mesh.triangles.size()];
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const double s = share(engine), r = share(engine) * (1 - s);
    const Vec3 anywhere{at(engine), at(engine), at(engine)};
    switch (i % 7) {
      case 0:
        points.push_back(a);
        break;
      case 1:
        points.push_back(a + s * (b - a));
        break;
      case 2:
        points.push_back(a + s * (b - a) + r * (c - a));
        break;
      case 3:
        points.push_back(a + s * (b - a) + r * (c - a) + 1e-9 * anywhere);
        break;
      case 4:
        points.push_back(std::pow(10, 12 * s) * anywhere);
        break;
      default:
        points.push_back(anywhere);
    }
  }
  return points;
}

void expect_brute(const TriangleMesh& mesh, size_t count, double size) {
  const auto set = surface_of_mesh(data_of(mesh), {});
  Nearest known;
  Vec3 beside{};
  for (const Vec3& p : points_for(mesh, count, 5)) {
    const double expected = brute_distance(mesh, p);
    const Nearest found = set->nearest(p);
    const double accuracy = 1e-12 * (expected + size);
    ASSERT_NEAR(found.distance, expected, accuracy) << p[0] << " " << p[1] << " " << p[2];
    ASSERT_NEAR(norm(p - found.point), expected, accuracy);
    ASSERT_NEAR(brute_distance(mesh, found.point), 0, 1e-12 * size);
    const Nearest again = set->nearest_beside(p, beside, known);
    ASSERT_EQ(again.distance, found.distance);
    ASSERT_EQ(again.part, found.part);
    known = again;
    beside = p;
  }
}

TEST(MeshDistanceSlow, IsThatToTheNearestOfAllTriangles) {
  expect_brute(random_triangles(1, 1, 1), 300, 1);
  expect_brute(random_triangles(7, 0.5, 2), 500, 1);
  expect_brute(random_triangles(500, 0.1, 3), 700, 1);
  expect_brute(icosphere(3), 700, 1);
  expect_brute(box_mesh({-1, -0.5, 0}, {1, 0.5, 0.25}), 700, 1);
}

TEST(MeshDistance, OfMeshesFarFromTheOriginAndOfAnySize) {
  TriangleMesh far = random_triangles(50, 0.3, 4);
  for (Vec3& v : far.vertices) v = v + Vec3{1e5, -2e5, 3e5};
  const auto set = surface_of_mesh(data_of(far), {});
  for (const Vec3& p : points_for(random_triangles(50, 0.3, 4), 200, 6)) {
    const Vec3 at = p + Vec3{1e5, -2e5, 3e5};
    const double expected = brute_distance(far, at);
    // An ulp of the coordinates.
    ASSERT_NEAR(set->nearest(at).distance, expected, 1e-12 * expected + 2e-10);
  }
  for (const double scale : {1e-90, 1e-20, 1e20, 1e90}) {
    TriangleMesh scaled = random_triangles(50, 0.3, 4);
    for (Vec3& v : scaled.vertices) v = scale * v;
    const auto scaled_set = surface_of_mesh(data_of(scaled), {});
    const auto usual = surface_of_mesh(data_of(random_triangles(50, 0.3, 4)), {});
    for (const Vec3& p : points_for(random_triangles(50, 0.3, 4), 100, 6)) {
      const double expected = usual->nearest(p).distance;
      ASSERT_NEAR(scaled_set->nearest(scale * p).distance / scale, expected,
                  1e-12 * (1 + expected));
    }
  }
}

// Points, segments, and slivers down to a line.
TEST(MeshDistance, TrianglesWithoutAreaAreSegmentsAndPoints) {
  TriangleMesh mesh =
      mesh_of({{0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {0, 2, 0}, {0, 2, 1}, {0.3, 0, 1e-9}},
              {{0, 0, 0}, {1, 2, 2}, {0, 2, 1}, {2, 1, 0}, {3, 4, 3}, {0, 1, 5}});
  expect_brute(mesh, 700, 3);
  expect_brute(mesh_of({{1, 2, 3}}, {{0, 0, 0}}), 100, 3);
  for (const double height : {1e-3, 1e-6, 1e-9, 1e-12, 1e-15}) {
    expect_brute(mesh_of({{-1, 0, 0}, {1, 0, 0}, {0.2, height, 0}}, {{0, 1, 2}}), 700, 10);
  }
}

TEST(MeshDistance, NotFinitePointsHaveNoNearest) {
  const auto solid = solid_of_mesh(data_of(icosphere(1)), "auto").set;
  const auto surface = surface_of_mesh(data_of(icosphere(1)), {});
  for (int k = 0; k < 3; ++k) {
    Vec3 p{0.1, 0.2, 0.3};
    p[size_t(k)] = infinity;
    EXPECT_EQ(solid->nearest(p).distance, -infinity);
    EXPECT_EQ(surface->nearest(p).distance, infinity);
    p[size_t(k)] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(std::isnan(solid->nearest(p).distance));
    EXPECT_TRUE(std::isnan(surface->nearest(p).gradient[0]));
  }
  EXPECT_NEAR(solid->nearest({1e300, 0, 0}).distance / -1e300, 1, 1e-12);
  EXPECT_NEAR(surface->nearest({1e300, 1e300, 1e300}).distance / 1e300, std::sqrt(3), 1e-12);
}

std::function<double(const Vec3&)> box_distance(const Vec3& size) {
  const Field box = make_field("box", {Vec3{}, size});
  return [evaluator = Evaluator(box.expression())](const Vec3& p) { return evaluator.value(p); };
}

TEST(MeshDistance, OfABoxIsTheBoxs) {
  for (const char* sign : {"auto", "normals", "winding"}) {
    const TriangleMesh mesh = box_mesh({-1, -0.5, -0.25}, {1, 0.5, 0.25});
    const MeshSolidSet made = solid_of_mesh(data_of(mesh), sign);
    EXPECT_EQ(made.quality.inside, Exactness::exact);
    EXPECT_EQ(made.quality.outside, Exactness::exact);
    const auto expected = box_distance({2, 1, 0.5});
    for (const Vec3& p : points_for(mesh, 2000, 9)) {
      ASSERT_NEAR(made.set->nearest(p).distance, expected(p), 1e-15 * (1 + norm(p)))
          << sign << " " << p[0] << " " << p[1] << " " << p[2];
    }
  }
}

// The triangles lie between the sphere and the sphere inside that touches the largest of them.
TEST(MeshDistance, OfAnIcosphereIsNearTheSpheres) {
  const TriangleMesh mesh = icosphere(4, 2, {1, 2, 3});
  double depth = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 *p = &mesh.vertices[a], *q = &mesh.vertices[b], *r = &mesh.vertices[c];
    const Vec3 n = normalized(cross(*q - *p, *r - *p));
    depth = std::max(depth, 2 - dot(n, *p - Vec3{1, 2, 3}));
  }
  EXPECT_LT(depth, 0.01);
  const auto set = solid_of_mesh(data_of(mesh), "auto").set;
  for (const Vec3& p : points_for(mesh, 2000, 10)) {
    const double sphere = 2 - norm(p - Vec3{1, 2, 3}), found = set->nearest(p).distance;
    ASSERT_LE(found, sphere + 1e-12 * (1 + norm(p)));
    ASSERT_GE(found, sphere - depth - 1e-12 * (1 + norm(p)));
  }
}

// At points off the surface, by central differences; where these disagree on the two sides there is
// a kink in between.
void expect_differences(const PointSet& set, const TriangleMesh& mesh, int least) {
  const double h = 1e-6;
  int smooth = 0;
  for (const Vec3& p : points_for(mesh, 700, 11)) {
    if (norm(p) > 4) continue;
    const Nearest at = set.nearest(p);
    if (std::abs(at.distance) < 1e-3) continue;
    EXPECT_NEAR(norm(at.gradient), 1, 1e-12);
    const std::array<Vec3, 3> jacobian = set.jacobian(p, at);
    for (size_t k = 0; k < 3; ++k) {
      Vec3 low = p, high = p;
      low[k] -= h;
      high[k] += h;
      const Nearest before = set.nearest(low), after = set.nearest(high);
      if (before.part != at.part || after.part != at.part) continue;
      ++smooth;
      ASSERT_NEAR(at.gradient[k], (after.distance - before.distance) / (2 * h), 2e-6);
      for (size_t row = 0; row < 3; ++row) {
        ASSERT_NEAR(jacobian[row][k], (after.point[row] - before.point[row]) / (2 * h), 1e-8);
      }
    }
  }
  EXPECT_GT(smooth, least);
}

TEST(MeshDistance, DerivativesAreDifferences) {
  for (const TriangleMesh& mesh : {icosphere(2), box_mesh({-1, -0.5, 0}, {1, 0.5, 0.25})}) {
    expect_differences(*solid_of_mesh(data_of(mesh), "normals").set, mesh, 500);
    expect_differences(*solid_of_mesh(data_of(mesh), "winding").set, mesh, 500);
    expect_differences(*solid_of_mesh(data_of(turned_over(mesh)), "auto").set, mesh, 500);
    expect_differences(*surface_of_mesh(data_of(mesh), {}), mesh, 500);
  }
  const TriangleMesh loose = random_triangles(20, 0.4, 12);
  expect_differences(*surface_of_mesh(data_of(loose), {}), loose, 300);
}

TEST(MeshDistance, GradientOnTheSurfacePointsInwards) {
  const TriangleMesh mesh = box_mesh({-1, -1, -1}, {1, 1, 1});
  for (const TriangleMesh& oriented : {mesh, turned_over(mesh)}) {
    for (const char* sign : {"normals", "winding"}) {
      const auto set = solid_of_mesh(data_of(oriented), sign).set;
      for (const double offset : {0.0, 1e-13, -1e-13, 1e-9, -1e-9}) {
        const Vec3 face = set->nearest({1 + offset, 0.3, 0.2}).gradient;
        EXPECT_NEAR(face[0], -1, 1e-15) << sign << offset;
        EXPECT_NEAR(norm(face), 1, 1e-15);
      }
      EXPECT_EQ(set->nearest({1, 0.3, 0.2}).distance, 0);
    }
    const auto set = solid_of_mesh(data_of(oriented), "normals").set;
    const Vec3 edge = set->nearest({1, 1, 0.2}).gradient, corner = set->nearest({1, 1, 1}).gradient;
    EXPECT_NEAR(edge[0], -std::sqrt(0.5), 1e-15);
    EXPECT_NEAR(edge[1], -std::sqrt(0.5), 1e-15);
    // Each face has a right angle there, however many triangles it is cut into.
    for (const double a : corner) EXPECT_NEAR(a, -std::sqrt(1.0 / 3), 1e-15);
  }
  EXPECT_TRUE(std::isnan(surface_of_mesh(data_of(mesh), {})->nearest({1, 0.3, 0.2}).gradient[0]));
}

TEST(MeshDistance, OfSomeFaces) {
  TriangleMesh mesh = box_mesh({0, 0, 0}, {1, 1, 1});
  for (uint32_t i = 0; i < 12; ++i) mesh.polygons[i] = i / 2;
  mesh.polygon_count = 6;
  const auto data = data_of(mesh);
  EXPECT_DOUBLE_EQ(surface_of_mesh(data, {})->nearest({0.5, 0.5, 0.9}).distance, 0.1);
  EXPECT_DOUBLE_EQ(surface_of_mesh(data, {0})->nearest({0.2, 0.5, 0.9}).distance, 0.9);
  EXPECT_DOUBLE_EQ(surface_of_mesh(data, {0, 4})->nearest({0.2, 0.5, 0.9}).distance, 0.2);
}

// The tree, its searches and what a solid is known by.
TEST(MeshDistance, ThreadsChangeNothing) {
  const auto distances = [](size_t threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    const auto data = data_of(icosphere(5));
    const auto set = solid_of_mesh(data, "auto").set;
    const Evaluator evaluator(
        call(distance_operation(set), {coordinate(0), coordinate(1), coordinate(2)}));
    std::vector<double> points, out(5000);
    std::mt19937_64 engine(3);
    std::uniform_real_distribution<double> at(-1.5, 1.5);
    for (int i = 0; i < 15000; ++i) points.push_back(at(engine));
    evaluator.values(points.data(), out.size(), out.data());
    for (const TriangleTree::Triangle& t : data->tree().triangles()) out.push_back(t.given());
    return out;
  };
  EXPECT_EQ(distances(1), distances(2));
}

}  // namespace
}  // namespace sardf

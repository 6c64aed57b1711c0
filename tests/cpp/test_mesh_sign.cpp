#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "error_of.hpp"
#include "sardf/evaluate.hpp"
#include "sardf/mesh_intersections.hpp"
#include "sardf/mesh_set.hpp"
#include "triangle_meshes.hpp"

namespace sardf {
namespace {

using testing::HasSubstr;

MeshDataPointer data_of(TriangleMesh mesh) {
  return std::make_shared<const MeshData>(std::move(mesh));
}

// The sum of spherical excesses by angles between the planes through the point: independent of the
// product's formula.
double brute_winding(const TriangleMesh& mesh, const Vec3& p) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    Vec3 to[3];
    for (size_t k = 0; k < 3; ++k) to[k] = normalized(mesh.vertices[t[k]] - p);
    const double volume = dot(to[0], cross(to[1], to[2]));
    if (!(std::abs(volume) > 0)) continue;
    double excess = -std::numbers::pi;
    for (size_t k = 0; k < 3; ++k) {
      const Vec3 a = cross(to[k], to[(k + 1) % 3]), b = cross(to[k], to[(k + 2) % 3]);
      excess += std::atan2(norm(cross(a, b)), dot(a, b));
    }
    sum += std::copysign(excess, volume);
  }
  return sum / (4 * std::numbers::pi);
}

std::vector<Vec3> random_points(size_t count, double reach, uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> at(-reach, reach);
  std::vector<Vec3> points;
  for (size_t i = 0; i < count; ++i) points.push_back({at(engine), at(engine), at(engine)});
  return points;
}

// Two spheres that overlap, as one mesh.
TriangleMesh overlapping() {
  return joined(icosphere(3, 1, {-0.5, 0, 0}), icosphere(3, 1, {0.5, 0.1, 0}));
}

TriangleMesh with_flipped_faces(TriangleMesh mesh) {
  for (size_t i = 0; i < mesh.triangles.size(); i += 9) {
    std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
  }
  return mesh;
}

struct Case {
  const char* name;
  TriangleMesh mesh;
  bool sound, closed;
};

std::vector<Case> cases() {
  const TriangleMesh ball = icosphere(3);
  TriangleMesh twice = joined(ball, ball);
  for (auto& t : twice.triangles) {
    for (uint32_t& v : t) v %= uint32_t(ball.vertices.size());
  }
  return {
      {"closed", ball, true, true},
      {"turned over", turned_over(ball), true, true},
      {"hollow", joined(ball, turned_over(icosphere(2, 0.5))), true, true},
      {"two", joined(icosphere(2, 0.4, {-0.6, 0, 0}), icosphere(2, 0.4, {0.6, 0, 0})), true, true},
      {"one of two inside out",
       joined(icosphere(2, 0.4, {-0.6, 0, 0}), turned_over(icosphere(2, 0.3, {0.6, 0, 0}))), false,
       true},
      {"nested alike", joined(ball, icosphere(2, 0.5)), false, true},
      {"overlapping", overlapping(), false, true},
      {"every face twice", twice, false, true},
      {"with a hole", without(ball, 40), false, false},
      {"with flipped faces", with_flipped_faces(ball), false, false},
      {"loose", random_triangles(60, 0.6, 8), false, false}};
}

// Turning a closed mesh that encloses a negative volume over.
double orientation(const Case& c) {
  double volume = 0;
  for (const auto& [i, j, k] : c.mesh.triangles) {
    volume += dot(c.mesh.vertices[i], cross(c.mesh.vertices[j], c.mesh.vertices[k]));
  }
  return c.closed && volume < 0 ? -1 : 1;
}

TEST(MeshSignSlow, IsThatOfTheSumOfSolidAngles) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const auto data = data_of(c.mesh);
    EXPECT_EQ(!data->solidity().fault, c.sound);
    EXPECT_EQ(data->solidity().topology.is_closed(), c.closed);
    const auto by_auto = solid_of_mesh(data, "auto"), by_winding = solid_of_mesh(data, "winding");
    Nearest known;
    Vec3 beside{};
    for (const Vec3& p : random_points(300, 1.6, 2)) {
      const double winding = orientation(c) * brute_winding(c.mesh, p);
      if (std::abs(winding - 0.5) < 2 * WindingNumber::accuracy) continue;
      const Nearest found = by_auto.set->nearest(p);
      ASSERT_EQ(found.distance > 0, winding > 0.5) << p[0] << " " << p[1] << " " << p[2];
      ASSERT_EQ(by_winding.set->nearest(p).distance, found.distance);
      known = by_winding.set->nearest_beside(p, beside, known);
      ASSERT_EQ(known.distance, found.distance);
      beside = p;
    }
  }
}

TEST(MeshSignSlow, WindingNumbersLieWithinTheirBounds) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const TriangleTree tree(c.mesh.vertices, c.mesh.triangles);
    const WindingNumber winding(tree);
    for (const Vec3& p : random_points(60, 3, 3)) {
      const double expected = brute_winding(c.mesh, p);
      const Interval found = winding.over_ball(tree.to_local(p), 0);
      ASSERT_TRUE(found.contains(expected)) << found.lo << " " << expected << " " << found.hi;
      ASSERT_TRUE(!found.contains(0.5) || found.hi - found.lo <= 2 * WindingNumber::accuracy);
      // Over a ball, at points of it.
      const double radius = 0.2 * norm(p);
      const Interval all = winding.over_ball(tree.to_local(p), radius / tree.unit());
      for (const Vec3& q : random_points(10, radius / std::sqrt(3), 4)) {
        ASSERT_TRUE(all.contains(brute_winding(c.mesh, p + q)));
      }
    }
  }
}

// A far cell's error must shrink with the square of its angle, or the bound is no bound of it.
TEST(MeshSign, BoundsAreNotIdle) {
  const TriangleMesh mesh = icosphere(4);
  const TriangleTree tree(mesh.vertices, mesh.triangles);
  const WindingNumber winding(tree);
  const Interval far = winding.over_ball(tree.to_local({30, 20, 10}), 0);
  EXPECT_LT(far.hi - far.lo, 0.01);
  const Interval around = winding.over_ball(tree.to_local({3, 2, 1}), 0.5 / tree.unit());
  EXPECT_LT(around.hi, 0.5);
}

TEST(MeshSign, QualityIsWhatIsProven) {
  const auto quality = [](const TriangleMesh& mesh, const char* sign) {
    return solid_of_mesh(data_of(mesh), sign).quality.inside;
  };
  EXPECT_EQ(quality(icosphere(2), "auto"), Exactness::exact);
  EXPECT_EQ(quality(icosphere(2), "winding"), Exactness::exact);
  EXPECT_EQ(quality(overlapping(), "auto"), Exactness::bound);
  EXPECT_EQ(quality(without(icosphere(2), 1), "auto"), Exactness::estimate);
}

TEST(MeshSign, NormalsNeedASoundMesh) {
  const auto error = [](const TriangleMesh& mesh) {
    return error_of([&] { solid_of_mesh(data_of(mesh), "normals"); });
  };
  EXPECT_EQ(error(icosphere(1)), "no error");
  EXPECT_THAT(error(without(box_mesh({0, 0, 0}, {1, 1, 1}), 1)),
              HasSubstr("face 0, counted from 0, has an edge, from (0, 0, 0) to (1, 1, 0), along "
                        "which 1 triangle runs and 0 back"));
  TriangleMesh flipped = box_mesh({0, 0, 0}, {1, 1, 1});
  std::swap(flipped.triangles[7][0], flipped.triangles[7][1]);
  EXPECT_THAT(error(flipped), HasSubstr("2 triangles run and 0 back"));
  EXPECT_THAT(error(overlapping()), HasSubstr("meets another face"));
  EXPECT_THAT(error(joined(icosphere(1), icosphere(1, 0.5))), HasSubstr("inside out"));
  TriangleMesh sliver = box_mesh({0, 0, 0}, {1, 1, 1});
  sliver.triangles.push_back({0, 1, 1});
  EXPECT_THAT(error(mesh_of(sliver.vertices, sliver.triangles)), HasSubstr("has no area"));
  // Two boxes that share one corner.
  TriangleMesh tips = joined(box_mesh({0, 0, 0}, {1, 1, 1}), box_mesh({1, 1, 1}, {2, 2, 2}));
  for (auto& t : tips.triangles) {
    for (uint32_t& v : t) v = v == 8 ? 7 : v;
  }
  EXPECT_THAT(error(tips), HasSubstr("several fans of faces meet"));
  EXPECT_THAT(error_of([] { solid_of_mesh(data_of(icosphere(0)), "normal"); }),
              HasSubstr("did you mean 'normals'"));
}

TEST(MeshSign, TrianglesThatMeet) {
  const auto meet = [](std::vector<Vec3> vertices, std::vector<std::array<uint32_t, 3>> triangles) {
    return meeting_triangles(TriangleTree(vertices, triangles)).has_value();
  };
  const std::vector<Vec3> base{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
  const auto with = [&](const std::vector<Vec3>& more) {
    std::vector<Vec3> all = base;
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  // No common corner: through the middle, beside, above, overlapping in the plane, beside in it.
  EXPECT_TRUE(meet(with({{0.5, 0.5, -1}, {0.5, 0.5, 1}, {3, 3, 0}}), {{0, 1, 2}, {3, 4, 5}}));
  EXPECT_FALSE(meet(with({{1.5, 1.5, -1}, {1.5, 1.5, 1}, {3, 3, 0}}), {{0, 1, 2}, {3, 4, 5}}));
  EXPECT_FALSE(meet(with({{0, 0, 1e-9}, {2, 0, 1e-9}, {0, 2, 1e-9}}), {{0, 1, 2}, {3, 4, 5}}));
  EXPECT_TRUE(meet(with({{0.1, 0.1, 0}, {0.2, 0.1, 0}, {0.1, 0.2, 0}}), {{0, 1, 2}, {3, 4, 5}}));
  EXPECT_FALSE(meet(with({{1.1, 1.1, 0}, {2, 1, 0}, {1, 2, 0}}), {{0, 1, 2}, {3, 4, 5}}));
  EXPECT_TRUE(meet(with({{1, 1, 0}, {2, 2, 1}, {2, 2, -1}}), {{0, 1, 2}, {3, 4, 5}}));
  // One common corner: folded away, coplanar beside, coplanar over it, through it.
  EXPECT_FALSE(meet(with({{-1, 0, 1}, {0, -1, 1}}), {{0, 1, 2}, {0, 3, 4}}));
  EXPECT_FALSE(meet(with({{1, 0.5, 1}, {0.5, 1, 1}}), {{0, 1, 2}, {0, 3, 4}}));
  EXPECT_FALSE(meet(with({{-1, -1, 0}, {1, -1, 0}}), {{0, 1, 2}, {0, 3, 4}}));
  EXPECT_TRUE(meet(with({{1, 1, 0}, {1, 3, 0}}), {{0, 1, 2}, {0, 3, 4}}));
  EXPECT_TRUE(meet(with({{1, 1, -1}, {1, 1, 1}}), {{0, 1, 2}, {0, 3, 4}}));
  EXPECT_FALSE(meet(with({{-1, -1, -1}, {-1, -1, 1}}), {{0, 1, 2}, {0, 3, 4}}));
  EXPECT_FALSE(meet(with({{1, -1, -1}, {1, -1, 1}}), {{0, 1, 2}, {0, 3, 4}}));
  // A common edge: any angle but none; the same triangle turned over.
  EXPECT_FALSE(meet(with({{0.5, 0.5, 0.01}}), {{0, 1, 2}, {1, 0, 3}}));
  EXPECT_FALSE(meet(with({{0.5, -0.5, 0}}), {{0, 1, 2}, {1, 0, 3}}));
  EXPECT_TRUE(meet(with({{0.5, 0.5, 0}}), {{0, 1, 2}, {1, 0, 3}}));
  EXPECT_TRUE(meet(base, {{0, 1, 2}, {0, 2, 1}}));
}

Evaluator evaluator_of(const PointSetPointer& set) {
  return Evaluator(call(distance_operation(set), {coordinate(0), coordinate(1), coordinate(2)}));
}

// Intervals enclose, and what is claimed of slopes holds between any two points.
TEST(MeshSign, IntervalsAndSlopesHold) {
  std::mt19937_64 engine(4);
  std::uniform_real_distribution<double> at(-1.6, 1.6), share(0, 1);
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    for (const bool solid : {true, false}) {
      const auto data = data_of(c.mesh);
      const PointSetPointer set =
          solid ? solid_of_mesh(data, "auto").set : surface_of_mesh(data, {});
      const OperationPointer operation = distance_operation(set);
      EXPECT_EQ(operation->is_distance(), !solid || c.closed);
      int finite = 0;
      for (int i = 0; i < 150; ++i) {
        const double half = std::pow(10, -2.5 * share(engine));
        Slope in[3];
        for (int k = 0; k < 3; ++k) {
          const double centre = at(engine);
          in[k].value = {centre - half, centre + half};
          in[k].partial[k] = in[k].length = 1;
        }
        const Slope slope = operation->slope(in);
        const bool lipschitz = slope.length < infinity;
        finite += lipschitz;
        if (!solid || c.closed) {
          EXPECT_NEAR(slope.length, 1, 1e-14);
        }
        double former = 0;
        Vec3 last{};
        for (int k = 0; k < 12; ++k) {
          Vec3 p;
          for (size_t axis = 0; axis < 3; ++axis) {
            p[axis] = in[axis].value.lo + share(engine) * 2 * half;
          }
          const double value = operation->evaluate(p.data());
          ASSERT_TRUE(slope.value.contains(value));
          if (k > 0 && lipschitz) {
            ASSERT_LE(std::abs(value - former), norm(p - last) * (1 + 1e-12));
          }
          former = value;
          last = p;
        }
      }
      // An open mesh's slope is known away from its triangles, too.
      EXPECT_GT(finite, 10);
    }
  }
}

// The winding number of a sphere's upper half falls to 1/2 across the opening.
TEST(MeshSign, OpenMeshesJumpAcrossTheirHoles) {
  TriangleMesh half = icosphere(3);
  std::erase_if(half.triangles, [&](const auto& t) {
    return half.vertices[t[0]][2] + half.vertices[t[1]][2] + half.vertices[t[2]][2] < 0;
  });
  const auto data = data_of(mesh_of(half.vertices, half.triangles));
  const auto set = solid_of_mesh(data, "auto").set;
  EXPECT_GT(set->nearest({0, 0, 0.3}).distance, 0.5);
  EXPECT_LT(set->nearest({0, 0, -0.3}).distance, -0.5);
  EXPECT_TRUE(set->may_jump({0, 0, 0}, 0.2));
  EXPECT_TRUE(set->may_jump({0, 0, 0}, infinity));
  EXPECT_FALSE(set->may_jump({0, 0, -5}, 0.5));
  EXPECT_FALSE(set->may_jump({0, 0, 0.6}, 0.01));
  const Evaluator evaluator = evaluator_of(set);
  EXPECT_EQ(evaluator.value({0, 0, 0.3}), set->nearest({0, 0, 0.3}).distance);
}

}  // namespace
}  // namespace sardf

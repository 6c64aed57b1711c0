// UV maps that somebody else made: overlaps, faces outside, scale; and vertices off the surface.
#include "sardf/uv_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "sardf/error.hpp"
#include "sardf/scene_file.hpp"

namespace sardf {
namespace {

/// Unit squares side by side along x, one for each rectangle (u0, v0, u1, v1) of the image.
Mesh squares(const std::vector<std::array<double, 4>>& rectangles) {
  Mesh mesh;
  for (size_t i = 0; i < rectangles.size(); ++i) {
    const double x = 2.0 * double(i);
    const auto first = static_cast<uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {{x, 0, 0}, {x + 1, 0, 0}, {x + 1, 1, 0}, {x, 1, 0}});
    mesh.faces.push_back({first, first + 1, first + 2, first + 3});
    const auto& [u0, v0, u1, v1] = rectangles[i];
    mesh.corner_uv.insert(mesh.corner_uv.end(), {{u0, v0}, {u1, v0}, {u1, v1}, {u0, v1}});
  }
  return mesh;
}

UvReport report_of(const Mesh& mesh, int size) { return check_uv(TexelMap(mesh, size, 0)); }

TEST(UvCheck, CountsTexelsThatLieOnTwoFaces) {
  // 0.5 + 0.5 - 0.25 of 64 x 64 texels; the second square covers a quarter of the image again.
  const UvReport report = report_of(squares({{0, 0, 0.5, 1}, {0.25, 0, 0.75, 1}}), 64);
  EXPECT_EQ(report.texels, 3072u);
  EXPECT_EQ(report.overlapping, 1024u);
  EXPECT_EQ(report.faces, 2u);
  EXPECT_EQ(report.outside, 0u);
}

TEST(UvCheck, NeighboursAndMirroredFacesDoNotOverlap) {
  EXPECT_EQ(report_of(squares({{0, 0, 0.5, 1}, {0.5, 0, 1, 1}}), 64).overlapping, 0u);
  // The second is mirrored; an edge along texels' centres belongs to both and overlaps nowhere.
  const double edge = 32.5 / 64;
  const UvReport report = report_of(squares({{0, 0, edge, 1}, {1, 0, edge, 1}}), 64);
  EXPECT_EQ(report.overlapping, 0u);
  EXPECT_EQ(report.texels, 64u * 64u);
  // Rounding to float, as Blender keeps coordinates, is no overlap.
  const double rounded = static_cast<float>(0.7 + 1e-8);
  EXPECT_EQ(report_of(squares({{0, 0, rounded, 1}, {0.7, 0, 1, 1}}), 4096).overlapping, 0u);
}

TEST(UvCheck, CountsFacesThatReachOutOfTheImage) {
  const UvReport report =
      report_of(squares({{0, 0, 0.5, 1}, {0.6, -0.1, 1, 1}, {1.5, 0, 2, 1}, {0.5, 0, 0.6, 1}}), 64);
  EXPECT_EQ(report.outside, 2u);
  EXPECT_EQ(report.faces, 4u);
}

TEST(UvCheck, OfAMapWithoutAreaNoTexelLiesOnTheMesh) {
  const UvReport report = report_of(squares({{0.5, 0.5, 0.5, 0.5}}), 64);
  EXPECT_EQ(report.texels, 0u);
  EXPECT_EQ(report.texels_per_unit, 0);
}

TEST(UvCheck, TexelsPerUnitAreTheRootOfTheAreasRatio) {
  // Half of 100 x 100 texels on two square units.
  const Mesh mesh = squares({{0, 0, 0.25, 1}, {0.5, 0, 0.75, 1}});
  EXPECT_DOUBLE_EQ(texels_per_unit(mesh, 100), 50);
  EXPECT_DOUBLE_EQ(report_of(mesh, 100).texels_per_unit, 50);
  Mesh bare = mesh;
  bare.corner_uv.clear();
  EXPECT_THROW(texels_per_unit(bare, 100), Error);
}

TEST(UvCheck, CanBeCancelled) {
  const Mesh mesh = squares({{0, 0, 1, 1}});
  const TexelMap map(mesh, 256, 0);
  EXPECT_THROW(check_uv(map, [](double) { return false; }), Cancelled);
}

SurfaceReport surface_of(std::vector<Vec3> vertices, double tolerance) {
  const Scene scene(parse_scene(
      R"({"sardf": 1, "fields": {"ball": {"sphere": {"radius": 2}}}, "solid": "ball"})", ""));
  Mesh mesh;
  mesh.vertices = std::move(vertices);
  return check_surface(mesh, scene.solid(), tolerance);
}

TEST(SurfaceCheck, MeasuresHowFarVerticesLieOffTheSurface) {
  const SurfaceReport report = surface_of({{2, 0, 0}, {0, 0, 2.5}, {0, 1.9, 0}}, 0.2);
  EXPECT_EQ(report.vertices, 3u);
  EXPECT_EQ(report.off, 1u);
  EXPECT_NEAR(report.farthest, 0.5, 1e-12);
  EXPECT_EQ(surface_of({}, 0.1).farthest, 0);
}

TEST(SurfaceCheck, AVertexThatIsNowhereIsFarAway) {
  const SurfaceReport report = surface_of({{NAN, 0, 0}, {2, 0, 0}}, 0.1);
  EXPECT_EQ(report.off, 1u);
  EXPECT_TRUE(std::isinf(report.farthest));
}

}  // namespace
}  // namespace sardf

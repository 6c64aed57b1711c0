#include <gtest/gtest.h>

#include <map>

#include "mesh_checks.hpp"
#include "sardf/mesher.hpp"
#include "sardf/mesher_stages.hpp"

namespace sardf {
namespace {

using namespace checks;

Mesh mesh_of(const Expression& field, const BoundingBox& bounds, int resolution) {
  MeshOptions options;
  options.resolution = resolution;
  return make_mesh(Evaluator(field), bounds, options);
}

std::map<uint32_t, int> creases_at(const Mesh& mesh) {
  std::map<uint32_t, int> result;
  for (const auto& crease : mesh.creases) {
    for (const uint32_t v : crease) ++result[v];
  }
  return result;
}

using Segment = std::array<Vec3, 2>;

// The edges of a box with half edges `half`, turned backwards by the rows of a rotation.
std::vector<Segment> edges_of_box(const Vec3& half, const std::array<Vec3, 3>& rows) {
  std::vector<Segment> edges;
  for (int axis = 0; axis < 3; ++axis) {
    for (int corner = 0; corner < 4; ++corner) {
      Segment edge{};
      for (int end = 0; end < 2; ++end) {
        Vec3 p;
        p[axis] = end ? half[axis] : -half[axis];
        for (int k = 0; k < 2; ++k) {
          const int other = (axis + 1 + k) % 3;
          p[other] = corner >> k & 1 ? half[other] : -half[other];
        }
        for (int i = 0; i < 3; ++i) edge[end] = edge[end] + p[i] * rows[i];
      }
      edges.push_back(edge);
    }
  }
  return edges;
}

// How many of 200 points on each edge are farther than `allowed` from the creases.
size_t points_off_creases(const Mesh& mesh, const std::vector<Segment>& edges, double allowed) {
  size_t off = 0;
  for (const Segment& edge : edges) {
    for (int i = 0; i <= 200; ++i) {
      const Vec3 p = edge[0] + (i / 200.0) * (edge[1] - edge[0]);
      double nearest = infinity;
      for (const auto& c : mesh.creases) {
        nearest =
            std::min(nearest, distance_to_segment(p, mesh.vertices[c[0]], mesh.vertices[c[1]]));
      }
      off += nearest > allowed;
    }
  }
  return off;
}

TEST(MesherFeatures, BoxHasItsEdgesAndCorners) {
  const auto upright = rotation({0, 0, 1}, 0);
  const BoundingBox bounds = padded({10, 6, 4});
  const Mesh mesh = mesh_of(box({20, 12, 8}), bounds, 64);
  const double allowed = 0.02 * cell_of(bounds, 64);
  const auto edges = edges_of_box({10, 6, 4}, upright);
  EXPECT_EQ(points_off_creases(mesh, edges, allowed), 0u);
  size_t corners = 0;
  for (const auto& [vertex, creases] : creases_at(mesh)) {
    const Vec3& p = mesh.vertices[vertex];
    double nearest = infinity, corner = infinity;
    for (const Segment& edge : edges) {
      nearest = std::min(nearest, distance_to_segment(p, edge[0], edge[1]));
      corner = std::min({corner, norm(p - edge[0]), norm(p - edge[1])});
    }
    EXPECT_LE(nearest, allowed);
    EXPECT_EQ(creases, corner <= allowed ? 3 : 2);
    corners += corner <= allowed;
  }
  EXPECT_EQ(corners, 8u);
}

TEST(MesherFeatures, TurnedBoxesToo) {
  const BoundingBox bounds = cube(12.4);
  size_t off = 0, points = 0;
  for (int k = 1; k <= 12; ++k) {
    const auto rows = rotation({1, 2 - 0.3 * k, 3 + 0.2 * k}, 0.3 + 0.37 * k);
    const Mesh mesh = mesh_of(rotated(box({20, 12, 8}), rows), bounds, 64);
    off += points_off_creases(mesh, edges_of_box({10, 6, 4}, rows), 0.02 * cell_of(bounds, 64));
    points += 12 * 201;
    EXPECT_TRUE(count(mesh).closed());
    EXPECT_EQ(turned_faces(mesh), 0u);
    EXPECT_NEAR(volume(mesh), 1920, 0.05);
  }
  // Where an edge runs along grid edges, a vertex may have to stay off it to keep faces upright.
  EXPECT_LE(double(off), 0.002 * double(points));
}

TEST(MesherFeatures, CurvedCreases) {
  const Mesh mesh = mesh_of(cylinder(3, {}, 4.0), padded({3, 3, 2}), 64);
  const double allowed = 0.02 * cell_of(padded({3, 3, 2}), 64);
  const auto creases = creases_at(mesh);
  EXPECT_GT(creases.size(), 300u);
  for (const auto& [vertex, number] : creases) {
    const Vec3& p = mesh.vertices[vertex];
    EXPECT_EQ(number, 2);
    EXPECT_NEAR(std::hypot(p[0], p[1]), 3, allowed);
    EXPECT_NEAR(std::abs(p[2]), 2, allowed);
  }
}

// The groove between two balls ends at a wall, in a corner that often lies out of its vertex's
// cell, among the vertices of the wall.
TEST(MesherFeatures, GroovesEndInCorners) {
  const BoundingBox bounds = padded({0.55, 0.3, 0.3});
  const double cell = cell_of(bounds, 40), radius = 0.3, half = 0.25;
  int missed = 0;
  for (int i = 0; i < 60; ++i) {
    const Vec3 at{i % 10 * 0.1 * cell, 0, i / 10 * 0.17 * cell};
    const Expression balls =
        joined(sphere(radius, at + Vec3{half, 0, 0}), sphere(radius, at - Vec3{half, 0, 0}));
    const Mesh mesh =
        mesh_of(cut(balls, box({4, 0.5, 0.5}, at + Vec3{0, -0.25, 0.25})), bounds, 40);
    const Vec3 corner = at + Vec3{0, 0, std::sqrt(radius * radius - half * half)};
    double nearest = infinity;
    for (const Vec3& p : mesh.vertices) nearest = std::min(nearest, norm(p - corner));
    missed += nearest > 0.01 * cell;
    EXPECT_TRUE(count(mesh).closed());
    EXPECT_EQ(turned_faces(mesh), 0u);
  }
  EXPECT_EQ(missed, 0);
}

// The rims of the holes, and the inner edges where the ring comes out of the block.
TEST(MesherFeatures, CreasesOfBlendsRunOn) {
  const BoundingBox bounds = padded({10, 6, 6});
  const Mesh mesh = mesh_of(block_with_holes({0, 1, 0}), bounds, 96);
  size_t inner = 0;
  for (const auto& [vertex, number] : creases_at(mesh)) {
    EXPECT_GE(number, 2);
    const Vec3& p = mesh.vertices[vertex];
    const double to_ring = std::hypot(std::hypot(p[0], p[2]) - 5, p[1]) - 1;
    const double to_bore = std::hypot(p[0], p[1]) - 3;
    const double allowed = 0.02 * cell_of(bounds, 96);
    if (std::abs(to_ring) > allowed || std::abs(std::abs(p[2]) - 4) > 0.5) continue;
    ++inner;
    EXPECT_LE(std::min(std::abs(std::abs(p[2]) - 4), std::abs(to_bore)), allowed);
  }
  EXPECT_GT(inner, 100u);
}

TEST(MesherFeatures, SmoothSolidsAndNarrowFilletsHaveNoCreases) {
  EXPECT_TRUE(mesh_of(sphere(1), padded({1, 1, 1}), 24).creases.empty());
  EXPECT_TRUE(mesh_of(torus(3, 1), padded({4, 4, 1}), 48).creases.empty());
  for (const double cells : {0.15, 0.4, 1.0, 3.0}) {
    RoundedBox op;
    op.size = {20, 12, 8};
    op.radius = cells * cell_of(padded({10, 6, 4}), 128);
    const Mesh mesh = mesh_of(at_point(op), padded({10, 6, 4}), 128);
    EXPECT_TRUE(mesh.creases.empty()) << cells << " cells: " << mesh.creases.size();
    EXPECT_LE(distance_from_surface(mesh, at_point(op)), 0.005 * cell_of(padded({10, 6, 4}), 128));
  }
}

// Every corner of a face has the normal of the face's own side, at creases too.
TEST(MesherFeatures, NormalsOfTheFacesOwnSide) {
  const Mesh mesh = mesh_of(cylinder(3, {}, 4.0), padded({3, 3, 2}), 64);
  for (size_t f = 0; f < mesh.faces.size(); ++f) {
    Vec3 middle{};
    for (const uint32_t v : mesh.faces[f]) middle = middle + 0.25 * mesh.vertices[v];
    const bool cap = std::abs(middle[2]) > 2 - 1e-3 * std::hypot(middle[0], middle[1]);
    for (int k = 0; k < 4; ++k) {
      const Vec3& p = mesh.vertices[mesh.faces[f][k]];
      const double r = std::hypot(p[0], p[1]);
      const Vec3 expected =
          cap ? Vec3{0, 0, middle[2] > 0 ? 1.0 : -1.0} : Vec3{p[0] / r, p[1] / r, 0};
      EXPECT_LT(norm(mesh.corner_normals[4 * f + k] - expected), 0.01);
    }
  }
}

TEST(MesherPieces, EveryCrossedEdgeHasAPieceOfAtLeastThreeEdges) {
  for (int inside = 0; inside < 256; ++inside) {
    for (int joined = 0; joined < 64; ++joined) {
      const auto pieces = mesher::pieces_of(uint8_t(inside), uint8_t(joined));
      std::map<int, int> edges;
      for (int edge = 0; edge < 12; ++edge) {
        const int axis = edge / 4;
        const int start = (edge & 1) << (axis + 1) % 3 | (edge >> 1 & 1) << (axis + 2) % 3;
        const bool crossed = (inside >> start & 1) != (inside >> (start | 1 << axis) & 1);
        EXPECT_EQ(pieces.of_edge[edge] >= 0, crossed);
        if (crossed) ++edges[pieces.of_edge[edge]];
      }
      EXPECT_EQ(int(edges.size()), pieces.count);
      EXPECT_LE(pieces.count, 4);
      for (const auto& [piece, number] : edges) EXPECT_GE(number, 3);
    }
  }
}

TEST(MesherPieces, DiagonalCornersAreApartOrJoined) {
  // Corners 0 and 3 inside: on the lower z face they lie across from each other.
  EXPECT_EQ(mesher::pieces_of(0b1001, 0).count, 2);
  EXPECT_EQ(mesher::pieces_of(0b1001, 1 << 4).count, 1);
}

}  // namespace
}  // namespace sardf

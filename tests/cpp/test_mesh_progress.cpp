// Reading a mesh and making its tree and checks: progress, and cancels at any time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <numbers>

#include "sanitized.hpp"
#include "sardf/constructor.hpp"
#include "sardf/evaluate.hpp"
#include "sardf/mesh_set.hpp"
#include "sardf/polygon_triangles.hpp"
#include "sardf/scene_file.hpp"
#include "triangle_meshes.hpp"

namespace sardf {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string ply_text(const TriangleMesh& mesh) {
  std::ostringstream text;
  text << "ply\nformat ascii 1.0\nelement vertex " << mesh.vertices.size()
       << "\nproperty double x\nproperty double y\nproperty double z\nelement face "
       << mesh.triangles.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3& v : mesh.vertices) text << v[0] << ' ' << v[1] << ' ' << v[2] << '\n';
  for (const auto& t : mesh.triangles) text << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
  return text.str();
}

std::string stl_bytes(const TriangleMesh& mesh) {
  std::string bytes(84 + 50 * mesh.triangles.size(), '\0');
  const uint32_t count = uint32_t(mesh.triangles.size());
  std::memcpy(&bytes[80], &count, 4);
  for (size_t i = 0; i < count; ++i) {
    for (size_t k = 0; k < 9; ++k) {
      const float a = float(mesh.vertices[mesh.triangles[i][k / 3]][k % 3]);
      std::memcpy(&bytes[84 + 50 * i + 12 + 4 * k], &a, 4);
    }
  }
  return bytes;
}

const TriangleMesh& ball() {
  static const TriangleMesh mesh = icosphere(6);
  return mesh;
}

class MeshProgressSlow : public testing::Test {
 protected:
  MeshProgressSlow()
      : paths_{folder_.write("ball.obj", obj_text(ball())),
               folder_.write("ball.ply", ply_text(ball())),
               folder_.write("ball.stl", stl_bytes(ball()))} {}

  static Field solid(const std::string& path) {
    return make_field("mesh_solid", {FilePath{path, ""}, "auto"});
  }

  TemporaryFolder folder_;
  std::vector<std::string> paths_;
};

TEST_F(MeshProgressSlow, RisesFrom0To1) {
  for (const std::string& path : paths_) {
    std::vector<double> shares;
    const ProgressScope scope([&](double share) {
      shares.push_back(share);
      return true;
    });
    solid(path);
    // One at the start of each: reading, the tree, the checks, the normals.
    EXPECT_GE(shares.size(), 4u) << path;
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end())) << path;
    EXPECT_GE(shares.front(), 0);
    EXPECT_LE(shares.back(), 1);
    EXPECT_GT(shares.back(), 0.6) << path;
    const size_t before = shares.size();
    make_field("mesh_surface", {FilePath{path, ""}, std::vector<double>{0, 1, 5}});
    EXPECT_GE(shares.size(), before + 1);
  }
}

TEST_F(MeshProgressSlow, IsCancelledAtOnce) {
  for (const std::string& path : paths_) {
    for (const double at : {0.0, 0.1, 0.3, 0.5, 0.6, 0.7, 0.9}) {
      Clock::time_point asked{};
      const ProgressScope scope([&](double share) {
        if (share < at) return true;
        asked = Clock::now();
        return false;
      });
      EXPECT_THROW(solid(path), Cancelled) << path << ' ' << at;
      EXPECT_LT(seconds_since(asked), at_once) << path << ' ' << at;
    }
    // Nothing half-made is kept.
    EXPECT_EQ(Evaluator(solid(path).expression()).value({0, 0, 2}) < -0.99, true);
  }
}

TEST_F(MeshProgressSlow, IsTheSameMeshWithAndWithout) {
  const TriangleMesh expected = read_triangle_mesh(paths_[0]);
  const TriangleMesh found = read_triangle_mesh(paths_[0], [](double) { return true; });
  EXPECT_EQ(found.vertices, expected.vertices);
  EXPECT_EQ(found.triangles, expected.triangles);
  const auto reporting = std::make_shared<const MeshData>(found, [](double) { return true; });
  const auto silent = std::make_shared<const MeshData>(expected);
  EXPECT_EQ(reporting->identity(), silent->identity());
  EXPECT_EQ(reporting->tree().nodes().size(), silent->tree().nodes().size());
  TriangleMesh moved = expected;
  moved.vertices.back()[2] += 1e-12;
  EXPECT_NE(MeshData(moved).identity(), silent->identity());
}

TEST_F(MeshProgressSlow, IsCancelledInAScene) {
  const ProgressScope scope([](double) { return false; });
  EXPECT_THROW(
      parse_scene(R"({"sardf": 1, "solid": {"mesh_solid": {"path": ")" + paths_[1] + R"("}}})",
                  "s"),
      Cancelled);
}

// One concave polygon with so many corners that cutting it takes long.
TEST_F(MeshProgressSlow, IsCancelledWithinAPolygon) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 20000; ++i) {
    const double angle = 2 * std::numbers::pi * i / 20000, r = i % 2 ? 1 : 0.5;
    corners.push_back({r * std::cos(angle), r * std::sin(angle), 0});
  }
  const Clock::time_point start = Clock::now();
  Clock::time_point asked{};
  const Progress progress = [&](double) {
    asked = Clock::now();
    return seconds_since(start) < 0.05;
  };
  Pulse pulse(progress);
  EXPECT_THROW(triangulated(corners, pulse), Cancelled);
  EXPECT_LT(seconds_since(asked), at_once);
}

// A reader that finds no vertex for long, as in a file with normals only, reports, too.
TEST_F(MeshProgressSlow, GoesOnInWhatIsSkipped) {
  std::string text;
  for (int i = 0; i < 3000000; ++i) text += "vn 0 0 1\n";
  const std::string path =
      folder_.write("normals.obj", text + "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_THROW(read_triangle_mesh(path, [](double share) { return share < 0.3; }), Cancelled);
}

}  // namespace
}  // namespace sardf

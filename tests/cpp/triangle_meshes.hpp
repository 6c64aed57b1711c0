// Triangle meshes with known shapes, and files of them.
#pragma once

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <string>

#include "sardf/mesh_read.hpp"

namespace sardf {

/// With each triangle a polygon of its own.
inline TriangleMesh mesh_of(std::vector<Vec3> vertices,
                            std::vector<std::array<uint32_t, 3>> triangles) {
  TriangleMesh mesh;
  mesh.polygon_count = triangles.size();
  for (uint32_t i = 0; i < triangles.size(); ++i) mesh.polygons.push_back(i);
  mesh.vertices = std::move(vertices);
  mesh.triangles = std::move(triangles);
  return mesh;
}

/// From corner to corner; every face cut in two.
inline TriangleMesh box_mesh(const Vec3& lo, const Vec3& hi) {
  std::vector<Vec3> v;
  for (int i = 0; i < 8; ++i) {
    v.push_back({i & 1 ? hi[0] : lo[0], i & 2 ? hi[1] : lo[1], i & 4 ? hi[2] : lo[2]});
  }
  return mesh_of(v, {{0, 2, 3},
                     {0, 3, 1},
                     {4, 5, 7},
                     {4, 7, 6},
                     {0, 1, 5},
                     {0, 5, 4},
                     {2, 6, 7},
                     {2, 7, 3},
                     {0, 4, 6},
                     {0, 6, 2},
                     {1, 3, 7},
                     {1, 7, 5}});
}

/// The icosahedron with every triangle cut in four `levels` times, corners on the sphere.
inline TriangleMesh icosphere(int levels, double radius = 1, const Vec3& centre = {}) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  std::vector<Vec3> v{{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                      {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  std::vector<std::array<uint32_t, 3>> t{
      {0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
      {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
      {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    const auto middle = [&](uint32_t a, uint32_t b) {
      const auto [at, is_new] = middles.try_emplace(std::minmax(a, b), uint32_t(v.size()));
      if (is_new) v.push_back(0.5 * (v[a] + v[b]));
      return at->second;
    };
    std::vector<std::array<uint32_t, 3>> finer;
    for (const auto& [a, b, c] : t) {
      for (Vec3* p : {&v[a], &v[b], &v[c]}) *p = normalized(*p);
      const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    t = finer;
  }
  for (Vec3& p : v) p = centre + radius * normalized(p);
  return mesh_of(v, t);
}

inline TriangleMesh joined(TriangleMesh a, const TriangleMesh& b) {
  const uint32_t shift = uint32_t(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& t : b.triangles) {
    a.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  }
  return mesh_of(a.vertices, a.triangles);
}

inline TriangleMesh turned_over(TriangleMesh mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

/// Without the first `count` triangles.
inline TriangleMesh without(TriangleMesh mesh, size_t count) {
  mesh.triangles.erase(mesh.triangles.begin(), mesh.triangles.begin() + long(count));
  return mesh_of(mesh.vertices, mesh.triangles);
}

inline TriangleMesh random_triangles(size_t count, double size, uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> at(-1, 1);
  std::vector<Vec3> v;
  std::vector<std::array<uint32_t, 3>> t;
  for (uint32_t i = 0; i < count; ++i) {
    const Vec3 middle{at(engine), at(engine), at(engine)};
    for (int k = 0; k < 3; ++k) {
      v.push_back(middle + size * Vec3{at(engine), at(engine), at(engine)});
    }
    t.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh_of(v, t);
}

/// A folder that goes with its files.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "sardf_mesh_XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string file(const std::string& name) const { return path_ / name; }
  std::string write(const std::string& name, const std::string& bytes) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(file(name), std::ios::binary) << bytes;
    return file(name);
  }

 private:
  std::filesystem::path path_;
};

inline std::string obj_text(const TriangleMesh& mesh) {
  std::string text;
  char line[128];
  for (const Vec3& v : mesh.vertices) {
    std::snprintf(line, sizeof line, "v %.17g %.17g %.17g\n", v[0], v[1], v[2]);
    text += line;
  }
  for (const auto& t : mesh.triangles) {
    std::snprintf(line, sizeof line, "f %u %u %u\n", t[0] + 1, t[1] + 1, t[2] + 1);
    text += line;
  }
  return text;
}

}  // namespace sardf

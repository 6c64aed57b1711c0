#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <map>
#include <set>
#include <string>

#include "sample_meshes.hpp"
#include "sardf/atlas.hpp"
#include "sardf/error.hpp"

namespace {

using sardf::Atlas;
using sardf::make_atlas;
using sardf::Mesh;
using sardf::Vec2;
using sardf::Vec3;
using sardf::operator-;

constexpr int size = 2048, gutter = 8;

struct Case {
  const char* name;
  std::function<Mesh()> mesh;
  double stretch;  // accepted largest stretch; 1.001 where the surface can be unrolled
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

const std::vector<Case>& cases() {
  static const std::vector<Case> all{
      {"box", [] { return sample::box(30, 20, 12); }, 1.001},
      {"plate", sample::plate_with_holes, 1.001},
      {"cylinder", [] { return sample::capped_cylinder(96, 3); }, 1.001},
      {"sphere", [] { return sample::sphere(40); }, 1.35},
      {"torus", [] { return sample::torus(60, 3, 1); }, 1.35},
      {"tanglecube", [] { return sample::tanglecube(64); }, 1.6},
  };
  return all;
}

struct Made {
  Mesh mesh;
  Atlas atlas;
};

/// Each case's atlas, made once.
const Made& made(const Case& c) {
  static std::map<std::string, Made> known;
  auto at = known.find(c.name);
  if (at == known.end()) {
    Made m{c.mesh(), {}};
    m.atlas = make_atlas(m.mesh, size, gutter);
    at = known.emplace(c.name, std::move(m)).first;
  }
  return at->second;
}

/// Calls visit(face, corners) for each drawn triangle.
template <typename Visit>
void for_triangles(const Mesh& mesh, const Visit& visit) {
  for (uint32_t f = 0; f < mesh.faces.size(); ++f)
    for (uint32_t k = 1; k < 3; ++k)
      if (mesh.faces[f][k] != mesh.faces[f][k + 1])
        visit(f, std::array<uint32_t, 3>{4 * f, 4 * f + k, 4 * f + k + 1});
}

double twice_area(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

class AtlasOf : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Samples, AtlasOf, testing::ValuesIn(cases()),
                         [](const auto& test) { return test.param.name; });

TEST_P(AtlasOf, PutsEveryFaceInOneChart) {
  const auto& [mesh, atlas] = made(GetParam());
  std::vector<uint32_t> seen(mesh.faces.size(), 0);
  for (uint32_t c = 0; c < atlas.charts.size(); ++c)
    for (const uint32_t f : atlas.charts[c].faces) {
      ++seen[f];
      EXPECT_EQ(atlas.chart_of_face[f], c);
    }
  EXPECT_THAT(seen, testing::Each(1u));
}

TEST_P(AtlasOf, NeverSpansACrease) {
  const auto& [mesh, atlas] = made(GetParam());
  const std::set<std::array<uint32_t, 2>> creases(mesh.creases.begin(), mesh.creases.end());
  std::map<std::array<uint32_t, 2>, std::set<uint32_t>> charts;
  size_t sides = 0;
  for (uint32_t f = 0; f < mesh.faces.size(); ++f)
    for (size_t k = 0; k < 4; ++k) {
      const uint32_t a = mesh.faces[f][k], b = mesh.faces[f][(k + 1) % 4];
      const std::array<uint32_t, 2> edge{std::min(a, b), std::max(a, b)};
      if (!creases.contains(edge)) continue;
      charts[edge].insert(atlas.chart_of_face[f]);
      ++sides;
    }
  EXPECT_EQ(sides, 2 * creases.size());
  for (const auto& [edge, touching] : charts) EXPECT_EQ(touching.size(), 2u);
}

uint32_t find_root(std::map<uint32_t, uint32_t>& parent, uint32_t i) {
  while (parent.at(i) != i) i = parent.at(i);
  return i;
}

TEST_P(AtlasOf, ChartsAreConnectedPlaneRegions) {
  const auto& [mesh, atlas] = made(GetParam());
  for (const sardf::Chart& chart : atlas.charts) {
    // Faces are sewn where both ends of an edge have the same texture coordinates.
    std::map<std::array<Vec2, 2>, std::array<uint32_t, 2>> edges;
    std::map<uint32_t, uint32_t> parent;
    const auto join = [&](uint32_t a, uint32_t b) {
      parent[find_root(parent, a)] = find_root(parent, b);
    };
    for (const uint32_t f : chart.faces)
      for (uint32_t c = 4 * f; c < 4 * f + 4; ++c) parent[c] = c;
    for (const uint32_t f : chart.faces)
      for (uint32_t k = 0; k < 4; ++k) {
        const uint32_t c = 4 * f + k, d = 4 * f + (k + 1) % 4;
        const Vec2 &a = mesh.corner_uv[c], &b = mesh.corner_uv[d];
        if (a == b) {
          join(c, d);
          continue;
        }
        EXPECT_TRUE(edges.insert({{a, b}, {c, d}}).second) << "two faces beside one edge";
      }
    std::map<uint32_t, uint32_t> onward;  // along the boundary
    long inner = 0, boundary = 0;
    for (const auto& [ends, corners] : edges) {
      const auto other = edges.find({ends[1], ends[0]});
      if (other == edges.end()) continue;
      ++inner;
      join(corners[0], other->second[1]);
      join(corners[1], other->second[0]);
    }
    for (const auto& [ends, corners] : edges) {
      if (edges.contains({ends[1], ends[0]})) continue;
      ++boundary;
      EXPECT_TRUE(
          onward.insert({find_root(parent, corners[0]), find_root(parent, corners[1])}).second);
    }
    std::set<uint32_t> vertices;
    for (const auto& [corner, up] : parent) vertices.insert(find_root(parent, corner));
    long loops = 0;
    for (; !onward.empty(); ++loops)
      for (auto at = onward.begin(); at != onward.end();) {
        const uint32_t next = at->second;
        onward.erase(at);
        at = onward.find(next);
      }
    const long euler = static_cast<long>(vertices.size()) - boundary - inner / 2 +
                       static_cast<long>(chart.faces.size());
    EXPECT_EQ(euler, 2 - loops) << "connected and without handles";
  }
}

TEST_P(AtlasOf, KeepsWindingAndScale) {
  const auto& [mesh, atlas] = made(GetParam());
  std::vector<double> flat(atlas.charts.size(), 0), real(atlas.charts.size(), 0);
  for_triangles(mesh, [&](uint32_t f, const std::array<uint32_t, 3>& t) {
    const double area =
        0.5 * twice_area(mesh.corner_uv[t[0]], mesh.corner_uv[t[1]], mesh.corner_uv[t[2]]);
    EXPECT_GT(area, 0) << "face " << f;
    const auto point = [&](uint32_t c) { return mesh.vertices[mesh.faces[f][c % 4]]; };
    flat[atlas.chart_of_face[f]] += area * size * size;
    real[atlas.chart_of_face[f]] +=
        0.5 * sardf::norm(sardf::cross(point(t[1]) - point(t[0]), point(t[2]) - point(t[0])));
  });
  for (size_t c = 0; c < flat.size(); ++c) {
    EXPECT_NEAR(std::sqrt(flat[c] / real[c]) / atlas.texels_per_unit, 1, 1e-3);
    EXPECT_NEAR(atlas.charts[c].area / real[c], 1, 1e-3);
  }
}

/// For each texel the chart whose triangles cover its centre, or -1; reports texels covered twice.
std::vector<int> rasterise(const Mesh& mesh, const Atlas& atlas, int& twice) {
  std::vector<int> owner(static_cast<size_t>(size) * size, -1);
  twice = 0;
  for_triangles(mesh, [&](uint32_t f, const std::array<uint32_t, 3>& t) {
    std::array<Vec2, 3> p;
    for (size_t k = 0; k < 3; ++k)
      p[k] = {mesh.corner_uv[t[k]][0] * size - 0.5, mesh.corner_uv[t[k]][1] * size - 0.5};
    const auto [x0, x1] = std::minmax({p[0][0], p[1][0], p[2][0]});
    const auto [y0, y1] = std::minmax({p[0][1], p[1][1], p[2][1]});
    for (int y = static_cast<int>(std::ceil(y0)); y <= y1; ++y)
      for (int x = static_cast<int>(std::ceil(x0)); x <= x1; ++x) {
        const Vec2 q{double(x), double(y)};
        if (!(twice_area(p[0], p[1], q) > 0 && twice_area(p[1], p[2], q) > 0 &&
              twice_area(p[2], p[0], q) > 0))
          continue;
        int& at = owner[static_cast<size_t>(y) * size + x];
        twice += at != -1;
        at = static_cast<int>(atlas.chart_of_face[f]);
      }
  });
  return owner;
}

TEST_P(AtlasOf, KeepsTheGutterAndCoversNoTexelTwice) {
  const auto& [mesh, atlas] = made(GetParam());
  for (const Vec2& uv : mesh.corner_uv)
    for (const double t : uv) {
      EXPECT_GE(t * size, gutter / 2 - 1e-9);
      EXPECT_LE(t * size, size - gutter / 2 + 1e-9);
    }
  int twice = 0, near = 0, used = 0;
  const std::vector<int> owner = rasterise(mesh, atlas, twice);
  EXPECT_EQ(twice, 0);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const int own = owner[static_cast<size_t>(y) * size + x];
      if (own < 0) continue;
      ++used;
      if (x + 1 < size && owner[static_cast<size_t>(y) * size + x + 1] == own) continue;
      for (int dy = -gutter; dy <= gutter; ++dy)
        for (int dx = 0; dx <= gutter; ++dx) {
          if (dx * dx + dy * dy >= gutter * gutter || x + dx >= size || y + dy < 0 ||
              y + dy >= size)
            continue;
          const int other = owner[static_cast<size_t>(y + dy) * size + x + dx];
          near += other >= 0 && other != own;
        }
    }
  EXPECT_EQ(near, 0) << "texels of two charts closer than the gutter";
  EXPECT_NEAR(used / (double(size) * size), atlas.texels_used, 0.002);
}

TEST_P(AtlasOf, UsesTheImageWellWithLittleStretch) {
  const auto& [mesh, atlas] = made(GetParam());
  EXPECT_LE(atlas.charts.size(), 60u);
  EXPECT_GE(atlas.texels_used, 0.55);
  for (const sardf::Chart& chart : atlas.charts) {
    EXPECT_LE(chart.stretch_max, GetParam().stretch);
    EXPECT_GE(chart.stretch_mean, 1 - 1e-9);
    EXPECT_LE(chart.stretch_mean, chart.stretch_max + 1e-9);
    EXPECT_NEAR(chart.density_mean / atlas.texels_per_unit, 1, 1e-3);
    EXPECT_GE(chart.density_min * chart.stretch_max, 0.999 * atlas.texels_per_unit);
    EXPECT_LE(chart.density_max, 1.001 * chart.stretch_max * atlas.texels_per_unit);
  }
}

TEST(Atlas, DoesNotDependOnThreads) {
  std::vector<std::vector<Vec2>> found;
  for (const size_t threads : {1, 4}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    Mesh mesh = sample::tanglecube(48);
    make_atlas(mesh, 512, 4);
    found.push_back(mesh.corner_uv);
  }
  EXPECT_EQ(found[0], found[1]);
}

TEST(Atlas, LeavesAPlateWithHolesInOnePiecePerSide) {
  const auto& [mesh, atlas] = made(cases()[1]);
  // Two large faces, four sides, and four walls in each of six holes.
  EXPECT_EQ(atlas.charts.size(), 2u + 4u + 24u);
}

TEST(Atlas, WorksWithoutNormals) {
  Mesh mesh = sample::sphere(12);
  mesh.corner_normals.clear();
  EXPECT_GT(make_atlas(mesh, 256, 2).texels_used, 0.4);
}

TEST(Atlas, CancelsAndLeavesTheMeshAlone) {
  for (const double stop : {0.0, 0.1, 0.5, 0.7}) {
    Mesh mesh = sample::tanglecube(32);
    EXPECT_THROW(make_atlas(mesh, 512, 4, [&](double share) { return share < stop; }),
                 sardf::Cancelled);
    EXPECT_TRUE(mesh.corner_uv.empty());
  }
}

TEST(Atlas, ReportsProgressInOrder) {
  Mesh mesh = sample::box(8, 8, 8);
  std::vector<double> shares;
  make_atlas(mesh, 256, 2, [&](double share) {
    shares.push_back(share);
    return true;
  });
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_GE(shares.front(), 0);
  EXPECT_LE(shares.back(), 1);
}

std::string message_of(Mesh mesh, int texels = size, int gap = gutter) {
  try {
    make_atlas(mesh, texels, gap);
  } catch (const sardf::Error& error) {
    EXPECT_TRUE(mesh.corner_uv.empty());
    return error.message;
  }
  return "";
}

TEST(Atlas, RefusesBadInput) {
  using testing::HasSubstr;
  const Mesh good = sample::box(2, 2, 2);
  EXPECT_THAT(message_of(Mesh{}), HasSubstr("at least one face"));
  EXPECT_THAT(message_of(good, 8), HasSubstr("16 to 16384"));
  EXPECT_THAT(message_of(good, size, 0), HasSubstr("gutter of 0"));
  EXPECT_THAT(message_of(good, 64, 9), HasSubstr("1 to 8"));
  EXPECT_THAT(message_of(sample::plate_with_holes(), 16, 2), HasSubstr("do not fit"));
  Mesh mesh = good;
  mesh.faces[3][1] = 999;
  EXPECT_THAT(message_of(mesh), HasSubstr("vertex 999"));
  mesh = good;
  mesh.vertices[1][2] = NAN;
  EXPECT_THAT(message_of(mesh), HasSubstr("not finite"));
  mesh = good;
  mesh.corner_normals.pop_back();
  EXPECT_THAT(message_of(mesh), HasSubstr("corner normals"));
  mesh = good;
  for (Vec3& p : mesh.vertices) p = {0, 0, 0};
  EXPECT_THAT(message_of(mesh), HasSubstr("area"));
}

}  // namespace

#include "sardf/mesh_read.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>

#include "error_of.hpp"
#include "sardf/polygon_triangles.hpp"
#include "triangle_meshes.hpp"

namespace sardf {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using Triangle = std::array<uint32_t, 3>;

// The bytes of a number, the last one first for big-endian files.
template <class Number>
std::string bytes_of(Number number, bool big) {
  const auto bytes = std::bit_cast<std::array<char, sizeof(Number)>>(number);
  std::string text(bytes.begin(), bytes.end());
  if (big) std::reverse(text.begin(), text.end());
  return text;
}

class MeshRead : public testing::Test {
 protected:
  TriangleMesh read(const std::string& name, const std::string& bytes) {
    return read_triangle_mesh(folder_.write(name, bytes));
  }
  std::string error(const std::string& name, const std::string& bytes) {
    return error_of([&] { read(name, bytes); });
  }
  TemporaryFolder folder_;
};

// A square pyramid without its base: a quad would be the base.
const std::vector<Vec3> pyramid{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 1, 1.5}};

void expect_pyramid(const TriangleMesh& mesh) {
  EXPECT_EQ(mesh.vertices, pyramid);
  EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 1, 4}, Triangle{0, 3, 2}, Triangle{0, 2, 1}));
  EXPECT_THAT(mesh.polygons, ElementsAre(0, 1, 1));
  EXPECT_EQ(mesh.polygon_count, 2u);
}

TEST_F(MeshRead, PlyInText) {
  expect_pyramid(read("a.ply",
                      "ply\r\nformat ascii 1.0\r\ncomment made by hand\r\nobj_info none\r\n"
                      "element vertex 5\r\nproperty float x\r\nproperty float y\r\n"
                      "property float z\r\nelement face 2\r\n"
                      "property list uchar int vertex_indices\r\nend_header\r\n"
                      "0 0 0\r\n2 0 0\r\n2 2 0\r\n0 2 0\r\n1 1 1.5\r\n3 0 1 4\r\n4 0 3 2 1\r\n"));
}

// Properties in another order, of other types, beside others; faces before vertices; an element
// that is not known, with a list.
TEST_F(MeshRead, PlyInBinaryOfEitherByteOrder) {
  for (const bool big : {false, true}) {
    std::string text = "ply\nformat binary_" + std::string(big ? "big" : "little") +
                       "_endian 1.0\nelement camera 1\nproperty list short double values\n"
                       "property int8 id\nelement face 2\nproperty uint8 flags\n"
                       "property list uint32 uint16 vertex_index\nelement vertex 5\n"
                       "property float64 z\nproperty uchar red\nproperty int x\nproperty float y\n"
                       "end_header\n";
    text += bytes_of(int16_t(2), big) + bytes_of(1.0, big) + bytes_of(2.0, big) + "\x05";
    for (const std::vector<uint16_t>& face :
         {std::vector<uint16_t>{0, 1, 4}, std::vector<uint16_t>{0, 3, 2, 1}}) {
      text += '\x07' + bytes_of(uint32_t(face.size()), big);
      for (const uint16_t corner : face) text += bytes_of(corner, big);
    }
    for (const Vec3& v : pyramid) {
      text +=
          bytes_of(v[2], big) + '\xFF' + bytes_of(int32_t(v[0]), big) + bytes_of(float(v[1]), big);
    }
    SCOPED_TRACE(big);
    expect_pyramid(read("a.PLY", text));
    EXPECT_THAT(error("a.ply", text.substr(0, text.size() - 1)),
                AllOf(HasSubstr("a.ply:9: "), HasSubstr("5 elements 'vertex'")));
  }
}

std::string ply(const std::string& vertices, const std::string& faces, int vertex_count = 3) {
  return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(vertex_count) +
         "\nproperty double x\nproperty double y\nproperty double z\nelement face 1\n"
         "property list uchar int vertex_indices\nend_header\n" +
         vertices + faces;
}

TEST_F(MeshRead, PlyErrorsNameFileAndLine) {
  const std::string corners = "0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_THAT(error("a.ply", ply(corners, "3 0 1 3\n")),
              AllOf(HasSubstr("a.ply:13: "), HasSubstr("vertex 3"), HasSubstr("3 vertices")));
  EXPECT_THAT(error("a.ply", ply(corners, "3 0 1 -1\n")), HasSubstr("a.ply:13: face 0"));
  EXPECT_THAT(error("a.ply", ply(corners, "2 0 1\n")),
              AllOf(HasSubstr("a.ply:13: "), HasSubstr("2 corners")));
  EXPECT_THAT(error("a.ply", ply("0 0 0\n1 nan 0\n0 1 0\n", "3 0 1 2\n")),
              AllOf(HasSubstr("a.ply:11: vertex 1"), HasSubstr("nan")));
  EXPECT_THAT(error("a.ply", ply("0 0 0\n1 0 0\n0 1 -inf\n", "3 0 1 2\n")),
              AllOf(HasSubstr("a.ply:12: vertex 2"), HasSubstr("-inf")));
  EXPECT_THAT(error("a.ply", ply("0 0 0\n1 0 0\n0 1 1e101\n", "3 0 1 2\n")), HasSubstr("1e+101"));
  EXPECT_THAT(error("a.ply", ply(corners, "3 0 one 2\n")), HasSubstr("a.ply:13: "));
  EXPECT_THAT(error("a.ply", ply(corners, "3 0 1")), HasSubstr("a.ply:13: found the end"));
  EXPECT_THAT(error("a.ply", ply(corners, "", 4)), HasSubstr("a.ply"));
  EXPECT_THAT(error("a.ply", "plx\n"), HasSubstr("a.ply:1: "));
  EXPECT_THAT(error("a.ply", "ply\nformat ascii 1.0\nelement vertex -3\n"),
              AllOf(HasSubstr("a.ply:3: "), HasSubstr("'-3'")));
  EXPECT_THAT(error("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty floaty x\n"),
              AllOf(HasSubstr("a.ply:4: "), HasSubstr("did you mean 'float'")));
  EXPECT_THAT(error("a.ply", "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\n"),
              HasSubstr("before end_header"));
  EXPECT_THAT(error("a.ply", "ply\nformat binary 1.0\n"), HasSubstr("binary_little_endian"));
  EXPECT_THAT(error("a.ply", "ply\nend_header\n"), HasSubstr("no format"));
  EXPECT_THAT(error("a.ply",
                    "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                    "property float x\nproperty float z\nend_header\n1 2 3\n"),
              AllOf(HasSubstr("a.ply:3: "), HasSubstr("x, y and z")));
}

// Would need many gigabytes if it were believed.
TEST_F(MeshRead, AnnouncedCountsAreNotBelieved) {
  const std::string head = "ply\nformat binary_little_endian 1.0\nelement vertex ";
  const std::string tail = "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  EXPECT_THAT(error("a.ply", head + "4000000000" + tail), HasSubstr("4000000000 elements"));
  EXPECT_THAT(error("a.ply", head + "9000000000000000000" + tail), HasSubstr("too short"));
  EXPECT_THAT(error("a.ply", head + "99999999999999999999" + tail), HasSubstr("a.ply:3: "));
  EXPECT_THAT(error("a.ply",
                    "ply\nformat ascii 1.0\nelement face 3000000000\n"
                    "property list uint int vertex_indices\nend_header\n3 0 1 2\n"),
              HasSubstr("3000000000 elements"));
  EXPECT_THAT(error("a.ply",
                    "ply\nformat binary_big_endian 1.0\nelement face 1\n"
                    "property list uint int vertex_indices\nend_header\n\xFF\xFF\xFF\xFF"),
              HasSubstr("byte"));
  EXPECT_THAT(error("a.stl", std::string(80, ' ') + "\xFF\xFF\xFF\xFF"), HasSubstr("4294967295"));
}

TEST_F(MeshRead, Obj) {
  const TriangleMesh mesh =
      read("a.obj",
           "# comment\nmtllib a.mtl\no part\nv 0 0 0\nv 2 0 0 1.0\nv +2 2 0\nvt 0 0\nvn 0 0 1\n"
           "s off\nf 1 2 5\nv 0 2 0\nv 1 1 1.5\nusemtl red\nf -5/1/1 -2//1 \\\n -3/1 2\nl 1 2\n");
  expect_pyramid(mesh);
  EXPECT_THAT(error("a.obj", "v 0 0 0\nv 1 0\n"),
              AllOf(HasSubstr("a.obj:2: "), HasSubstr("end of")));
  EXPECT_THAT(error("a.obj", "v 0 0 zero\n"), AllOf(HasSubstr("a.obj:1: "), HasSubstr("'zero'")));
  EXPECT_THAT(error("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n\nf 1 2 4\n"), HasSubstr("a.obj:5: "));
  EXPECT_THAT(error("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4\n"), HasSubstr("a.obj:4: "));
  EXPECT_THAT(error("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0\n"), HasSubstr("'0'"));
  EXPECT_THAT(error("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n"), HasSubstr("2 corners"));
  EXPECT_THAT(error("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"), HasSubstr("no triangles"));
  EXPECT_THAT(error("a.obj", ""), HasSubstr("no triangles"));
}

std::string stl_facet(const Vec3& a, const Vec3& b, const Vec3& c) {
  std::string bytes(12, '\0');
  for (const Vec3& p : {a, b, c}) {
    for (const double x : p) bytes += bytes_of(float(x), false);
  }
  return bytes + std::string(2, '\0');
}

TEST_F(MeshRead, StlMergesEqualVertices) {
  const std::string text =
      "solid a part\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n"
      "   vertex 0 1 0\n  endloop\n endfacet\n facet normal 0 0 1\n  outer loop\n"
      "   vertex 1 0 0\n   vertex 1 1 0\n   vertex 0 1 -0\n  endloop\n endfacet\nendsolid a part\n";
  std::string binary = "solid although it is binary";
  binary.resize(80, ' ');
  binary += bytes_of(uint32_t(2), false) + stl_facet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}) +
            stl_facet({1, 0, 0}, {1, 1, 0}, {0, 1, -0.0});
  for (const std::string& bytes : {text, binary}) {
    const TriangleMesh mesh = read("a.stl", bytes);
    EXPECT_THAT(mesh.vertices,
                ElementsAre(Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{1, 1, 0}));
    EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{1, 3, 2}));
  }
  for (const char first : {'s', 'S'}) {
    binary[0] = first;
    EXPECT_THAT(error("a.stl", binary.substr(0, 150)),
                AllOf(HasSubstr("2 facets"), HasSubstr("184 bytes"), HasSubstr("has 150")));
  }
  EXPECT_THAT(error("a.stl", "short"), HasSubstr("5 bytes"));
  EXPECT_THAT(error("a.stl", text.substr(0, text.size() - 17)), HasSubstr("without endsolid"));
  EXPECT_THAT(error("a.stl", text.substr(0, 60)), HasSubstr("the end of the file"));
  std::string with_nan = binary;
  with_nan.replace(84 + 12 + 12, 4, bytes_of(std::numeric_limits<float>::quiet_NaN(), false));
  EXPECT_THAT(error("a.stl", with_nan), AllOf(HasSubstr("byte 108"), HasSubstr("vertex 1")));
  EXPECT_THAT(error("a.stl", "solid nothing\nendsolid\n"), HasSubstr("no triangles"));
}

TEST_F(MeshRead, FilesThatAreNoMeshes) {
  EXPECT_THAT(error_of([&] { read_triangle_mesh(folder_.file("none.ply")); }),
              AllOf(HasSubstr("none.ply"), HasSubstr("No such file")));
  EXPECT_THAT(error("a.plt", ""), AllOf(HasSubstr("'.plt'"), HasSubstr("did you mean '.ply'")));
  EXPECT_THAT(error("a", ""), HasSubstr(".ply, .obj and .stl"));
  std::filesystem::create_directory(folder_.file("folder.ply"));
  EXPECT_THAT(error_of([&] { read_triangle_mesh(folder_.file("folder.ply")); }),
              HasSubstr("Is a directory"));
}

double area(const std::vector<Vec3>& corners) {
  double sum = 0;
  for (const auto& [a, b, c] : triangulated(corners)) {
    sum += 0.5 * norm(cross(corners[b] - corners[a], corners[c] - corners[a]));
  }
  return sum;
}

// The triangles of a polygon cover its area once only where none of them lies outside.
TEST(PolygonTriangles, ConcavePolygonsKeepTheirArea) {
  const std::vector<Vec2> comb{{0, 0}, {7, 0}, {7, 3}, {6, 3}, {6, 1}, {5, 1},
                               {5, 3}, {4, 3}, {4, 1}, {3, 1}, {3, 3}, {0, 3}};
  for (size_t first = 0; first < comb.size(); ++first) {
    std::vector<Vec3> corners;
    for (size_t i = 0; i < comb.size(); ++i) {
      const Vec2& p = comb[(first + i) % comb.size()];
      corners.push_back({p[0], 0.6 * p[1], 0.8 * p[1]});
    }
    EXPECT_EQ(triangulated(corners).size(), comb.size() - 2);
    EXPECT_NEAR(area(corners), 21 - 4, 1e-12);
    std::reverse(corners.begin(), corners.end());
    EXPECT_NEAR(area(corners), 21 - 4, 1e-12);
  }
}

TEST(PolygonTriangles, OddPolygonsAreCutAllTheSame) {
  EXPECT_EQ(triangulated(std::vector<Vec3>(5, Vec3{1, 2, 3})).size(), 3u);
  EXPECT_EQ(triangulated(std::vector<Vec3>{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}).size(), 2u);
  EXPECT_EQ(triangulated(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}).size(), 2u);
}

}  // namespace
}  // namespace sardf

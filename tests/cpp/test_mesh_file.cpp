#include "sardf/mesh_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "sardf/error.hpp"

namespace sardf {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

// The box [0,1] × [0,2] × [0,3], its top split into two triangles.
Mesh sample() {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.push_back({double(i & 1), 2.0 * (i >> 1 & 1), 3.0 * (i >> 2)});
  }
  mesh.faces = {{0, 2, 3, 1}, {4, 5, 7, 7}, {4, 7, 6, 6}, {0, 1, 5, 4},
                {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  const Vec3 normals[] = {{0, 0, -1}, {0, 0, 1},  {0, 0, 1}, {0, -1, 0},
                          {0, 1, 0},  {-1, 0, 0}, {1, 0, 0}};
  for (const Vec3& normal : normals) {
    for (int k = 0; k < 4; ++k) mesh.corner_normals.push_back(normal);
  }
  for (size_t i = 0; i < mesh.corner_normals.size(); ++i) {
    mesh.corner_uv.push_back({(i % 4 == 1 || i % 4 == 2) ? 0.25 : 0.0, i % 4 >= 2 ? 0.75 : 0.0});
  }
  return mesh;
}

MeshAttributes attributes() {
  MeshAttributes result;
  result.fraction_names = {"steel", "hard metal"};
  for (int i = 0; i < 8; ++i) {
    result.fractions.insert(result.fractions.end(), {float(i) / 8, 1 - float(i) / 8});
    result.colors.insert(result.colors.end(), {0, 0.5f, 1});
  }
  return result;
}

class MeshFile : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override {
    fs::remove_all(folder_);
    unsetenv("SARDF_MESH_FILE_TEST_FOLDER");
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string written(const std::string& name, const Mesh& mesh, const MeshAttributes& with) const {
    write_mesh(path(name), mesh, with, 0.001);
    std::ifstream file(path(name), std::ios::binary);
    std::stringstream bytes;
    bytes << file.rdbuf();
    return bytes.str();
  }
  size_t files() const {
    return size_t(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  // A death test's child runs in its parent's folder.
  static fs::path own_folder() {
    const auto own = fs::temp_directory_path() / ("sardf_mesh_file_" + std::to_string(getpid()));
    setenv("SARDF_MESH_FILE_TEST_FOLDER", own.c_str(), 0);
    return getenv("SARDF_MESH_FILE_TEST_FOLDER");
  }
  fs::path folder_ = own_folder();
};

// Reads little-endian numbers one after the other.
struct Reader {
  const std::string& bytes;
  size_t at = 0;
  uint32_t integer(int size) {
    uint32_t value = 0;
    for (int i = 0; i < size; ++i) value |= uint32_t(uint8_t(bytes.at(at++))) << 8 * i;
    return value;
  }
  float number() { return std::bit_cast<float>(integer(4)); }
};

TEST_F(MeshFile, Ply) {
  const std::string bytes = written("part.ply", sample(), attributes());
  const std::string end = "end_header\n";
  const std::string header = bytes.substr(0, bytes.find(end) + end.size());
  EXPECT_THAT(header, HasSubstr("ply\nformat binary_little_endian 1.0\n"));
  EXPECT_THAT(header, HasSubstr("0.001 m"));
  EXPECT_THAT(header, HasSubstr("element vertex 8\n"));
  EXPECT_THAT(header, HasSubstr("property float fraction_steel\nproperty float "
                                "fraction_hard_metal\nelement face 7\n"));
  Reader reader{bytes, header.size()};
  const Mesh mesh = sample();
  for (int v = 0; v < 8; ++v) {
    for (int i = 0; i < 3; ++i) EXPECT_EQ(reader.number(), float(mesh.vertices[v][i]));
    Vec3 normal;
    for (double& n : normal) n = double(reader.number());
    EXPECT_NEAR(norm(normal), 1, 1e-6);
    EXPECT_GT(dot(normal, mesh.vertices[v] - Vec3{0.5, 1, 1.5}), 0);
    EXPECT_EQ(reader.integer(1), 0u);
    EXPECT_EQ(reader.integer(1), 188u);  // sRGB of 0.5
    EXPECT_EQ(reader.integer(1), 255u);
    EXPECT_EQ(reader.number(), float(v) / 8);
    EXPECT_EQ(reader.number(), 1 - float(v) / 8);
  }
  for (const auto& face : mesh.faces) {
    const uint32_t corners = face[3] == face[2] ? 3 : 4;
    EXPECT_EQ(reader.integer(1), corners);
    for (uint32_t k = 0; k < corners; ++k) EXPECT_EQ(reader.integer(4), face[k]);
    EXPECT_EQ(reader.integer(1), 2 * corners);
    for (uint32_t k = 0; k < 2 * corners; ++k) EXPECT_GE(reader.number(), 0);
  }
  EXPECT_EQ(reader.at, bytes.size());
}

TEST_F(MeshFile, Obj) {
  std::istringstream lines(written("part.obj", sample(), attributes()));
  std::vector<std::vector<double>> v, vn, vt;
  size_t faces = 0;
  const Mesh mesh = sample();
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    std::vector<double> numbers;
    if (word == "f") {
      for (int k = 0; words >> word; ++k) {
        unsigned a = 0, b = 0, c = 0;
        ASSERT_EQ(std::sscanf(word.c_str(), "%u/%u/%u", &a, &b, &c), 3);
        EXPECT_EQ(a - 1, mesh.faces[faces][k]);
        for (int i = 0; i < 3; ++i) EXPECT_EQ(vn.at(c - 1)[i], mesh.corner_normals[4 * faces][i]);
        EXPECT_EQ(vt.at(b - 1)[1], mesh.corner_uv[4 * faces + k][1]);
      }
      ++faces;
      continue;
    }
    for (double number; words >> number;) numbers.push_back(number);
    if (word == "v") v.push_back(numbers);
    if (word == "vn") vn.push_back(numbers);
    if (word == "vt") vt.push_back(numbers);
  }
  EXPECT_EQ(faces, 7u);
  EXPECT_EQ(v.size(), 8u);
  EXPECT_EQ(vn.size(), 6u);
  ASSERT_EQ(v[7].size(), 6u);
  EXPECT_THAT(std::vector<double>(v[7].begin(), v[7].begin() + 3), ElementsAre(1, 2, 3));
  EXPECT_NEAR(v[7][4], 0.7354, 1e-4);  // sRGB of 0.5
}

// A GLB file taken apart by the rules of its specification.
struct Glb {
  explicit Glb(const std::string& from) : bytes(from) {
    Reader reader{bytes};
    EXPECT_EQ(bytes.substr(0, 4), "glTF");
    reader.at = 4;
    EXPECT_EQ(reader.integer(4), 2u);
    EXPECT_EQ(reader.integer(4), bytes.size());
    const uint32_t length = reader.integer(4);
    EXPECT_EQ(length % 4, 0u);
    EXPECT_EQ(bytes.substr(16, 4), "JSON");
    json = nlohmann::json::parse(bytes.substr(20, length));
    reader.at = 20 + length;
    const uint32_t binary_length = reader.integer(4);
    EXPECT_EQ(binary_length % 4, 0u);
    EXPECT_EQ(bytes.substr(reader.at, 4), std::string("BIN\0", 4));
    binary = reader.at + 4;
    EXPECT_EQ(binary + binary_length, bytes.size());
    EXPECT_EQ(json["buffers"][0]["byteLength"], binary_length);
  }

  // The numbers of an accessor, row by row.
  std::vector<double> values(size_t number) const {
    const auto& accessor = json["accessors"][number];
    const auto& view = json["bufferViews"][accessor["bufferView"].get<size_t>()];
    const std::map<std::string, size_t> widths{{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}};
    const size_t count = accessor["count"].get<size_t>() * widths.at(accessor["type"]);
    EXPECT_EQ(view["byteOffset"].get<size_t>() % 4, 0u);
    EXPECT_EQ(view["byteLength"].get<size_t>(), 4 * count);
    Reader reader{bytes, binary + view["byteOffset"].get<size_t>()};
    std::vector<double> result;
    for (size_t i = 0; i < count; ++i) {
      const bool real = accessor["componentType"] == 5126;
      result.push_back(real ? double(reader.number()) : reader.integer(4));
    }
    return result;
  }
  std::vector<double> attribute(const std::string& name) const {
    return values(json["meshes"][0]["primitives"][0]["attributes"][name].get<size_t>());
  }

  std::string bytes;
  nlohmann::json json;
  size_t binary = 0;
};

TEST_F(MeshFile, GlbInMetresWithYUp) {
  const Glb glb(written("part.glb", sample(), attributes()));
  EXPECT_EQ(glb.json["asset"]["version"], "2.0");
  const auto indices = glb.values(glb.json["meshes"][0]["primitives"][0]["indices"].get<size_t>());
  EXPECT_EQ(indices.size(), 3 * 12u);
  const auto position = glb.attribute("POSITION"), normal = glb.attribute("NORMAL");
  EXPECT_EQ(position.size(), normal.size());
  const auto at = [](const std::vector<double>& list, double i) {
    return Vec3{list.at(3 * size_t(i)), list.at(3 * size_t(i) + 1), list.at(3 * size_t(i) + 2)};
  };
  double volume = 0;
  for (size_t i = 0; i < indices.size(); i += 3) {
    const Vec3 a = at(position, indices[i]), b = at(position, indices[i + 1]),
               c = at(position, indices[i + 2]);
    volume += dot(a, cross(b, c)) / 6;
    for (size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(dot(normalized(cross(b - a, c - a)), at(normal, indices[i + k])), 1, 1e-6);
    }
  }
  EXPECT_NEAR(volume, 6e-9, 1e-14);
  const auto& bounds = glb.json["accessors"][0];
  const Vec3 lo = bounds["min"].get<Vec3>(), hi = bounds["max"].get<Vec3>();
  EXPECT_NEAR(norm(lo - Vec3{0, 0, -0.002}), 0, 1e-9);  // z up became y up
  EXPECT_NEAR(norm(hi - Vec3{0.001, 0.003, 0}), 0, 1e-9);
}

TEST_F(MeshFile, GlbAttributes) {
  MeshAttributes with = attributes();
  with.fraction_names[1] =
      "st\xC3\xA9"
      "el";  // not a letter of ASCII, twice the byte
  const Glb glb(written("part.glb", sample(), with));
  const auto position = glb.attribute("POSITION");
  const auto steel = glb.attribute("_MATERIAL_steel");
  const auto other = glb.attribute("_MATERIAL_st__el");
  const auto color = glb.attribute("COLOR_0"), uv = glb.attribute("TEXCOORD_0");
  EXPECT_EQ(glb.json["meshes"][0]["extras"]["fractions"]["_MATERIAL_st__el"],
            "st\xC3\xA9"
            "el");
  EXPECT_EQ(steel.size(), position.size() / 3);
  for (size_t i = 0; i < steel.size(); ++i) {
    const double x = 1000 * position[3 * i], y = -1000 * position[3 * i + 2],
                 z = 1000 * position[3 * i + 1];
    EXPECT_NEAR(steel[i], (x + y + 4 * z / 3) / 8, 1e-6);
    EXPECT_NEAR(steel[i] + other[i], 1, 1e-6);
    EXPECT_NEAR(color[3 * i + 1], 0.5, 1e-7);
    EXPECT_TRUE(uv[2 * i + 1] == 1 || uv[2 * i + 1] == 0.25) << "v runs downwards";
  }
}

TEST_F(MeshFile, WithoutNormalsUvAndAttributes) {
  Mesh mesh = sample();
  mesh.corner_normals.clear();
  mesh.corner_uv.clear();
  const Glb glb(written("bare.glb", mesh, {}));
  EXPECT_EQ(glb.attribute("POSITION").size(), 3 * 8u);
  EXPECT_FALSE(glb.json["meshes"][0]["primitives"][0]["attributes"].contains("NORMAL"));
  EXPECT_THAT(written("bare.ply", mesh, {}), HasSubstr("property float z\nelement face"));
  EXPECT_THAT(written("bare.obj", mesh, {}), HasSubstr("\nf 1 3 4 2\n"));
}

std::string error_of(const std::string& path, const MeshAttributes& with = {}) {
  try {
    write_mesh(path, sample(), with, 1);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST_F(MeshFile, ErrorsNameThePathAndLeaveNothing) {
  EXPECT_THAT(error_of(path("part.gbl")),
              HasSubstr("unknown extension '.gbl'; accepted are .ply, .obj and .glb"));
  EXPECT_THAT(error_of(path("part")), HasSubstr("has no extension"));
  EXPECT_THAT(error_of(path("no/part.ply")), HasSubstr("no/part.ply: cannot be written: No such"));
  fs::create_directory(path("folder.obj"));
  EXPECT_THAT(error_of(path("folder.obj")), HasSubstr("it is a folder"));
  MeshAttributes wrong = attributes();
  wrong.fractions.pop_back();
  EXPECT_THAT(error_of(path("part.ply"), wrong), HasSubstr("15 numbers for 8 vertices and 2"));
  wrong = attributes();
  wrong.colors.pop_back();
  EXPECT_THAT(error_of(path("part.ply"), wrong), HasSubstr("the colours do not fit"));
  EXPECT_EQ(files(), 1u) << "only the folder made here";
}

// A disk that is full, by a limit on the size of files: the file under the name stays as it was.
TEST_F(MeshFile, WhatCannotBeWrittenKeepsTheOldFile) {
  const std::string before = written("part.ply", sample(), {});
  const auto attempt = [&] {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{100, 100};
    setrlimit(RLIMIT_FSIZE, &limit);
    const std::string message = error_of(path("part.ply"), attributes());
    std::fputs(message.c_str(), stderr);
    std::_Exit(0);
  };
  EXPECT_EXIT(attempt(), testing::ExitedWithCode(0), "part.ply: cannot be written: File too large");
  std::ifstream file(path("part.ply"), std::ios::binary);
  std::stringstream now;
  now << file.rdbuf();
  EXPECT_EQ(now.str(), before);
  EXPECT_EQ(files(), 1u);
}

}  // namespace
}  // namespace sardf

// Meshes in scene files: names, the cache, errors, and saving elsewhere.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "error_of.hpp"
#include "sardf/constructor.hpp"
#include "sardf/evaluate.hpp"
#include "sardf/mesh_set.hpp"
#include "sardf/scene_file.hpp"
#include "triangle_meshes.hpp"

namespace sardf {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class MeshScene : public testing::Test {
 protected:
  std::string mesh(const std::string& name) {
    return folder_.write(name, obj_text(box_mesh({-1, -0.5, -0.25}, {1, 0.5, 0.25})));
  }
  std::string scene(const std::string& name, const std::string& path,
                    const std::string& more = "") {
    return folder_.write(
        name, R"({"sardf": 1, "solid": {"mesh_solid": {"path": ")" + path + "\"" + more + "}}}");
  }
  static double value(const SceneDescription& scene, const Vec3& at) {
    return Evaluator(scene.solid.expression()).value(at);
  }
  TemporaryFolder folder_;
};

TEST_F(MeshScene, PathsAreRelativeToTheScene) {
  mesh("meshes/box.obj");
  const SceneDescription read = read_scene(scene("scenes/a.json", "../meshes/box.obj"));
  EXPECT_DOUBLE_EQ(value(read, {0, 0, 0}), 0.25);
  EXPECT_DOUBLE_EQ(value(read, {2, 0, 0}), -1);
  EXPECT_EQ(read.solid.quality().inside, Exactness::exact);
  const Scene whole(read);
  EXPECT_NEAR(whole.bounds().hi[0], 1, 0.1);
  EXPECT_GE(whole.bounds().hi[0], 1);
}

TEST_F(MeshScene, SavedElsewhereItsFileIsFound) {
  mesh("meshes/box.obj");
  const SceneDescription read = read_scene(scene("scenes/a.json", "../meshes/box.obj"));
  EXPECT_THAT(scene_text(read), HasSubstr("\"../meshes/box.obj\""));
  for (const auto& [name, path] : std::vector<std::pair<std::string, std::string>>{
           {"b.json", "meshes/box.obj"},
           {"meshes/b.json", "box.obj"},
           {"other/deep/b.json", "../../meshes/box.obj"},
           {"scenes/b.json", "../meshes/box.obj"}}) {
    const std::string file = folder_.write(name, "");
    write_scene(file, read);
    const SceneDescription again = read_scene(file);
    EXPECT_THAT(scene_text(again), HasSubstr("\"" + path + "\"")) << name;
    EXPECT_EQ(again.solid.expression(), read.solid.expression());
  }
  const std::string absolute = folder_.file("meshes/box.obj");
  const SceneDescription by_absolute = read_scene(scene("scenes/c.json", absolute));
  write_scene(folder_.write("other/c.json", ""), by_absolute);
  EXPECT_THAT(scene_text(read_scene(folder_.file("other/c.json"))), HasSubstr(absolute));
}

// As from standard input and from Python, whose scenes have no file.
TEST_F(MeshScene, WithoutASceneFileTheyAreRelativeToTheCurrentFolder) {
  mesh("meshes/box.obj");
  const fs::path former = fs::current_path();
  fs::current_path(folder_.file("meshes"));
  const std::string text = R"({"sardf": 1, "solid": {"mesh_solid": {"path": "box.obj"}}})";
  const SceneDescription read = parse_scene(text, "standard input");
  const SceneDescription from_python = parse_scene(text, "");
  fs::create_directory("deeper");
  write_scene("deeper/a.json", from_python);
  write_scene("b.json", read);
  fs::current_path(former);
  EXPECT_THAT(scene_text(read_scene(folder_.file("meshes/deeper/a.json"))),
              HasSubstr("\"../box.obj\""));
  EXPECT_THAT(scene_text(read_scene(folder_.file("meshes/b.json"))), HasSubstr("\"box.obj\""));
}

TEST_F(MeshScene, OneFileIsReadOnceWhileItIsInUse) {
  const std::string path = mesh("box.obj");
  MeshDataPointer first = mesh_data(path);
  EXPECT_EQ(mesh_data(path), first);
  EXPECT_EQ(mesh_data(folder_.file("./box.obj")), first);
  // Another size, then another time.
  folder_.write("box.obj", obj_text(box_mesh({0, 0, 0}, {1, 1, 1})));
  const MeshDataPointer second = mesh_data(path);
  EXPECT_NE(second, first);
  fs::last_write_time(path, fs::last_write_time(path) + std::chrono::seconds(5));
  EXPECT_NE(mesh_data(path), second);
  // Fields of one mesh are one node, however they were read.
  const Field a = make_field("mesh_solid", {FilePath{"box.obj", folder_.file("")}, "auto"});
  const Field b = make_field("mesh_solid", {FilePath{path, ""}, "auto"});
  const Field c = make_field("mesh_solid", {FilePath{path, ""}, "winding"});
  EXPECT_EQ(a.expression(), b.expression());
  EXPECT_NE(a.expression(), c.expression());
}

TEST_F(MeshScene, ErrorsNameTheSceneAndTheMesh) {
  const auto error = [&](const std::string& file) { return error_of([&] { read_scene(file); }); };
  EXPECT_THAT(error(scene("a.json", "none.ply")),
              AllOf(HasSubstr("a.json:1: /solid/mesh_solid"), HasSubstr("none.ply: cannot read")));
  folder_.write("bad.obj", "v 0 0 0\nf 1 1 2\n");
  EXPECT_THAT(error(scene("a.json", "bad.obj")),
              AllOf(HasSubstr("a.json:1: "), HasSubstr("bad.obj:2: face 0")));
  mesh("box.obj");
  EXPECT_THAT(error(scene("a.json", "box.obj", R"(, "sign": "windings")")),
              HasSubstr("did you mean 'winding'"));
  EXPECT_THAT(error(scene("a.json", "")), HasSubstr("a.json:1: "));
}

TEST_F(MeshScene, SurfacesOfSomeFaces) {
  const std::string path =
      folder_.write("quads.obj",
                    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
                    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\n");
  const auto distance = [&](std::vector<double> faces) {
    const Field field = make_field("mesh_surface", {FilePath{path, ""}, std::move(faces)});
    return Evaluator(field.expression()).value({0.5, 0.25, 0.75});
  };
  EXPECT_DOUBLE_EQ(distance({}), 0.25);
  EXPECT_DOUBLE_EQ(distance({0}), 0.75);
  EXPECT_DOUBLE_EQ(distance({1}), 0.25);
  EXPECT_DOUBLE_EQ(distance({0, 2}), 0.25);
  EXPECT_THAT(error_of([&] {
                distance({0, 3});
              }),
              AllOf(HasSubstr("face 3"), HasSubstr("from 0 to 2")));
  EXPECT_THAT(error_of([&] { distance({-1}); }), HasSubstr("face -1"));
  EXPECT_THAT(error_of([&] { distance({0.5}); }), HasSubstr("face 0.5"));
}

}  // namespace
}  // namespace sardf

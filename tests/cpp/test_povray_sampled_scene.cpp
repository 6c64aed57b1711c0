// Scenes with sampled functions: as files, and as pictures without holes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "error_of.hpp"
#include "povray_gen/scene_files.hpp"
#include "povray_gen/scene_text.hpp"
#include "povray_harness.hpp"
#include "sampled_shapes.hpp"
#include "sardf/camera_file.hpp"
#include "sardf/image_file.hpp"
#include "sardf/operation_of.hpp"
#include "sardf/ops.hpp"

namespace sardf {
namespace {

namespace fs = std::filesystem;
using povray::Look;
using povray::PovrayScene;
using povray::SceneText;

const Expression X = coordinate(0), Y = coordinate(1), Z = coordinate(2);
const Vec3 centre{0.13, -0.21, 0.34};

Expression sampled_ball() {
  const auto set = std::make_shared<TestPoints>("ball", std::vector<Vec3>{centre}, 0.9);
  return call(distance_operation(set), {X, Y, Z});
}
Expression exact_ball() {
  Sphere sphere;
  sphere.center = centre;
  sphere.radius = 0.9;
  return call(make_operation(sphere), {X, Y, Z});
}
Expression dots() {
  const auto set =
      std::make_shared<TestPoints>("dots", std::vector<Vec3>{{0.4, 0.1, 0.9}, {-0.5, -0.7, 0.8}});
  return call(distance_operation(set), {X, Y, Z});
}
// With dents, so that a hole of the surface would show.
Expression dented(const Expression& ball) {
  const Expression near = call(make_operation(Subtract()), {dots(), constant(0.35)});
  return call(make_operation(IntersectionOf<Sardf>(Sardf{.radius = 0.1})), {ball, near});
}
Expression dented_by_formula() {
  Expression out = exact_ball();
  Sphere hole;
  hole.radius = 0.35;
  const auto unite = make_operation(UnionOf<MinMax>(MinMax()));
  std::vector<Expression> holes;
  for (const Vec3& p : {Vec3{0.4, 0.1, 0.9}, Vec3{-0.5, -0.7, 0.8}}) {
    hole.center = p;
    holes.push_back(call(make_operation(hole), {X, Y, Z}));
  }
  return call(make_operation(DifferenceOf<Sardf>(Sardf{.radius = 0.1})),
              {out, call(unite, {holes[0], holes[1]})});
}

constexpr double bounds_radius = 0.91;

PovrayScene scene_of(const Expression& solid, Look look = Look::flat) {
  PovrayScene scene;
  scene.title = "ball";
  scene.solid = solid;
  const Vec3 half{bounds_radius, bounds_radius, bounds_radius};
  scene.bounds = {centre - half, centre + half};
  scene.width = 320;
  scene.height = 240;
  scene.camera = frame_camera(scene.bounds, scene.width, scene.height);
  scene.look = look;
  return scene;
}

Image rendered(const PovrayScene& scene, const SceneText& text) {
  const TestFolder folder;
  for (const povray::SampledPointer& sampled : text.sampled) {
    OutputFile file(folder / sampled->file());
    sampled->samples().write_to(file);
    file.commit();
  }
  std::ofstream(folder / "scene.inc") << text.include;
  std::ofstream(folder / "scene.pov") << text.scene;
  povray::RunOptions options;
  options.width = scene.width;
  options.height = scene.height;
  povray::render(folder / "scene.pov", folder / "picture.exr", options);
  return read_image(folder / "picture.exr", Meaning::color);
}

struct Difference {
  int covered = 0;         // pixels of the reference
  int differing = 0;       // in the mask
  int off_the_edge = 0;    // of these, those with no edge of the reference among their neighbours
  double worst_color = 0;  // inside both, away from the edge
};

Difference compared(const Image& a, const Image& reference) {
  Difference out;
  const auto inside = [&](const Image& image, int i, int j) { return image.at(i, j)[3] > 0.5f; };
  for (int j = 1; j + 1 < reference.height; ++j) {
    for (int i = 1; i + 1 < reference.width; ++i) {
      const bool here = inside(reference, i, j);
      bool edge = false;
      for (int k = 0; k < 9; ++k) {
        edge = edge || inside(reference, i - 1 + k % 3, j - 1 + k / 3) != here;
      }
      out.covered += here;
      const bool differs = inside(a, i, j) != here;
      out.differing += differs;
      out.off_the_edge += differs && !edge;
      if (!here || edge || differs) continue;
      for (int k = 0; k < 3; ++k) {
        out.worst_color =
            std::max(out.worst_color, double(std::abs(a.at(i, j)[k] - reference.at(i, j)[k])));
      }
    }
  }
  return out;
}

povray::SamplingOptions up_to(double most_samples) {
  povray::SamplingOptions options;
  options.most_samples = most_samples;
  return options;
}

TEST(PovraySampledSceneSlow, ASolidOfSamplesLooksAsThatOfItsFormula) {
  const PovrayScene exact = scene_of(exact_ball(), Look::normals);
  const Image reference = rendered(exact, povray::scene_text(exact, "scene.inc"));
  const PovrayScene scene = scene_of(sampled_ball(), Look::normals);
  const SceneText text = povray::scene_text(scene, "scene.inc", up_to(1e6));
  EXPECT_TRUE(text.proven);
  EXPECT_GT(text.max_gradient, 1);
  EXPECT_LT(text.max_gradient, 1.02 * std::sqrt(3.0));
  const Difference d = compared(rendered(scene, text), reference);
  EXPECT_GT(d.covered, 15000);
  EXPECT_EQ(d.off_the_edge, 0);
  EXPECT_LT(d.differing, d.covered / 300);
  // The slope of a cell changes over its width, 1/50 of the radius: by 0.01 at its ends.
  EXPECT_LT(d.worst_color, 0.012);
}

TEST(PovraySampledSceneSlow, SamplesInsideAFormulaLeaveNoHoles) {
  const PovrayScene exact = scene_of(dented_by_formula());
  const Image reference = rendered(exact, povray::scene_text(exact, "scene.inc"));
  const PovrayScene scene = scene_of(dented(sampled_ball()));
  const SceneText text = povray::scene_text(scene, "scene.inc", up_to(1e6));
  EXPECT_EQ(text.sampled.size(), 2u);
  const Difference d = compared(rendered(scene, text), reference);
  EXPECT_GT(d.covered, 15000);
  EXPECT_EQ(d.off_the_edge, 0);
}

TEST(PovraySampledSceneSlow, WhatTheUserStatesOfTheGradientIsNotBelievedOfSamples) {
  PovrayScene scene = scene_of(sampled_ball());
  scene.stated_lipschitz = 0.5;
  const SceneText text = povray::scene_text(scene, "scene.inc", up_to(40000));
  EXPECT_TRUE(text.proven);
  EXPECT_GT(text.max_gradient, 1);
}

std::string contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class PovraySampledFiles : public testing::Test {
 protected:
  PovraySampledFiles() {
    SceneDescription description;
    description.solid = Field(exact_ball(), {}, nullptr);
    // Smooth: few samples are enough.
    const Expression wave = call(std::make_shared<TestWave>(2), {X, Y});
    description.fields = {{"wave", Field(wave, {}, nullptr)}};
    scene_ = std::make_unique<Scene>(description);
    files_.path = folder_ / "part.pov";
    files_.look = "flat";
    files_.width = files_.height = 24;
    files_.camera = scene_camera(*scene_, 24, 24);
    files_.all_fields = true;
  }
  std::vector<std::string> names() const {
    std::vector<std::string> out;
    for (const auto& entry : fs::directory_iterator(folder_ / "")) {
      out.push_back(entry.path().filename());
    }
    std::sort(out.begin(), out.end());
    return out;
  }

  TestFolder folder_;
  std::unique_ptr<Scene> scene_;
  povray::SceneFiles files_;
};

TEST_F(PovraySampledFiles, ReplaceThoseOfAnEarlierRunAndAreFoundByPovray) {
  std::ofstream(folder_ / "part_sampled_1.df3") << "stale";
  const std::vector<std::string> sentences = povray::write_files(*scene_, files_);
  ASSERT_EQ(sentences.size(), 2u);
  EXPECT_THAT(sentences[0], testing::StartsWith("wave: "));
  EXPECT_THAT(sentences[1], testing::StartsWith("wave: differs from the exact one by at most 0"));
  EXPECT_EQ(names(), (std::vector<std::string>{"part.inc", "part.pov", "part_sampled_1.df3"}));
  const std::string bytes = contents(folder_ / "part_sampled_1.df3");
  const auto size = [&](size_t k) {
    return 256 * int(uint8_t(bytes.at(2 * k))) + int(uint8_t(bytes.at(2 * k + 1)));
  };
  EXPECT_GT(size(0), 30);
  EXPECT_EQ(size(2), 1);
  EXPECT_EQ(bytes.size(), size_t(6 + 4 * size(0) * size(1) * size(2)));
  const size_t last = size_t(6 + 4 * (size(0) - 1));
  EXPECT_EQ(bytes.substr(last, 4), bytes.substr(last - 4, 4))
      << "behind the last sample POV-Ray goes on with the first";
  povray::render_files(files_, folder_ / "part.exr", {});
  EXPECT_TRUE(fs::exists(folder_ / "part.exr"));
}

TEST_F(PovraySampledFiles, AreNotWrittenForFieldsThatThePictureDoesNotNeed) {
  files_.all_fields = false;
  const std::vector<std::string> sentences = povray::write_files(*scene_, files_);
  EXPECT_THAT(sentences, testing::ElementsAre(
                             "not written, because the picture does not need their samples: wave"));
  EXPECT_EQ(names(), (std::vector<std::string>{"part.inc", "part.pov"}));
  const std::string text = contents(folder_ / "part.inc");
  EXPECT_NE(text.find("\n// " + sentences[0] + "\n"), std::string::npos);
  EXPECT_EQ(text.find("_wave"), std::string::npos);
}

// The curve in space is not needed: one layer is enough for that in the plane.
TEST(PovraySampledScene, APlanarUseOfACurveIsSampledInThePlane) {
  const Expression in_space = dots();
  const Expression in_plane = substitute(in_space, {X, Y, constant(0)});
  PovrayScene scene = scene_of(exact_ball());
  scene.fields = {{"curve", in_space}, {"u", in_plane}};
  scene.color = {in_plane, in_plane, in_plane};
  povray::SamplingOptions options = up_to(40000);
  options.all_fields = false;
  const SceneText text = povray::scene_text(scene, "scene.inc", options);
  ASSERT_EQ(text.sampled.size(), 1u);
  EXPECT_EQ(text.sampled[0]->samples().grid().counts[2], 1);
  EXPECT_EQ(text.include.find("ball_curve"), std::string::npos);
  EXPECT_NE(text.include.find("#declare ball_u = "), std::string::npos);
  EXPECT_THAT(text.sentences.back(), testing::EndsWith(": curve"));
  options.all_fields = true;
  const SceneText all = povray::scene_text(scene, "scene.inc", options);
  EXPECT_GT(all.sampled.at(0)->samples().grid().counts[2], 10);
  EXPECT_NE(all.include.find("#declare ball_curve = "), std::string::npos);
}

class PovrayStaleFiles : public PovraySampledFiles {
 protected:
  // Writes the samples of the wave, then the scene without it.
  void write_twice(const std::function<void()>& between = {}) {
    povray::write_files(*scene_, files_);
    ASSERT_TRUE(fs::exists(folder_ / "part_sampled_1.df3"));
    if (between) between();
    files_.all_fields = false;
    povray::write_files(*scene_, files_);
  }
};

TEST_F(PovrayStaleFiles, AreRemoved) {
  write_twice();
  EXPECT_EQ(names(), (std::vector<std::string>{"part.inc", "part.pov"}));
}

TEST_F(PovrayStaleFiles, AreOnlyThoseThatTheReplacedFileReads) {
  write_twice([&] {
    fs::copy_file(folder_ / "part_sampled_1.df3", folder_ / "part_sampled_2.df3");
    fs::copy_file(folder_ / "part_sampled_1.df3", folder_ / "part_sampled_1.df3.df3");
    fs::copy_file(folder_ / "part_sampled_1.df3", folder_ / "other_sampled_1.df3");
  });
  EXPECT_EQ(names(), (std::vector<std::string>{"other_sampled_1.df3", "part.inc", "part.pov",
                                               "part_sampled_1.df3.df3", "part_sampled_2.df3"}));
}

TEST_F(PovrayStaleFiles, AreNotWhatAUserPutInTheirPlace) {
  write_twice([&] { std::ofstream(folder_ / "part_sampled_1.df3") << "mine"; });
  EXPECT_EQ(contents(folder_ / "part_sampled_1.df3"), "mine");
}

TEST_F(PovrayStaleFiles, AreNotSamplesOfAnotherSizeOrLinksToSome) {
  write_twice([&] {
    const std::string path = folder_ / "part_sampled_1.df3";
    std::string bytes = contents(path);
    std::swap(bytes[0], bytes[4]);  // as many samples, in other rows
    std::swap(bytes[1], bytes[5]);
    std::ofstream(path) << bytes;
  });
  EXPECT_TRUE(fs::exists(folder_ / "part_sampled_1.df3"));
  files_.all_fields = true;
  write_twice([&] {
    fs::rename(folder_ / "part_sampled_1.df3", folder_ / "mine.df3");
    fs::create_symlink("mine.df3", folder_ / "part_sampled_1.df3");
  });
  EXPECT_TRUE(fs::is_symlink(folder_ / "part_sampled_1.df3"));
  EXPECT_TRUE(fs::exists(folder_ / "mine.df3"));
}

TEST_F(PovrayStaleFiles, AreNotNamedByAFileOfAUsers) {
  write_twice([&] {
    std::ofstream(folder_ / "part.inc")
        << "#declare f = function { pattern { density_file df3 \"part_sampled_1.df3\" "
           "interpolate 1 } }\n";
  });
  EXPECT_TRUE(fs::exists(folder_ / "part_sampled_1.df3"));
}

TEST_F(PovrayStaleFiles, AreFoundInFilesWithSpacesInTheirNames) {
  files_.path =
      folder_ / "a part with a long name of many words that must be wrapped somewhere.pov";
  povray::write_files(*scene_, files_);
  EXPECT_EQ(names().size(), 3u);
  files_.all_fields = false;
  povray::write_files(*scene_, files_);
  EXPECT_EQ(names().size(), 2u);
}

TEST_F(PovrayStaleFiles, StayWhereWritingIsCancelled) {
  povray::write_files(*scene_, files_);
  files_.all_fields = false;
  EXPECT_THROW(povray::write_files(*scene_, files_, [](double) { return false; }), Cancelled);
  EXPECT_TRUE(fs::exists(folder_ / "part_sampled_1.df3"));
}

TEST_F(PovraySampledFiles, HaveTheNumberOfSamplesThatIsAskedFor) {
  files_.samples = 8;
  EXPECT_THAT(povray::write_files(*scene_, files_)[0], testing::StartsWith("wave: 21 x 21 x 1 "));
  files_.samples = 7;
  EXPECT_THAT(error_of([&] { povray::write_files(*scene_, files_); }),
              testing::HasSubstr("samples is 7; 8 to 512 is accepted"));
}

TEST_F(PovraySampledFiles, AppearOnlyWhenAllAreComplete) {
  std::ofstream(folder_ / "part_sampled_1.df3") << "stale";
  EXPECT_THROW(povray::write_files(*scene_, files_, [](double share) { return share < 0.1; }),
               Cancelled);
  EXPECT_EQ(names(), (std::vector<std::string>{"part_sampled_1.df3"}));
  EXPECT_EQ(contents(folder_ / "part_sampled_1.df3"), "stale");
}

}  // namespace
}  // namespace sardf

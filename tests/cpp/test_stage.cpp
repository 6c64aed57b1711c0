// Stages as text, their lights as POV-Ray's, and how far a child process says it is.
#include "sardf/stage.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "error_of.hpp"
#include "povray_gen/light_text.hpp"
#include "povray_gen/run.hpp"
#include "povray_gen/stage_files.hpp"
#include "sardf/error.hpp"
#include "sardf/process.hpp"

namespace sardf {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string identity = "[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]";
const std::string ball = R"({"sardf": 1, "fields": {"ball": {"sphere": {"radius": 1}}},
  "solid": "ball", "materials": {"clay": {"color": [1, 1, 1]}},
  "fractions": {"constant": {"clay": 1}}})";

Stage stage_with(const std::string& more) {
  return stage_from_text("{\"camera\": {\"matrix_world\": " + identity +
                         "}, \"parts\": [{\"scene\": " + ball + "}]" + more + "}");
}

size_t count_of(const std::string& text, const std::string& word) {
  size_t count = 0;
  for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

TEST(Stage, DefaultsAreThoseOfTheStructs) {
  const Stage stage = stage_with("");
  EXPECT_EQ(stage.parts.size(), 1u);
  EXPECT_EQ(stage.parts[0].matrix_world, identity_matrix);
  EXPECT_EQ(stage.lights.size(), 0u);
  EXPECT_EQ(stage.world, Vec3({0, 0, 0}));
  EXPECT_EQ(stage.camera.lens, 50);
}

TEST(Stage, ColoursAndPowersAreProducts) {
  const Stage stage = stage_with(R"(, "world": {"color": [0.5, 0.25, 0], "strength": 2},
    "lights": [{"type": "sun", "color": [1, 2, 3], "tint": [2, 0.5, 1], "power": 3,
                "exposure": -1}])");
  EXPECT_EQ(stage.world, Vec3({1, 0.5, 0}));
  EXPECT_EQ(stage.lights[0].color, Vec3({2, 1, 3}));
  EXPECT_EQ(stage.lights[0].power, 1.5);
}

TEST(Stage, LightsOfOlderBlendersAreWeaker) {
  const std::string lights =
      R"(, "lights": [{"type": "area", "power": 4}, {"type": "spot", "power": 4}])";
  const Stage old = stage_with(R"(, "blender": [3, 4, 1])" + lights);
  EXPECT_DOUBLE_EQ(old.lights[0].power, std::numbers::pi);
  EXPECT_EQ(old.lights[1].power, 4);
  EXPECT_TRUE(old.lights[1].spot_cosine);
  const Stage now = stage_with(R"(, "blender": [5, 0, 1])" + lights);
  EXPECT_EQ(now.lights[0].power, 4);
  EXPECT_FALSE(now.lights[1].spot_cosine);
}

TEST(Stage, ErrorsPointToWhatIsWrong) {
  const auto pointer = [](const std::string& more) {
    try {
      stage_with(more);
    } catch (const Error& error) {
      return error.pointer;
    }
    return std::string("no error");
  };
  EXPECT_EQ(pointer(R"(, "lights": [{"type": "sun"}, {"type": "sun", "color": [1, 2]}])"),
            "/lights/1/color");
  EXPECT_EQ(pointer(R"(, "lights": [{"type": "area", "size_x": -1}])"), "/lights/0/size_x");
  EXPECT_EQ(pointer(R"(, "lights": {})"), "/lights");
  EXPECT_EQ(pointer(R"(, "world": {"strength": 1})"), "/world");
  EXPECT_THAT(error_of([] { read_stage("no/such.json"); }), HasSubstr("no/such.json"));
  EXPECT_THAT(error_of([] { stage_from_text("{", "a.json"); }), HasSubstr("a.json"));
}

TEST(LightText, AnAreaLightIsManyAndAnUnlitOneNone) {
  const BoundingBox lit{{-1, -1, -1}, {1, 1, 1}};
  Light light;
  light.type = Light::Type::area;
  EXPECT_EQ(count_of(povray::light_text(light, lit, 3), "light_source"), 9u);
  light.shape = Light::Shape::ellipse;
  EXPECT_EQ(count_of(povray::light_text(light, lit, 4), "light_source"), 16u);
  EXPECT_EQ(count_of(povray::light_text(light, lit, 1), "light_source"), 2u);
  light.power = 0;
  EXPECT_EQ(povray::light_text(light, lit, 3), "");
}

TEST(LightText, SoftShadowsNeedASizeAndNamesStayOnTheirLine) {
  const BoundingBox lit{{-1, -1, -1}, {1, 1, 1}};
  Light light;
  light.name = "two\nlines";
  EXPECT_THAT(povray::light_text(light, lit, 4), Not(HasSubstr("area_light")));
  EXPECT_THAT(povray::light_text(light, lit, 4), HasSubstr("// two lines\n"));
  light.radius = 0.5;
  EXPECT_THAT(povray::light_text(light, lit, 4), HasSubstr("area_light <1, 0, 0>"));
  EXPECT_THAT(povray::light_text(light, lit, 1), Not(HasSubstr("area_light")));
}

TEST(StageFiles, SaysWhatIsNotAccepted) {
  const Stage stage = stage_with("");
  const auto error = [&](const povray::StageFiles& files) {
    return error_of([&] { povray::write_stage(stage, files); });
  };
  EXPECT_THAT(error({"a.txt"}), HasSubstr("must end in .pov"));
  EXPECT_THAT(error({"a.pov", "lt"}), HasSubstr("did you mean 'lit'"));
  EXPECT_THAT(error({"a.pov", "lit", 0, 10}), HasSubstr("width is 0; 1 to 16384"));
}

TEST(ShareIn, IsThatOfTheLastMessage) {
  EXPECT_EQ(povray::share_in(""), 0);
  EXPECT_EQ(povray::share_in("a warning (50%) of no pixels"), 0);
  EXPECT_EQ(povray::share_in("Rendered 5 of 20 pixels (25%)\rRendered 10 of 20 pixels (50%)"), 0.5);
  EXPECT_EQ(povray::share_in("Rendered 20 of 20 pixels (100%)\r\nDone (3%)"), 1);
  EXPECT_EQ(povray::share_in("Rendered 5 of 20 pixels (2"), 0);
}

TEST(RunProcess, TellsTheShareThatTheProgramWrites) {
  double largest = 0;
  const ProcessOptions options{
      .progress =
          [&](double share) {
            largest = std::max(largest, share);
            return share < 0.5;
          },
      .share = [](const std::string& errors) { return errors == "half\n" ? 0.5 : 0.25; }};
  EXPECT_THROW(run_process({"sh", "-c", "echo half >&2; exec cat /dev/zero >/dev/null"}, options),
               Cancelled);
  EXPECT_EQ(largest, 0.5);
}

}  // namespace
}  // namespace sardf

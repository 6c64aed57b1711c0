// Whole scenes: rendered by POV-Ray, with its complaints understood; and the camera.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <optional>

#include "error_of.hpp"
#include "povray_gen/run.hpp"
#include "povray_gen/scene_text.hpp"
#include "povray_harness.hpp"
#include "sardf/error.hpp"
#include "sardf/image_file.hpp"
#include "sardf/operation_of.hpp"
#include "sardf/ops.hpp"

namespace sardf {
namespace {

using povray::Look;
using povray::PovrayScene;
using testing::HasSubstr;

const Expression X = coordinate(0), Y = coordinate(1), Z = coordinate(2);

template <class Op>
Expression in_space(const Op& op) {
  return call(make_operation(op), {X, Y, Z});
}

/// S3 of the benchmarks: a plate with a bore and four bolt holes and a ring, rounded by SARDF.
Expression bearing_plate() {
  Box plate;
  plate.size = {20, 12, 8};
  Torus ring;
  ring.major_radius = 5;
  ring.minor_radius = 1;
  ring.center = {0, 0, 4};
  const auto difference = make_operation(DifferenceOf<Sardf>(Sardf{.radius = 0.5}));
  const auto hole = [](double x, double y, double radius) {
    Cylinder cylinder;
    cylinder.center = {x, y, 0};
    cylinder.radius = radius;
    return in_space(cylinder);
  };
  Expression part = call(difference, {in_space(plate), hole(0, 0, 3)});
  for (double x : {-8.0, 8.0}) {
    for (double y : {-4.0, 4.0}) part = call(difference, {part, hole(x, y, 1)});
  }
  return call(make_operation(UnionOf<Sardf>(Sardf{.radius = 0.5})), {part, in_space(ring)});
}

PovrayScene scene_of(const Expression& solid, const BoundingBox& bounds) {
  PovrayScene scene;
  scene.title = "plate";
  scene.solid = solid;
  scene.bounds = bounds;
  scene.width = 64;
  scene.height = 48;
  scene.camera = frame_camera(bounds, scene.width, scene.height);
  scene.look = Look::flat;
  return scene;
}
PovrayScene plate_scene() {
  return scene_of(bearing_plate(), {{-10.1, -6.1, -4.1}, {10.1, 6.1, 5.1}});
}
PovrayScene ball_scene() {
  return scene_of(in_space(Sphere()), {{-1.01, -1.01, -1.01}, {1.01, 1.01, 1.01}});
}

Expression ramp(const Expression& along, double scale) {
  return call(make_operation(Mix()), {constant(0.5), constant(0.5 + scale), along});
}

class PovrayRender : public testing::Test {
 protected:
  Image render(const PovrayScene& scene, const povray::SceneText& text,
               povray::RunOptions options = {}) {
    std::ofstream(folder_ / "scene.inc") << text.include;
    std::ofstream(folder_ / "scene.pov") << text.scene;
    options.width = scene.width;
    options.height = scene.height;
    povray::render(folder_ / "scene.pov", folder_ / "picture.exr", options);
    return read_image(folder_ / "picture.exr", Meaning::color);
  }
  Image render(const PovrayScene& scene) {
    return render(scene, povray::scene_text(scene, "scene.inc"));
  }
  TestFolder folder_;
};

int covered(const Image& image) {
  int count = 0;
  for (int i = 0; i < image.width * image.height; ++i) count += image.samples[4 * i + 3] == 1;
  return count;
}

// The point of the unit ball that pixel (i, j) sees, or nothing.
std::optional<Vec3> seen_on_ball(const PovrayScene& scene, int i, int j) {
  const View view = view_of(scene.camera, scene.width, scene.height);
  const Vec3 ray = normalized(view.direction + ((i + 0.5) / scene.width - 0.5) * view.right +
                              (0.5 - (j + 0.5) / scene.height) * view.up);
  const double b = dot(view.location, ray), c = dot(view.location, view.location) - 1;
  if (b * b < c) return {};
  return view.location + (-b - std::sqrt(b * b - c)) * ray;
}

TEST_F(PovrayRender, ColoursAndMaskAreThoseOfTheFormula) {
  PovrayScene scene = ball_scene();
  scene.color = {ramp(X, 0.5), ramp(Y, 0.25), ramp(Z, -0.5)};
  const Image image = render(scene);
  ASSERT_EQ(image.channels, 4);
  int hits = 0, mask_errors = 0;
  float worst = 0;
  for (int j = 0; j < scene.height; ++j) {
    for (int i = 0; i < scene.width; ++i) {
      const float* pixel = image.at(i, j);
      const auto at = seen_on_ball(scene, i, j);
      mask_errors += pixel[3] != (at ? 1.0f : 0.0f);
      if (!at || pixel[3] != 1) continue;
      ++hits;
      const double expected[] = {0.5 + 0.5 * (*at)[0], 0.5 + 0.25 * (*at)[1], 0.5 - 0.5 * (*at)[2]};
      for (int k = 0; k < 3; ++k) worst = std::max(worst, std::abs(pixel[k] - float(expected[k])));
    }
  }
  EXPECT_GT(hits, 300);
  EXPECT_EQ(mask_errors, 0);
  EXPECT_LT(worst, 1e-3) << "half precision has 5e-4";
}

TEST_F(PovrayRender, TwoAndThreeMaterialsTakeFewerFunctionsAndLookTheSame) {
  const std::vector<Vec3> colors{{0.9, 0.1, 0.05}, {0.1, 0.7, 0.3}, {0.2, 0.3, 0.8}};
  const auto plus = make_operation(Add()), times = make_operation(Multiply());
  const Expression across = ramp(X, 0.4), up = call(times, {constant(0.3), ramp(Z, 0.4)});
  for (size_t materials : {2u, 3u}) {
    PovrayScene scene = ball_scene();
    Expression rest = call(make_operation(Subtract()), {constant(1), up});
    scene.fractions = {{"a", call(times, {rest, across})}};
    scene.fractions.push_back(
        {"b", call(make_operation(Subtract()), {rest, scene.fractions[0].expression})});
    if (materials == 3) scene.fractions.push_back({"c", up});
    if (materials == 2) {
      scene.fractions = {{"a", across},
                         {"b", call(make_operation(Subtract()), {constant(1), across})}};
    }
    for (size_t channel = 0; channel < 3; ++channel) {
      scene.color[channel] = constant(0);
      for (size_t i = 0; i < materials; ++i) {
        const Expression share =
            call(times, {scene.fractions[i].expression, constant(colors[i][channel])});
        scene.color[channel] = call(plus, {scene.color[channel], share});
      }
    }
    const Image by_channels = render(scene);
    scene.material_colors.assign(colors.begin(), colors.begin() + std::ptrdiff_t(materials));
    const povray::SceneText text = povray::scene_text(scene, "scene.inc");
    EXPECT_THAT(text.include, testing::Not(HasSubstr("plate_red")));
    const Image by_fractions = render(scene, text);
    float worst = 0;
    for (size_t i = 0; i < by_channels.samples.size(); ++i) {
      worst = std::max(worst, std::abs(by_channels.samples[i] - by_fractions.samples[i]));
    }
    EXPECT_LT(worst, 1e-3) << "half precision has 5e-4";
  }
}

TEST_F(PovrayRender, NormalsPointOutwards) {
  PovrayScene scene = ball_scene();
  scene.look = Look::normals;
  scene.camera.type = Camera::Type::perspective;
  const Image image = render(scene);
  float worst = 0;
  int hits = 0;
  for (int j = 0; j < scene.height; ++j) {
    for (int i = 0; i < scene.width; ++i) {
      const auto at = seen_on_ball(scene, i, j);
      if (!at || image.at(i, j)[3] != 1) continue;
      ++hits;
      for (int k = 0; k < 3; ++k) {
        worst = std::max(worst, std::abs(image.at(i, j)[k] - float(0.5 + 0.5 * (*at)[k])));
      }
    }
  }
  EXPECT_GT(hits, 300);
  EXPECT_LT(worst, 1e-3);
}

TEST_F(PovrayRender, AnOrdinaryPartIsSeenWithoutComplaint) {
  PovrayScene scene = plate_scene();
  EXPECT_GT(covered(render(scene)), 600);
  scene.look = Look::shaded;
  const Image image = render(scene);
  float least = 1, most = 0;
  for (int i = 0; i < image.width * image.height; ++i) {
    least = std::min(least, image.samples[4 * i]);
    most = std::max(most, image.samples[4 * i]);
  }
  EXPECT_LT(least, 0.5);
  EXPECT_GT(most, 0.85);
}

TEST_F(PovrayRender, TheIncludeFileServesUsersScenes) {
  // Twice in one scene, with the user's own short names declared, and cut by a plane.
  const PovrayScene scene = plate_scene();
  povray::SceneText text = povray::scene_text(scene, "scene.inc");
  text.scene =
      "#version 3.7;\nglobal_settings { assumed_gamma 1.0 }\n#declare a = 1; #declare part = 2;\n"
      "#declare plate_csg = yes;\n#include \"scene.inc\"\n#include \"scene.inc\"\n" +
      povray::camera_text(scene.camera, scene.width, scene.height) +
      "background { rgbt 1 }\n"
      "intersection {\n  plate_isosurface()\n  plane { -y, 0 }\n"
      "  texture { pigment { rgb <1, 0, 0> } finish { emission 1 ambient 0 diffuse 0 } }\n}\n";
  const Image image = render(scene, text);
  EXPECT_GT(covered(image), 300);
  for (int i = 0; i < image.width * image.height; ++i) {
    ASSERT_EQ(image.samples[4 * i], image.samples[4 * i + 3]) << "an untextured face";
  }
}

TEST_F(PovrayRender, ATooSmallGradientIsAnErrorAndLeavesNoPicture) {
  const PovrayScene scene = ball_scene();
  povray::SceneText text = povray::scene_text(scene, "scene.inc");
  const std::string right = "max_gradient " + povray::number_text(text.max_gradient);
  ASSERT_THAT(text.include, HasSubstr(right));
  text.include.replace(text.include.find(right), right.size(), "max_gradient 0.3");
  EXPECT_THAT(
      error_of([&] { render(scene, text); }),
      testing::AllOf(HasSubstr("The maximum gradient found was"), HasSubstr("may contain holes")));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "picture.exr"));
}

TEST_F(PovrayRender, PovraysComplaintsAreErrors) {
  const PovrayScene scene = ball_scene();
  povray::SceneText text = povray::scene_text(scene, "scene.inc");
  const std::string sound = text.scene;
  text.scene = sound + "sphere { oops }\n";
  EXPECT_THAT(
      error_of([&] { render(scene, text); }),
      testing::AllOf(HasSubstr("scene.pov' line"), HasSubstr("Parse Error"), HasSubstr("oops")));
  text.scene = "camera { location 0 }\n" + sound;
  EXPECT_THAT(error_of([&] { render(scene, text); }), HasSubstr("Parse Warning"));
  text.scene = sound;
  const auto empty = [](const std::string&) { return std::string("the picture is empty"); };
  std::ofstream(folder_ / "scene.pov") << text.scene;
  EXPECT_THAT(
      error_of([&] { povray::render(folder_ / "scene.pov", folder_ / "picture.exr", {}, empty); }),
      HasSubstr("POV-Ray: the picture is empty"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "picture.exr"));
  EXPECT_THAT(error_of([&] { povray::render(folder_ / "none.pov", folder_ / "p.exr", {}); }),
              HasSubstr("there is no such scene"));
  EXPECT_THAT(error_of([&] { povray::render(folder_ / "scene.pov", folder_ / "no/p.exr", {}); }),
              HasSubstr("does not exist"));
}

TEST(ComplaintIn, ShiftedLensesAreMeantAndHideNoOtherWarning) {
  const std::string shifted =
      "File './a.pov' line 11: Parse Warning: Camera vectors are not perpendicular. \n"
      "Making look_at the last statement may help.\n";
  EXPECT_EQ(povray::complaint_in(shifted), "");
  EXPECT_THAT(povray::complaint_in(shifted + "File './a.pov' line 12: Parse Warning: Other.\n"),
              HasSubstr("Other."));
}

TEST_F(PovrayRender, StopsAtOnceWhenCancelledOrTimedOut) {
  PovrayScene scene = plate_scene();
  scene.width = 3000;
  scene.height = 2000;
  const povray::SceneText text = povray::scene_text(scene, "scene.inc");
  const auto start = std::chrono::steady_clock::now();
  povray::RunOptions options;
  options.timeout = 1;
  EXPECT_THAT(error_of([&] { render(scene, text, options); }), HasSubstr("stopped after 1 s"));
  int asked = 0;
  options.progress = [&](double) { return ++asked < 10; };
  EXPECT_THROW(render(scene, text, options), Cancelled);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  EXPECT_LT(seconds.count(), 6);
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "")) {
    files += entry.path().filename() != "scene.inc" && entry.path().filename() != "scene.pov";
  }
  EXPECT_EQ(files, 0) << "a partial picture is left";
}

TEST_F(PovrayRender, AMissingPovrayIsSaidPlainly) {
  const PovrayScene scene = ball_scene();
  const std::string path = getenv("PATH");
  setenv("PATH", folder_.operator/("").c_str(), 1);
  EXPECT_THAT(error_of([&] { render(scene); }), HasSubstr("apt install povray"));
  setenv("PATH", path.c_str(), 1);
  setenv("POVRAY", "/nowhere/povray", 1);
  EXPECT_THAT(error_of([&] { render(scene); }),
              HasSubstr("POVRAY to its path; it is '/nowhere/povray'"));
  unsetenv("POVRAY");
}

TEST(PovrayScene, AnInfiniteGradientNeedsAStatedBound) {
  const Expression inverse = call(make_operation(Divide()), {constant(1), X});
  PovrayScene scene = ball_scene();
  scene.solid = call(make_operation(Subtract()), {scene.solid, inverse});
  EXPECT_THAT(error_of([&] { povray::scene_text(scene, "a.inc"); }),
              testing::AllOf(HasSubstr("divide"), HasSubstr("\"lipschitz\": L")));
  scene.stated_lipschitz = 7;
  const povray::SceneText text = povray::scene_text(scene, "a.inc");
  EXPECT_FALSE(text.proven);
  EXPECT_DOUBLE_EQ(text.max_gradient, 7 * 1.02);
  EXPECT_THAT(text.include, HasSubstr("not proven"));
}

TEST(PovrayScene, BoundsMustBeFinite) {
  PovrayScene scene = ball_scene();
  scene.bounds.hi[1] = infinity;
  EXPECT_THAT(error_of([&] { povray::scene_text(scene, "a.inc"); }), HasSubstr("along y"));
}

TEST(FrameCamera, TheWholeBoxFillsThePicture) {
  const BoundingBox boxes[] = {
      {{-1, -1, -1}, {1, 1, 1}}, {{5, 5, 5}, {25, 6, 9}}, {{-0.01, -40, 0}, {0.01, 40, 2}}};
  for (const auto& box : boxes) {
    for (const auto& [width, height] : {std::pair(320, 240), std::pair(100, 400)}) {
      for (const Vec3& direction : {three_quarter_view, Vec3{0, 0, -1}, Vec3{1, 0, 0}}) {
        const Camera camera = frame_camera(box, width, height, direction);
        const View view = view_of(camera, width, height);
        double low[] = {1, 1}, high[] = {-1, -1};
        for (int i = 0; i < 8; ++i) {
          const Vec3 corner{i & 1 ? box.hi[0] : box.lo[0], i & 2 ? box.hi[1] : box.lo[1],
                            i & 4 ? box.hi[2] : box.lo[2]};
          const Vec3 to = corner - view.location;
          const double depth = dot(to, view.direction) / dot(view.direction, view.direction);
          EXPECT_GT(depth * norm(view.direction), camera.clip_start);
          EXPECT_LT(depth * norm(view.direction), camera.clip_end);
          const double at[] = {dot(to, view.right) / dot(view.right, view.right) / depth,
                               dot(to, view.up) / dot(view.up, view.up) / depth};
          for (int k = 0; k < 2; ++k) {
            low[k] = std::min(low[k], at[k]);
            high[k] = std::max(high[k], at[k]);
          }
        }
        // Inside by 4 % of the picture; exactly so along one of the two directions.
        for (int k = 0; k < 2; ++k) {
          EXPECT_GE(low[k], -0.46 - 1e-9);
          EXPECT_LE(high[k], 0.46 + 1e-9);
        }
        EXPECT_NEAR(std::max(high[0] - low[0], high[1] - low[1]), 0.92, 1e-9);
      }
    }
  }
}

TEST(FrameCamera, ViewsFollowTheSensor) {
  // Blender's rules: AUTO fits the sensor's width to the longer edge.
  Camera camera;
  camera.shift_x = 0.1;
  View view = view_of(camera, 200, 100);
  EXPECT_NEAR(norm(view.right), 1, 1e-15);
  EXPECT_NEAR(norm(view.up), 0.5, 1e-15);
  EXPECT_NEAR(view.direction[2], -50.0 / 36, 1e-15);
  EXPECT_NEAR(view.direction[0], 0.1, 1e-15);
  view = view_of(camera, 100, 200);
  EXPECT_NEAR(norm(view.right), 0.5, 1e-15);
  EXPECT_NEAR(norm(view.up), 1, 1e-15);
  camera.sensor_fit = Camera::Fit::vertical;
  EXPECT_NEAR(view_of(camera, 200, 100).direction[2], -50.0 / 24, 1e-15);
  camera.type = Camera::Type::orthographic;
  camera.sensor_fit = Camera::Fit::horizontal;
  camera.ortho_scale = 4;
  view = view_of(camera, 200, 100);
  EXPECT_NEAR(norm(view.right), 4, 1e-15);
  EXPECT_NEAR(view.location[0], 0.4, 1e-15);
  camera.matrix_world[2][2] = 0;
  EXPECT_THAT(error_of([&] { view_of(camera, 2, 1); }), HasSubstr("lie in one plane"));
}

TEST(RunProcess, ReturnsWhatTheProgramSaysAndHowItEnds) {
  const ProcessResult result =
      run_process({"sh", "-c", "pwd; echo oops >&2; exit 3"}, {.folder = "/usr"});
  EXPECT_EQ(result.output, "/usr\n");
  EXPECT_EQ(result.errors, "oops\n");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(run_process({"sh", "-c", "kill -9 $$"}).exit_code, 137);
  const ProcessResult large = run_process({"sh", "-c", "head -c 3000000 /dev/zero; exit 0"});
  EXPECT_EQ(large.output.size(), 3000000u) << "more than a pipe holds";
}

TEST(RunProcess, SaysWhatCannotBeStarted) {
  EXPECT_THAT(error_of([] { run_process({"no-such-program"}); }),
              HasSubstr("no-such-program cannot be started: No such file"));
  EXPECT_THAT(error_of([] { run_process({"true"}, {.folder = "/nowhere"}); }),
              HasSubstr("in /nowhere"));
}

}  // namespace
}  // namespace sardf

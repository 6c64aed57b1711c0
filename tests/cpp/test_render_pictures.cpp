#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render_checks.hpp"
#include "sardf/camera_file.hpp"
#include "sardf/render.hpp"
#include "sardf/scene_file.hpp"
#include "source_folder.hpp"

namespace sardf {
namespace {

using namespace checks;
using testing::ElementsAre;

Scene scene_of(const std::string& rest) {
  const std::string text = R"scene({"sardf": 1, "solid": {"box": {"size": [4, 4, 4]}},
    "materials": {"red": {"color": [1, 0, 0]}, "blue": {"color": [0, 0.25, 1]}},
    "fractions": {"functions": {"red": "=step(1, length(x, y, z))", "blue": "rest"}})scene";
  return Scene(parse_scene(text + rest + "}", ""));
}

TEST(RenderPictures, SectionsShowTheMaterialsInside) {
  const Scene scene = scene_of(R"(, "sections": [{"remove": {"half_space": {"point": [0, 0, 0],
    "normal": "z"}}}])");
  RenderOptions options = orthographic(options_of(padded({2, 2, 2}), {0, 0, -1}), 6);
  options.depth = options.normals = true;
  const RenderedPicture picture = render(scene, options);
  EXPECT_THAT(picture.channels, ElementsAre("R", "G", "B", "A", "Z", "NX", "NY", "NZ"));
  const double pixel = 6.0 / options.width, height = options.camera.matrix_world[2][3];
  int blue = 0;
  for (int y = 0; y < options.height; ++y) {
    for (int x = 0; x < options.width; ++x) {
      const Vec3 at = ray_of(options, x, y).from;
      const float* p = picture.image.at(x, y);
      const double radius = std::hypot(at[0], at[1]);
      const bool inside = std::abs(at[0]) < 2 && std::abs(at[1]) < 2;
      ASSERT_EQ(p[3], inside ? 1 : 0);
      if (!inside) {
        ASSERT_EQ(p[4], float(infinity));
        continue;
      }
      // The cut lies at z = 0.
      ASSERT_NEAR(p[4], height, 1e-5 * height);
      ASSERT_NEAR(p[7], 1, 1e-6);
      if (std::abs(radius - 1) < 1e-3 * pixel) continue;
      ASSERT_EQ(p[0], radius < 1 ? 0 : 1) << x << ", " << y;
      ASSERT_NEAR(p[1], radius < 1 ? 0.25 : 0, 1e-6);
      blue += radius < 1 ? 1 : 0;
    }
  }
  EXPECT_NEAR(blue * pixel * pixel, 3.14159, 0.05);
}

// A skin thinner than the way from the surface at which colours are taken in single precision, and
// with that precision's rounding: the two sides' colours differ, and neither nor their mean counts.
TEST(RenderPictures, AThinSkinKeepsItsColor) {
  const Scene scene(parse_scene(R"scene({"sardf": 1, "solid": {"box": {"size": [4, 4, 4]}},
    "materials": {"red": {"color": [1, 0, 0]}, "blue": {"color": [0, 0.25, 1]}},
    "fractions": {"functions": {"red": "=step(0, 1.99998 - z)", "blue": "rest"}}})scene",
                                ""));
  RenderOptions options = orthographic(options_of(padded({2, 2, 2}), {0, 0, -1}), 3);
  const RenderedPicture picture = render(scene, options);
  for (int y = 0; y < options.height; ++y) {
    for (int x = 0; x < options.width; ++x) {
      const float* p = picture.image.at(x, y);
      ASSERT_EQ(p[3], 1) << x << ", " << y;
      ASSERT_EQ(p[0], 0) << x << ", " << y;
      ASSERT_NEAR(p[1], 0.25, 1e-6);
    }
  }
}

// Without depth the surface is found in single precision only, where that does.
TEST(RenderPictures, DepthDoesNotChangeColors) {
  for (const char* name : {"cad_plate_cut", "cad_plate_stripes", "lined_bore"}) {
    const Scene scene(read_scene(source_folder() / "scenes" / (std::string(name) + ".json")));
    RenderOptions options;
    options.width = 133;
    options.height = 97;
    options.camera = scene_camera(scene, options.width, options.height);
    const RenderedPicture rough = render(scene, options);
    options.depth = true;
    const RenderedPicture exact = render(scene, options);
    int shown = 0;
    for (int y = 0; y < options.height; ++y) {
      for (int x = 0; x < options.width; ++x) {
        const float *p = rough.image.at(x, y), *q = exact.image.at(x, y);
        ASSERT_EQ(p[3], q[3]) << name << ": " << x << ", " << y;
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(p[c], q[c], 1.0 / 255) << name << ": " << x << ", " << y;
        shown += p[3] > 0 ? 1 : 0;
      }
    }
    EXPECT_GT(shown, 1000) << name;
  }
}

TEST(RenderPictures, LooksAndBackgrounds) {
  const Scene scene = scene_of("");
  RenderOptions options = options_of(padded({2, 2, 2}));
  options.look = RenderLook::normals;
  const RenderedPicture normals = render(scene, options);
  // The middle shows the corner's three faces; their normals are along the axes.
  const float* p = normals.image.at(options.width / 2, options.height / 5);
  EXPECT_THAT((std::array<float, 4>{p[0], p[1], p[2], p[3]}), ElementsAre(0.5, 0.5, 1, 1));
  options.look = RenderLook::shaded;
  options.background = Vec3{0.25, 0.5, 0.75};
  const RenderedPicture lit = render(scene, options);
  const float* corner = lit.image.at(0, 0);
  EXPECT_THAT((std::array<float, 4>{corner[0], corner[1], corner[2], corner[3]}),
              ElementsAre(0.25, 0.5, 0.75, 1));
  // The top is lit, and it is red.
  const float* top = lit.image.at(options.width / 2, options.height / 5);
  EXPECT_GT(top[0], 0.3);
  EXPECT_LT(top[1], 0.2);
}

// A pixel of several samples is the mean of the pixels of a finer picture.
TEST(RenderPictures, SeveralSamplesOfAPixel) {
  const Scene scene = scene_of("");
  RenderOptions options = options_of(padded({2, 2, 2}));
  options.depth = options.normals = true;
  options.samples = 3;
  const RenderedPicture smooth = render(scene, options);
  ASSERT_EQ(smooth.image.width, options.width);
  options.samples = 1;
  options.width *= 3;
  options.height *= 3;
  const RenderedPicture fine = render(scene, options);
  int mixed = 0;
  for (int y = 0; y < smooth.image.height; ++y) {
    for (int x = 0; x < smooth.image.width; ++x) {
      float alpha = 0, depth = float(infinity);
      for (int k = 0; k < 9; ++k) {
        const float* part = fine.image.at(3 * x + k % 3, 3 * y + k / 3);
        alpha += part[3] / 9;
        depth = std::min(depth, part[4]);
      }
      const float* pixel = smooth.image.at(x, y);
      ASSERT_NEAR(pixel[3], alpha, 1e-6);
      ASSERT_EQ(pixel[4], depth);
      ASSERT_NEAR(pixel[0], alpha, 1e-6);  // red, premultiplied
      const double length = std::hypot(pixel[5], pixel[6], pixel[7]);
      ASSERT_NEAR(length, alpha > 0 ? 1 : 0, 1e-6);
      mixed += alpha > 0.05f && alpha < 0.95f ? 1 : 0;
    }
  }
  EXPECT_GT(mixed, 100);
}

// The key light comes from the camera's upper left: a ball above a plate darkens it to its right.
TEST(RenderPictures, ShadowsFallAwayFromTheKeyLight) {
  const Scene scene(parse_scene(R"({"sardf": 1, "solid": {"union": {"of": [
    {"box": {"size": [8, 8, 0.4]}}, {"sphere": {"center": [0, 0, 1.5], "radius": 0.7}}]}}})",
                                ""));
  RenderOptions options = orthographic(options_of(padded({4, 4, 2}), {0, 0, -1}), 9);
  options.look = RenderLook::shaded;
  const RenderedPicture picture = render(scene, options);
  const View view = view_of(options.camera, options.width, options.height);
  const auto brightness = [&](const Vec3& at) {
    const Vec3 from = at - view.location;
    const double u = dot(from, view.right) / dot(view.right, view.right);
    const double v = dot(from, view.up) / dot(view.up, view.up);
    return picture.image.at(int((u + 0.5) * options.width), int((0.5 - v) * options.height))[0];
  };
  // The light's direction is (-0.6, 0.9, 0.8) by right, up and back: from the ball's middle, 1.3
  // above the plate, its shadow is moved by 1.3 × (0.6, -0.9) / 0.8.
  const Vec3 right = normalized(view.right), up = normalized(view.up);
  const Vec3 shadow = 1.3 / 0.8 * (0.6 * right - 0.9 * up) + Vec3{0, 0, 0.2};
  const Vec3 opposite = -1.3 / 0.8 * (0.6 * right - 0.9 * up) + Vec3{0, 0, 0.2};
  EXPECT_LT(brightness(shadow), 0.6 * brightness(opposite));
}

TEST(RenderPictures, ThePictureDoesNotDependOnThreads) {
  const Scene scene(read_scene(source_folder() / "scenes/cad_plate_cut.json"));
  RenderOptions options;
  options.width = 133;
  options.height = 97;
  options.look = RenderLook::shaded;
  options.depth = options.normals = true;
  options.camera = scene_camera(scene, options.width, options.height);
  options.threads = 1;
  const RenderedPicture one = render(scene, options);
  for (const int threads : {2, 5, 0}) {
    options.threads = threads;
    EXPECT_EQ(render(scene, options).image.samples, one.image.samples) << threads;
  }
}

}  // namespace
}  // namespace sardf

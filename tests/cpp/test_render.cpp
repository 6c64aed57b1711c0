#include "sardf/render.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "mesh_checks.hpp"
#include "sardf/bounds.hpp"
#include "sardf/camera_file.hpp"
#include "sardf/constructor.hpp"
#include "sardf/error.hpp"
#include "sardf/formula.hpp"
#include "sardf/scene_file.hpp"

namespace sardf {
namespace {

using namespace checks;
using testing::ElementsAre;
using testing::HasSubstr;

/// A ray as camera.hpp describes it: from + t along, t the depth along the view.
struct TestRay {
  Vec3 from, along;
  Vec3 at(double t) const { return from + t * along; }
};

TestRay ray_of(const RenderOptions& options, int x, int y) {
  const View view = view_of(options.camera, options.width, options.height);
  const double u = (x + 0.5) / options.width - 0.5, v = 0.5 - (y + 0.5) / options.height;
  const Vec3 across = u * view.right + v * view.up;
  if (options.camera.type == Camera::Type::orthographic) {
    return {view.location + across, view.direction};
  }
  const Vec3 axis = normalized(cross(view.up, view.right));
  return {view.location, (1 / dot(view.direction, axis)) * (view.direction + across)};
}

// Where a ray is in the solid, by a closed formula; `from` > `to`: nowhere.
struct Inside {
  double from = infinity, to = -infinity;
};

Inside in_ball(const TestRay& ray, const Vec3& center, double radius) {
  const Vec3 to = ray.from - center;
  const double a = dot(ray.along, ray.along), b = dot(ray.along, to);
  const double d = b * b - a * (dot(to, to) - radius * radius);
  if (d < 0) return {};
  return {(-b - std::sqrt(d)) / a, (-b + std::sqrt(d)) / a};
}

Inside in_box(const TestRay& ray, const Vec3& half) {
  Inside in{-infinity, infinity};
  for (int i = 0; i < 3; ++i) {
    const double one = (-half[i] - ray.from[i]) / ray.along[i];
    const double other = (half[i] - ray.from[i]) / ray.along[i];
    in.from = std::max(in.from, std::min(one, other));
    in.to = std::min(in.to, std::max(one, other));
  }
  return in;
}

RenderOptions options_of(const BoundingBox& bounds, const Vec3& direction = three_quarter_view) {
  RenderOptions options;
  options.width = 150;
  options.height = 110;
  options.camera = frame_camera(bounds, options.width, options.height, direction);
  options.tolerance = 1e-4 * bounds.diagonal();
  return options;
}

RenderOptions orthographic(RenderOptions options, double scale) {
  options.camera.type = Camera::Type::orthographic;
  options.camera.ortho_scale = scale;
  return options;
}

// Every pixel against the closed form: a stretch longer than the tolerance is met, and where it
// begins; a ray without any misses; in between either may be.
template <class Form>
void expect_closed_form(const Expression& field, const BoundingBox& bounds,
                        const RenderOptions& options, Form form, int least_met = 1000) {
  const std::vector<double> depths = render_depths(Evaluator(field), bounds, options);
  int met = 0;
  for (int y = 0; y < options.height; ++y) {
    for (int x = 0; x < options.width; ++x) {
      SCOPED_TRACE(testing::Message() << "pixel " << x << ", " << y);
      const TestRay ray = ray_of(options, x, y);
      const Inside in = form(ray);
      const double depth = depths[size_t(y) * options.width + x];
      if (!(in.to >= in.from)) {
        ASSERT_EQ(depth, infinity);
      } else if ((in.to - in.from) * norm(ray.along) > *options.tolerance || depth < infinity) {
        ASSERT_NEAR(depth, in.from, 1e-8 * bounds.diagonal());
        ++met;
      }
    }
  }
  EXPECT_GE(met, least_met);
}

TEST(Render, BallToThePixelAndToNineDigits) {
  const auto form = [](const TestRay& ray) { return in_ball(ray, {1, 2, 3}, 2); };
  const Expression ball = sphere(2, {1, 2, 3});
  const BoundingBox bounds = certified_bounds(Evaluator(ball));
  RenderOptions options = options_of(bounds);
  expect_closed_form(ball, bounds, options, form);
  options.camera.shift_x = 0.13;
  options.camera.shift_y = -0.07;
  options.camera.sensor_fit = Camera::Fit::vertical;
  expect_closed_form(ball, bounds, options, form);
  expect_closed_form(ball, bounds, orthographic(options, 6), form);
}

TEST(Render, BoxToThePixel) {
  const auto form = [](const TestRay& ray) { return in_box(ray, {10, 6, 4}); };
  const Expression block = box({20, 12, 8});
  const BoundingBox bounds = certified_bounds(Evaluator(block));
  RenderOptions options = options_of(bounds);
  expect_closed_form(block, bounds, options, form);
  expect_closed_form(block, bounds, orthographic(options, 30), form);
}

TEST(Render, FarFromTheOriginAndVerySmall) {
  const Vec3 center{1000, 3, -20};
  const Expression ball = sphere(1e-3, center);
  const BoundingBox bounds = certified_bounds(Evaluator(ball));
  const RenderOptions options = options_of(bounds);
  const std::vector<double> depths = render_depths(Evaluator(ball), bounds, options);
  for (int y = 0; y < options.height; ++y) {
    for (int x = 0; x < options.width; ++x) {
      const TestRay ray = ray_of(options, x, y);
      // Coordinates have 1e-13 here, a pixel 1e-5: only what is nearer to the outline is unsure.
      const bool surely_in =
          in_ball(ray, center, 0.99999e-3).to < infinity && in_ball(ray, center, 0.99999e-3).to > 0;
      const bool maybe_in = in_ball(ray, center, 1.00001e-3).to > 0;
      const double depth = depths[size_t(y) * options.width + x];
      ASSERT_TRUE(!surely_in || depth < infinity) << x << ", " << y;
      ASSERT_TRUE(maybe_in || depth == infinity) << x << ", " << y;
    }
  }
}

// Plates that are a few tolerances thick, seen from the side and at a slant: none has a hole.
TEST(Render, ThinPlatesHaveNoHoles) {
  for (const double tolerances : {1.01, 3.0, 40.0}) {
    const double tolerance = 2e-3, thick = tolerances * tolerance;
    const auto form = [&](const TestRay& ray) { return in_box(ray, {10, 6, 0.5 * thick}); };
    const Expression plate = box({20, 12, thick});
    const BoundingBox bounds = certified_bounds(Evaluator(plate));
    for (const Vec3& direction :
         {Vec3{-0.5, 0.78, -0.42}, Vec3{0.03, 0.02, -1}, Vec3{0, 1, -0.02}}) {
      RenderOptions options = options_of(padded({10, 6, 4}), direction);
      options.tolerance = tolerance;
      expect_closed_form(plate, bounds, options, form, 60);
    }
  }
}

// A shell thinner than the tolerance is not met head-on, which the tolerance allows, but no ray
// that stays in it for longer is lost: those that touch it.
TEST(Render, ThinShellSeenAlongItsWall) {
  const double wall = 1e-3;
  const Expression shell = cut(sphere(2), sphere(2 - wall));
  const BoundingBox bounds = certified_bounds(Evaluator(shell));
  RenderOptions options = options_of(bounds);
  options.tolerance = 5 * wall;
  const std::vector<double> depths = render_depths(Evaluator(shell), bounds, options);
  int long_ways = 0;
  for (int y = 0; y < options.height; ++y) {
    for (int x = 0; x < options.width; ++x) {
      const TestRay ray = ray_of(options, x, y);
      const Inside outer = in_ball(ray, {}, 2), inner = in_ball(ray, {}, 2 - wall);
      const double depth = depths[size_t(y) * options.width + x];
      if (!(outer.to >= outer.from)) {
        ASSERT_EQ(depth, infinity);
        continue;
      }
      const double first = inner.to >= inner.from ? inner.from : outer.to;
      if ((first - outer.from) * norm(ray.along) <= *options.tolerance) continue;
      ++long_ways;
      ASSERT_NEAR(depth, outer.from, 1e-8) << x << ", " << y;
    }
  }
  EXPECT_GT(long_ways, 50);
}

// Ever higher thin fins across a floor, seen along the floor. A ray over the lower fins comes no
// nearer to what is below it, and long steps are tempting.
TEST(Render, ThinFinsBehindEachOther) {
  std::vector<std::pair<Vec3, Vec3>> boxes{{{10, 8, 1}, {0, 0, -0.5}}};
  double x = -4.5;
  for (int k = 1; k <= 18; ++k) {
    boxes.push_back({{0.004, 8, 0.15 * k}, {x, 0, 0.075 * k}});
    x += 0.31 + 0.23 * std::sin(1.7 * k);
  }
  Expression field = box(boxes[0].first, boxes[0].second);
  for (size_t i = 1; i < boxes.size(); ++i) {
    field = joined(field, box(boxes[i].first, boxes[i].second));
  }
  const BoundingBox bounds{{-5.1, -4.1, -1.1}, {5.1, 4.1, 2.8}};
  const auto form = [&](const TestRay& ray) {
    Inside first;
    for (const auto& [size, center] : boxes) {
      const Inside in = in_box({ray.from - center, ray.along}, 0.5 * size);
      if (in.to >= in.from && in.from < first.from) first = in;
    }
    return first;
  };
  for (const Vec3& direction : {Vec3{1, 0.01, -0.004}, Vec3{1, 0.02, 0.003}}) {
    RenderOptions options = orthographic(options_of(bounds, direction), 11);
    options.tolerance = 1e-3;
    expect_closed_form(field, bounds, options, form);
  }
}

// Against samples so dense that no stretch longer than the tolerance lies between them.
void expect_no_stretch_missed(const std::string& text, const BoundingBox& bounds,
                              int least_met = 100) {
  SCOPED_TRACE(text);
  const Evaluator field(parse_formula(text, {}, {}).expression());
  RenderOptions options = options_of(bounds);
  options.width = 40;
  options.height = 30;
  options.tolerance = 1e-3 * bounds.diagonal();
  const std::vector<double> depths = render_depths(field, bounds, options);
  int met = 0;
  for (int i = 0; i < options.width * options.height; ++i) {
    const TestRay ray = ray_of(options, i % options.width, i / options.width);
    const double step = 0.2 * *options.tolerance / norm(ray.along);
    const Inside in = in_box({ray.from - bounds.center(), ray.along}, 0.5 * bounds.size());
    // The first stretch of the solid that is surely longer than the tolerance.
    double first = infinity, begin = infinity;
    for (double t = in.from; t <= in.to && first == infinity; t += step) {
      if (!(field.value(ray.at(t)) >= 0)) {
        begin = infinity;
        continue;
      }
      begin = std::min(begin, t);
      if (t - begin > 5.5 * step) first = begin;
    }
    const double depth = depths[size_t(i)];
    ASSERT_LE(depth, first + step) << "pixel " << i;
    if (!(depth < infinity)) continue;
    ++met;
    // What is met is there: the field changes its sign, or has jumped, at the place.
    const double beside = 1e-7 * bounds.diagonal();
    ASSERT_TRUE(field.value(ray.at(depth)) >= -1e-9 || field.value(ray.at(depth + beside)) >= 0 ||
                field.value(ray.at(depth - beside)) >= 0)
        << "pixel " << i;
  }
  EXPECT_GE(met, least_met);
}

TEST(RenderSlow, NothingIsMissedInFieldsOfAnySlope) {
  const BoundingBox box = padded({2, 2, 2});
  const std::string within = "min(min(1.9-abs(x), 1.9-abs(y)), 1.9-abs(z))";
  // A lattice of thin walls, steep waves, and a distance with a slope of 40 in places.
  expect_no_stretch_missed(
      "min(" + within + ", 0.02-abs(sin(5*x)*cos(5*y)+sin(5*y)*cos(5*z)+" + "sin(5*z)*cos(5*x))/7)",
      box);
  expect_no_stretch_missed("min(" + within + ", sin(20*x)*sin(20*y)*sin(20*z)-0.9)", box);
  expect_no_stretch_missed("1.5-length(x,y,z)+0.2*sin(40*x)*sin(40*y)", box);
  // Infinite slopes: at points, on surfaces, and jumps of the value.
  expect_no_stretch_missed("1.2-sqrt(sqrt(x*x+y*y+z*z))", box);
  expect_no_stretch_missed("0.9-sqrt(abs(x))-sqrt(abs(y))-sqrt(abs(z))", box, 5);
  expect_no_stretch_missed("min(" + within + ", floor(x+0.5)*floor(z+0.3)-0.5)", box);
  // No number at all where x > 1.
  expect_no_stretch_missed("1.5-length(x,y,z)+0*log(1-x)", box);
}

TEST(Render, BlendsOfTheFirstPaper) {
  const BlendPointer blend = make_blend("sardf", {0.5});
  const Field ball = make_field("sphere", {Vec3{0, 0, 0}, 1.0});
  const Field other = make_field("sphere", {Vec3{1.2, 0, 0}, 0.8});
  std::vector<Value> arguments{std::vector<Field>{ball, other}, blend};
  const Field both = make_field("union", arguments);
  const Evaluator field(both.expression());
  const BoundingBox bounds = certified_bounds(field);
  const RenderOptions options = options_of(bounds);
  const std::vector<double> depths = render_depths(field, bounds, options);
  int met = 0;
  for (int i = 0; i < options.width * options.height; ++i) {
    const TestRay ray = ray_of(options, i % options.width, i / options.width);
    const Inside a = in_ball(ray, {0, 0, 0}, 1), b = in_ball(ray, {1.2, 0, 0}, 0.8);
    // The blend adds to the union and takes nothing from it.
    const double plain = std::min(a.from, b.from);
    ASSERT_LE(depths[size_t(i)], plain + 1e-8) << i;
    if (!(depths[size_t(i)] < infinity)) continue;
    ASSERT_NEAR(field.value(ray.at(depths[size_t(i)])), 0, 1e-8) << i;
    ++met;
  }
  EXPECT_GT(met, 4000);
}

TEST(Render, TolerancesBelowAllRoundings) {
  const Expression block = box({20, 12, 8});
  const BoundingBox bounds = certified_bounds(Evaluator(block));
  RenderOptions options = options_of(bounds);
  options.width = 40;
  options.height = 30;
  options.tolerance = 1e-300;
  const std::vector<double> depths = render_depths(Evaluator(block), bounds, options);
  for (int i = 0; i < options.width * options.height; ++i) {
    const TestRay ray = ray_of(options, i % options.width, i / options.width);
    const Inside in = in_box(ray, {10, 6, 4});
    const bool crossed = in.to >= in.from;
    ASSERT_EQ(depths[size_t(i)] < infinity, crossed) << i;
    if (crossed) {
      ASSERT_NEAR(depths[size_t(i)], in.from, 1e-7) << i;
    }
  }
}

TEST(Render, CameraInsideTheSolidOrBehindIt) {
  const Expression ball = sphere(2);
  const BoundingBox bounds = certified_bounds(Evaluator(ball));
  RenderOptions options = options_of(bounds);
  for (int i = 0; i < 3; ++i) options.camera.matrix_world[i][3] = 0;
  for (const double depth : render_depths(Evaluator(ball), bounds, options)) {
    ASSERT_NEAR(depth, 0, 1e-8);
  }
  // 5 units further along the view the ball lies behind the camera.
  for (int i = 0; i < 3; ++i) {
    options.camera.matrix_world[i][3] = -5 * options.camera.matrix_world[i][2];
  }
  for (const double depth : render_depths(Evaluator(ball), bounds, options)) {
    ASSERT_EQ(depth, infinity);
  }
}

Scene scene_of(const std::string& rest) {
  const std::string text = R"scene({"sardf": 1, "solid": {"box": {"size": [4, 4, 4]}},
    "materials": {"red": {"color": [1, 0, 0]}, "blue": {"color": [0, 0.25, 1]}},
    "fractions": {"functions": {"red": "=step(1, length(x, y, z))", "blue": "rest"}})scene";
  return Scene(parse_scene(text + rest + "}", ""));
}

TEST(Render, SectionsShowTheMaterialsInside) {
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

TEST(Render, LooksAndBackgrounds) {
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
TEST(Render, SeveralSamplesOfAPixel) {
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
TEST(Render, ShadowsFallAwayFromTheKeyLight) {
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

TEST(Render, ThePictureDoesNotDependOnThreads) {
  const Scene scene(read_scene(SARDF_SOURCE_DIR "/scenes/cad_plate_cut.json"));
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

TEST(Render, ReportsProgressAndStopsWhenAsked) {
  const Expression field = gyroid(3, 0.1);
  const BoundingBox bounds = padded({4, 4, 4});
  RenderOptions options = options_of(bounds);
  double last = 0;
  render_depths(Evaluator(field), bounds, options, [&](double share) {
    EXPECT_GE(share, last);
    last = share;
    return true;
  });
  EXPECT_EQ(last, 1);
  options.width = 4000;
  options.height = 3000;
  int calls = 0;
  std::chrono::steady_clock::time_point asked;
  const Progress stop = [&](double) {
    EXPECT_LT(calls, 3) << "asked again after it said no";
    asked = std::chrono::steady_clock::now();
    return ++calls < 3;
  };
  EXPECT_THROW(render_depths(Evaluator(field), bounds, options, stop), Cancelled);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - asked;
  EXPECT_EQ(calls, 3);
  // 0.1 s are promised on a machine with nothing else to do.
  EXPECT_LT(taken.count(), 1);
}

std::string error_of(const RenderOptions& options) {
  try {
    render_depths(Evaluator(sphere(1)), padded({1, 1, 1}), options);
  } catch (const Error& error) {
    return error.message;
  }
  return "no error";
}

TEST(Render, RefusesWhatItCannotRender) {
  RenderOptions options = options_of(padded({1, 1, 1}));
  options.width = 0;
  EXPECT_THAT(error_of(options), HasSubstr("0 x 110 pixels; 1 to 16384 are accepted"));
  options = options_of(padded({1, 1, 1}));
  options.tolerance = -1;
  EXPECT_THAT(error_of(options), HasSubstr("the tolerance is -1; a positive length"));
  options.tolerance = std::nan("");
  EXPECT_THAT(error_of(options), HasSubstr("a positive length"));
  options = options_of(padded({1, 1, 1}));
  options.samples = 9;
  EXPECT_THAT(error_of(options), HasSubstr("pixel's side are 9; 1 to 8 are accepted"));
  options.samples = 1;
  options.threads = -2;
  EXPECT_THAT(error_of(options), HasSubstr("threads is -2"));
  EXPECT_THROW(
      render_depths(Evaluator(sphere(1)), padded({infinity, 1, 1}), options_of(padded({1, 1, 1}))),
      Error);
  EXPECT_THROW(render_look("flatt"), Error);
}

}  // namespace
}  // namespace sardf

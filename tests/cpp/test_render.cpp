#include "sardf/render.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "render_checks.hpp"
#include "sardf/bounds.hpp"
#include "sardf/constructor.hpp"
#include "sardf/error.hpp"
#include "sardf/formula.hpp"

namespace sardf {
namespace {

using namespace checks;
using testing::HasSubstr;

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

// Rays against closed forms.
#include "sardf/first_point.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "error_of.hpp"
#include "sardf/scene_file.hpp"

namespace sardf {
namespace {

using testing::HasSubstr;

Scene scene_of(const std::string& rest) {
  return Scene(parse_scene("{\"sardf\": 1, " + rest + "}", ""));
}

const Scene& ball() {
  static const Scene scene = scene_of(R"("solid": {"sphere": {"center": [1, 2, 3], "radius": 2}})");
  return scene;
}

TEST(FirstPoint, OfABallIsThatOfTheQuadraticEquation) {
  std::mt19937 engine(8);
  std::normal_distribution<double> any(0, 1);
  const Vec3 center{1, 2, 3};
  int hits = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 origin = center + 9.0 * normalized(Vec3{any(engine), any(engine), any(engine)});
    const Vec3 target = center + Vec3{any(engine), any(engine), any(engine)};
    const Vec3 way = normalized(target - origin);
    const double middle = dot(center - origin, way);
    const double square = 4 - (81 - middle * middle);
    const auto found = first_point(ball(), origin, 3.0 * (target - origin));
    if (square < 0) {
      EXPECT_EQ(found.has_value(), square > 0) << i;
      continue;
    }
    ++hits;
    ASSERT_TRUE(found) << i;
    EXPECT_LT(norm(*found - (origin + (middle - std::sqrt(square)) * way)), 1e-6) << i;
  }
  EXPECT_GT(hits, 100);
}

TEST(FirstPoint, MayLieOnACutOrAtTheOrigin) {
  // What has y > 2 or y < 2 is cut away.
  EXPECT_EQ(first_point(ball(), {1, 9, 3}, {0, -1, 0}, {0, 3, 0, -6}), (Vec3{1, 2, 3}));
  EXPECT_NEAR(first_point(ball(), {1, 9, 3}, {0, -1, 0}, {0, -3, 0, 6}).value()[1], 4, 1e-6);
  EXPECT_FALSE(first_point(ball(), {1, 3, 3}, {1, 0, 0}, {0, 3, 0, -6}));
  EXPECT_EQ(first_point(ball(), {1, 2, 4}, {0, 1, 1}), (Vec3{1, 2, 4}));
  EXPECT_FALSE(first_point(ball(), {1, 9, 3}, {0, 1, 0}));
}

TEST(FirstPoint, KnowsTheScenesOwnSections) {
  const Scene scene = scene_of(R"("solid": {"sphere": {"radius": 2}},
    "sections": [{"remove": {"half_space": {"point": [0, 0, 0.5], "normal": [0, 0, 1]}}}])");
  EXPECT_NEAR(first_point(scene, {0, 0, 9}, {0, 0, -1}).value()[2], 0.5, 1e-6);
}

TEST(FirstPoint, RefusesWhatIsNoRay) {
  const auto message = [](const Vec3& origin, const Vec3& direction, const Plane& plane = {}) {
    return error_of([&] { first_point(ball(), origin, direction, plane); });
  };
  EXPECT_THAT(message({0, 0, 0}, {0, 0, 0}), HasSubstr("the direction is (0, 0, 0)"));
  EXPECT_THAT(message({0, 0, 0}, {NAN, 0, 0}), HasSubstr("three finite numbers"));
  EXPECT_THAT(message({0, infinity, 0}, {1, 0, 0}), HasSubstr("not finite"));
  EXPECT_THAT(message({0, 0, 0}, {1, 0, 0}, {0, 0, 0, NAN}), HasSubstr("not finite"));
}

}  // namespace
}  // namespace sardf

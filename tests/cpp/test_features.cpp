// Planes, skeletons, and points and polylines with so many elements that they need a tree.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "feature_checks.hpp"
#include "sardf/error.hpp"
#include "sardf/ops_features.hpp"
#include "sardf/segment_set.hpp"

namespace sardf {
namespace {

using features::Draw;

double to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double squared = dot(along, along);
  const double t = squared > 0 ? std::clamp(dot(p - a, along) / squared, 0.0, 1.0) : 0;
  return norm(p - (a + t * along));
}

std::vector<Vec3> walk(Draw& draw, int n) {
  std::vector<Vec3> corners{{0, 0, 0}};
  for (int i = 1; i < n; ++i) {
    // Some segments have no length.
    corners.push_back(corners.back() + (i % 50 ? 0.2 : 0.0) * draw.point(1));
  }
  return corners;
}

TEST(ManyElements, PolylineEqualsEverySegment) {
  Draw draw(41);
  for (const bool closed : {false, true}) {
    const std::vector<Vec3> corners = walk(draw, 1000);
    const Field field = features::feature("polyline", {{"vertices", corners}, {"closed", closed}});
    EXPECT_FALSE(field.expression()->operation->has_formula());
    EXPECT_EQ(field.quality().outside, Exactness::exact);
    const Evaluator f(field.expression());
    for (int i = 0; i < 300; ++i) {
      const Vec3 p = draw.point(6);
      double expected = closed ? to_segment(p, corners.back(), corners[0]) : infinity;
      for (size_t k = 1; k < corners.size(); ++k) {
        expected = std::min(expected, to_segment(p, corners[k - 1], corners[k]));
      }
      EXPECT_NEAR(f.value(p), expected, 1e-14);
    }
    EXPECT_EQ(f.value(corners[3]), 0);
    features::expect_distance_laws(field, draw, 6, 100);
  }
}

TEST(ManyElements, PointsEqualEveryPoint) {
  Draw draw(42);
  const std::vector<Vec3> points = draw.points(2000, 3);
  const Field field = features::feature("points", {{"at", points}});
  EXPECT_FALSE(field.expression()->operation->has_formula());
  const Evaluator f(field.expression());
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = draw.point(5);
    double expected = infinity;
    for (const Vec3& q : points) expected = std::min(expected, norm(p - q));
    EXPECT_NEAR(f.value(p), expected, 1e-14);
  }
  features::expect_distance_laws(field, draw, 5, 100);
}

TEST(ManyElements, FewKeepTheirFormula) {
  Draw draw(43);
  const std::vector<Vec3> few = draw.points(int(most_in_formula), 3);
  EXPECT_TRUE(
      features::feature("polyline", {{"vertices", few}}).expression()->operation->has_formula());
  EXPECT_TRUE(features::feature("points", {{"at", few}}).expression()->operation->has_formula());
}

TEST(ManyElements, DerivativesOfTheNearestPoint) {
  Draw draw(44);
  std::vector<SegmentSet::Ends> segments;
  for (int i = 0; i < 300; ++i) {
    const Vec3 a = draw.point(3);
    segments.push_back({a, i % 3 ? a + draw.point(1) : a});
  }
  const std::vector<double> data{44};
  features::expect_jacobians(SegmentSet("s", "", data, segments), draw, 4, 200);
}

TEST(ManyElements, TakesAnyNumbers) {
  Draw draw(45);
  const Evaluator f(features::feature("points", {{"at", draw.points(300, 3)}}).expression());
  const double nan = std::nan("");
  EXPECT_TRUE(std::isnan(f.value({nan, 0, infinity})));
  EXPECT_EQ(f.value({infinity, 0, -infinity}), infinity);
  EXPECT_NEAR(f.value({1e200, 0, 0}), 1e200, 1e190);
}

TEST(PlaneFeature, IsTheDistanceFromEitherSide) {
  const Field plane =
      features::feature("plane", {{"point", Vec3{1, 2, 3}}, {"normal", Vec3{0, 3, 4}}});
  EXPECT_EQ(plane.quality().inside, Exactness::exact);
  const Evaluator f(plane.expression());
  EXPECT_NEAR(f.value({7, 2, 8}), 4, 1e-15);
  EXPECT_NEAR(f.value({7, 2, -2}), 4, 1e-15);
  EXPECT_NEAR(f.value({9, -2, 6}), 0, 1e-15);
  Draw draw(46);
  features::expect_distance_laws(plane, draw, 5, 100);
}

std::vector<Field> two_features() {
  return {features::feature("point", {{"at", Vec3{1, 0, 0}}}),
          features::feature("segment", {{"a", Vec3{0, 3, 0}}, {"b", Vec3{0, 3, 9}}})};
}

TEST(Skeleton, IsTheDistanceToTheNearest) {
  const Field both = features::feature("skeleton", {{"of", two_features()}});
  EXPECT_EQ(both.quality().outside, Exactness::exact);
  const Evaluator f(both.expression());
  EXPECT_EQ(f.value({1, 0, 2}), 2);
  EXPECT_EQ(f.value({0, 2, 4}), 1);
}

TEST(Skeleton, TakesFeaturesAndWhatIsMadeOfThem) {
  const Field ball = features::feature("sphere", {{"radius", 1.0}});
  const Field boundary = features::feature("boundary", {{"solid", ball}});
  const Field moved = features::feature("translate", {{"field", boundary}, {"by", Vec3{0, 0, 5}}});
  const Field both = features::feature("skeleton", {{"of", std::vector<Field>{boundary, moved}}});
  EXPECT_EQ(Evaluator(both.expression()).value({0, 0, 3}), 1);
}

TEST(Skeleton, RefusesSolids) {
  const Field ball = features::feature("sphere", {{"radius", 1.0}});
  for (const Field& solid :
       {ball, features::feature("translate", {{"field", ball}, {"by", Vec3{0, 0, 5}}}),
        features::feature("disc", {{"radius", 1.0}})}) {
    std::vector<Field> all = two_features();
    all.push_back(solid);
    try {
      features::feature("skeleton", {{"of", all}});
      ADD_FAILURE() << "a solid was accepted";
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("element 2"));
      EXPECT_THAT(error.what(), testing::HasSubstr("boundary"));
    }
  }
}

}  // namespace
}  // namespace sardf

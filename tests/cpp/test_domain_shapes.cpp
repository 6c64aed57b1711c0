// Repetition, twist, bend and quadrics against brute force, hand computation and sampling.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "error_of.hpp"
#include "laws.hpp"
#include "sardf/certify.hpp"

namespace sardf {
namespace {

using laws::Random;
using testing::HasSubstr;

constexpr double pi = std::numbers::pi;

double value(const Field& field, const Vec3& p) { return Evaluator(field.expression()).value(p); }

Field ball(const Vec3& center, double radius) { return make_field("sphere", {center, radius}); }
Field block(const Vec3& center, const Vec3& size) { return make_field("box", {center, size}); }

Field endless(const Field& field, const Vec3& spacing) {
  return make_field("repeat", {field, spacing, Value()});
}
Field counted(const Field& field, const Vec3& spacing, const Vec3& counts) {
  return make_field("repeat", {field, spacing, counts});
}

Vec3 random_point(Random& r, const BoundingBox& box) {
  return {r.uniform(box.lo[0], box.hi[0]), r.uniform(box.lo[1], box.hi[1]),
          r.uniform(box.lo[2], box.hi[2])};
}

/// The largest value of copies numbered from `first` to `last` along each axis.
double of_all_copies(const Evaluator& one, const Vec3& spacing, const std::array<int, 3>& first,
                     const std::array<int, 3>& last, const Vec3& p) {
  double most = -infinity;
  for (int i = first[0]; i <= last[0]; ++i) {
    for (int j = first[1]; j <= last[1]; ++j) {
      for (int k = first[2]; k <= last[2]; ++k) {
        const Vec3 at{i * spacing[0], j * spacing[1], k * spacing[2]};
        most = std::max(most, one.value(p - at));
      }
    }
  }
  return most;
}

struct Repeated {
  const char* name;
  Field (*one)();
  Vec3 spacing;
};

/// Exact solids that fit between their neighbours.
class FittingCopies : public testing::TestWithParam<Repeated> {
 protected:
  const Vec3& spacing() const { return GetParam().spacing; }
  Field one_ = GetParam().one();
  Evaluator single_{one_.expression()};
};

// Copies more than four steps away are nearest to none of the points.
TEST_P(FittingCopies, AreEndlessAndExact) {
  const Field all = endless(one_, spacing());
  const Evaluator evaluator(all.expression());
  std::array<int, 3> first{}, last{};
  for (int axis = 0; axis < 3; ++axis) {
    if (spacing()[axis] > 0) first[axis] = -4, last[axis] = 4;
  }
  Random r(1);
  int outside = 0;
  for (int i = 0; i < laws::effort(400); ++i) {
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis) {
      const double reach = spacing()[axis] > 0 ? 1.5 * spacing()[axis] : 5;
      p[axis] = r.uniform(-reach, reach);
    }
    const double expected = of_all_copies(single_, spacing(), first, last, p);
    EXPECT_NEAR(evaluator.value(p), expected, 1e-12) << p[0] << " " << p[1] << " " << p[2];
    // A thousand steps further nothing is different.
    EXPECT_NEAR(evaluator.value(p + 1000.0 * spacing()), expected, 1e-11);
    outside += expected < 0;
  }
  EXPECT_GT(outside, 0);
  EXPECT_EQ(all.quality().outside, Exactness::exact);
}

TEST_P(FittingCopies, AreAtMostAsSteepAsOne) {
  const Field some = counted(one_, spacing(), {7, spacing()[1] > 0 ? 5.0 : 1.0, 1});
  for (const Field& all : {endless(one_, spacing()), some}) {
    const Evaluator evaluator(all.expression());
    Random r(2);
    for (int i = 0; i < 20; ++i) {
      BoundingBox box{random_point(r, {{-9, -9, -9}, {9, 9, 9}}), {}};
      for (int axis = 0; axis < 3; ++axis) box.hi[axis] = box.lo[axis] + r.decades(-2, 1);
      const double slope = lipschitz_bound(evaluator, box, 16);
      EXPECT_LE(slope, 1 + 1e-12);
      for (int k = 0; k < 20; ++k) {
        const Vec3 p = random_point(r, box), q = random_point(r, box);
        const double change = std::abs(evaluator.value(p) - evaluator.value(q));
        EXPECT_LE(change, slope * norm(p - q) + 1e-12);
      }
      const Interval enclosing = evaluator.interval(box);
      const double inside = evaluator.value(random_point(r, box));
      EXPECT_TRUE(enclosing.lo <= inside && inside <= enclosing.hi);
    }
  }
}

TEST_P(FittingCopies, AreCounted) {
  const std::array<int, 3> last{6, spacing()[1] > 0 ? 4 : 0, spacing()[2] > 0 ? 1 : 0};
  const Field all = counted(one_, spacing(), {last[0] + 1.0, last[1] + 1.0, last[2] + 1.0});
  const Evaluator evaluator(all.expression());
  Random r(3);
  for (int i = 0; i < laws::effort(400); ++i) {
    const Vec3 p = random_point(r, {{-20, -20, -20}, {40, 30, 20}});
    const double expected = of_all_copies(single_, spacing(), {0, 0, 0}, last, p);
    EXPECT_NEAR(evaluator.value(p), expected, 1e-12) << p[0] << " " << p[1] << " " << p[2];
    const float rough[3] = {float(p[0]), float(p[1]), float(p[2])};
    float single;
    evaluator.values(rough, 1, &single);
    EXPECT_NEAR(single, expected, 2e-5);
  }
  EXPECT_EQ(all.quality().outside, Exactness::exact);
}

INSTANTIATE_TEST_SUITE_P(
    Solids, FittingCopies,
    testing::Values(Repeated{"sphere", [] { return ball({}, 0.9); }, {2, 2.5, 3}},
                    Repeated{"sphere_beside",
                             [] {
                               return ball({3, -4, 0.3}, 0.9);
                             },
                             {2, 2, 0}},
                    Repeated{"capsule",
                             [] {
                               return make_field("capsule", {Vec3{-1, -1, 0}, Vec3{1, 1, 1}, 0.4});
                             },
                             {3, 3, 2}},
                    Repeated{"box_off_centre",
                             [] {
                               return block({0.7, -0.4, 0.2}, {1.6, 1, 3});
                             },
                             {2, 1.5, 4}},
                    Repeated{"thin_box",
                             [] {
                               return block({0.25, 0, 0}, {1.99, 0.02, 1});
                             },
                             {2, 0.5, 0}},
                    Repeated{"one_row",
                             [] {
                               return block({0, 3, 0}, {1, 2, 5});
                             },
                             {2, 0, 0}}),
    [](const auto& of) { return std::string(of.param.name); });

// Copies of a box on x at 0, 2, 4, ...: by hand.
TEST(Repeat, IsMeasuredByHand) {
  const Field row = counted(block({}, {1, 1, 1}), {2, 0, 0}, {3, 1, 1});
  EXPECT_NEAR(value(row, {-2, 0, 0}), -1.5, 1e-15);
  EXPECT_NEAR(value(row, {1, 0, 0}), -0.5, 1e-15);
  EXPECT_NEAR(value(row, {4.25, 0, 0}), 0.25, 1e-15);
  EXPECT_NEAR(value(row, {4.5 + 3, 0.5 + 4, 0}), -5, 1e-15);
  const Field endless_row = endless(block({}, {1, 1, 1}), {2, 0, 0});
  EXPECT_NEAR(value(endless_row, {7, 0, 0}), -0.5, 1e-15);
  EXPECT_NEAR(value(endless_row, {-100.25, 0, 0}), 0.25, 1e-13);
  EXPECT_NEAR(value(endless_row, {8, 3.5, 4.5}), -5, 1e-13);
}

TEST(Repeat, OfWhatDoesNotFitIsAUnionWhenCounted) {
  const Field wide = ball({0.3, 0, 0}, 1.4), tilted = block({1, 0, 0}, {5, 0.4, 0.4});
  const Vec3 spacing{2, 0.7, 0};
  Random r(4);
  for (const Field& one : {wide, tilted}) {
    const Evaluator single(one.expression());
    const Field all = counted(one, spacing, {4, 6, 1});
    const Evaluator evaluator(all.expression());
    for (int i = 0; i < 500; ++i) {
      const Vec3 p = random_point(r, {{-5, -4, -4}, {12, 8, 4}});
      EXPECT_NEAR(evaluator.value(p), of_all_copies(single, spacing, {0, 0, 0}, {3, 5, 0}, p),
                  1e-12);
    }
    // Copies overlap: outside the nearest is still exact, inside it is only a bound.
    EXPECT_EQ(all.quality().outside, Exactness::exact);
    EXPECT_EQ(all.quality().inside, Exactness::bound);
    EXPECT_LE(lipschitz_bound(evaluator, {{-5, -4, -4}, {12, 8, 4}}), 1 + 1e-12);
  }
}

TEST(Repeat, OfWhatDoesNotFitIsAnEstimateWithoutEnd) {
  for (const Field& one : {ball({}, 1.2), block({}, {2.2, 1, 1})}) {
    const Field all = endless(one, {2, 0, 0});
    EXPECT_EQ(all.quality().outside, Exactness::estimate);
    EXPECT_EQ(all.quality().inside, Exactness::estimate);
    const Evaluator evaluator(all.expression());
    EXPECT_EQ(lipschitz_bound(evaluator, {{-3, -1, -1}, {3, 1, 1}}), infinity);
    EXPECT_FALSE(certified_lipschitz(evaluator, {{-3, -1, -1}, {3, 1, 1}}).infinite_at.empty());
    // It is still the nearest two copies' union.
    EXPECT_NEAR(evaluator.value({1, 0, 0}), value(one, {1, 0, 0}), 1e-15);
  }
  // No distance, no proof.
  const Field egg =
      make_field("quadric", {std::vector<Vec3>{{-4, 0, 0}, {0, -1, 0}, {0, 0, -1}}, Vec3{}, 1.0});
  EXPECT_EQ(endless(egg, {3, 0, 0}).quality().outside, Exactness::estimate);
}

// A bar along z has no bounds there, and needs none.
TEST(Repeat, AcceptsWhatIsUnboundedAlongOtherAxes) {
  const Field rod = make_field("cylinder", {Vec3{}, Vec3{0, 0, 1}, 0.5, Value()});
  const Field rods = endless(rod, {2, 2, 0});
  EXPECT_EQ(rods.quality().outside, Exactness::exact);
  EXPECT_NEAR(value(rods, {7, 9, 100}), 0.5 - std::sqrt(2.0), 1e-13);
  EXPECT_NEAR(value(rods, {8, 8.2, -100}), 0.3, 1e-13);
}

TEST(Repeat, SaysWhatIsWrong) {
  const Field one = ball({}, 1);
  const auto said = [&](const Vec3& spacing, const Value& counts) {
    return error_of([&] { make_field("repeat", {one, spacing, counts}); });
  };
  EXPECT_THAT(said({3, 3, 0}, Vec3{2, 2.5, 1}), HasSubstr("counts along y is not accepted"));
  EXPECT_THAT(said({3, 3, 3}, Vec3{0, 1, 1}), HasSubstr("counts along x is not accepted"));
  EXPECT_THAT(said({3, 3, 3}, Vec3{100, 100, 1}), HasSubstr("4096"));
  EXPECT_THAT(said({3, 3, 3}, Vec3{5000, 1, 1}), HasSubstr("4096"));
  EXPECT_THAT(said({3, 3, 0}, Vec3{2, 2, 2}),
              HasSubstr("several copies along z but the spacing is 0"));
  EXPECT_THAT(said({3, -3, 0}, Value()), HasSubstr("spacing"));
  EXPECT_EQ(said({3, 3, 0}, Vec3{64, 64, 1}), "no error");
}

Vec3 turned(const Vec3& p, const Vec3& axis, double degrees) {
  // Rodrigues' formula.
  const double a = degrees * pi / 180;
  return std::cos(a) * p + std::sin(a) * cross(axis, p) + (1 - std::cos(a)) * dot(axis, p) * axis;
}

Field twist(const Field& field, double rate, const Vec3& axis, const Vec3& center) {
  return make_field("twist", {field, rate, axis, center});
}

TEST(Twist, TurnsByTheHeight) {
  // A ball at height 1, turned by a quarter: from +x to +y.
  const Field up = twist(ball({2, 0, 1}, 0.5), 90, {0, 0, 1}, {});
  EXPECT_NEAR(value(up, {0, 2, 1}), 0.5, 1e-15);
  EXPECT_NEAR(value(up, {0, 2.5, 1}), 0, 1e-15);
  // About y, from +z to +x; heights count from the centre's.
  const Field across = twist(ball({0, 5, 2}, 0.5), 45, {0, 2, 0}, {0, 3, 0});
  EXPECT_NEAR(value(across, {2, 5, 0}), 0.5, 1e-15);
  EXPECT_NEAR(value(twist(ball({0, 3, 2}, 0.5), 45, {0, 2, 0}, {0, 3, 0}), {0, 3, 2}), 0.5, 1e-15);
}

TEST(Twist, IsTheFieldAtPointsTurnedBack) {
  const Field one = block({0.5, 0.2, 0}, {3, 1, 4});
  Random r(5);
  for (int k = 0; k < 20; ++k) {
    const Vec3 axis = normalized(r.direction()),
               center = random_point(r, {{-1, -1, -1}, {1, 1, 1}});
    const double rate = r.uniform(-60, 60);
    const Evaluator evaluator(twist(one, rate, 3.0 * axis, center).expression());
    for (int i = 0; i < 50; ++i) {
      const Vec3 p = random_point(r, {{-4, -4, -4}, {4, 4, 4}});
      const double height = dot(axis, p - center);
      const Vec3 back = center + turned(p - center, axis, -rate * height);
      EXPECT_NEAR(evaluator.value(p), value(one, back), 1e-13);
    }
  }
}

TEST(Twist, IsAsSteepAsItsFormulaSays) {
  Random r(6);
  const Field prism = block({}, {2, 2, 8});
  for (const auto& [rate, boxes] : {std::pair{5.0, 512}, {30.0, 512}, {90.0, 4096}}) {
    const Field all = twist(prism, rate, {0, 0, 1}, {});
    const Evaluator evaluator(all.expression());
    const BoundingBox box{{-2, -2, -4}, {2, 2, 4}};
    double sampled = 0;
    for (int i = 0; i < 4000; ++i) {
      const Vec3 p = random_point(r, box);
      Vec3 gradient;
      evaluator.gradients(p.data(), 1, nullptr, gradient.data());
      sampled = std::max(sampled, norm(gradient));
    }
    const double certified = lipschitz_bound(evaluator, box, boxes);
    const double k = rate * pi / 180, farthest = std::hypot(2, 2);
    const double stated = (k * farthest + std::sqrt(k * k * farthest * farthest + 4)) / 2;
    EXPECT_GE(certified, sampled);
    EXPECT_LE(certified, 1.3 * stated) << rate;
    EXPECT_GE(1.0001 * stated, sampled) << rate;
    EXPECT_EQ(all.quality().outside, Exactness::estimate);
  }
  EXPECT_EQ(twist(prism, 0, {0, 0, 1}, {}).quality().outside, Exactness::exact);
}

Field bend(const Field& field, double radius) { return make_field("bend", {field, radius}); }

TEST(Bend, TurnsABarByAQuarter) {
  const double R = 3, quarter = pi * R / 2;
  const Field end = bend(ball({quarter, 1, 0}, 0.5), R);
  // The fibre z = 0 ends at (R, ., R), pointing up.
  EXPECT_NEAR(value(end, {3, 1, 3}), 0.5, 1e-14);
  EXPECT_NEAR(value(bend(ball({-quarter, 1, 0}, 0.5), R), {-3, 1, 3}), 0.5, 1e-14);
  // z = 1 is nearer to the axis (0, ., R).
  EXPECT_NEAR(value(bend(ball({quarter, 0, 1}, 0.5), R), {2, 0, 3}), 0.5, 1e-14);
  EXPECT_NEAR(value(bend(ball({quarter, 0, -1}, 0.5), R), {4, 0, 3}), 0.5, 1e-14);
  // Near x = 0 nothing moves.
  EXPECT_NEAR(value(bend(ball({0, 0, 0.5}, 0.5), R), {0, 0, 0.5}), 0.5, 1e-15);
}

TEST(Bend, KeepsLengthsAlongTheFibre) {
  const double R = 2;
  const Field x = make_field("half_space", {Vec3{}, Vec3{1, 0, 0}});
  const Field block_end = make_field("box", {Vec3{1, 0, 0}, Vec3{4, 2, 1}});
  Random r(7);
  for (int i = 0; i < 500; ++i) {
    const Vec3 p{r.uniform(-0.99, 0.99) * pi * R, r.uniform(-2, 2), r.uniform(-1, 1.9)};
    const double a = p[0] / R, d = R - p[2];
    const Vec3 moved{d * std::sin(a), p[1], R - d * std::cos(a)};
    EXPECT_NEAR(value(bend(x, R), moved), p[0], 1e-13);
    EXPECT_NEAR(value(bend(block_end, R), moved), value(block_end, p), 1e-13);
  }
}

TEST(Bend, IsAsSteepAsItsFormulaSays) {
  const double R = 3;
  const Field all = bend(block({}, {6, 1, 1}), R);
  EXPECT_EQ(all.quality().outside, Exactness::estimate);
  const Evaluator evaluator(all.expression());
  Random r(8);
  // Boxes in front of the axis at z = 3: the nearest distance from it is that of their top.
  for (const double top : {-1.0, 1.0, 2.0, 2.5}) {
    const BoundingBox box{{-2, -2, -2}, {2, 2, top}};
    double sampled = 0;
    for (int i = 0; i < 4000; ++i) {
      const Vec3 p = random_point(r, box);
      Vec3 gradient;
      evaluator.gradients(p.data(), 1, nullptr, gradient.data());
      sampled = std::max(sampled, norm(gradient));
    }
    const double certified = lipschitz_bound(evaluator, box);
    EXPECT_GE(certified, sampled) << top;
    EXPECT_LE(sampled, 1.0001 * std::max(1.0, R / (R - top))) << top;
    EXPECT_LE(certified, 1.3 * std::max(1.0, R / (R - top))) << top;
  }
  // Around the axis, and behind it, where both ends meet, it jumps.
  EXPECT_EQ(lipschitz_bound(evaluator, {{-1, -1, 2}, {1, 1, 4}}), infinity);
  const Evaluator along(bend(make_field("half_space", {Vec3{}, Vec3{1, 0, 0}}), R).expression());
  EXPECT_EQ(lipschitz_bound(along, {{-1, -1, 4}, {1, 1, 5}}), infinity);
  EXPECT_THAT(error_of([&] { bend(ball({}, 1), -1); }), HasSubstr("radius"));
}

Field quadric(const std::vector<Vec3>& matrix, const Vec3& vector, double constant) {
  return make_field("quadric", {matrix, vector, constant});
}

TEST(Quadric, IsItsPolynomial) {
  Random r(9);
  for (int k = 0; k < 30; ++k) {
    std::vector<Vec3> m(3);
    for (Vec3& row : m) row = random_point(r, {{-2, -2, -2}, {2, 2, 2}});
    const Vec3 v = random_point(r, {{-3, -3, -3}, {3, 3, 3}});
    const double c = r.uniform(-2, 2);
    const Field made = quadric(m, v, c);
    const Evaluator evaluator(made.expression());
    EXPECT_EQ(made.quality().outside, Exactness::estimate);
    const auto gradient = [&](const Vec3& p) {
      Vec3 g;
      for (int i = 0; i < 3; ++i) {
        g[i] = v[i];
        for (int j = 0; j < 3; ++j) g[i] += (m[i][j] + m[j][i]) * p[j];
      }
      return g;
    };
    for (int i = 0; i < 20; ++i) {
      const Vec3 p = random_point(r, {{-4, -4, -4}, {4, 4, 4}});
      const double expected = dot(p, {dot(m[0], p), dot(m[1], p), dot(m[2], p)}) + dot(v, p) + c;
      Vec3 found;
      double out;
      evaluator.gradients(p.data(), 1, &out, found.data());
      EXPECT_NEAR(out, expected, 1e-12);
      EXPECT_LT(norm(found - gradient(p)), 1e-12);
    }
    // The gradient is linear: its length is largest at a corner of the box.
    BoundingBox box{random_point(r, {{-4, -4, -4}, {4, 4, 4}}), {}};
    for (int axis = 0; axis < 3; ++axis) box.hi[axis] = box.lo[axis] + r.decades(-1, 1);
    double steepest = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 p{corner & 1 ? box.lo[0] : box.hi[0], corner & 2 ? box.lo[1] : box.hi[1],
                   corner & 4 ? box.lo[2] : box.hi[2]};
      steepest = std::max(steepest, norm(gradient(p)));
    }
    const double certified = lipschitz_bound(evaluator, box);
    EXPECT_GE(certified, steepest * (1 - 1e-12));
    EXPECT_LE(certified, 1.15 * steepest);
  }
}

TEST(Quadric, IsASphereOrAConeBySign) {
  // 4 - |p - (1, 0, 0)|² = 3 + 2 x - |p|².
  const Field sphere = quadric({{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}, {2, 0, 0}, 3);
  // z² - x² - y²: half an angle of 45 degrees about z.
  const Field cone = quadric({{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}}, {}, 0);
  Random r(10);
  for (int i = 0; i < 500; ++i) {
    const Vec3 p = random_point(r, {{-3, -3, -3}, {3, 3, 3}});
    EXPECT_EQ(value(sphere, p) > 0, norm(p - Vec3{1, 0, 0}) < 2);
    EXPECT_EQ(value(cone, p) > 0, std::hypot(p[0], p[1]) < std::abs(p[2]));
  }
  EXPECT_NEAR(value(sphere, {1, 0, 0}), 4, 1e-15);
  EXPECT_THAT(error_of([] { quadric({{1, 0, 0}, {0, 1, 0}}, {}, 0); }), HasSubstr("matrix"));
  EXPECT_THAT(error_of([] {
                quadric({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}, {}, 0);
              }),
              HasSubstr("matrix has 4 rows; 3 are accepted"));
}

}  // namespace
}  // namespace sardf

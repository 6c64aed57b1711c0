// Distance to helices: against golden values and a dense sampling with refinement.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "feature_checks.hpp"
#include "golden_helix.hpp"
#include "sardf/error.hpp"

namespace sardf {
namespace {

using features::Draw;

constexpr double turn = 2 * std::numbers::pi;

/// The least distance to (r cos t, r sin t, c t), from <= t <= to, by sampling and refinement.
double reference(const Vec3& p, double r, double c, double from, double to) {
  const auto squared = [&](double t) {
    return std::pow(r * std::cos(t) - p[0], 2) + std::pow(r * std::sin(t) - p[1], 2) +
           std::pow(c * t - p[2], 2);
  };
  const int count = int((to - from) / turn * 400) + 10;
  const double step = (to - from) / count;
  double best = std::min(squared(from), squared(to));
  for (int i = 0; i <= count; ++i) {
    const double t = from + i * step;
    const double before = squared(std::max(t - step, from)),
                 after = squared(std::min(t + step, to));
    const double here = squared(t);
    if (here > before || here > after) continue;
    double a = std::max(t - step, from), b = std::min(t + step, to);
    for (int k = 0; k < 70; ++k) {
      const double golden = 0.6180339887498949, x = b - golden * (b - a), y = a + golden * (b - a);
      (squared(x) < squared(y) ? b : a) = squared(x) < squared(y) ? y : x;
    }
    best = std::min(best, squared(0.5 * (a + b)));
  }
  return std::sqrt(best);
}

Field helix(double radius, double pitch, const Value& start, const Value& end) {
  return features::feature("helix",
                           {{"radius", radius}, {"pitch", pitch}, {"start", start}, {"end", end}});
}

TEST(Helix, EqualsRefinedSampling) {
  Draw draw(31);
  for (int i = 0; i < 60; ++i) {
    const double r = std::pow(10, draw.uniform(-1, 1)),
                 c = draw.uniform(-1, 1) + (i % 2 ? 0.05 : -0.05);
    const double start = draw.uniform(-900, 300), end = start + draw.uniform(5, 1300);
    const bool starts = i % 4 < 2, ends = i % 2 == 0;
    const Evaluator f(
        helix(r, turn * c, starts ? Value(start) : Value(), ends ? Value(end) : Value())
            .expression());
    for (int k = 0; k < 40; ++k) {
      Vec3 p = draw.point(2 * r);
      p[2] = 4 * turn * std::abs(c) * draw.uniform(-1, 1);
      if (k % 8 == 0) p[0] = p[1] = 0;
      // Beyond any turn that can be nearest where there is no end.
      const double far = 12 * turn;
      const double expected =
          reference(p, r, c, starts ? start * turn / 360 : -far, ends ? end * turn / 360 : far);
      EXPECT_NEAR(f.value(p), expected, 1e-9 * (1 + r)) << "helix " << i << ", point " << k;
    }
  }
}

// Where r rho = c² and the height is half a turn off, the root is triple: the distance there is
// known, the nearest point is opposite.
TEST(Helix, IsRightOnItsFocalLine) {
  const double r = 2, c = 1, rho = c * c / r;
  const Evaluator f(helix(r, turn * c, {}, {}).expression());
  for (const double off : {0.0, 1e-12, 1e-9, 1e-6, 1e-3}) {
    const double height = std::numbers::pi * c - off;
    const double expected = reference({rho, 0, height}, r, c, -turn, turn);
    EXPECT_NEAR(f.value({rho, 0, height}), expected, 1e-13) << off;
  }
  EXPECT_NEAR(f.value({rho, 0, std::numbers::pi * c}), r + rho, 1e-13);
}

TEST(Helix, IsAsFarAsItsRadiusOnItsAxis) {
  Draw draw(32);
  const Evaluator f(helix(1.5, 0.7, {}, {}).expression());
  for (int i = 0; i < 100; ++i) {
    const double z = draw.uniform(-20, 20);
    EXPECT_NEAR(f.value({0, 0, z}), 1.5, 1e-14);
    const Vec3 g = features::gradient(f, {0, 0, z});
    const double angle = turn * z / 0.7;
    EXPECT_NEAR(g[0], -std::cos(angle), 1e-9);
    EXPECT_NEAR(g[1], -std::sin(angle), 1e-9);
  }
}

TEST(Helix, IsADistance) {
  Draw draw(33);
  features::expect_distance_laws(helix(2, 3, {}, {}), draw, 4, 100);
  features::expect_distance_laws(helix(1, -0.5, -400.0, 700.0), draw, 3, 100);
  features::expect_distance_laws(helix(3, 20, 10.0, {}), draw, 6, 100);
}

TEST(Helix, SaysWhatIsWrong) {
  const auto message = [](double radius, double pitch, double start, double end) -> std::string {
    try {
      helix(radius, pitch, start, end);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(message(1, 0, 0, 1), testing::HasSubstr("pitch is 0"));
  EXPECT_THAT(message(1, 1, 20, 10), testing::HasSubstr("end must be larger than start"));
  EXPECT_EQ(message(1, -1, 10, 20), "no error");
}

class GoldenHelix : public golden::InEachFolder {};

TEST_P(GoldenHelix, EqualsTheReference) {
  golden::Table table = read("prim_helix");
  const auto& c = table.parameter("c");
  const Vec3 center{c.at(0), c.at(1), c.at(2)};
  golden::HelixSearch{center, table.parameter("radius"), table.parameter("pitch")}.remove_missed(
      table);
  // The reference's helix has one turn to either side.
  const Evaluator f(features::feature("helix", {{"center", center},
                                                {"radius", double(table.parameter("radius"))},
                                                {"pitch", double(table.parameter("pitch"))},
                                                {"start", -360.0},
                                                {"end", 360.0}})
                        .expression());
  size_t directed = 0;
  for (const std::vector<double>& row : table.rows) {
    const Vec3 p{row[table.column("x")], row[table.column("y")], row[table.column("z")]};
    EXPECT_NEAR(f.value(p), row[table.column("f")], table.tolerance());
    const Vec3 expected{row[table.column("gx")], row[table.column("gy")], row[table.column("gz")]};
    if (std::isnan(expected[0])) continue;
    ++directed;
    const Vec3 g = features::gradient(f, p);
    for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(g[k], expected[k], 10 * table.tolerance());
  }
  EXPECT_GT(directed, table.rows.size() * 9 / 10);
}

INSTANTIATE_TEST_SUITE_P(Each, GoldenHelix, golden::each_folder(), golden::folder_name);

}  // namespace
}  // namespace sardf

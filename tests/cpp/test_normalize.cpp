// Normalised fields: values against golden ones, orders by the slope of the error.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "error_of.hpp"
#include "golden.hpp"
#include "quad.hpp"
#include "sardf/constructor.hpp"
#include "sardf/evaluate.hpp"
#include "sardf/formula.hpp"

namespace sardf {
namespace {

using golden::Table;

Field formula(const std::string& text) { return parse_formula(text, {}, {}); }
Expression normalized(const Field& f, double order) {
  return make_field("normalized", {f, order}).expression();
}
double value(const Expression& f, const Vec3& at) { return Evaluator(f).value(at); }
std::string digits(double a) {
  char text[40];
  std::snprintf(text, sizeof text, "(%.17g)", a);
  return text;
}

class Normalization : public golden::InEachFolder {};
INSTANTIATE_TEST_SUITE_P(Each, Normalization, golden::each_folder(), golden::folder_name);

TEST_P(Normalization, EqualsGoldenValues) {
  const Table table = read("bst_normalization");
  const Field f = formula("1 - x^2/" + digits(table.parameter("a")) + "^2 - y^2/" +
                          digits(table.parameter("b")) + "^2");
  const size_t x = table.column("x"), y = table.column("y");
  const Expression first = normalized(f, 1);
  for (const auto& row : table.rows) {
    EXPECT_NEAR(value(first, {row[x], row[y], 0}), row[table.column("w1")], table.tolerance());
  }
  for (int order = 2; order <= 4; ++order) {
    const Expression w = normalized(f, order);
    for (const auto& row : table.rows) {
      // The order of the error, with room for the steepest curvature of the ellipse, 2 here.
      const double offset = std::abs(row[table.column("offset")]);
      EXPECT_NEAR(value(w, {row[x], row[y], 0}), row[table.column("dist")],
                  std::pow(4 * offset, order + 1) + table.tolerance())
          << "order " << order;
    }
  }
}

using Point = std::array<Quad, 3>;

// A surface Σ (|x_i| / e_i)^p = 1 with p = 2 or 4, and the direction of its gradient.
struct Superquadric {
  std::string text;
  int power;
  std::array<double, 3> radii;

  Point on_surface(const std::array<double, 3>& towards) const {
    Quad sum;
    for (size_t i = 0; i < 3; ++i) sum = sum + raised(Quad(towards[i]) / Quad(radii[i]));
    Quad scale = sqrt(sum);
    if (power == 4) scale = sqrt(scale);
    return {Quad(towards[0]) / scale, Quad(towards[1]) / scale, Quad(towards[2]) / scale};
  }
  Point normal(const Point& at) const {
    Point n;
    Quad squares;
    for (size_t i = 0; i < 3; ++i) {
      const Quad e(radii[i]), t = at[i] / e;
      n[i] = (power == 4 ? t * t * t : t) / e;
      squares = squares + n[i] * n[i];
    }
    for (Quad& part : n) part = part / sqrt(squares);
    return n;
  }

 private:
  Quad raised(Quad t) const { return power == 4 ? t * t * t * t : t * t; }
};

// The error at a point at `offset` from the surface, whose distance is the offset exactly.
Quad error_at(const Expression& w, const Superquadric& shape, const Point& foot, double offset) {
  const Point n = shape.normal(foot);
  Point p;
  for (size_t i = 0; i < 3; ++i) p[i] = foot[i] + Quad(offset) * n[i];
  // Inside is positive, against the gradient of the sum.
  return abs(evaluate_in_quad(w, p) + Quad(offset));
}

const std::vector<Superquadric>& shapes() {
  static const std::vector<Superquadric> all{
      {"1 - x^2/4 - y^2", 2, {2, 1, infinity}},
      {"(2.25 - x^2 - y^2 - z^2)*3", 2, {1.5, 1.5, 1.5}},
      {"1 - x^2/4 - y^2 - z^2/2.25", 2, {2, 1, 1.5}},
      {"1 - x^4 - y^4/16", 4, {1, 2, infinity}},
      {"1 - x^4 - y^4/16 - z^4", 4, {1, 2, 1}},
  };
  return all;
}

// The largest error at points on either side of the surface, so far away.
Quad largest_error(const Expression& w, const Superquadric& shape, double offset) {
  Quad most;
  for (const auto& towards :
       {std::array{0.7, 0.5, 0.6}, std::array{-0.3, 0.9, 0.4}, std::array{0.8, -0.4, 0.2}}) {
    const bool in_plane = shape.radii[2] == infinity;
    const Point foot = shape.on_surface({towards[0], towards[1], in_plane ? 0 : towards[2]});
    most = max(most, max(error_at(w, shape, foot, offset), error_at(w, shape, foot, -offset)));
  }
  return most;
}

TEST(Normalized, ErrorsHaveTheOrderThatIsAskedFor) {
  for (const Superquadric& shape : shapes()) {
    const Field f = formula(shape.text);
    for (int order = 1; order <= 12; ++order) {
      const Expression w = normalized(f, order);
      // As near as the error still has digits.
      const double offset = order < 7 ? 0x1p-9 : 0x1p-7;
      const Quad error = largest_error(w, shape, offset);
      // A sphere's normals are right at once.
      if (double(error) < 1e-31) continue;
      const double slope = std::log2(double(largest_error(w, shape, 2 * offset)) / double(error));
      EXPECT_GT(slope, order + 0.9) << shape.text << ", order " << order;
    }
  }
}

// About two values and one gradient of the field for two orders.
TEST(Normalized, GrowsLinearlyWithTheOrder) {
  const Field f = formula("1 - x^4 - y^4/16 - z^4 + x*y*z");
  const auto nodes = [&](double order) {
    const Expression w = normalized(f, order);
    return topological_order({&w, 1}).size();
  };
  EXPECT_LE(nodes(12) - nodes(10), nodes(4) - nodes(2) + 5);
  EXPECT_LT(nodes(12), 12 * nodes(2));
}

TEST(Normalized, IsDefinedWhereTheGradientVanishes) {
  for (const double order : {1.0, 2.0, 5.0, 12.0}) {
    // In the middle, on a cone's tip, and where a distance has no direction.
    EXPECT_GT(value(normalized(formula("1 - x^2/4 - y^2"), order), {0, 0, 0}), 0);
    EXPECT_EQ(value(normalized(formula("x^2 + y^2 - z^2"), order), {0, 0, 0}), 0);
    EXPECT_GT(value(normalized(make_field("sphere", {Vec3{}, 2.0}), order), {0, 0, 0}), 0.8);
    EXPECT_EQ(value(normalized(make_field("point", {Vec3{1, 2, 3}}), order), {1, 2, 3}), 0);
    // The gradient of its gradient, too: the middle is an ordinary place.
    double at[3] = {0, 0, 0}, result, gradient[3];
    const Evaluator evaluator(normalized(formula("1 - x^2/4 - y^2"), order));
    evaluator.gradients(at, 1, &result, gradient);
    for (const double g : gradient) EXPECT_EQ(g, 0);
    const Interval bound = evaluator.interval({{-9, -9, -9}, {9, 9, 9}});
    EXPECT_GE(bound.lo, -1 - (order + 1) / 2 - 1e-9);
    EXPECT_LE(bound.hi, 1 + (order + 1) / 2 + 1e-9);
  }
}

TEST(REquivalence, IsSafeAtAllMagnitudes) {
  const auto joined = [](double a, double b, double order) {
    const std::vector<Field> of{Field::coordinate(0), Field::coordinate(1)};
    return value(make_field("r_equivalence", {of, order}).expression(), {a, b, 0});
  };
  EXPECT_DOUBLE_EQ(joined(3, 6, 1), 2);
  EXPECT_DOUBLE_EQ(joined(3, 4, 2), 2.4);
  EXPECT_DOUBLE_EQ(joined(1e-200, 1e200, 12), 1e-200);
  EXPECT_DOUBLE_EQ(joined(1e-180, 1e-180, 12), 1e-180 * std::pow(2, -1.0 / 12));
  EXPECT_DOUBLE_EQ(joined(1e280, 1e280, 12), 1e280 * std::pow(2, -1.0 / 12));
  EXPECT_EQ(joined(0, 5, 12), 0);
  EXPECT_EQ(joined(0, 0, 12), 0);
  EXPECT_DOUBLE_EQ(joined(3, infinity, 2), 3);
  const std::vector<Field> points{make_field("point", {Vec3{}}),
                                  make_field("point", {Vec3{4, 0, 0}})};
  const Field both = make_field("r_equivalence", {points, 2.5});
  EXPECT_EQ(both.quality().outside, Exactness::bound);
  const Interval near = Evaluator(both.expression()).interval({{-1, -1, -1}, {5, 1, 1}});
  EXPECT_GE(near.lo, -1e-12);
  EXPECT_LE(near.hi, 6);
}

// In space it is what the plane formula is around the segment's axis.
TEST(TrimmedSegment, TurnsWithItsEnds) {
  const Field along_x = make_field("trimmed_segment", {Vec3{-1, 0, 0}, Vec3{1, 0, 0}});
  const Field askew = make_field("trimmed_segment", {Vec3{1, 2, 3} - (1 / 3.0) * Vec3{1, 2, -2},
                                                     Vec3{1, 2, 3} + (1 / 3.0) * Vec3{1, 2, -2}});
  // (2, 1, 2)/3 and (-2, 2, 1)/3 are perpendicular to (1, 2, -2)/3.
  for (const Vec3& at : {Vec3{0.3, 0.5, -0.4}, {1, 0, 0}, {-1.7, 0.2, 0.9}, {0.5, 0, 0}}) {
    const Vec3 turned = Vec3{1, 2, 3} + (at[0] / 3) * Vec3{1, 2, -2} + (at[1] / 3) * Vec3{2, 1, 2} +
                        (at[2] / 3) * Vec3{-2, 2, 1};
    EXPECT_NEAR(value(along_x.expression(), at), value(askew.expression(), turned), 1e-14);
  }
  EXPECT_EQ(value(along_x.expression(), {0.5, 0, 0}), 0);
  EXPECT_THAT(error_of([] {
                make_field("trimmed_segment", {Vec3{1, 2, 3}, Vec3{1, 2, 3}});
              }),
              testing::HasSubstr("a and b are the same point"));
}

}  // namespace
}  // namespace sardf

// Joined and trimmed features and functions of their distance against golden values.
#include <gtest/gtest.h>

#include <cmath>

#include "golden.hpp"
#include "sardf/constructor.hpp"
#include "sardf/evaluate.hpp"
#include "sardf/formula.hpp"

namespace sardf {
namespace {

using golden::Table;
using nlohmann::json;

class GoldenFeatures : public golden::InEachFolder {};
INSTANTIATE_TEST_SUITE_P(Each, GoldenFeatures, golden::each_folder(), golden::folder_name);

Vec3 in_space(const json& at, double scale = 1) {
  return {scale * double(at.at(0)), scale * double(at.at(1)), 0};
}

// The column and, where it has them, its gradient's.
void expect_column(const Table& table, const Field& f, const std::string& column,
                   double steepness = 1) {
  const Evaluator evaluator(f.expression());
  const size_t x = table.column("x"), y = table.column("y"), expected = table.column(column);
  const int slope = table.find(column + "_gx");
  for (const auto& row : table.rows) {
    const double at[3] = {row[x], row[y], 0};
    double value, gradient[3];
    evaluator.gradients(at, 1, &value, gradient);
    EXPECT_NEAR(value, row[expected], table.tolerance()) << column;
    EXPECT_EQ(value, evaluator.value({at[0], at[1], at[2]}));
    for (size_t axis = 0; slope >= 0 && axis < 2; ++axis) {
      const double by = row[size_t(slope) + axis];
      if (!std::isnan(by)) {
        EXPECT_NEAR(gradient[axis], by, 100 * table.tolerance() * steepness) << column;
      }
    }
  }
}

TEST_P(GoldenFeatures, RJoinsAndTrimmedSegment) {
  const Table table = read("bst_r_equivalence");
  const auto segment = [](const Vec3& a, const Vec3& b) { return make_field("segment", {a, b}); };
  const std::vector<Field> of{
      segment({-2, -1, 0}, {2, -1, 0}), segment({2, -1, 0}, {0, 2, 0}),
      make_field("circle", {Vec3{}, double(table.parameter("r")), Vec3{0, 0, 1}})};
  for (const int order : {1, 2, 12}) {
    expect_column(table, make_field("r_equivalence", {of, double(order)}),
                  "u_m" + std::to_string(order), 10);
  }
  const Vec3 a{-2, -1, 0}, b{2, -1, 0};
  expect_column(table, make_field("trimmed_segment", {a, b}), "seg_norm", 10);
  // The same from its parts: the line y = -1 and the ball around the segment.
  const Field line = parse_formula("y + 1", {}, {});
  const Field ball = parse_formula("(4 - x^2 - (y + 1)^2)/4", {}, {});
  expect_column(table, make_field("trimmed", {line, ball}), "seg_norm", 10);
}

// Fig. 8: the refractive index around a Y-shaped skeleton.
TEST_P(GoldenFeatures, GradientIndexOfAWaveguide) {
  const Table table = read("fig_bst_08_grin");
  const double scale = table.parameter("scale");
  std::vector<Field> of;
  for (const json& ends : table.parameter("Y_segments")) {
    of.push_back(make_field("segment", {in_space(ends.at(0), scale), in_space(ends.at(1), scale)}));
  }
  const Field u = make_field("r_equivalence", {of, 12.0});
  expect_column(table, u, "u12");
  const std::vector<Field> coefficients{Field::number(table.parameter("n0")), Field::number(0),
                                        Field::number(2 * double(table.parameter("n2")))};
  expect_column(table, make_field("canonical_form", {u, coefficients, Value()}), "n12", 10);
}

// Figs 4 to 6: functions of u alone, here of x.
TEST_P(GoldenFeatures, TaylorTerms) {
  const Table table = read("fig_bst_04_06_taylor");
  char exact[60];
  std::snprintf(exact, sizeof exact, "exp((%.17g)*u)", double(table.parameter("a")));
  const auto expect_terms = [&](const char* column, double terms, double first) {
    const Field f = make_field("taylor", {std::string(exact), Field::coordinate(0), terms, first});
    const Evaluator evaluator(f.expression());
    for (const auto& row : table.rows) {
      EXPECT_NEAR(evaluator.value({row[table.column("u")], 0, 0}), row[table.column(column)],
                  table.tolerance())
          << column;
    }
  };
  expect_terms("t0", 1, 1);
  expect_terms("t1", 1, 2);
  expect_terms("t2", 1, 3);
  expect_terms("t3", 1, 4);
  expect_terms("sum2", 2, 1);
  expect_terms("sum4", 4, 1);
  // With enough terms it is the function.
  expect_terms("exact", 32, 1);
}

}  // namespace
}  // namespace sardf

// Figures 11, 12, 14 (a) and 15 and the general form of the second paper. The distances u1 and u2
// of the golden files stand in as the coordinates x and y.
#include <gtest/gtest.h>

#include "golden_fields.hpp"
#include "sardf/scene.hpp"

namespace sardf {
namespace {

using golden::number;
using golden::two;
using GoldenInterpolation = golden::InEachFolder;

// Of a scene file whose features "S" and "ring" are at distances x and y.
std::map<std::string, Field> fields(const std::string& members) {
  return golden::fields(R"("S": "=x", "ring": "=y")", members);
}

void expect_values(const golden::Table& table, const Field& field, const std::string& column) {
  const Evaluator evaluator(field.expression());
  const size_t u1 = table.column("u1"), u2 = table.column("u2"), to = table.column(column);
  for (const std::vector<double>& row : table.rows) {
    EXPECT_NEAR(evaluator.value({row[u1], row[u2], 0}), row[to], table.tolerance()) << column;
  }
}

TEST_P(GoldenInterpolation, HasTheValuesOfFigure11) {
  const golden::Table table = read("fig_bst_11");
  const std::string exponent = ", \"exponent\": " + number(table, "k");
  const std::string first = "\"value\": " + number(table, "P1") + exponent;
  const std::string second = "\"value\": \"=" + number(table, "P2") + "*exp(-ring^2)\"" + exponent;
  const std::string influence = ", \"influence\": \"=exp(" + number(table, "lambda_rate") + "*u)\"";
  const auto all =
      fields("\"a\": " + two(first, second) + ", \"b\": " + two(first + influence, second));
  expect_values(table, all.at("a"), "a");
  expect_values(table, all.at("b"), "b");
}

TEST_P(GoldenInterpolation, HasTheValuesOfFigure12) {
  const golden::Table table = read("fig_bst_12");
  const std::string first = "\"value\": \"=1 + " + number(table, "F1") + "*S\", \"exponent\": ";
  const std::string second = "\"value\": " + number(table, "P2");
  for (const std::string k : {"1", "2", "3"}) {
    expect_values(table, fields("\"F\": " + two(first + k, second)).at("F"), "k" + k);
  }
}

TEST_P(GoldenInterpolation, HasTheValuesOfFigure14a) {
  const golden::Table table = read("fig_bst_14a_idw");
  const std::string first = "\"value\": \"=1 - " + number(table, "P1_coef") + "*S^2\"";
  const std::string second = "\"value\": \"=" + number(table, "P2_coef") + "*exp(-ring^2)\"";
  expect_values(table, fields("\"F\": " + two(first, second)).at("F"), "P");
}

// Three materials, of which the third takes the rest.
std::string shares(const std::string& one, const std::string& two) {
  return "\"fractions\": {\"functions\": {\"one\": \"=" + one + "\", \"two\": \"=" + two +
         "\", \"three\": \"rest\"}}";
}

Scene figure15(const golden::Table& table, const std::string& first, const std::string& second) {
  const std::string a = shares(number(table, "A1") + "*exp(-S^2)", number(table, "A2"));
  const std::string b =
      shares(number(table, "B1") + "*(1 - 0.1*ring^2)", number(table, "B2") + "*exp(-ring^2)");
  return Scene(parse_scene(
      R"({"sardf": 1, "fields": {"S": "=x", "ring": "=y"},
          "solid": {"box": {"center": [1.6, 1.6, 0], "size": [3, 3, 1]}},
          "materials": {"one": {}, "two": {}, "three": {}},
          "fractions": {"inverse_distance": {"features": [{"at": "S", )" +
          a + first + "}, {\"at\": \"ring\", " + b + second + "}]}}}",
      ""));
}

TEST_P(GoldenInterpolation, HasTheValuesOfFigure15) {
  const golden::Table table = read("fig_bst_15");
  const Scene plain = figure15(table, "", "");
  const Scene weighed = figure15(table, ", \"influence\": \"=0.1 + 10*exp(-5*u^2)\"",
                                 ", \"influence\": \"=0.5 + exp(-0.5*u^2)\"");
  const size_t u1 = table.column("u1"), u2 = table.column("u2");
  for (const std::vector<double>& row : table.rows) {
    const double point[3] = {row[u1], row[u2], 0};
    double a[3], b[3];
    plain.fractions_at(point, 1, a);
    weighed.fractions_at(point, 1, b);
    for (int j = 0; j < 3; ++j) {
      const std::string place = std::to_string(j + 1);
      EXPECT_NEAR(a[j], row[table.column("a" + place)], table.tolerance());
      EXPECT_NEAR(b[j], row[table.column("b" + place)], table.tolerance());
    }
  }
}

// F = P + Phi u1² u2 with Phi = phi x + 0.3 y, whose value enters here as z.
TEST_P(GoldenInterpolation, HasTheValuesOfTheGeneralForm) {
  const golden::Table table = read("bst_form10");
  const auto all = fields(R"("P": )" +
                          two(R"("value": "=1 + )" + number(table, "F1") + R"(*S", "exponent": 2)",
                              R"("value": )" + number(table, "P2")) +
                          R"(, "F": "=P + z*S^2*ring")");
  const Evaluator evaluator(all.at("F").expression());
  const double phi = table.parameter("phi");
  for (const std::vector<double>& row : table.rows) {
    const auto at = [&](const char* name) { return row[table.column(name)]; };
    const Vec3 point{at("u1"), at("u2"), phi * at("x") + 0.3 * at("y")};
    EXPECT_NEAR(evaluator.value(point), at("F"), table.tolerance());
  }
}

// Near a feature with exponent 2 the general form keeps the feature's value and slope:
// m = (2, 1) keeps value and first derivative on S, the value on the ring.
TEST(GeneralForm, KeepsValuesAndDerivativesOnTheFeatures) {
  const auto all =
      fields(R"("P": )" + two(R"("value": "=1 - 1.5*S", "exponent": 2)", R"("value": 2)") +
             R"(, "F": "=P + (0.7*x + 0.3*z)*S^2*ring")");
  const Evaluator F(all.at("F").expression());
  const double h = 1e-6;
  for (const double other : {0.3, 1.0, 2.5}) {
    EXPECT_NEAR(F.value({0, other, 0.4}), 1, 1e-14);
    EXPECT_NEAR((F.value({h, other, 0.4}) - 1) / h, -1.5, 1e-5);
    EXPECT_NEAR(F.value({other, 0, 0.4}), 2, 1e-14);
  }
}

INSTANTIATE_TEST_SUITE_P(Each, GoldenInterpolation, golden::each_folder(), golden::folder_name);

}  // namespace
}  // namespace sardf

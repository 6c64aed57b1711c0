// Figures 11, 12, 14 (a) and 15 and the general form of the second paper, with their features: the
// distances, what is interpolated, and its gradient.
#include <gtest/gtest.h>

#include "golden_fields.hpp"
#include "golden_helix.hpp"
#include "sardf/scene.hpp"

namespace sardf {
namespace {

using golden::number;
using golden::two;
using GoldenInterpolationFeatures = golden::InEachFolder;

// Two-dimensional points at z = 0.
std::string corners(const golden::Table& table, const char* name) {
  std::string text;
  for (const auto& point : table.parameter(name)) {
    text += (text.empty() ? "[" : ", [") + number(point.at(0).get<double>()) + ", " +
            number(point.at(1).get<double>()) + ", 0]";
  }
  return "[" + text + "]";
}

std::string features(const golden::Table& table) {
  const auto& center = table.parameter("ring_c");
  return R"("S": {"bspline_curve": {"control_points": )" + corners(table, "S_control_points") +
         R"(}}, "ring": {"circle": {"center": [)" + number(center.at(0).get<double>()) + ", " +
         number(center.at(1).get<double>()) + R"(, 0], "radius": )" + number(table, "ring_r") +
         "}}";
}

std::map<std::string, Field> fields(const golden::Table& table, const std::string& members) {
  return golden::fields(features(table), members);
}

void expect_field(const golden::Table& table, const Expression& field, const std::string& column) {
  golden::expect_field(table, field, column, {1e-6, 1e-6});
}

TEST_P(GoldenInterpolationFeatures, HaveTheDistances) {
  const golden::Table table = read("fig_bst_12");
  const auto all = fields(table, "");
  expect_field(table, all.at("S").expression(), "u1");
  expect_field(table, all.at("ring").expression(), "u2");
}

TEST_P(GoldenInterpolationFeatures, MakeFigure11) {
  const golden::Table table = read("fig_bst_11");
  const std::string exponent = ", \"exponent\": " + number(table, "k");
  const std::string first = "\"value\": " + number(table, "P1") + exponent;
  const std::string second = "\"value\": \"=" + number(table, "P2") + "*exp(-ring^2)\"" + exponent;
  const std::string influence = ", \"influence\": \"=exp(" + number(table, "lambda_rate") + "*u)\"";
  const auto all =
      fields(table, "\"a\": " + two(first, second) + ", \"b\": " + two(first + influence, second));
  expect_field(table, all.at("a").expression(), "a");
  expect_field(table, all.at("b").expression(), "b");
}

TEST_P(GoldenInterpolationFeatures, MakeFigure12) {
  const golden::Table table = read("fig_bst_12");
  const std::string first = "\"value\": \"=1 + " + number(table, "F1") + "*S\", \"exponent\": ";
  const std::string second = "\"value\": " + number(table, "P2");
  for (const std::string k : {"1", "2", "3"}) {
    const auto all = fields(table, "\"F\": " + two(first + k, second));
    expect_field(table, all.at("F").expression(), "k" + k);
  }
}

TEST_P(GoldenInterpolationFeatures, MakeTheGeneralForm) {
  const golden::Table table = read("bst_form10");
  const std::string first = "\"value\": \"=1 + " + number(table, "F1") + "*S\", \"exponent\": 2";
  const std::string second = "\"value\": " + number(table, "P2");
  const auto all = fields(table, "\"P\": " + two(first, second) + ", \"F\": \"=P + (" +
                                     number(table, "phi") + "*x + 0.3*y)*S^2*ring\"");
  expect_field(table, all.at("P").expression(), "P");
  expect_field(table, all.at("F").expression(), "F");
}

std::string shares(const std::string& one, const std::string& two) {
  return "\"fractions\": {\"functions\": {\"one\": \"=" + one + "\", \"two\": \"=" + two +
         "\", \"three\": \"rest\"}}";
}

TEST_P(GoldenInterpolationFeatures, MakeFigure15) {
  const golden::Table table = read("fig_bst_15");
  const std::string a = shares(number(table, "A1") + "*exp(-S^2)", number(table, "A2"));
  const std::string b =
      shares(number(table, "B1") + "*(1 - 0.1*ring^2)", number(table, "B2") + "*exp(-ring^2)");
  const auto scene = [&](const std::string& first, const std::string& second) {
    return Scene(
        parse_scene("{\"sardf\": 1, \"fields\": {" + features(table) +
                        R"(}, "solid": {"box": {"center": [0, 1.5, 0], "size": [3, 3, 0.1]}},
            "materials": {"one": {}, "two": {}, "three": {}},
            "fractions": {"inverse_distance": {"features": [{"at": "S", )" +
                        a + first + "}, {\"at\": \"ring\", " + b + second + "}]}}}",
                    ""));
  };
  const Scene plain = scene("", "");
  const Scene weighed = scene(", \"influence\": \"=0.1 + 10*exp(-5*u^2)\"",
                              ", \"influence\": \"=0.5 + exp(-0.5*u^2)\"");
  for (size_t j = 0; j < 3; ++j) {
    const std::string place = std::to_string(j + 1);
    expect_field(table, plain.fractions()[j], "a" + place);
    expect_field(table, weighed.fractions()[j], "b" + place);
  }
}

// u1 joins the four walls and the hole by the R-equivalence of order 1, 1 / Σ 1/u.
TEST_P(GoldenInterpolationFeatures, MakeFigure14a) {
  golden::Table table = read("fig_bst_14a_idw");
  const std::string half = number(table, "cube_half");
  golden::HelixSearch{{}, table.parameter("helix_rad"), table.parameter("cube_half")}.remove_missed(
      table);
  std::string walls;
  for (const char* side : {" - x)", " + x)", " - y)", " + y)"}) {
    walls += "1/abs(" + half + side + " + ";
  }
  // Two turns in the cube's height of twice its half: the pitch is the half.
  const std::string text =
      R"json("u1": "=1/()json" + walls + "1/abs(length(x, y) - " + number(table, "hole_r") +
      R"json())", "helix": {"helix": {"radius": )json" + number(table, "helix_rad") +
      R"json(, "pitch": )json" + half +
      R"json(, "start": -360, "end": 360}}, "u2": "=max(0, helix - )json" +
      number(table, "tube_r") +
      R"json()", "P": {"value_of": {"inverse_distance": {"features": [
        {"at": "u1", "value": "=1 - )json" +
      number(table, "P1_coef") + R"json(*u1^2"}, {"at": "u2", "value": "=)json" +
      number(table, "P2_coef") + R"json(*exp(-u2^2)"}]}}})json";
  const auto all = golden::fields(text, "");
  expect_field(table, all.at("u1").expression(), "u1");
  expect_field(table, all.at("u2").expression(), "u2");
  expect_field(table, all.at("P").expression(), "P");
}

INSTANTIATE_TEST_SUITE_P(Each, GoldenInterpolationFeatures, golden::each_folder(),
                         golden::folder_name);

}  // namespace
}  // namespace sardf

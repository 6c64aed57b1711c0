// Coefficients that are stored with the fingerprint of the problem they solve.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <regex>
#include <set>

#include "error_of.hpp"
#include "sardf/arithmetic.hpp"
#include "sardf/fit.hpp"
#include "sardf/scene_file.hpp"
#include "sardf/scene_solution.hpp"
#include "sardf/shapes_fit.hpp"

namespace sardf {
namespace {

using testing::HasSubstr;
using testing::Not;

const Expression x = coordinate(0), y = coordinate(1), z = coordinate(2);
Expression number(double a) { return constant(a); }

FitProblem simple() {
  FitProblem p;
  p.grid = spline_grid({-1, 0, 0}, {1.5, 1, 0}, {7, 6}, 3);
  p.start = number(0.1);
  p.factor = x;
  p.values = y * number(0.3);
  p.smoothness = 0.25;
  p.at_least = -0.5;
  return p;
}

// The value is from a program of its own, in another language, after the description of the
// words that are hashed: node by node type, axis, number, operation's name and numbers, inputs;
// then fields, grid, weights, points, options. Files carry such values: they must not change.
TEST(FitFingerprint, IsTheSameEverywhere) {
  EXPECT_EQ(fingerprint_of(simple()), "450d4bc300e01f62");
}

TEST(FitFingerprint, TellsProblemsApart) {
  const std::vector<std::function<void(FitProblem&)>> changes{
      [](FitProblem&) {},
      [](FitProblem& p) { p.grid.lower[0] = -2; },
      [](FitProblem& p) { p.grid.upper[1] = 2; },
      [](FitProblem& p) { p.grid.counts[1] = 7; },
      [](FitProblem& p) {
        p.grid = spline_grid({-1, 0, 0}, {1.5, 1, 0}, {7, 6}, 2);
      },
      [](FitProblem& p) {
        p.grid = spline_grid({-1, 0, 0}, {1.5, 1, 1}, {7, 6, 6}, 3);
      },
      [](FitProblem& p) { p.start = number(0.1000001); },
      [](FitProblem& p) { p.factor = y; },
      [](FitProblem& p) { std::swap(p.start, p.factor); },
      [](FitProblem& p) { p.solid = p.values; },
      [](FitProblem& p) { p.solid = std::exchange(p.values, nullptr); },
      [](FitProblem& p) { p.values = number(0.3) * y; },
      [](FitProblem& p) { p.values = y / number(0.3); },
      [](FitProblem& p) { p.slope = x; },
      [](FitProblem& p) { p.along = x; },
      [](FitProblem& p) { p.values_weight = 2; },
      [](FitProblem& p) { p.slope_weight = 2; },
      [](FitProblem& p) { p.smoothness = 0.5; },
      [](FitProblem& p) { p.points = 5; },
      [](FitProblem& p) { p.mean = 0; },
      [](FitProblem& p) { p.at_least = std::nullopt; },
      [](FitProblem& p) { p.at_most = 0; },
      [](FitProblem& p) { p.at_most = std::exchange(p.at_least, std::nullopt); }};
  std::set<std::string> all;
  for (const auto& change : changes) {
    FitProblem p = simple();
    change(p);
    const std::string made = fingerprint_of(p);
    EXPECT_EQ(made.size(), 16u);
    EXPECT_TRUE(all.insert(made).second) << all.size();
  }
}

// Neither by what was made before it, nor by a last bit of a constant.
TEST(FitFingerprint, DoesNotDependOnAddressesOrRounding) {
  const auto made = [](double angle) {
    FitProblem p = simple();
    p.solid = min(number(angle) + x, max(y, number(2) - x * y));
    return fingerprint_of(p);
  };
  const double angle = std::sin(0.3);
  const std::string first = made(angle);
  std::vector<Expression> others;
  for (int i = 0; i < 1000; ++i) others.push_back(x * number(i) + number(angle));
  EXPECT_EQ(made(angle), first);
  EXPECT_EQ(made(std::nextafter(angle, 1)), first);
  EXPECT_EQ(made(std::nextafter(angle, 0)), first);
  EXPECT_NE(made(angle + 1e-9), first);
}

// G starts from F: its problem has F's solution in it.
std::string scene(const std::string& weight, const std::string& of_first = "",
                  const std::string& of_second = "") {
  return R"json({"sardf": 1, "fields": {
    "F": {"fitted": {"start": "=1 - x", "factor": "=x^2", "lower": [-1, -1, 0],
                     "upper": [1, 1, 0], "splines": [5, 5], "values": "=cos(y)",
                     "values_weight": )json" +
         weight + of_first + R"json(}},
    "G": {"fitted": {"start": "F", "factor": "=y^2", "lower": [-1, -1, 0], "upper": [1, 1, 0],
                     "splines": [5, 5], "smoothness": 1)json" +
         of_second + R"json(}},
    "part": {"sphere": {"radius": 1}}},
  "solid": "part", "attributes": {"a": {"value": "G"}}})json";
}

std::string solved(const std::string& text) {
  const SceneDescription read = parse_scene(text, "s");
  return scene_text(read, solved_arguments(read));
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST(FitFingerprint, IsWrittenWithTheCoefficientsAndHolds) {
  const std::string text = solved(scene("1.5"));
  EXPECT_THAT(text, HasSubstr("\"fingerprint\": \""));
  const SceneDescription again = parse_scene(text, "s");
  EXPECT_EQ(scene_text(again), text);
  for (size_t i = 0; i < again.fields.size(); ++i) {
    EXPECT_EQ(again.fields[i].field.expression(),
              parse_scene(scene("1.5"), "s").fields[i].field.expression());
  }
}

TEST(FitFingerprint, RefusesCoefficientsOfAnotherProblem) {
  const std::string text = solved(scene("1.5"));
  const std::string changed = replaced(text, "\"values_weight\": 1.5", "\"values_weight\": 2.5");
  const std::string error = error_of([&] { parse_scene(changed, "s"); });
  EXPECT_THAT(error, HasSubstr("the coefficients solve another problem"));
  EXPECT_THAT(error, HasSubstr("remove coefficients and fingerprint, or run `sardf solve` again"));
  // Without a fingerprint they are data.
  const std::regex fingerprints(R"(,\s*"fingerprint": "[0-9a-f]{16}")");
  const std::string data = std::regex_replace(changed, fingerprints, "");
  EXPECT_THAT(data, Not(HasSubstr("fingerprint")));
  EXPECT_THAT(data, HasSubstr("coefficients"));
  EXPECT_EQ(error_of([&] { parse_scene(data, "s"); }), "no error");
}

TEST(FitFingerprint, OfAPartThatChangedIsRefusedToo) {
  // F without coefficients, of another weight; G with those of before.
  const std::string text = solved(scene("1.5"));
  const size_t from = text.rfind("\"coefficients\"");
  const std::string of_second = ", " + text.substr(from, text.find('}', from) - from);
  EXPECT_THAT(of_second, HasSubstr("fingerprint"));
  EXPECT_EQ(error_of([&] { parse_scene(scene("1.5", "", of_second), "s"); }), "no error");
  EXPECT_THAT(error_of([&] { parse_scene(scene("7", "", of_second), "s"); }),
              HasSubstr("solve another problem"));
}

TEST(FitFingerprint, SolvingAgainMendsIt) {
  const std::string text =
      replaced(solved(scene("1.5")), "\"values_weight\": 1.5", "\"values_weight\": 4");
  std::string again;
  {
    const IgnoredCoefficients ignored;
    again = solved(text);
  }
  EXPECT_EQ(error_of([&] { parse_scene(again, "s"); }), "no error");
  EXPECT_EQ(again, solved(scene("4")));
  EXPECT_FALSE(IgnoredCoefficients::active());
}

}  // namespace
}  // namespace sardf

// Functions that must be fractions, and features that must not contradict each other.
#include "sardf/scene_checks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "error_of.hpp"
#include "sardf/formula.hpp"
#include "sardf/polynomial.hpp"
#include "sardf/scene_file.hpp"

namespace sardf {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::optional<double> constant_of(const std::string& text) {
  const Field u = parse_formula("sqrt(x^2 + y^2)", {}, {});
  return proven_constant(parse_formula(text, {{"u", u}}, {}).expression());
}

TEST(ProvenConstant, CollectsTerms) {
  EXPECT_EQ(constant_of("0.2 + 0.3*u + 0.8 - 0.3*u"), 1);
  EXPECT_EQ(constant_of("(x + y)^2 - x^2 - 2*x*y - y*y + 3"), 3);
  EXPECT_EQ(constant_of("exp(-1.5*u) + (1 - exp(-1.5*u))"), 1);
  EXPECT_EQ(constant_of("(1 - u)^3 + 3*u*(1 - u)^2 + 3*u^2*(1 - u) + u^3"), 1);
  EXPECT_EQ(constant_of("mix(2, x, u) + 2*u - x*u"), 2);
  EXPECT_EQ(constant_of("x/4 - 0.25*x"), 0);
  EXPECT_EQ(constant_of("-(x - 2) + x"), 2);
  EXPECT_NEAR(*constant_of("0.1*u + 0.2*u - 0.3*u + 0.7 + 0.1 + 0.2"), 1, 1e-15);
}

TEST(ProvenConstant, ProvesNothingElse) {
  EXPECT_FALSE(constant_of("0.2 + 0.3*u + 0.8 - 0.30001*u"));
  EXPECT_FALSE(constant_of("sin(x)^2 + cos(x)^2"));
  EXPECT_FALSE(constant_of("1 + 1e-9*x"));
  EXPECT_FALSE(constant_of("max(x, 0) + max(-x, 0) - abs(x)"));
  EXPECT_FALSE(constant_of("x"));
  // Too long to be multiplied out.
  EXPECT_FALSE(constant_of("(x + y + z + u + exp(x) + exp(y))^20 - x"));
}

Scene scene(const std::string& fractions, const std::string& fields = "") {
  return Scene(parse_scene(
      "{\"sardf\": 1, \"solid\": {\"box\": {\"size\": [2, 2, 2]}},\n" +
          ("\"fields\": {" + fields + "},\n") +
          "\"materials\": {\"SiC\": {}, \"diamond\": {}},\n\"fractions\": " + fractions + "}",
      "t.json"));
}

std::string problem(const std::string& fractions, const std::string& fields = "") {
  return error_of([&] { scene(fractions, fields); });
}

std::vector<std::string> warnings(const Scene& of) {
  std::vector<std::string> all;
  for (const Warning& warning : of.warnings()) all.push_back(warning.message);
  return all;
}

std::string functions(const std::string& sic, const std::string& diamond) {
  return R"({"functions": {"SiC": )" + sic + R"(, "diamond": )" + diamond + "}}";
}

TEST(FractionFunctions, AreTakenAsTheyAre) {
  const Scene s = scene(functions("\"=0.2 + 0.3*u1\"", "\"=0.8 - 0.3*u1\""),
                        R"("u1": {"point": {"at": [0, 0, 0]}})");
  double at[2];
  s.fractions_at(Vec3{1, 0.5, 0}.data(), 1, at);
  EXPECT_NEAR(at[0], 0.2 + 0.3 * std::sqrt(1.25), 1e-15);
  EXPECT_NEAR(at[1], 0.8 - 0.3 * std::sqrt(1.25), 1e-15);
  EXPECT_TRUE(warnings(s).empty());
  // Far outside of the solid the second would be -2.2, which counts as 0.
  s.fractions_at(Vec3{10, 0, 0}.data(), 1, at);
  EXPECT_EQ(at[0], 1);
  EXPECT_EQ(at[1], 0);
  s.fractions_at(Vec3{1e30, -1e30, 0}.data(), 1, at);
  EXPECT_EQ(at[0] + at[1], 1);
}

TEST(FractionFunctions, TakeTheRest) {
  const Scene rest = scene(functions("\"=exp(-x^2)\"", "\"rest\""));
  double at[2];
  rest.fractions_at(Vec3{0.5, 0, 0}.data(), 1, at);
  EXPECT_NEAR(at[0], std::exp(-0.25), 1e-15);
  EXPECT_NEAR(at[1], 1 - std::exp(-0.25), 1e-15);
  EXPECT_THAT(problem(functions("\"rest\"", "\"rest\"")),
              HasSubstr("t.json:4: /fractions/functions: 2 materials take the rest; only one can"));
  // A field of that name is reached by a formula.
  const Scene named = scene(functions("\"=rest\"", "\"rest\""), R"("rest": "=0.25")");
  named.fractions_at(Vec3{0.5, 0, 0}.data(), 1, at);
  EXPECT_EQ(at[0], 0.25);
}

TEST(FractionFunctions, MustSumToOne) {
  const std::string wrong = problem(functions("\"=0.2 + 0.3*x\"", "\"=0.8 - 0.2*x\""));
  // Largest where the grid's samples are farthest from x = 0: 1 + 0.1 * 23/24.
  EXPECT_THAT(wrong, AllOf(HasSubstr("t.json:4: /fractions/functions: the fractions: the functions "
                                     "sum to "),
                           HasSubstr("at ("), HasSubstr("they must sum to 1 everywhere")));
  EXPECT_THAT(problem(functions("\"=cos(x)^2\"", "\"=sin(x)^2\"")),
              HasSubstr("cannot be proven; write the word \"rest\""));
}

// The place that an error names is one where the sum is what it says.
TEST(FractionFunctions, NameThePlaceWhereTheSumIsWrong) {
  const std::string text = problem(functions("\"=0.2 + 0.3*x\"", "\"=0.8 - 0.2*x\""));
  double sum, x, y, z;
  ASSERT_EQ(std::sscanf(text.c_str() + text.find("sum to "), "sum to %lf at (%lf, %lf, %lf)", &sum,
                        &x, &y, &z),
            4);
  EXPECT_NEAR(sum, 1 + 0.1 * x, 1e-5);
  EXPECT_GT(std::abs(x), 0.9);
}

TEST(FractionFunctions, MustLieBetweenZeroAndOneInTheSolid) {
  const std::string text = problem(functions("\"=0.5 + 0.7*x\"", "\"=0.5 - 0.7*x\""));
  EXPECT_THAT(text, HasSubstr("t.json:4: /fractions/functions/SiC: the fractions: the function of "
                              "'SiC' is "));
  double value, x;
  ASSERT_EQ(std::sscanf(text.c_str() + text.find("'SiC' is "), "'SiC' is %lf at (%lf,", &value, &x),
            2);
  EXPECT_NEAR(value, 0.5 + 0.7 * x, 1e-5);
  EXPECT_TRUE(value < 0 || value > 1);
  // Outside of the solid they may be anything.
  EXPECT_EQ(problem(functions("\"=0.5 + 0.49*x\"", "\"=0.5 - 0.49*x\"")), "no error");
}

// Of several lines and rules, errors name the one function that is wrong.
TEST(FractionFunctions, AreNamedByErrorsWithTheirLines) {
  const std::string below_zero = problem(
      "{\"functions\": {\n\"SiC\": \"=2 + x\",\n\"diamond\":\n"
      "\"rest\"}}");
  EXPECT_THAT(below_zero, HasSubstr("t.json:5: /fractions/functions/SiC: the fractions: the "
                                    "function of 'SiC' is "));
  const std::string rest = problem(
      "{\"functions\": {\n\"SiC\": \"=0.5 + 0*x\",\n\"diamond\": "
      "\"=0.5 - 0*x\"}}");
  EXPECT_EQ(rest, "no error");
  // Neither function alone is wrong where the sum is.
  EXPECT_THAT(problem("{\"functions\":\n{\n\"SiC\": 0.5,\n\"diamond\": 0.4}}"),
              HasSubstr("t.json:5: /fractions/functions: the fractions: the functions sum to 0.9"));
  // Where there is one, or one that is no number, it is.
  EXPECT_THAT(
      problem("{\"functions\": {\n\n\"SiC\": 0.5}}"),
      HasSubstr("t.json:6: /fractions/functions/SiC: the fractions: the functions sum to "));
  EXPECT_THAT(problem("{\"functions\": {\n\"SiC\": 0.5,\n\"diamond\": \"=log(-1 - x^2)\"}}"),
              HasSubstr("t.json:6: /fractions/functions/diamond: the fractions: the functions sum "
                        "to "));
}

TEST(FractionFunctions, AreNamedByErrorsInsideOtherRules) {
  const std::string outer = R"({"partition": {"of": [{"solid": {"sphere": {"radius": 0.5}},
      "material": "SiC"}, {"solid": {"box": {"size": [4, 4, 4]}}, "fractions":
      {"functions": {
        "SiC": "=0.5 - x",
        "diamond": "rest"}}}]}})";
  EXPECT_THAT(problem(outer), HasSubstr("t.json:7: /fractions/partition/of/1/fractions/functions/"
                                        "SiC: the fractions: the function of 'SiC' is "));
}

// It is 0 on all of the surface, which no interval across the surface proves.
TEST(FractionFunctions, ThatAreNotProvenToBeFractionsAreAWarning) {
  const Scene s = scene(functions("\"=1 - max(abs(x), abs(y), abs(z))\"", "\"rest\""));
  const auto found = warnings(s);
  ASSERT_EQ(found.size(), 2u);
  double lo, hi;
  const std::string start =
      "the fractions: the function of 'SiC' is not proven to lie in [0, 1] in the solid, but only "
      "in [";
  ASSERT_EQ(found[0].substr(0, start.size()), start);
  ASSERT_EQ(std::sscanf(found[0].c_str() + start.size(), "%lf, %lf]", &lo, &hi), 2);
  EXPECT_LT(lo, 0);
  EXPECT_GT(lo, -0.2);
  EXPECT_EQ(hi, 1);
}

// In a part of a partition a function matters in that part alone.
TEST(FractionFunctions, AreCheckedWhereTheyCount) {
  const std::string fields = R"("half": {"half_space": {"normal": [1, 0, 0], "point": [0.1, 0, 0]}},
      "all": {"sphere": {"radius": 9}})";
  const std::string inside = functions("\"=x\"", "\"=1 - x\"");
  EXPECT_EQ(problem(R"({"partition": {"of": [{"solid": "half", "fractions": )" + inside +
                        R"(}, {"solid": "all", "material": "SiC"}]}})",
                    fields),
            "no error");
  EXPECT_THAT(problem(inside, fields), HasSubstr("a fraction lies in [0, 1]"));
}

TEST(FractionFunctions, AreWrittenSoThatTheyReadBack) {
  const auto before = parse_scene(
      R"({"sardf": 1, "solid": {"sphere": {"radius": 1}}, "fields": {"rest": "=0.1*x", "u": {"point": {"at":
          [0, 0, 0]}}}, "materials": {"a": {}, "b": {}, "c": {}},
          "fractions": {"inverse_distance": {"features": [{"at": "u", "fractions":
            {"functions": {"a": "=rest", "b": 0.25, "c": "rest"}}},
            {"at": {"circle": {"radius": 1}}, "material": "b"}]}}})",
      "");
  const std::string text = scene_text(before);
  const auto after = parse_scene(text, "");
  EXPECT_EQ(scene_text(after), text);
  EXPECT_EQ(lower(after.fractions, {"a", "b", "c"}, 1), lower(before.fractions, {"a", "b", "c"}, 1))
      << text;
}

std::string features(const std::string& first, const std::string& second) {
  return R"({"inverse_distance": {"features": [)" + first + ", " + second + "]}}";
}

std::string segment(const char* a, const char* b, const std::string& what) {
  return std::string(R"({"at": {"segment": {"a": )") + a + R"(, "b": )" + b + "}}, " + what + "}";
}

const std::string sic = R"("material": "SiC")", diamond = R"("material": "diamond")";

TEST(Contradictions, AreFoundWhereFeaturesCross) {
  const Scene s = scene(features(segment("[-1, 0.3, 0.2]", "[1, 0.3, 0.2]", sic),
                                 segment("[0.4, -1, 0.2]", "[0.4, 1, 0.2]", diamond)));
  const auto all = warnings(s);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0],
            "the fractions: features 1 and 2 touch at (0.4, 0.3, 0.2), where they prescribe "
            "different values (SiC 1, diamond 0 and SiC 0, diamond 1); their mean counts there");
}

TEST(Contradictions, AreNoneWhereValuesAgreeOrFeaturesAreApart) {
  EXPECT_TRUE(warnings(scene(features(segment("[-1, 0.3, 0.2]", "[1, 0.3, 0.2]", sic),
                                      segment("[0.4, -1, 0.2]", "[0.4, 1, 0.2]", sic))))
                  .empty());
  EXPECT_TRUE(warnings(scene(features(segment("[-1, 0.3, 0.2]", "[1, 0.3, 0.2]", sic),
                                      segment("[0.4, -1, 0.21]", "[0.4, 1, 0.21]", diamond))))
                  .empty());
  // They cross outside of the solid.
  EXPECT_TRUE(warnings(scene(features(segment("[-1, 0, 0]", "[2, 0, 0]", sic),
                                      segment("[1.5, -1, 0]", "[1.5, 1, 0]", diamond))))
                  .empty());
}

TEST(Contradictions, AreFoundWhereSurfacesTouchInAPoint) {
  const std::string ball = R"({"at": {"boundary": "ball"}, )", wall = R"({"at": "wall", )";
  const std::string fields = R"("ball": {"sphere": {"radius": 0.5, "center": [0.1, 0.2, 0]}},
      "wall": {"boundary": {"solid": {"half_space": {"point": [0.6, 0, 0], "normal": "x"}}}})";
  const auto all = warnings(scene(features(ball + sic + "}", wall + diamond + "}"), fields));
  ASSERT_EQ(all.size(), 1u);
  EXPECT_THAT(all[0], HasSubstr("touch at (0.6"));
}

TEST(Contradictions, OfFunctionsAreFoundWhereTheyDiffer) {
  // On the common line y = z = 0 they agree at x = 0.5 alone.
  const Scene s = scene(
      features(
          R"({"at": "wide", "fractions": {"functions": {"SiC": "=0.5 + 0.1*x", "diamond": "rest"}}})",
          R"({"at": "tall", "fractions": {"functions": {"SiC": 0.55, "diamond": "rest"}}})"),
      R"("wide": {"boundary": {"solid": {"half_space": {"normal": "y"}}}},
         "tall": {"boundary": {"solid": {"half_space": {"normal": "z"}}}})");
  EXPECT_EQ(warnings(s).size(), 1u);
}

TEST(Contradictions, AreFoundInAttributesAndFields) {
  const Scene s(parse_scene(
      R"({"sardf": 1, "solid": {"sphere": {"radius": 2}}, "fields": {
            "a": {"segment": {"a": [0, 0, 0], "b": [1, 0, 0]}},
            "b": {"segment": {"a": [0, 0, 0], "b": [0, 1, 0]}},
            "F": {"value_of": {"inverse_distance": {"features": [
              {"at": "a", "value": 1}, {"at": "b", "value": "=2 + y"}]}}}},
          "attributes": {"grain": {"value": {"inverse_distance": {"features": [
            {"at": "a", "value": [1, 0, 0]}, {"at": "b", "value": [0, 1, 0]}]}}}}})",
      ""));
  const auto all = warnings(s);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0],
            "the attribute 'grain': features 1 and 2 touch at (0, 0, 0), where they prescribe "
            "different values (1, 0, 0 and 0, 1, 0); their mean counts there");
  EXPECT_EQ(all[1],
            "the field 'F': features 1 and 2 touch at (0, 0, 0), where they prescribe different "
            "values (1 and 2); their mean counts there");
}

TEST(Contradictions, StayQuickAndCanBeCancelled) {
  // Many features that all but touch.
  std::string all;
  for (int i = 0; i < 20; ++i) {
    all += (i ? "," : "") + segment("[-1, -1, -1]", "[1, 1, 1]", sic);
    all += "," + segment("[-1, -1, -0.9999]", "[1, 1, 1.0001]", diamond);
  }
  const Scene s = scene(R"({"inverse_distance": {"features": [)" + all + "]}}");
  const auto start = std::chrono::steady_clock::now();
  EXPECT_TRUE(warnings(s).empty());
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
  EXPECT_THROW(s.warnings([](double) { return false; }), Cancelled);
}

}  // namespace
}  // namespace sardf

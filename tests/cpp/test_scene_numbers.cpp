// Numbers in scene files where fields are accepted, and points of a plane where points of space
// are.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error_of.hpp"
#include "sardf/arithmetic.hpp"
#include "sardf/constructor.hpp"
#include "sardf/json_document.hpp"
#include "sardf/scene_file.hpp"

namespace sardf {
namespace {

using testing::HasSubstr;
using testing::Not;

SceneDescription with_field(const std::string& definition) {
  return parse_scene(
      R"({"sardf": 1, "fields": {"f": )" + definition + R"(}, "solid": {"sphere": {"radius": 1}}})",
      "t.json");
}

Expression field(const std::string& definition) {
  return with_field(definition).fields.at(0).field.expression();
}

// Reads, writes and reads again: the text contains `written`, and the field is the same.
void expect_round_trip(const std::string& definition, const std::string& written) {
  const SceneDescription scene = with_field(definition);
  const std::string text = scene_text(scene);
  EXPECT_THAT(text, HasSubstr(written));
  EXPECT_EQ(parse_scene(text, "").fields.at(0).field.expression(),
            scene.fields.at(0).field.expression());
}

TEST(SceneNumbers, AreFieldsWhereOneIsAccepted) {
  EXPECT_EQ(field(R"({"translate": {"field": 3, "by": [1, 2, 3]}})"), constant(3));
  EXPECT_EQ(field(R"({"normal_derivative": {"field": "=x*y", "distance": -2}})"), constant(0));
  // Where it may be left out, too.
  const std::string with_number =
      R"({"canonical_form": {"distance": "=x", "coefficients": [1], "remainder": -2.5}})";
  EXPECT_EQ(
      field(with_number),
      field(
          R"({"canonical_form": {"distance": "=x", "coefficients": [1], "remainder": "=-2.5"}})"));
  EXPECT_NE(field(with_number),
            field(R"({"canonical_form": {"distance": "=x", "coefficients": [1]}})"));
}

TEST(SceneNumbers, AreWrittenAsTheyWereRead) {
  for (const char* number : {"-2", "0", "1e-300", "0.1", "9.8765432109876543e+99",
                             "-2.2250738585072014e-308", "0.30000000000000004"}) {
    const std::string value(number);
    const SceneDescription scene =
        with_field(R"({"offset": {"field": )" + value + R"(, "distance": 0}})");
    const SceneDescription again = parse_scene(scene_text(scene), "");
    const auto of = [](const SceneDescription& s) {
      return std::get<Field>(s.fields.at(0).field.construction()->arguments.at(0))
          .expression()
          ->value;
    };
    EXPECT_EQ(of(scene), std::stod(value)) << value;
    EXPECT_EQ(of(again), of(scene)) << value;
    EXPECT_EQ(std::signbit(of(again)), std::signbit(of(scene))) << value;
  }
  expect_round_trip(
      R"({"canonical_form": {"distance": "=x", "coefficients": [1], "remainder": -2}})",
      R"("remainder": -2)");
}

TEST(SceneNumbers, StayFormulasOfParameters) {
  const SceneDescription scene = parse_scene(
      R"({"sardf": 1, "parameters": {"R": 2}, "fields": {"f": {"canonical_form": {"distance":
         "=x", "coefficients": [1], "remainder": "=R"}}}, "solid": {"sphere": {"radius": 1}}})",
      "");
  EXPECT_THAT(scene_text(scene), HasSubstr(R"("remainder": "=R")"));
}

TEST(SceneNumbers, OfOtherTypesAreErrors) {
  EXPECT_EQ(error_of([] { field(R"({"translate": {"field": true, "by": [1, 2, 3]}})"); }),
            "t.json:1: /fields/f/translate/field: found true; a number or a field (a name, a "
            "formula \"=...\", or an object such as {\"sphere\": {...}}) is accepted");
  // Not in lists of solids, where it would most often be a slip.
  EXPECT_THAT(error_of([] { field(R"({"union": {"of": [1, "=x"]}})"); }),
              HasSubstr("/fields/f/union/of/0: found the number 1; a field (a name"));
}

TEST(PlanePoints, HaveZ0) {
  const auto same = [](const std::string& flat, const std::string& in_space) {
    EXPECT_EQ(field(flat), field(in_space)) << flat;
  };
  same(R"({"bspline_curve": {"control_points": [[0, 1], [2, 3], [4, 1], [5, 0]]}})",
       R"({"bspline_curve": {"control_points": [[0, 1, 0], [2, 3, 0], [4, 1, 0], [5, 0, 0]]}})");
  same(R"({"polyline": {"vertices": [[0, 1], [2, "=1 + 2"], [4, 1]], "closed": true}})",
       R"({"polyline": {"vertices": [[0, 1, 0], [2, 3, 0], [4, 1, 0]], "closed": true}})");
  same(R"({"points": {"at": [[0, 1], [2, 3, 4]]}})",
       R"({"points": {"at": [[0, 1, 0], [2, 3, 4]]}})");
  EXPECT_NE(field(R"({"points": {"at": [[0, 1], [2, 3]]}})"),
            field(R"({"points": {"at": [[0, 1, 1], [2, 3, 0]]}})"));
  expect_round_trip(R"({"polyline": {"vertices": [[0, 1], [2, 3]]}})", "[0, 1, 0]");
}

TEST(PlanePoints, OfOtherLengthsAreErrors) {
  const auto problem = [](const std::string& points) {
    return error_of([&] { field(R"({"polyline": {"vertices": )" + points + "}}"); });
  };
  EXPECT_EQ(problem("[[1, 2], [3]]"),
            "t.json:1: /fields/f/polyline/vertices/1: found a list of 1; 2 or 3 numbers is "
            "accepted");
  EXPECT_THAT(problem("[[1, 2], [3, 4, 5, 6]]"),
              HasSubstr("vertices/1: found a list of 4; 2 or 3"));
  EXPECT_THAT(problem("[[1, 2], 7]"), HasSubstr("vertices/1: found the number 7; 2 or 3 numbers"));
  EXPECT_THAT(problem("[[1, true], [1, 2]]"), HasSubstr("vertices/0/1: found true"));
  EXPECT_THAT(problem("7"), HasSubstr("a list of points of 2 or 3 numbers is accepted"));
  // A surface's are in space.
  EXPECT_THAT(
      error_of([] { field(R"({"bspline_surface": {"control_points": [[[0, 1], [2, 3]]]}})"); }),
      HasSubstr("found a list of 2; 3 numbers is accepted"));
}

// The schema says the same, for editors.
TEST(SceneNumbers, AreInTheSchema) {
  const std::string schema = scene_schema();
  std::vector<Error> errors;
  const JsonValue all = parse_json(schema, "", errors);
  ASSERT_TRUE(errors.empty());
  const auto parameter = [&](const char* constructor, const char* name) {
    const JsonValue* at = all.find("$defs")->find("field");
    at = &at->find("anyOf")->elements.at(1);
    at = at->find("properties")->find(constructor);
    if (const JsonValue* choices = at->find("anyOf")) at = &choices->elements.at(0);
    return *at->find("properties")->find(name);
  };
  EXPECT_EQ(parameter("fitted", "slope").find("$ref")->text, "#/$defs/field_or_number");
  EXPECT_EQ(parameter("translate", "field").find("$ref")->text, "#/$defs/field_or_number");
  const JsonValue points = parameter("polyline", "vertices");
  EXPECT_EQ(points.find("items")->find("minItems")->number, 2);
  EXPECT_EQ(points.find("items")->find("maxItems")->number, 3);
}

}  // namespace
}  // namespace sardf

// Rules for values as fields: read, in any order, with every error at its place, and written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "sardf/arithmetic.hpp"
#include "sardf/constructor.hpp"
#include "sardf/error.hpp"
#include "sardf/scene_file.hpp"

namespace sardf {
namespace {

using testing::HasSubstr;

SceneDescription parse(const std::string& fields) {
  return parse_scene(
      "{\"sardf\": 1, \"solid\": {\"sphere\": {\"radius\": 1}},\n\"fields\": {\n" + fields + "}}",
      "t.json");
}

std::vector<Error> problems(const std::string& fields) {
  try {
    parse(fields);
  } catch (const SceneErrors& error) {
    return error.errors;
  }
  return {};
}

Field named(const SceneDescription& scene, const std::string& name) {
  for (const NamedField& field : scene.fields) {
    if (field.name == name) return field.field;
  }
  return {};
}

double value(const Field& field, const Vec3& p) { return Evaluator(field.expression()).value(p); }

const std::string features =
    R"({"features": [{"at": "a", "value": "=1 - 1.5*a", "exponent": 2}, {"at": "b", "value": 3}]})";
const std::string two_points =
    R"("a": {"point": {"at": [0, 0, 0]}}, "b": {"point": {"at": [4, 0, 0]}})";

TEST(ValueOf, IsTheInterpolatedValue) {
  const auto scene = parse(two_points + R"(, "F": {"value_of": {"rule": {"inverse_distance": )" +
                           features + "}}}");
  const Field F = named(scene, "F");
  // At x = 1: u = 1 and 3, weights 1 and 1/3, values -0.5 and 3.
  EXPECT_NEAR(value(F, {1, 0, 0}), (-0.5 + 3.0 / 3) / (1 + 1.0 / 3), 1e-15);
  EXPECT_EQ(value(F, {0, 0, 0}), 1);
  EXPECT_EQ(value(F, {4, 0, 0}), 3);
  EXPECT_EQ(F.quality().inside, Exactness::estimate);
}

TEST(ValueOf, HasAShortForm) {
  const auto scene =
      parse(two_points + R"(, "long": {"value_of": {"rule": {"inverse_distance": )" + features +
            R"(}}}, "short": {"value_of": {"inverse_distance": )" + features +
            R"(}}, "plain": {"value_of": "=2*a"}, "number": {"value_of": 3})");
  EXPECT_EQ(named(scene, "long").expression(), named(scene, "short").expression());
  EXPECT_EQ(named(scene, "plain").expression(), constant(2) * named(scene, "a").expression());
  EXPECT_EQ(named(scene, "number").expression(), constant(3));
}

// The tolerance within which a point counts as on a feature is a share of the scale.
TEST(ValueOf, HasAScaleForItsTolerance) {
  const auto at_scale = [&](const std::string& scale) {
    return named(parse(R"("a": {"point": {"at": [0, 0, 0]}}, "b": {"point": {"at": [1, 0, 0]}},
        "F": {"value_of": {"rule": {"inverse_distance": {"features": [
          {"at": "a", "value": 1}, {"at": "b", "value": 2}]}}, "scale": )" +
                       scale + "}}"),
                 "F");
  };
  const Vec3 near{1e-8, 0, 0};
  EXPECT_NEAR(value(at_scale("1"), near), 1 + 1e-8, 1e-13);
  EXPECT_GT(value(at_scale("1"), near), 1);
  EXPECT_EQ(value(at_scale("1e5"), near), 1);
  EXPECT_THAT(problems(R"("F": {"value_of": {"rule": 1, "scale": 0}})").at(0).message,
              HasSubstr("scale is 0; a positive number is accepted"));
}

TEST(ValueOf, NamesFieldsInAnyOrder) {
  const std::string F = R"("F": {"value_of": {"inverse_distance": {"features": [
      {"at": {"boundary": "hole"}, "value": "=G + 1"}, {"at": "b", "value": [2],
       "influence": "=exp(3*u) + H"}]}}})";
  const std::string G = R"("G": {"value_of": {"ramp": {"field": "=x", "stops": [
      {"at": 0, "value": "b"}, {"at": 1, "value": {"value_of": "H"}}]}}})";
  const std::string rest = R"("H": "=x + 1", "hole": {"sphere": {"radius": 2}},
      "b": {"point": {"at": [4, 0, 0]}})";
  const Field before = named(parse(F + "," + G + "," + rest), "F");
  const Field after = named(parse(rest + "," + G + "," + F), "F");
  ASSERT_TRUE(before);
  EXPECT_EQ(before.expression(), after.expression());
}

// Words of a rule are no names of fields, and u is the distance in an influence.
TEST(ValueOf, DoesNotTakeItsWordsForNames) {
  const auto scene = parse(
      R"("last": {"value_of": {"partition": {"conflict": "last", "of": [
           {"solid": {"sphere": {"radius": 1}}, "value": 1}, {"solid": {"sphere": {"radius": 2}}, "value": 5}
         ]}}},
         "u": {"value_of": {"inverse_distance": {"features": [
           {"at": {"point": {"at": [0, 0, 0]}}, "value": 1, "influence": "=2 + u"},
           {"at": {"point": {"at": [1, 0, 0]}}, "value": 2}]}}})");
  EXPECT_EQ(value(named(scene, "last"), {0, 0, 0}), 5);
  // Weights 1 / (0.5 * 2.5) and 1 / 0.5.
  EXPECT_NEAR(value(named(scene, "u"), {0.5, 0, 0}), (0.8 + 2 * 2) / 2.8, 1e-15);
}

TEST(ValueOf, IsPartOfCircles) {
  const std::string rule = R"({"value_of": {"ramp": {"field": "=x", "stops": [
      {"at": 0, "value": 1}, {"at": 1, "value": "=G*2"}]}}})";
  const auto found = problems("\"F\": " + rule + ",\n\"G\": {\"offset\": {\"field\": \"F\", " +
                              "\"distance\": 1}}");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].message, "fields name each other in a circle: 'F' -> 'G' -> 'F'");
  EXPECT_EQ(found[0].pointer, "/fields/F");
  EXPECT_EQ(found[0].line, 3);
}

struct Wrong {
  std::string field;
  int line;
  std::string pointer, message;
};

TEST(ValueOf, ErrorsNameTheirPlace) {
  const std::vector<Wrong> all{
      {"{\"value_of\": {}}", 4, "/fields/F/value_of", "'value_of' needs 'rule'"},
      {"{\"value_of\": {\"rul\": 1}}", 4, "/fields/F/value_of/rul",
       "unknown key 'rul'; did you mean 'rule'?"},
      {"{\"value_of\": {\"rule\": {\"inverse_distance\": {\"features\": [\n{\"at\": \"a\"}]}}}}", 5,
       "/fields/F/value_of/rule/inverse_distance/features/0",
       "element 1 of 'features' needs 'value'"},
      {"{\"value_of\": {\n\"inverse_distance\": {\n\"features\": [\n{\"at\": \"aa\", \"value\": "
       "1}]}}}",
       7, "/fields/F/value_of/inverse_distance/features/0/at", "there is no field 'aa'"},
      {"{\"value_of\": {\"inverse_distanc\": {}}}", 4, "/fields/F/value_of/inverse_distanc",
       "there is no rule 'inverse_distanc' here; did you mean 'inverse_distance'?"},
      {"{\"value_of\": {\"constant\": {\"steel\": 1}}}", 4, "/fields/F/value_of/constant",
       "there is no rule 'constant' here"},
      {"{\"value_of\": {\"of_materials\": {\"steel\": 1}}}", 4, "/fields/F/value_of/of_materials",
       "there is no rule 'of_materials' here"},
      {"{\"value_of\": {\"ramp\": {\"field\": \"=x\", \"stops\": [\n{\"at\": 0, \"value\": [1, "
       "2]}]}}}",
       5, "/fields/F/value_of/ramp/stops/0/value", "found 2 components where others have 1"},
      {"{\"value_of\": {\"ramp\": {\"field\": \"=x\", \"stops\": [{\"at\": 2, \"value\": 1},\n"
       "{\"at\": 1, \"value\": 1}]}}}",
       4, "/fields/F/value_of/ramp", "stop 2 is at 1, before the one at 2"},
      {"{\"value_of\": {\"ramp\": {\"field\": \"=x\", \"stops\": [\n{\"at\": 0, \"value\": {\n"
       "\"components\": {\"xx\": 1}}}]}}}",
       6, "/fields/F/value_of/ramp/stops/0/value/components", "there is no rule 'components' here"},
      {"{\"value_of\": true}", 4, "/fields/F/value_of",
       "an object of the parameters of 'value_of'"}};
  for (const Wrong& wrong : all) {
    const auto found = problems("\"a\": \"=x\",\n\"F\": " + wrong.field);
    ASSERT_FALSE(found.empty()) << wrong.field;
    EXPECT_EQ(found[0].line, wrong.line) << wrong.field;
    EXPECT_EQ(found[0].pointer, wrong.pointer) << wrong.field;
    EXPECT_THAT(found[0].message, HasSubstr(wrong.message)) << wrong.field;
    EXPECT_EQ(found[0].file, "t.json");
  }
}

TEST(ValueOf, ShortFormsOfOtherConstructorsNameTheirPlaceToo) {
  const auto found = problems("\"F\": {\"boundary\": \"nothing\"}");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].pointer, "/fields/F/boundary");
}

TEST(ValueOf, IsWrittenSoThatItReadsBack) {
  const auto scene = parse(two_points + R"json(,
      "F": {"value_of": {"rule": {"inverse_distance": {"features": [
        {"at": "a", "value": "=1 - 1.5*a", "exponent": 2, "influence": "=exp(60*u)"},
        {"at": {"boundary": {"solid": {"sphere": {"radius": 7}}}}, "value": {"value_of": {"bands": {
          "field": "b", "bands": [{"width": 1, "value": 1}, {"width": 2, "value": "=b"}]}}}}]}},
        "scale": 20}},
      "G": "=F + (x - 1)*a^2*b", "part": {"offset": {"field": "G", "distance": "=0.5"}})json");
  const std::string text = scene_text(scene);
  const auto again = parse_scene(text, "again.json");
  ASSERT_EQ(again.fields.size(), scene.fields.size()) << text;
  for (size_t i = 0; i < scene.fields.size(); ++i) {
    EXPECT_EQ(again.fields[i].name, scene.fields[i].name);
    EXPECT_EQ(again.fields[i].field.expression(), scene.fields[i].field.expression()) << text;
  }
  EXPECT_EQ(scene_text(again), text);
}

// Fields that are used nowhere but inside a rule, and twice there, get names.
TEST(ValueOf, NamesWhatIsSharedInsideItsRule) {
  const Field ball = make_field("sphere", {Vec3{}, 2.0});
  const Field doubled = make_field("offset", {ball, 1.0});
  const std::map<std::string, Field> names{{"it", doubled}};
  const Fractions rule = parse_value_rule(
      R"({"inverse_distance": {"features": [{"at": "it", "value": "=it + 1"},
          {"at": "it", "value": 2}]}})",
      names);
  SceneDescription scene;
  scene.solid = make_field("value_of", {rule.pointer(), 1.0});
  const auto again = parse_scene(scene_text(scene), "");
  EXPECT_EQ(again.solid.expression(), scene.solid.expression()) << scene_text(scene);
}

TEST(ValueOf, TakesRulesFromText) {
  EXPECT_THROW(parse_value_rule(R"({"inverse_distance": {}})", {}), SceneErrors);
  EXPECT_THROW(parse_value_rule("{", {}), Error);
  EXPECT_THROW(make_field("value_of", {Fractions::material("steel").pointer(), 1.0}), Error);
}

// A long chain of rules inside rules is destroyed without recursion.
TEST(ValueOf, ChainsMayBeLong) {
  Field field = Field::coordinate(0);
  for (int i = 0; i < 50000; ++i) {
    field = make_field("value_of",
                       {Fractions::value({combine(field, '+', Field::number(1))}).pointer(), 1.0});
  }
  EXPECT_EQ(value(field, {2, 0, 0}), 50002);
}

}  // namespace
}  // namespace sardf

// Unit vectors and named components.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "error_of.hpp"
#include "sardf/bake_channels.hpp"
#include "sardf/scene.hpp"
#include "sardf/scene_file.hpp"
#include "sardf/unit_vectors.hpp"

namespace sardf {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string with(const std::string& attributes) {
  return "{\"sardf\": 1, \"solid\": {\"box\": {\"size\": [4, 4, 4]}},\n\"attributes\": {\n" +
         attributes + "}}";
}

Scene scene(const std::string& attributes) {
  return Scene(parse_scene(with(attributes), "t.json"));
}

std::string problem(const std::string& attributes) {
  return error_of([&] { scene(attributes); });
}

Evaluator components(const Scene& of, size_t attribute = 0) {
  std::vector<Expression> all;
  for (const Field& f : of.description().attributes[attribute].components) {
    all.push_back(f.expression());
  }
  return Evaluator(all);
}

Vec3 vector_at(const Scene& of, const Vec3& p) {
  Vec3 v;
  components(of).values(p, v.data());
  return v;
}

// Opposed directions at the ends of a bar: in the middle they cancel.
const std::string opposed = R"({"inverse_distance": {"features": [
    {"at": {"point": {"at": [-1, 0, 0]}}, "value": [0, 2, 0]},
    {"at": {"point": {"at": [1, 0, 0]}}, "value": [0, -2, 0]}]}})";

TEST(UnitVector, HasTheLengthOneEverywhere) {
  const Scene s = scene(R"("grain": {"value": {"inverse_distance": {"features": [
      {"at": {"point": {"at": [-1, 0, 0]}}, "value": [0, 3, 0]},
      {"at": {"point": {"at": [1, 0, 0]}}, "value": ["=1e-20", "=y*1e-20", 0]},
      {"at": {"segment": {"a": [0, 1, 0], "b": [0, 1, 1]}}, "value": ["=x", 0, 1]}]}},
      "unit_vector": true})");
  std::mt19937_64 engine(3);
  std::uniform_real_distribution<double> along(-2, 2);
  const Evaluator evaluator = components(s);
  for (int i = 0; i < 500; ++i) {
    const Vec3 p{along(engine), along(engine), along(engine)};
    Vec3 v;
    evaluator.values(p, v.data());
    EXPECT_NEAR(norm(v), 1, 1e-15);
    const float at[3] = {float(p[0]), float(p[1]), float(p[2])};
    float w[3];
    evaluator.values(at, 1, w);
    EXPECT_NEAR(std::hypot(w[0], w[1], w[2]), 1, 1e-6);
  }
  EXPECT_EQ(vector_at(s, {-1, 0, 0}), (Vec3{0, 1, 0}));
}

TEST(UnitVector, KeepsTheDirectionOfTheSum) {
  const Scene s = scene("\"grain\": {\"value\": " + opposed + ", \"unit_vector\": true}");
  EXPECT_EQ(vector_at(s, {-0.5, 0.7, 0.1}), (Vec3{0, 1, 0}));
  EXPECT_EQ(vector_at(s, {1e-9, 0.7, 0.1}), (Vec3{0, -1, 0}));
}

TEST(UnitVector, FallsBackWhereTheSumVanishes) {
  const Scene usual = scene("\"grain\": {\"value\": " + opposed + ", \"unit_vector\": true}");
  EXPECT_EQ(vector_at(usual, {0, 0, 0}), (Vec3{0, 0, 1}));
  EXPECT_EQ(vector_at(usual, {0, 1.5, -1}), (Vec3{0, 0, 1}));
  const Scene stated = scene("\"grain\": {\"value\": " + opposed +
                             ", \"unit_vector\": true, \"fallback\": [3, 0, 4]}");
  EXPECT_LT(norm(vector_at(stated, {0, 0, 0}) - Vec3{0.6, 0, 0.8}), 1e-15);
  // What counts is the size of what is prescribed: small vectors have a direction, too.
  const Scene small = scene(R"("grain": {"value": ["=1e-30*x", 0, 0], "unit_vector": true})");
  EXPECT_EQ(vector_at(small, {-1, 0, 0}), (Vec3{-1, 0, 0}));
  EXPECT_EQ(vector_at(small, {0, 0, 0}), (Vec3{0, 0, 1}));
}

TEST(UnitVector, HasNoGradientThatIsNaN) {
  const Scene s = scene("\"grain\": {\"value\": " + opposed + ", \"unit_vector\": true}");
  for (const Field& f : s.description().attributes[0].components) {
    for (const Vec3& p : {Vec3{0, 0, 0}, Vec3{0.3, 0.2, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}}) {
      Vec3 gradient;
      Evaluator(f.expression()).gradients(p.data(), 1, nullptr, gradient.data());
      EXPECT_TRUE(std::isfinite(norm(gradient))) << p[0] << " " << p[1];
    }
  }
}

TEST(UnitVector, IsOfThreeComponents) {
  EXPECT_EQ(problem("\"grain\": {\"value\": [1, 2],\n\"unit_vector\": true}"),
            "t.json:3: /attributes/grain: a unit vector has 3 components; the value has 2");
  EXPECT_EQ(problem("\"grain\": {\"value\": [1, 2, 3],\n\"fallback\": [1, 0, 0]}"),
            "t.json:4: /attributes/grain/fallback: a fallback needs \"unit_vector\": true");
  EXPECT_THAT(problem("\"grain\": {\"value\": [1, 2, 3], \"unit_vector\": true, \"fallback\": [0, "
                      "0, 0]}"),
              HasSubstr("/attributes/grain/fallback: fallback is the zero vector"));
  EXPECT_THAT(problem("\"grain\": {\"value\": [1, 2, 3], \"unit_vector\": 1}"),
              HasSubstr("/attributes/grain/unit_vector: found the number 1; true or false"));
}

const std::string stress = R"("stress": {"unit": "MPa", "value": {"inverse_distance": {"features": [
    {"at": {"point": {"at": [-1, 0, 0]}}, "value": {"components": {"xx": 1, "yy": "=2*y", "xy": 3}}},
    {"at": {"point": {"at": [1, 0, 0]}}, "value": {"components": {"xy": 0, "xx": 5, "yy": 7}}}]}}})";

TEST(NamedComponents, AreInterpolatedByName) {
  const Scene s = scene(stress);
  const Attribute& attribute = s.description().attributes[0];
  EXPECT_THAT(attribute.component_names, ElementsAre("xx", "yy", "xy"));
  double at[3];
  components(s).values({0, 1, 0}, at);
  EXPECT_NEAR(at[0], 3, 1e-15);
  EXPECT_NEAR(at[1], 4.5, 1e-15);
  EXPECT_NEAR(at[2], 1.5, 1e-15);
}

TEST(NamedComponents, NameColumnsAndImages) {
  const Scene s = scene(stress + R"(, "flow": ["=x", "=y", 0], "heat": 3)");
  const auto& all = s.description().attributes;
  EXPECT_EQ(all[0].column(2, 3), "stress_xy");
  EXPECT_EQ(all[1].column(1, 3), "flow_y");
  EXPECT_EQ(all[2].column(0, 1), "heat");
  const auto channels = scene_channels(s, {"stress", "flow", "heat"});
  std::vector<std::string> names;
  for (const BakeChannel& channel : channels) names.push_back(channel.name);
  EXPECT_THAT(names, ElementsAre("stress_xx", "stress_yy", "stress_xy", "flow", "heat"));
  EXPECT_EQ(channels[0].components.size(), 1u);
  EXPECT_EQ(channels[3].components.size(), 3u);
  EXPECT_THAT(problem(stress + R"(, "stress_xy": 1)"),
              HasSubstr("a component of 'stress' would be called 'stress_xy', as something else"));
}

TEST(NamedComponents, MustAgree) {
  const auto mixed = [](const std::string& second) {
    return problem(
        "\"s\": {\"value\": {\"ramp\": {\"field\": \"=x\", \"stops\": [{\"at\": 0, "
        "\"value\": {\"components\": {\"xx\": 1, \"yy\": 2}}},\n{\"at\": 1, \"value\": " +
        second + "}]}}}");
  };
  EXPECT_EQ(mixed("{\"components\": {\"xx\": 1, \"zz\": 2}}"),
            "t.json:4: /attributes/s/value/ramp/stops/1/value/components: found the components xx, "
            "zz where others are xx, yy");
  EXPECT_THAT(mixed("[1, 2]"), HasSubstr("found a component without a name where others have the "
                                         "names xx, yy"));
  EXPECT_THAT(problem(R"("s": {"value": {"ramp": {"field": "=x", "stops": [{"at": 0,
                  "value": [1, 2]}, {"at": 1, "value": {"components": {"a": 1, "b": 2}}}]}}})"),
              HasSubstr("found the components a, b where others are without names"));
  EXPECT_THAT(problem(R"("s": {"value": {"components": {"x-x": 1}}})"),
              HasSubstr("'x-x' cannot name a component; letters, digits and _ are accepted"));
  EXPECT_THAT(problem(R"("s": {"value": {"components": {}}})"),
              HasSubstr("/attributes/s/value/components"));
}

TEST(Attributes, AreWrittenSoThatTheyReadBack) {
  const auto before =
      parse_scene(with(stress + R"(, "grain": {"value": )" + opposed +
                       R"(, "unit_vector": true, "fallback": "x"}, "plain": {"value": {"components":
                       {"x": "=x", "z": 2}}})"),
                  "");
  const std::string text = scene_text(before);
  const auto after = parse_scene(text, "");
  EXPECT_EQ(scene_text(after), text);
  const Scene first(before), second(after);
  for (size_t i = 0; i < 3; ++i) {
    const Attribute &a = first.description().attributes[i], &b = second.description().attributes[i];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.component_names, b.component_names);
    ASSERT_EQ(a.components.size(), b.components.size());
    for (size_t c = 0; c < a.components.size(); ++c) {
      EXPECT_EQ(a.components[c].expression(), b.components[c].expression()) << text;
    }
  }
  EXPECT_THAT(text, HasSubstr("\"fallback\": \"x\""));
}

TEST(Attributes, HaveTheirWordsInTheSchema) {
  const std::string text = scene_schema();
  for (const char* word : {"unit_vector", "fallback", "components", "functions", "value_of"}) {
    EXPECT_THAT(text, HasSubstr("\"" + std::string(word) + "\""));
  }
}

}  // namespace
}  // namespace sardf

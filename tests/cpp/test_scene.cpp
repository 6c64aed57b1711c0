#include "sardf/scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "sardf/constructor.hpp"
#include "sardf/error.hpp"
#include "sardf/formula.hpp"

namespace sardf {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pointwise;

Field ball(const Vec3& center, double radius) { return make_field("sphere", {center, radius}); }
Field half_space(const Vec3& point, const Vec3& normal) {
  return make_field("half_space", {point, normal});
}
Field formula(const std::string& text) { return parse_formula(text, {}, {}); }

double at(const Expression& e, const Vec3& p) { return Evaluator(e).value(p); }

SceneDescription two_materials() {
  SceneDescription scene;
  scene.solid = ball({1, 2, 3}, 2);
  scene.materials.resize(2);
  scene.materials[0].name = "red";
  scene.materials[0].color = {1, 0, 0};
  scene.materials[0].roughness = 0.2;
  scene.materials[1].name = "blue";
  scene.materials[1].color = {0, 0.25, 1};
  scene.materials[1].emission = {0, 0, 8};
  const std::vector<Record> stops{{{0.0, Fractions::material("red")}},
                                  {{2.0, Fractions::material("blue")}}};
  scene.fractions = make_fractions("ramp", {Field::coordinate(0), stops});
  return scene;
}

std::string problem(SceneDescription scene) {
  try {
    Scene made(std::move(scene));
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Scene, HasCertifiedBounds) {
  const Scene scene(two_materials());
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LE(scene.bounds().lo[axis], axis - 1);
    EXPECT_GE(scene.bounds().lo[axis], axis - 1 - 0.01);
    EXPECT_GE(scene.bounds().hi[axis], axis + 3);
    EXPECT_LE(scene.bounds().hi[axis], axis + 3 + 0.01);
  }
}

TEST(Scene, AveragesMaterials) {
  const Scene scene(two_materials());
  const Vec3 p{0.5, 2, 3};
  EXPECT_THAT(scene.material_names(), ElementsAre("red", "blue"));
  EXPECT_EQ(at(scene.base_color()[0], p), 0.75);
  EXPECT_EQ(at(scene.base_color()[1], p), 0.0625);
  EXPECT_EQ(at(scene.base_color()[2], p), 0.25);
  EXPECT_EQ(at(scene.emission()[2], p), 2);
  EXPECT_DOUBLE_EQ(at(scene.roughness(), p), 0.275);
  EXPECT_EQ(scene.metallic(), constant(0));
}

TEST(Scene, GivesFractionsAtPoints) {
  const Scene scene(two_materials());
  const double points[] = {0.5, 2, 3, 50, 0, 0, -7, 1, 1};
  double w[6];
  scene.fractions_at(points, 3, w);
  EXPECT_THAT(w, Pointwise(testing::DoubleEq(), {0.75, 0.25, 0.0, 1.0, 1.0, 0.0}));
  scene.fractions_at(points, 3, w, true);
  EXPECT_EQ(w[0], 0.75);
  for (int i = 2; i < 6; ++i) EXPECT_TRUE(std::isnan(w[i]));
}

TEST(Scene, IsMadeOfTheFirstMaterialUnlessToldOtherwise) {
  SceneDescription plain;
  plain.solid = ball({}, 1);
  const Scene scene(plain);
  EXPECT_EQ(scene.material_names().size(), 1u);
  EXPECT_EQ(scene.fractions()[0], constant(1));
  EXPECT_EQ(scene.drawn(), scene.solid());
  EXPECT_EQ(scene.removed(), nullptr);
}

TEST(Scene, IsCutOpen) {
  SceneDescription cut = two_materials();
  cut.solid = ball({}, 2);
  cut.sections = {{half_space({}, {1, 0, 0}), {ball({1, 0, 0}, 0.5)}},
                  {half_space({}, {0, 0, 1}), {}}};
  const Scene scene(cut), whole([&] {
    SceneDescription same = cut;
    same.sections.clear();
    return same;
  }());
  EXPECT_GT(at(scene.drawn(), {-1, 0, -1}), 0);
  EXPECT_LT(at(scene.drawn(), {1.6, 0, -0.1}), 0);  // removed by the first
  EXPECT_GT(at(scene.drawn(), {1.2, 0, -0.1}), 0);  // kept by the first
  EXPECT_LT(at(scene.drawn(), {1.2, 0, 0.1}), 0);   // but removed by the second
  EXPECT_GT(at(scene.removed(), {1.6, 0, -0.1}), 0);
  EXPECT_LT(at(scene.removed(), {1.2, 0, -0.1}), 0);
  EXPECT_EQ(at(scene.removed(), {0, 0.5, -0.5}), 0);  // on a cap
  // A cut changes neither bounds nor fractions.
  EXPECT_EQ(scene.bounds().lo, whole.bounds().lo);
  EXPECT_EQ(scene.fractions(), whole.fractions());
}

TEST(Scene, MakesAttributesByRules) {
  SceneDescription scene = two_materials();
  const std::vector<Record> stops{{{0.0, Fractions::value({formula("1"), formula("y")})}},
                                  {{2.0, Fractions::value({formula("3"), formula("0")})}}};
  scene.attributes.push_back({"grain", "", {}, {}, 1, {}, false, {0, 0, 1}});
  scene.attributes[0].rule = make_fractions("ramp", {Field::coordinate(0), stops});
  scene.attributes[0].rule_components = 2;
  const MaterialFunctions index{{"red", formula("1.5")}, {"blue", formula("2.5")}};
  scene.attributes.push_back(
      {"index", "", {}, make_fractions("of_materials", {index}), 1, {}, false, {0, 0, 1}});
  const Scene made(scene);
  const auto& attributes = made.description().attributes;
  EXPECT_EQ(at(attributes[0].components[0].expression(), {1, 4, 0}), 2);
  EXPECT_EQ(at(attributes[0].components[1].expression(), {1, 4, 0}), 2);
  EXPECT_EQ(at(attributes[1].components[0].expression(), {0.5, 0, 0}), 1.75);
}

TEST(Scene, SaysWhatIsWrong) {
  SceneDescription scene = two_materials();
  scene.solid = Field();
  EXPECT_EQ(problem(scene), "the scene has no solid");
  scene = two_materials();
  scene.materials[1].name = "red";
  EXPECT_THAT(problem(scene), HasSubstr("two materials named 'red'"));
  scene = two_materials();
  scene.materials[1].name = "green";
  EXPECT_THAT(problem(scene), HasSubstr("there is no material 'blue'"));
  scene = two_materials();
  scene.units = "inches";
  EXPECT_THAT(problem(scene), HasSubstr("accepted are um, mm, cm, m and in"));
  scene = two_materials();
  scene.solid = half_space({}, {0, 0, 1});
  scene.source = {"part.json", {{"/solid", 7}}, {}};
  EXPECT_THAT(problem(scene), testing::StartsWith("part.json:7: /solid: "));
  scene = two_materials();
  const MaterialFunctions some{{"red", formula("x - 1")}};
  scene.fractions = make_fractions("formulas", {some});
  EXPECT_THAT(problem(scene), HasSubstr("fractions cannot be normalised at ("));
  // Where the sum is not positive only outside of the solid, the scene stands, but not the point.
  const MaterialFunctions most{{"red", formula("x + 1.5")}};
  scene.fractions = make_fractions("formulas", {most});
  const Scene made(scene);
  const double far_away[] = {-9, 0, 0};
  double w[2];
  EXPECT_THROW(made.fractions_at(far_away, 1, w), Error);
  EXPECT_EQ(metres_per_unit("in"), 0.0254);
}

}  // namespace
}  // namespace sardf

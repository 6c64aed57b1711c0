// The text of OSL shaders; what it computes is compared in Cycles
// (tests/python/test_blender_osl.py).
#include "sardf/osl_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "error_of.hpp"
#include "sardf/scene_file.hpp"

namespace sardf::test {
namespace {

using testing::HasSubstr;

Scene scene_of(const std::string& attributes) {
  return Scene(parse_scene(R"({"sardf": 1, "fields": {"ball": {"sphere": {"radius": 2}},
    "vein": {"bspline_curve": {"control_points": [[0, 0, 0], [1, 2, 0], [2, -2, 1], [3, 0, 0]]}}},
    "solid": "ball", "materials": {"red": {"color": [1, 0, 0]}, "a b": {}},
    "fractions": {"inverse_distance": {"features": [
      {"at": {"point": {"at": [-1, 0, 0]}}, "material": "red"},
      {"at": {"point": {"at": [1, 0, 0]}}, "material": "a b"}]}},
    "attributes": {)" + attributes +
                               "}}",
                           ""));
}

TEST(OslText, EachOperationIsOneFunctionOfLocalVariables) {
  const OslShader shader = osl_shader(scene_of(R"("s": "=2*x + 2*y + 2*x")"), {"s"});
  EXPECT_THAT(shader.text, HasSubstr("point p = transform(\"object\", P);"));
  EXPECT_THAT(shader.text, HasSubstr("output float s = 0"));
  const std::string head = "float sardf_multiply_";
  size_t declared = 0;
  for (size_t at = shader.text.find(head); at != std::string::npos;
       at = shader.text.find(head, at + 1))
    ++declared;
  EXPECT_EQ(declared, 1u);
}

TEST(OslText, NumbersAreFloatsAndNeverInfinite) {
  const OslShader shader = osl_shader(scene_of(R"("s": "=x + 1e300 - 1/3*y")"), {"s"});
  EXPECT_THAT(shader.text, HasSubstr("3.4e+38"));
  EXPECT_THAT(shader.text, HasSubstr("0.33333334"));
  EXPECT_THAT(shader.text, testing::Not(HasSubstr("inf")));
}

TEST(OslText, OutputsAreColorsFractionsAndComponents) {
  const Scene scene = scene_of(R"("v": ["=x", 1, 2], "color": "=z")");
  const OslShader shader = osl_shader(scene, {"base_color", "fractions", "v", "color"});
  std::vector<std::string> names, meanings;
  for (const OslOutput& output : shader.outputs) {
    names.push_back(output.name);
    meanings.push_back(output.meaning);
  }
  EXPECT_THAT(names, testing::ElementsAre("base_color", "fraction_red", "fraction_a_b", "v_1",
                                          "v_2", "v_3", "color_2"));
  EXPECT_THAT(meanings,
              testing::ElementsAre("base_color", "red", "a b", "v_1", "v_2", "v_3", "color"));
  EXPECT_TRUE(shader.outputs[0].is_color);
  EXPECT_FALSE(shader.outputs[1].is_color);
}

TEST(OslText, WhatHasNoFormulaIsNamed) {
  EXPECT_THAT(error_of([] { osl_shader(scene_of(R"("s": "vein")"), {"s"}); }),
              HasSubstr("'bspline_curve' has no formula that OSL could evaluate"));
  EXPECT_THAT(error_of([] { osl_shader(scene_of(R"("s": 1)"), {"normal"}); }),
              HasSubstr("'normal' is no channel of a shader"));
  EXPECT_THAT(error_of([] { osl_shader(scene_of(R"("s": 1)"), {"bas_color"}); }),
              HasSubstr("did you mean 'base_color'"));
}

}  // namespace
}  // namespace sardf::test

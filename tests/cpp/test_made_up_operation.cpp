// Adding an operation touches one place: made_up_operation.hpp adds a solid and a function, and
// here they are found in everything that is derived from the list; Python's side is
// tests/python/test_made_up_operation.py.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "made_up_operation.hpp"
#include "povray_gen/function_printer.hpp"
#include "povray_harness.hpp"
#include "sardf/document.hpp"
#include "sardf/evaluate.hpp"
#include "sardf/scene_file.hpp"

namespace sardf {
namespace {

class MadeUpOperation : public testing::Test {
 protected:
  MadeUpOperation() : evaluator_(make_field(pear(), {Vec3{1, 0, 0}, 2.0, 0.5}).expression()) {}
  // At (1, 3, 4) from the centre (1, 0, 0): 2 - 0.5 * 4 - 5.
  static constexpr double value = -5;
  const Vec3 at_{1, 3, 4};
  Evaluator evaluator_;
};

TEST_F(MadeUpOperation, IsInTheRegistryWithItsParameters) {
  const auto named = [](const Constructor& c) { return c.name == "pear"; };
  EXPECT_EQ(std::ranges::count_if(constructors(), named), 1);
  EXPECT_EQ(pear().group, "solid");
  EXPECT_EQ(pear().doc, Pear::doc);
  ASSERT_EQ(pear().parameters.size(), 3u);
  EXPECT_EQ(pear().parameters[0].type, ParameterType::vector3);
  EXPECT_TRUE(pear().parameters[1].required);
  EXPECT_EQ(pear().parameters[2].name, "taper");
  EXPECT_EQ(std::get<double>(pear().parameters[2].default_value), 0.25);
  EXPECT_THROW(make_field(pear(), {Vec3{}, -1.0, 0.5}), Error);
  EXPECT_THROW(add_constructor(constructor_of_operation<Pear>()), Error);
}

TEST_F(MadeUpOperation, EvaluatesInDoubleAndFloat) {
  EXPECT_DOUBLE_EQ(evaluator_.value(at_), value);
  std::vector<float> points, out(100);
  for (int i = 0; i < 100; ++i) points.insert(points.end(), {1, 3, 4});
  evaluator_.values(points.data(), out.size(), out.data());
  for (float result : out) EXPECT_FLOAT_EQ(result, float(value));
}

TEST_F(MadeUpOperation, HasBoundsAndGradients) {
  const Interval bound = evaluator_.interval({{0, 2, 3}, {2, 4, 5}});
  EXPECT_TRUE(bound.contains(value));
  EXPECT_GT(bound.lo, -20);
  double gradient[3];
  evaluator_.gradients(at_.data(), 1, nullptr, gradient);
  EXPECT_DOUBLE_EQ(gradient[0], 0);
  EXPECT_DOUBLE_EQ(gradient[1], -0.6);
  EXPECT_DOUBLE_EQ(gradient[2], -0.5 - 0.8);
  EXPECT_GE(evaluator_.slope({{0, 2, 3}, {2, 4, 5}}).length, std::hypot(0.6, 1.3));
}

TEST_F(MadeUpOperation, RecordsItsFormula) {
  const OperationPointer operation = make_operation(Pear{});
  Trace trace(3);
  operation->record(trace);
  ASSERT_GE(trace.result, 0);
  EXPECT_EQ(trace[trace.result].name, "-");
  const auto is_root = [](const TraceStep& step) { return step.name == "sqrt"; };
  EXPECT_EQ(std::ranges::count_if(trace.steps(), is_root), 1);
}

TEST_F(MadeUpOperation, IsPovrayText) {
  povray::Names names("made up");
  povray::FunctionPrinter printer(names);
  povray::Terms terms;
  std::vector<int> inputs;
  for (int i = 0; i < 3; ++i) inputs.push_back(terms.input(i));
  Trace trace(3);
  make_operation(Pear{{1, 0, 0}, 2, 0.5})->record(trace);
  const std::string name = names.numbered("pear");
  printer.declare(name, terms, terms.append(trace, inputs), 3, povray::InputNames::parameters);
  const std::vector<double> values = evaluate_in_povray(printer.text(), {{name, {1, 3, 4}}});
  EXPECT_NEAR(values.at(0), value, 1e-12);
}

TEST_F(MadeUpOperation, FunctionIsAWordOfFormulas) {
  EXPECT_EQ(std::ranges::count(function_names(), "wobble"), 1);
  const Expression wobble = function("wobble", {coordinate(0), coordinate(1)});
  EXPECT_DOUBLE_EQ(Evaluator(wobble).value({1, 0.5, 0}), std::sin(1) * std::exp(-0.25));
  const Interval bound = Evaluator(wobble).interval({{0, -1, 0}, {1, 1, 0}});
  EXPECT_TRUE(bound.contains(std::sin(1)));
  EXPECT_LE(bound.hi, 1);
  EXPECT_THROW(add_function(make_operation(Wobble{})), Error);
}

TEST_F(MadeUpOperation, IsAKeyOfSceneFiles) {
  const SceneDescription scene = parse_scene(R"json({
    "sardf": 1,
    "fields": {"fruit": {"pear": {"radius": 2, "center": [1, 0, 0], "taper": 0.5}},
               "bitten": "=wobble(fruit, x)"},
    "solid": "fruit"
})json",
                                             "pear.json");
  EXPECT_DOUBLE_EQ(Evaluator(scene.solid.expression()).value(at_), value);
  EXPECT_EQ(scene.solid.expression(),
            parse_scene(scene_text(scene), "again.json").solid.expression());
  const auto wrong = [] {
    parse_scene(R"({"sardf": 1, "solid": {"pear": {"radius": -2}}})", "pear.json");
  };
  EXPECT_THROW(wrong(), SceneErrors);
}

TEST_F(MadeUpOperation, IsInTheSchemaAndTheDocument) {
  const std::string schema = nlohmann::json::parse(scene_schema()).dump();
  EXPECT_NE(schema.find("\"pear\""), std::string::npos);
  EXPECT_NE(schema.find(Pear::doc), std::string::npos);
  EXPECT_NE(schema.find("\"taper\""), std::string::npos);
  const std::string document = operations_document();
  EXPECT_NE(document.find("pear"), std::string::npos);
  EXPECT_NE(document.find(Pear::doc), std::string::npos);
  EXPECT_NE(document.find("wobble"), std::string::npos);
}

}  // namespace
}  // namespace sardf

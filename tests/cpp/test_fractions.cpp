#include "sardf/fractions.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "golden.hpp"
#include "sardf/constructor.hpp"
#include "sardf/error.hpp"
#include "sardf/evaluate.hpp"
#include "sardf/formula.hpp"

namespace sardf {
namespace {

using testing::HasSubstr;

const std::vector<std::string> three{"a", "b", "c"};

Fractions of(const char* material) { return Fractions::material(material); }

Field formula(const std::string& text, const std::map<std::string, Field>& names = {}) {
  return parse_formula(text, names, {});
}

std::string numbered(const char* name, int place) {
  return std::string(name).append(std::to_string(place + 1));
}

Field ball(const Vec3& center, double radius) { return make_field("sphere", {center, radius}); }

Field block(const Vec3& center, const Vec3& half) {
  return make_field("box", {center, 2.0 * half});
}

// A feature of inverse_distance: where, what, exponent, influence.
Record feature(const Field& at, const Fractions& what, double exponent = 1,
               const RuleValue& influence = {}) {
  return {{at, what, exponent, influence}};
}

std::vector<double> at(const std::vector<Expression>& outputs, const Vec3& p) {
  std::vector<double> out(outputs.size());
  Evaluator(outputs).values(p, out.data());
  return out;
}

std::string problem(const char* rule, std::vector<RuleValue> arguments) {
  try {
    make_fractions(rule, std::move(arguments));
  } catch (const Error& error) {
    return error.message;
  }
  return "";
}

// The distances are the coordinates: u = (x, y, z).
Fractions weights(const std::vector<double>& k, const std::vector<double>& lambda) {
  std::vector<Record> features;
  for (size_t i = 0; i < 3; ++i) {
    const RuleValue influence = lambda[i] == 1 ? RuleValue{} : RuleValue{Field::number(lambda[i])};
    features.push_back(feature(Field::coordinate(int(i)), of(three[i].c_str()), k[i], influence));
  }
  return make_fractions("inverse_distance", {features});
}

using GoldenFractions = golden::InEachFolder;

TEST_P(GoldenFractions, WeighByInverseDistanceAsTheGoldenValues) {
  const golden::Table table = read("bst_weights");
  const std::vector<double> k = table.parameter("k"), lambda = table.parameter("lambda");
  const std::vector<double> ones(3, 1.0);
  const std::vector<std::pair<std::string, Fractions>> cases{{"k1", weights(ones, ones)},
                                                             {"k2", weights({2, 2, 2}, ones)},
                                                             {"mixed", weights(k, ones)},
                                                             {"lam", weights(ones, lambda)}};
  for (const auto& [tag, rule] : cases) {
    const Evaluator evaluator(lower(rule, three, 1.0));
    for (const std::vector<double>& row : table.rows) {
      double w[3];
      evaluator.values(Vec3{row[0], row[1], row[2]}, w);
      for (int i = 0; i < 3; ++i) {
        const size_t column = table.column(numbered("W", i) + "_" + tag);
        EXPECT_NEAR(w[i], row[column], table.tolerance()) << tag << " " << row[0];
      }
    }
  }
}

TEST_P(GoldenFractions, HaveTheGoldenDerivatives) {
  const golden::Table table = read("bst_weights");
  const Fractions rule = weights(table.parameter("k"), table.parameter("lambda"));
  const std::vector<Expression> lowered = lower(rule, three, 1.0);
  for (int i = 0; i < 3; ++i) {
    const Evaluator evaluator(lowered[i]);
    for (const std::vector<double>& row : table.rows) {
      double value, gradient[3];
      evaluator.gradients(row.data(), 1, &value, gradient);
      for (int j = 0; j < 3; ++j) {
        const double expected = row[table.column(numbered("dW", i) + numbered("_du", j))];
        if (std::isnan(expected)) continue;
        EXPECT_NEAR(gradient[j], expected, 1e-11 * std::max(1.0, std::abs(expected)));
      }
    }
  }
}

TEST_P(GoldenFractions, AreThoseOfTheCutter) {
  const golden::Table table = read("fig_bst_01_cutter");
  const auto flat = [&](const char* c, const char* h) {
    const Vec2 center = table.parameter(c), half = table.parameter(h);
    return make_field("box2d", {center, Vec2{2 * half[0], 2 * half[1]}});
  };
  const std::vector<std::string> names{"sic", "diamond"};
  const Fractions chip = make_fractions("constant", {Shares{{"sic", 0.2}, {"diamond", 0.8}}});
  const Fractions rule = make_fractions(
      "inverse_distance",
      {std::vector<Record>{feature(flat("chip_c", "chip_h"), chip),
                           feature(flat("shank_c", "shank_h"), Fractions::material("sic"))}});
  const std::vector<Expression> lowered = lower(rule, names, 1.0);
  for (const std::vector<double>& row : table.rows) {
    const std::vector<double> w = at(lowered, {row[0], row[1], 0});
    EXPECT_NEAR(w[0], row[table.column("sic")], table.tolerance());
    EXPECT_NEAR(w[1], row[table.column("diamond")], table.tolerance());
  }
}

INSTANTIATE_TEST_SUITE_P(Each, GoldenFractions, golden::each_folder(), golden::folder_name);

// u1 = x, u2 = y. Influences and material functions as printed in Figs. 11 and 15 of Biswas,
// Shapiro, Tsukanov 2004; values from an independent implementation.
TEST(Fractions, TakeInfluencesThatDependOnTheDistance) {
  const Field x = Field::coordinate(0), y = Field::coordinate(1);
  const auto function = [](const char* a, const char* b) {
    const MaterialFunctions all{{"a", formula(a)},
                                {"b", formula(b)},
                                {"c", formula("1 - (" + std::string(a) + ") - (" + b + ")")}};
    return make_fractions("formulas", {all});
  };
  const Fractions at_x = function("0.5*exp(-x^2)", "0.25");
  const Fractions at_y = function("0.1*(1 - 0.1*y^2)", "0.5*exp(-y^2)");
  const std::vector<Record> plain{feature(x, at_x), feature(y, at_y)};
  const std::vector<Record> influenced{
      feature(x, at_x, 1, formula("0.1 + 10*exp(-5*u^2)", {{"u", x}})),
      feature(y, at_y, 1, formula("0.5 + exp(-u^2/2)", {{"u", y}}))};
  const auto a = at(lower(make_fractions("inverse_distance", {plain}), three, 1.0), {1, 0.5, 0});
  const auto b =
      at(lower(make_fractions("inverse_distance", {influenced}), three, 1.0), {1, 0.5, 0});
  const double expected_a[] = {.12631324, .34293359, .53075317};
  const double expected_b[] = {.16708931, .27717448, .55573622};
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(a[i], expected_a[i], 1e-8);
    EXPECT_NEAR(b[i], expected_b[i], 1e-8);
  }
  const std::vector<Record> steep{
      feature(x, Fractions::value({formula("1")}), 1, formula("exp(60*u)", {{"u", x}})),
      feature(y, Fractions::value({formula("0.5*exp(-y^2)")}))};
  const auto value = lower(make_fractions("inverse_distance", {steep}), {three, 1.0, 1, {}});
  EXPECT_NEAR(at(value, {0.1, 1, 0})[0], 0.2036785557190951, 1e-14);
  EXPECT_NEAR(at(value, {1e5, 1, 0})[0], 0.5 * std::exp(-1), 1e-14);
  // Both influences overflow here; their ratio is e^-20.
  const std::vector<Record> huge{feature(x, of("a"), 1, formula("exp(60*u)", {{"u", x}})),
                                 feature(y, of("b"), 1, formula("2*exp(59*u)", {{"u", y}}))};
  const auto shares = lower(make_fractions("inverse_distance", {huge}), three, 1.0);
  EXPECT_NEAR(at(shares, {20, 20, 0})[0], 2 * std::exp(-20), 1e-16);
}

// One of each rule, with features that meet each other and with solids that share faces.
std::vector<std::pair<std::string, Fractions>> samples() {
  const Field ray = make_field("segment", {Vec3{}, Vec3{5, 0, 0}});
  const Field other = make_field("segment", {Vec3{}, Vec3{0, 5, 0}});
  const Field left = block({-2, 0, 0}, {2, 1, 1}), right = block({2, 0, 0}, {2, 1, 1});
  const Field whole = block({}, {4, 1, 1});
  const Fractions mixed = make_fractions("constant", {Shares{{"a", 0.3}, {"c", 0.7}}});
  const Field steep = formula("exp(60*u)", {{"u", ray}});
  const Field steeper = formula("3*exp(60*u)", {{"u", other}});
  const Field x = Field::coordinate(0);
  const auto parts = [&](const Field& last) {
    return std::vector<Record>{{{left, of("a")}}, {{right, mixed}}, {{last, of("c")}}};
  };
  const std::vector<Record> stops{
      {{-1.0, of("a")}}, {{0.3, mixed}}, {{0.3, of("b")}}, {{1.7, of("c")}}};
  const std::vector<Record> bands{{{0.7, of("a")}}, {{0.4, of("b")}}, {{1.1, mixed}}};
  const Fractions ramp = make_fractions("ramp", {x, stops});
  const std::vector<Record> plain{feature(ray, of("a")), feature(other, mixed, 2),
                                  feature(ball({1, 1, 1}, 0.5), ramp, 3)};
  const std::vector<Record> influenced{feature(ray, of("a"), 1, steep),
                                       feature(other, of("b"), 1, steeper),
                                       feature(whole, of("c"), 1, formula("x"))};
  const MaterialFunctions functions{{"a", formula("1 + sin(9*x)")}, {"c", formula("0.01 + y*y")}};
  return {
      {"constant", mixed},
      {"inverse_distance", make_fractions("inverse_distance", {plain})},
      {"influence", make_fractions("inverse_distance", {influenced})},
      {"one feature", make_fractions("inverse_distance", {std::vector{plain[0]}})},
      {"blend_between",
       make_fractions("blend_between", {std::vector<Record>{{{left, of("a")}}, {{right, mixed}}}})},
      {"ramp", ramp},
      {"bands", make_fractions("bands", {x, bands, 0.2, 0.0})},
      {"soft bands", make_fractions("bands", {x, bands, 0.2, 0.4})},
      {"formulas", make_fractions("formulas", {functions})},
      {"partition", make_fractions("partition", {parts(whole), 0.0})},
      {"soft partition", make_fractions("partition", {parts(ball({0, 9, 0}, 1)), 0.5})}};
}

std::vector<Vec3> places() {
  std::vector<Vec3> all{{0, 0, 0},       {1, 0, 0},   {0, 1, 0},        {1e-13, 0, 0},
                        {1e-7, 1e-7, 0}, {4, 1, 1},   {4 + 1e-7, 0, 0}, {0, 1 + 1e-6, 0},
                        {0.3, 0, 0},     {1.7, 2, 3}, {1e7, 0, 0},      {-1e7, 1e7, 3e6},
                        {0, 0, -1e7}};
  std::mt19937 random(5);
  std::uniform_real_distribution<double> coordinate(-5, 5);
  for (int i = 0; i < 2000; ++i) {
    const double x = coordinate(random), y = coordinate(random), z = coordinate(random);
    all.push_back({x, y, z});
  }
  return all;
}

TEST(Fractions, SumToOneEverywhere) {
  const std::vector<Vec3> points = places();
  const size_t n = points.size();
  std::vector<float> rough;
  for (const Vec3& p : points) rough.insert(rough.end(), {float(p[0]), float(p[1]), float(p[2])});
  for (const auto& [name, rule] : samples()) {
    const Evaluator evaluator(lower(rule, three, 10.0));
    std::vector<double> exact(3 * n);
    std::vector<float> fast(3 * n);
    evaluator.values(points[0].data(), n, exact.data());
    evaluator.values(rough.data(), n, fast.data());
    for (size_t i = 0; i < n; ++i) {
      const double* w = &exact[3 * i];
      const float* v = &fast[3 * i];
      EXPECT_NEAR(w[0] + w[1] + w[2], 1, 1e-12) << name << " at " << i;
      EXPECT_NEAR(double(v[0]) + double(v[1]) + double(v[2]), 1, 1e-6) << name << " at " << i;
      EXPECT_GE(std::min({w[0], w[1], w[2]}), 0) << name << " at " << i;
      EXPECT_GE(std::min({v[0], v[1], v[2]}), 0) << name << " at " << i;
    }
  }
}

TEST(Fractions, AreSharedEvenlyWhereFeaturesMeet) {
  const std::vector<Record> features{
      feature(make_field("segment", {Vec3{}, Vec3{5, 0, 0}}), of("a"), 3),
      feature(make_field("segment", {Vec3{}, Vec3{0, 5, 0}}), of("b"), 1, Field::number(40)),
      feature(make_field("point", {Vec3{0, 0, 2}}), of("c"))};
  const std::vector<Expression> lowered =
      lower(make_fractions("inverse_distance", {features}), three, 10.0);
  EXPECT_EQ(at(lowered, {0, 0, 0}), (std::vector<double>{0.5, 0.5, 0}));
  EXPECT_EQ(at(lowered, {0, 0, 5e-12}), (std::vector<double>{0.5, 0.5, 0}));
  EXPECT_EQ(at(lowered, {2, 0, 0}), (std::vector<double>{1, 0, 0}));
}

TEST(Fractions, FollowFieldsInRampsAndBands) {
  const Field x = Field::coordinate(0);
  const std::vector<Record> stops{
      {{0.0, of("a")}}, {{2.0, of("b")}}, {{2.0, of("c")}}, {{4.0, of("a")}}};
  const auto ramp = lower(make_fractions("ramp", {x, stops}), three, 1.0);
  EXPECT_EQ(at(ramp, {-7, 0, 0}), (std::vector<double>{1, 0, 0}));
  EXPECT_EQ(at(ramp, {0.5, 0, 0}), (std::vector<double>{0.75, 0.25, 0}));
  EXPECT_EQ(at(ramp, {2, 0, 0}), (std::vector<double>{0, 0, 1}));
  EXPECT_EQ(at(ramp, {3, 0, 0}), (std::vector<double>{0.5, 0, 0.5}));
  EXPECT_EQ(at(ramp, {9, 0, 0}), (std::vector<double>{1, 0, 0}));

  const std::vector<Record> stripes{{{1.0, of("a")}}, {{2.0, of("b")}}, {{1.0, of("c")}}};
  const auto sharp = lower(make_fractions("bands", {x, stripes, 10.0, 0.0}), three, 1.0);
  EXPECT_EQ(at(sharp, {10, 0, 0}), (std::vector<double>{1, 0, 0}));
  EXPECT_EQ(at(sharp, {11, 0, 0}), (std::vector<double>{0, 1, 0}));
  EXPECT_EQ(at(sharp, {9.5, 0, 0}), (std::vector<double>{0, 0, 1}));
  EXPECT_EQ(at(sharp, {-25.5, 0, 0}), (std::vector<double>{1, 0, 0}));
  const auto soft = lower(make_fractions("bands", {x, stripes, 10.0, 1.0}), three, 1.0);
  EXPECT_EQ(at(soft, {10, 0, 0}), (std::vector<double>{0.5, 0, 0.5}));
  EXPECT_EQ(at(soft, {10.25, 0, 0}), (std::vector<double>{0.75, 0, 0.25}));
  EXPECT_EQ(at(soft, {9.75, 0, 0}), (std::vector<double>{0.25, 0, 0.75}));
  EXPECT_EQ(at(soft, {12, 0, 0}), (std::vector<double>{0, 1, 0}));
}

// Faces that parts share must not let another part through: baked points lie on them, and after
// rounding to either side.
TEST(Fractions, OfAPartitionHaveNoStrayOnSharedFaces) {
  const Field coat = make_field(
      "difference",
      {std::vector<Field>{block({}, {4, 2, 1}), ball({4, 0, 0}, 1.5)}, make_blend("min_max", {})});
  const Field core = block({}, {4, 2, 1}), inlay = ball({4, 0, 0}, 1.5);
  for (const double width : {0.0, 0.25}) {
    const std::vector<Record> parts{{{inlay, of("a")}}, {{coat, of("b")}}, {{core, of("c")}}};
    const Evaluator evaluator(lower(make_fractions("partition", {parts, width}), three, 10.0));
    std::mt19937 random(7);
    std::uniform_real_distribution<double> coordinate(-1, 1), off(-9e-6, 9e-6);
    for (int i = 0; i < 20000; ++i) {
      const double y = 2 * coordinate(random), z = coordinate(random);
      const double from_inlay = std::hypot(y, z) - 1.5;
      if (std::abs(from_inlay) < 1e-4) continue;
      const double expected =
          width > 0 ? std::clamp(1 - from_inlay / width, 0.0, 1.0) : double(from_inlay < 0);
      const float p[3] = {float(4 + off(random)), float(y), float(z)};
      float w[3];
      evaluator.values(p, 1, w);
      ASSERT_NEAR(w[0], expected, 1e-4) << y << " " << z;
      ASSERT_EQ(w[2], 0) << y << " " << z;
    }
  }
  // Outside of all parts the nearest wins.
  const std::vector<Record> apart{{{ball({-3, 0, 0}, 1), of("a")}},
                                  {{ball({3, 0, 0}, 1), of("b")}}};
  for (const double width : {0.0, 0.5}) {
    const auto lowered = lower(make_fractions("partition", {apart, width}), three, 10.0);
    EXPECT_EQ(at(lowered, {-1, 0, 0}), (std::vector<double>{1, 0, 0}));
    EXPECT_EQ(at(lowered, {100, 0, 0}), (std::vector<double>{0, 1, 0}));
  }
}

TEST(Fractions, CountSolidsByTheDistanceOutside) {
  const Field solid = ball({}, 2), moved = make_field("translate", {solid, Vec3{1, 0, 0}});
  EXPECT_EQ(at({feature_distance(solid)}, {1, 0, 0})[0], 0);
  EXPECT_EQ(at({feature_distance(solid)}, {5, 0, 0})[0], 3);
  EXPECT_EQ(at({feature_distance(moved)}, {5, 0, 0})[0], 2);
  const Field line = make_field("point", {Vec3{}});
  const Field turned = make_field("translate", {line, Vec3{1, 0, 0}});
  EXPECT_EQ(at({feature_distance(turned)}, {5, 0, 0})[0], 4);
  EXPECT_EQ(at({feature_distance(formula("x"))}, {-5, 0, 0})[0], 0);
}

TEST(Fractions, OfFormulasAreDividedByTheirSum) {
  const MaterialFunctions functions{{"a", formula("x")}, {"b", formula("3")}};
  const auto lowered = lower(make_fractions("formulas", {functions}), three, 1.0);
  EXPECT_EQ(at(lowered, {1, 0, 0}), (std::vector<double>{0.25, 0.75, 0}));
  EXPECT_EQ(at(lowered, {-1, 0, 0}), (std::vector<double>{0, 1, 0}));
  const MaterialFunctions nothing{{"a", formula("x")}};
  EXPECT_EQ(at(lower(make_fractions("formulas", {nothing}), three, 1.0), {-1, 0, 0})[0], 0);
}

TEST(Fractions, GiveAttributesByTheSameRules) {
  const auto value = [](const char* a, const char* b) {
    return Fractions::value({formula(a), formula(b)});
  };
  const std::vector<Record> stops{{{0.0, value("1", "y")}}, {{1.0, value("3", "2*y")}}};
  const Fractions rule = make_fractions("ramp", {Field::coordinate(0), stops});
  const auto lowered = lower(rule, {three, 1.0, 2, {}});
  EXPECT_EQ(at(lowered, {0.5, 4, 0}), (std::vector<double>{2, 6}));
  EXPECT_THROW(lower(rule, {three, 1.0, 3, {}}), Error);
  EXPECT_THROW(lower(rule, three, 1.0), Error);
  EXPECT_THROW(lower(of("a"), {three, 1.0, 1, {}}), Error);
  const MaterialFunctions by{{"a", formula("10")}, {"c", formula("x")}};
  const Lowering lowering{three, 1.0, 1, {constant(0.25), constant(0.25), constant(0.5)}};
  EXPECT_EQ(at(lower(make_fractions("of_materials", {by}), lowering), {8, 0, 0})[0], 6.5);
}

TEST(Fractions, SayWhatIsWrong) {
  EXPECT_EQ(problem("constant", {Shares{{"a", 0.5}, {"b", 0.6}}}),
            "the shares sum to 1.1; they must sum to 1");
  EXPECT_THAT(problem("constant", {Shares{{"a", -0.5}, {"b", 1.5}}}), HasSubstr("'a' is -0.5"));
  EXPECT_THAT(problem("constnat", {}), HasSubstr("did you mean 'constant'?"));
  EXPECT_THAT(problem("inverse_distance", {std::vector<Record>{}}), HasSubstr("at least 1"));
  EXPECT_THAT(problem("inverse_distance",
                      {std::vector<Record>{feature(Field::coordinate(0), of("a"), -1)}}),
              HasSubstr("exponent is -1"));
  EXPECT_THAT(problem("ramp", {Field::coordinate(0),
                               std::vector<Record>{{{1.0, of("a")}}, {{0.0, of("b")}}}}),
              HasSubstr("rising order"));
  EXPECT_THAT(
      problem("bands", {Field::coordinate(0), std::vector<Record>{{{1.0, of("a")}}}, 0.0, 2.0}),
      HasSubstr("more than the width"));
  try {
    lower(of("d"), three, 1.0);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.message, HasSubstr("there is no material 'd'"));
  }
  const Fractions nested = make_fractions(
      "partition", {std::vector<Record>{{{ball({}, 1), of("b")}}, {{ball({}, 2), of("a")}}}, 0.0});
  EXPECT_THAT(materials_of(nested), testing::ElementsAre("b", "a"));
}

}  // namespace
}  // namespace sardf

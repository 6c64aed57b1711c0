// Substitution, derivatives, conditioning and canonical forms as constructors and in formulas.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "error_of.hpp"
#include "sardf/constructor.hpp"
#include "sardf/derivative.hpp"
#include "sardf/evaluate.hpp"
#include "sardf/formula.hpp"
#include "sardf/scene_file.hpp"
#include "sardf/taylor_series.hpp"

namespace sardf {
namespace {

using testing::HasSubstr;

Field formula(const std::string& text, const std::map<std::string, Field>& names = {}) {
  return parse_formula(text, names, {});
}
double value(const Field& f, const Vec3& at) { return Evaluator(f.expression()).value(at); }

const Field circle = make_field("circle", {Vec3{0, 0, 1}, 2.0, Vec3{0, 0, 1}});
const Field sphere = make_field("sphere", {Vec3{}, 2.0});

TEST(CalculusShapes, At) {
  const std::vector<Field> plane{Field::coordinate(0), Field::coordinate(1), Field::number(0)};
  const Field section = make_field("at", {circle, plane});
  EXPECT_DOUBLE_EQ(value(section, {2, 0, 77}), 1);
  EXPECT_EQ(section.expression()->coordinates, 3);
  EXPECT_EQ(section.expression(), formula("at(u, x, y, 0)", {{"u", circle}}).expression());
  EXPECT_THAT(error_of([&] {
                make_field("at", {circle, std::vector<Field>(4, sphere)});
              }),
              HasSubstr("point has 4 elements; 3 are accepted"));
  EXPECT_THAT(error_of([&] {
                make_field("at", {circle, std::vector<Field>(2, sphere)});
              }),
              HasSubstr("point has 2 elements; at least 3 are needed"));
}

TEST(CalculusShapes, Derivatives) {
  const Field f = formula("x^2*y + z");
  EXPECT_DOUBLE_EQ(value(make_field("derivative", {f, Vec3{0, 5, 0}}), {3, 1, 1}), 9);
  EXPECT_DOUBLE_EQ(value(make_field("derivative", {f, Vec3{3, 0, 4}}), {3, 1, 1}), 0.6 * 6 + 0.8);
  EXPECT_DOUBLE_EQ(value(make_field("gradient_length", {f}), {1, 2, 7}), std::sqrt(18.0));
  EXPECT_DOUBLE_EQ(value(make_field("gradient_length", {sphere}), {1, 2, 7}), 1);
  EXPECT_EQ(value(make_field("gradient_length", {formula("3")}), {}), 0);
  // grad F . grad u; the solid's field falls outwards.
  EXPECT_DOUBLE_EQ(value(make_field("normal_derivative", {f, sphere}), {0, 3, 4}), -0.8);
}

TEST(CalculusShapes, InFormulas) {
  const Vec3 at{0.3, -0.7, 0.4};
  EXPECT_DOUBLE_EQ(value(formula("dx(x^3*y) + dy(x*y^2)*dz(z^2)"), at),
                   3 * 0.09 * -0.7 + 2 * 0.3 * -0.7 * 0.8);
  EXPECT_DOUBLE_EQ(value(formula("dx(dx(x^3))"), at), 1.8);
  EXPECT_DOUBLE_EQ(value(formula("at(f, y, x, 2*z)", {{"f", formula("x - 10*z")}}), at), -8.7);
  EXPECT_EQ(error_of([] { formula("1 + dx(x, y)"); }),
            "at character 5: the function 'dx' takes 1 argument, 2 are given");
  EXPECT_EQ(error_of([] { formula("at(x, y)"); }),
            "at character 1: the function 'at' takes 4 arguments, 2 are given");
  // They may still name fields and parameters.
  EXPECT_DOUBLE_EQ(value(formula("dx*at", {{"dx", formula("2")}, {"at", formula("x")}}), at), 0.6);
  EXPECT_EQ(parse_number("dx(a) + at(a, 1, 2, 3)", {{"a", 4}}), 4);
}

TEST(CalculusShapes, InSceneFiles) {
  const SceneDescription scene = parse_scene(R"json({"sardf": 1, "fields": {
      "curve": {"circle": {"radius": 2}},
      "plane": {"at": {"field": "curve", "point": ["=x", "=y", 0]}},
      "slope": {"derivative": {"field": "plane", "axis": "x"}},
      "w": {"normalized": {"field": "=1 - x^2 - y^2", "order": 3}},
      "f": {"canonical_form": {"distance": "plane", "coefficients": [1, "=x", -2]}},
      "t": {"taylor": {"formula": "exp(-1.5*u)", "distance": "plane", "terms": 2}}},
      "solid": {"sphere": {"radius": 1}}})json",
                                             "");
  std::map<std::string, Field> fields;
  for (const NamedField& named : scene.fields) fields[named.name] = named.field;
  EXPECT_DOUBLE_EQ(value(fields["plane"], {3, 4, 9}), 3);
  EXPECT_DOUBLE_EQ(value(fields["slope"], {3, 4, 9}), 0.6);
  EXPECT_DOUBLE_EQ(value(fields["f"], {3, 4, 9}), 1 + 3 * 3 - 9);
  EXPECT_DOUBLE_EQ(value(fields["t"], {3, 4, 9}), 1 - 4.5);
  // Written and read again they are the same.
  const SceneDescription again = parse_scene(scene_text(scene), "");
  for (const NamedField& named : again.fields) {
    EXPECT_EQ(named.field.expression(), fields[named.name].expression()) << named.name;
  }
  EXPECT_THAT(scene_text(scene), HasSubstr("\"point\": [\"=x\", \"=y\", 0]"));
}

TEST(CalculusShapes, CountsAreWholeNumbers) {
  const auto order = [](double n) {
    return error_of([&] { make_field("normalized", {formula("x"), n}); });
  };
  EXPECT_EQ(order(12), "no error");
  EXPECT_THAT(order(1.5), HasSubstr("order is 1.5; a whole number from 1 is accepted"));
  EXPECT_THAT(order(0), HasSubstr("order is 0; a whole number from 1 is accepted"));
  EXPECT_THAT(order(13), HasSubstr("order is 13; 1 to 12 are accepted"));
}

// On circles and segments, whose nearest points are known in closed form.
TEST(Conditioned, TakesTheValueAtTheNearestPoint) {
  const Field f = formula("x + 10*y + 100*z");
  const Field on_circle = make_field("conditioned", {f, circle});
  EXPECT_NEAR(value(on_circle, {3, 4, 7}), 1.2 + 16 + 100, 1e-13);
  EXPECT_NEAR(value(on_circle, {0.3, -0.4, -2}), 1.2 - 16 + 100, 1e-13);
  EXPECT_NEAR(value(on_circle, {0, 2, 1}), 120, 1e-13);  // on it
  const Field segment = make_field("segment", {Vec3{}, Vec3{4, 0, 0}});
  const Field on_segment = make_field("conditioned", {f, segment});
  EXPECT_NEAR(value(on_segment, {1, 5, 6}), 1, 1e-13);
  EXPECT_NEAR(value(on_segment, {9, 5, 6}), 4, 1e-13);
  EXPECT_EQ(value(on_segment, {2, 0, 0}), 2);
  // Its normal derivatives vanish, and its values on the feature are F's: eq. (4).
  const Field curved = formula("x*y + z^2 + sin(x)");
  const Field constant = make_field("conditioned", {curved, circle});
  const Field slope = make_field("normal_derivative", {constant, circle});
  const Field before = make_field("normal_derivative", {curved, circle});
  for (const Vec3& at : {Vec3{1, 1, 0.5}, {-2, 1, 1.3}, {0.3, -2.5, 2}}) {
    EXPECT_NEAR(value(slope, at), 0, 1e-13);
    EXPECT_GT(std::abs(value(before, at)), 0.1);
  }
}

// With eq. (2) the coefficients are the normal derivatives on the feature.
TEST(CanonicalForm, PrescribesValueAndNormalDerivatives) {
  const Field u = circle;
  std::vector<Field> coefficients;
  for (const char* text : {"x + 2*y", "3*y - 1", "-4*x", "7"}) {
    coefficients.push_back(make_field("conditioned", {formula(text), u}));
  }
  const Field f = make_field("canonical_form", {u, coefficients, formula("sin(x)")});
  // Along the ray from the circle's point (1.2, 1.6, 1): c_k k! is the k-th derivative, u > 0.
  const Vec3 foot{1.2, 1.6, 1}, n{0.6 * 0.8, 0.8 * 0.8, 0.6};
  const std::vector<Expression> series =
      directional_series(f.expression(), {constant(n[0]), constant(n[1]), constant(n[2])}, 3);
  const double expected[] = {1.2 + 3.2, 4.8 - 1, -4.8, 7};
  const double h = 1e-4;
  double factorial = 1;
  for (size_t k = 0; k < 4; ++k) {
    if (k > 1) factorial *= double(k);
    EXPECT_NEAR(Evaluator(series[k]).value(foot + h * n) * factorial, expected[k], 200 * h) << k;
  }
  // On the feature it is F_0.
  EXPECT_NEAR(value(f, {2, 0, 1}), 2, 1e-13);
  // The remainder does not change them: it has the factor u^4.
  EXPECT_NEAR(value(f, foot + 0.5 * n) -
                  value(make_field("canonical_form", {u, coefficients, Value()}), foot + 0.5 * n),
              std::pow(0.5, 4) * std::sin(1.2 + 0.24), 1e-12);
}

TEST(Taylor, CoefficientsOfKnownSeries) {
  const std::vector<double> c = taylor_coefficients("exp(-1.5*u)*(1 + u^2)", 6);
  double factorial = 1;
  for (int k = 0; k < 6; ++k) {
    if (k > 1) factorial *= k;
    double expected = std::pow(-1.5, k) / factorial;
    if (k >= 2) expected += std::pow(-1.5, k - 2) / (factorial / (k * (k - 1)));
    EXPECT_NEAR(c[size_t(k)], expected, 1e-14) << k;
  }
  EXPECT_EQ(taylor_coefficients("1/(1 - u) + abs(u)", 3), (std::vector<double>{1, 2, 1}));
  EXPECT_EQ(taylor_coefficients("5", 2), (std::vector<double>{5, 0}));
}

TEST(Taylor, SaysWhatIsSingular) {
  const auto problem = [](const char* text, int count) {
    return error_of([&] { taylor_coefficients(text, count); });
  };
  EXPECT_EQ(problem("sqrt(u)", 1), "no error");
  EXPECT_EQ(problem("sqrt(u)", 4),
            "the formula 'sqrt(u)' is singular at u = 0: its term 2, of u^1, has no finite value");
  EXPECT_THAT(problem("u^2.5", 4), HasSubstr("its term 4, of u^3"));
  EXPECT_EQ(problem("u^2.5", 3), "no error");
  EXPECT_THAT(problem("log(u)", 2), HasSubstr("its term 1, of u^0"));
  EXPECT_THAT(problem("u + x", 2), HasSubstr("depends on x, y or z; a function of u is accepted"));
  EXPECT_THAT(problem("exp(v)", 2), HasSubstr("there is no field or parameter 'v'"));
  EXPECT_THAT(error_of([] {
                make_field("taylor", {std::string("u"), circle, 30.0, 4.0});
              }),
              HasSubstr("the last term is number 33; at most 32 are accepted"));
}

}  // namespace
}  // namespace sardf

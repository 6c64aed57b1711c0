#include "sardf/formula.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sardf/arithmetic.hpp"
#include "sardf/constructor.hpp"
#include "sardf/error.hpp"
#include "sardf/evaluate.hpp"

namespace sardf {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

double at(const std::string& text, const Vec3& p = {}) {
  return Evaluator(parse_formula(text, {}, {{"R", 0.5}}).expression()).value(p);
}

std::string problem(const std::string& text) {
  try {
    parse_formula(text, {{"block", Field::coordinate(0)}}, {{"R", 0.5}});
  } catch (const Error& error) {
    return error.message;
  }
  return "";
}

TEST(Formula, ObeysPrecedence) {
  EXPECT_EQ(at("2 + 3 * 4"), 14);
  EXPECT_EQ(at("(2 + 3) * 4"), 20);
  EXPECT_EQ(at("10 - 4 - 3"), 3);
  EXPECT_EQ(at("24 / 4 / 3"), 2);
  EXPECT_EQ(at("2 ^ 3 ^ 2"), 512);
  EXPECT_EQ(at("-2 ^ 2"), -4);
  EXPECT_EQ(at("2 ^ -1"), 0.5);
  EXPECT_EQ(at("2 ^ -1 * 6"), 3);
  EXPECT_EQ(at("-2 * -3"), 6);
  EXPECT_EQ(at("5 - -3"), 8);
  EXPECT_EQ(at("--3"), 3);
  EXPECT_EQ(at("2*x - y^2/z", {3, 4, 8}), 4);
  EXPECT_EQ(at("-x^2", {3, 0, 0}), -9);
  EXPECT_EQ(at("1e-3 + .5 + 2."), 2.501);
}

TEST(Formula, ComparesAsOneOrZero) {
  for (const auto& [x, y] : {std::pair{1.0, 2.0}, {2.0, 2.0}, {3.0, 2.0}}) {
    const Vec3 p{x, y, 0};
    EXPECT_EQ(at("x < y", p), x < y);
    EXPECT_EQ(at("x <= y", p), x <= y);
    EXPECT_EQ(at("x > y", p), x > y);
    EXPECT_EQ(at("x >= y", p), x >= y);
    EXPECT_EQ(at("x == y", p), x == y);
    EXPECT_EQ(at("x != y", p), x != y);
  }
  EXPECT_EQ(at("1 + 1 < 3 * 1"), 1);
  EXPECT_EQ(at("(1 < 2) + (2 < 1)"), 1);
}

TEST(Formula, KnowsEveryFunction) {
  const double e = 1e-15;
  EXPECT_EQ(at("min(3, x, 2, y)", {5, 1, 0}), 1);
  EXPECT_EQ(at("max(3, x, 2, y)", {5, 1, 0}), 5);
  EXPECT_EQ(at("abs(x) + sign(x)", {-3, 0, 0}), 2);
  EXPECT_EQ(at("length(x, y)", {3, 4, 0}), 5);
  EXPECT_EQ(at("length(x, y, z)", {2, 3, 6}), 7);
  EXPECT_NEAR(at("sqrt(x) * exp(y) + log(z)", {4, 1, 2}), 2 * std::exp(1) + std::log(2), 4 * e);
  EXPECT_NEAR(at("sin(x) + cos(x) * tan(x)", {0.7, 0, 0}), 2 * std::sin(0.7), e);
  EXPECT_NEAR(at("asin(x) + acos(x)", {0.3, 0, 0}), std::numbers::pi / 2, e);
  EXPECT_NEAR(at("atan2(y, x)", {-1, 1, 0}), 0.75 * std::numbers::pi, e);
  EXPECT_NEAR(at("floor(x) + fract(x)", {-2.25, 0, 0}), -2.25, e);
  EXPECT_EQ(at("mod(x, 3)", {-1, 0, 0}), 2);
  EXPECT_EQ(at("clamp(x, 0, 1) + mix(2, 4, 0.25)", {7, 0, 0}), 3.5);
  EXPECT_EQ(at("step(2, x) + smoothstep(0, 2, y)", {2, 1, 0}), 1.5);
  EXPECT_EQ(at("select(x < 0, 10, 20)", {-1, 0, 0}), 10);
  EXPECT_NEAR(at("pow(x, 1.5)", {4, 0, 0}), 8, 8 * e);
  EXPECT_EQ(at("pow(x, 3)", {-2, 0, 0}), -8);
  EXPECT_EQ(at("pi * R"), std::numbers::pi / 2);
  for (const std::string& name : function_names()) {
    const size_t arity = size_t(find_function(name)->info().arity);
    std::string text = name + "(";
    for (size_t i = 0; i < arity; ++i) text += i ? ", x" : "x";
    EXPECT_NO_THROW(at(text + ")", {0.5, 0, 0})) << text;
  }
}

TEST(Formula, NamesFields) {
  const Field ball = make_field("sphere", {Vec3{}, 2.0});
  const Field f = parse_formula("ball * k + x", {{"ball", ball}, {"other", ball}}, {{"k", 3}});
  EXPECT_EQ(Evaluator(f.expression()).value({1, 0, 0}), 4);
  EXPECT_THAT(f.construction()->names, testing::SizeIs(2));
  EXPECT_EQ(f.construction()->names.at("ball").construction(), ball.construction());
  EXPECT_EQ(f.construction()->formula, "ball * k + x");
  EXPECT_THAT(names_in_formula("sin(b) + a*x - a + pi(3)"), ElementsAre("a", "b"));
  EXPECT_EQ(rename_in_formula("a + sin(b)*ab - a", {{"a", "c"}, {"b", "bb"}, {"sin", "no"}}),
            "c + sin(bb)*ab - c");
}

TEST(Formula, TurnsRootsOfSumsOfSquaresIntoLengths) {
  const Expression x = coordinate(0), y = coordinate(1), z = coordinate(2);
  const auto of = [](const char* text) { return parse_formula(text, {}, {}).expression(); };
  EXPECT_EQ(of("sqrt(x^2 + y^2)"), length(x, y));
  EXPECT_EQ(of("sqrt(x*x + y*y + z^2)"), function("length3", {x, y, z}));
  EXPECT_EQ(of("sqrt(x^2 + y^2 + 9)"), function("length3", {x, y, constant(3)}));
  EXPECT_EQ(of("sqrt(x^2)"), abs(x));
  EXPECT_EQ(of("sqrt(x^2 + y)"), function("sqrt", {of("x^2 + y")}));
  const Vec3 p{1.5, -2.5, 0.5};
  EXPECT_NEAR(at("sqrt(4*x^2 + y^2/9 + z^2*25 + 1 + (x+y)^2)", p),
              std::sqrt(9 + 6.25 / 9 + 6.25 + 1 + 1), 1e-14);
  // The slope of a plain root is infinite where its argument can be 0; that of a length is not.
  const BoundingBox box{{-1, -1, -1}, {1, 1, 1}};
  EXPECT_LE(Evaluator(of("sqrt(x^2 + y^2 + z^2)")).slope(box).length, 1 + 1e-14);
  EXPECT_EQ(Evaluator(of("sqrt(x + y)")).slope(box).length, infinity);
}

TEST(Formula, IsANumberWhereANumberIsNeeded) {
  EXPECT_EQ(parse_number("2*R + 1", {{"R", 0.5}}), 2);
  EXPECT_THROW(parse_number("1/0", {}), Error);
  try {
    parse_number("2*x", {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.message, "at character 3: 'x' stands in a formula that must be a number");
  }
}

TEST(Formula, PointsAtTheCharacter) {
  EXPECT_EQ(problem("x + blok"),
            "at character 5: there is no field or parameter 'blok'; did you mean 'block'?");
  EXPECT_EQ(problem("sni(x)"), "at character 1: there is no function 'sni'; did you mean 'sin'?");
  // Of names equally near the one that begins alike: not 'sign'.
  EXPECT_THAT(problem("sinn(x)"), testing::EndsWith("did you mean 'sin'?"));
  EXPECT_EQ(problem("1 + min(x)"),
            "at character 5: the function 'min' takes 2 or more arguments, 1 is given");
  EXPECT_EQ(problem("sin()"), "at character 1: the function 'sin' takes 1 argument, 0 are given");
  EXPECT_EQ(problem("length(x, y, z, x)"),
            "at character 1: the function 'length' takes 2 or 3 arguments, 4 are given");
  EXPECT_THAT(problem("(x + 1"), StartsWith("at character 1: this '(' is never closed"));
  EXPECT_THAT(problem("sin(x"), StartsWith("at character 1: the '(' of 'sin(' is never closed"));
  EXPECT_THAT(problem("x + 1)"), StartsWith("at character 6: this ')' has no '('"));
  EXPECT_THAT(problem("x + "), StartsWith("at character 5: the formula ends where"));
  EXPECT_THAT(problem(""), StartsWith("at character 1: the formula ends where"));
  EXPECT_THAT(problem("x + * y"), StartsWith("at character 5: '*' stands where"));
  EXPECT_THAT(problem("2 x"), StartsWith("at character 3: 'x' stands where an operator"));
  EXPECT_THAT(problem("2x"), StartsWith("at character 1: '2x' is not a number"));
  EXPECT_THAT(problem("1e999"), StartsWith("at character 1: '1e999' is not a number"));
  EXPECT_THAT(problem("x = 3"), StartsWith("at character 3: '=' alone has no meaning"));
  EXPECT_THAT(problem("ä + é$"), StartsWith("at character 1: 'ä' has no meaning"));
  EXPECT_THAT(problem("x $ y"), StartsWith("at character 3: '$' has no meaning"));
  EXPECT_THAT(problem("1 < 2 < 3"), StartsWith("at character 7: comparisons cannot follow"));
  EXPECT_THAT(problem("x, y"), StartsWith("at character 2: ',' stands outside"));
  EXPECT_THAT(problem("sin + 1"), HasSubstr("the function 'sin' needs arguments"));
  EXPECT_THAT(problem("x(3)"), HasSubstr("'x' is no function"));
}

TEST(Formula, HasNoLimitOfNesting) {
  const size_t deep = 50000;
  const std::string open(deep, '('), close(deep, ')');
  EXPECT_EQ(at(open + "x" + close, {7, 0, 0}), 7);
  EXPECT_EQ(at(std::string(deep, '-') + "x", {7, 0, 0}), 7);
  std::string powers = "x", calls;
  for (size_t i = 0; i < 20000; ++i) {
    powers += "^1";
    calls += "abs(";
  }
  EXPECT_EQ(at(powers, {7, 0, 0}), 7);
  EXPECT_EQ(at(calls + "x" + std::string(20000, ')'), {-7, 0, 0}), 7);
  EXPECT_THAT(problem(open), StartsWith("at character 50001"));
}

}  // namespace
}  // namespace sardf

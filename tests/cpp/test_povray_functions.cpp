// Sharing, depth and width of the functions written for POV-Ray.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <numbers>
#include <random>
#include <regex>

#include "povray_gen/function_text.hpp"
#include "povray_harness.hpp"
#include "sardf/evaluate.hpp"
#include "sardf/operation_of.hpp"
#include "sardf/ops.hpp"

namespace sardf {
namespace {

using povray::FunctionWriter;
using povray::NamedExpression;
using povray::Names;
using testing::HasSubstr;
using testing::Not;

const Expression X = coordinate(0), Y = coordinate(1), Z = coordinate(2);

template <class Op>
Expression apply_to(const Op& op, std::initializer_list<Expression> inputs) {
  return call(make_operation(op), inputs);
}
Expression plus(const Expression& a, const Expression& b) { return apply_to(Add(), {a, b}); }
Expression times(const Expression& a, const Expression& b) { return apply_to(Multiply(), {a, b}); }
Expression sphere_at(double x, double y = 0, double z = 0) {
  Sphere sphere;
  sphere.center = {x, y, z};
  return apply_to(sphere, {X, Y, Z});
}
Expression joined(const Expression& a, const Expression& b) {
  return apply_to(UnionOf<Sardf>(Sardf{.radius = 0.5}), {a, b});
}

struct Written {
  std::string text;
  std::vector<std::string> names;
};
Written written(const std::vector<NamedExpression>& fields, const std::string& title = "test") {
  Names names(title);
  FunctionWriter writer(names);
  Written out;
  out.names = writer.declare(fields);
  out.text = writer.text();
  return out;
}

int count(const std::string& text, const std::string& what) {
  int found = 0;
  for (size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
  return found;
}

size_t most_parameters(const std::string& text) {
  const std::regex signature("= function\\(([^)]*)\\)");
  size_t most = 0;
  for (std::sregex_iterator at(text.begin(), text.end(), signature), end; at != end; ++at) {
    const std::string list = (*at)[1];
    most = std::max(most, size_t(std::count(list.begin(), list.end(), ',')) + 1);
  }
  return most;
}

// POV-Ray's values of the written fields equal ours.
void expect_same_values(const std::vector<NamedExpression>& fields, int points = 20) {
  const Written text = written(fields);
  EXPECT_LE(most_parameters(text.text), 56u);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-2, 2);
  std::vector<FunctionCall> calls;
  std::vector<double> expected;
  for (size_t i = 0; i < fields.size(); ++i) {
    const Evaluator evaluator(fields[i].expression);
    for (int k = 0; k < points; ++k) {
      const Vec3 p{uniform(random), uniform(random), uniform(random)};
      calls.push_back({text.names[i], {p[0], p[1], p[2]}});
      expected.push_back(evaluator.value(p));
    }
  }
  const std::vector<double> found = evaluate_in_povray(text.text, calls);
  for (size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i], expected[i], 1e-9 * std::max(1.0, std::abs(expected[i])))
        << fields[i / size_t(points)].name;
  }
}

// f_k = union(f_{k-1}, 0.5 f_{k-1} + k/100), each level needing the one below twice.
Expression nested_levels(int levels) {
  Expression f = sphere_at(0);
  for (int k = 0; k < levels; ++k) {
    f = joined(f, plus(times(constant(0.5), f), constant(0.01 * k)));
  }
  return f;
}

// A section may leave a piece of which only the cutting plane is near.
TEST(PovrayFunctions, WriteCoordinatesAloneWhereTextIsToBeQuick) {
  Names names("test");
  FunctionWriter writer(names);
  EXPECT_EQ(writer.quick("near", X), "x");
  EXPECT_EQ(writer.quick("near", Y), "y");
  EXPECT_EQ(writer.quick("near", Z), "z");
  EXPECT_EQ(writer.text(), "");
}

TEST(PovrayFunctions, NameFunctionsAfterTheSceneAndAvoidReservedWords) {
  const Written text =
      written({{"box", sphere_at(1)}, {"box", sphere_at(2)}, {"t", X}, {"größe 1", Y}, {"7", Z}},
              "3 Zähne-rad!");
  EXPECT_EQ(text.names, (std::vector<std::string>{"part3_Z_hne_rad_box", "part3_Z_hne_rad_box_2",
                                                  "part3_Z_hne_rad_t", "part3_Z_hne_rad_gr_e_1",
                                                  "part3_Z_hne_rad_7"}));
  EXPECT_EQ(Names("bearing block, hardened around its bore").prefix(), "bearing_block");
  expect_same_values({{"union", sphere_at(1)}, {"x", X}, {"a", plus(X, Y)}, {"Z", Z}});
}

TEST(PovrayFunctions, UseNoNameThatAUserMayHaveDeclared) {
  const Written text = written({{"solid", nested_levels(3)}});
  std::string user;
  for (char c = 'a'; c <= 'w'; ++c) {
    if (c != 't' && c != 'u' && c != 'v') user += std::string("#declare ") + c + " = 1;\n";
  }
  EXPECT_NEAR(evaluate_in_povray(user + text.text, {{text.names[0], {0.5, 0, 0}}})[0],
              Evaluator(nested_levels(3)).value({0.5, 0, 0}), 1e-9);
}

TEST(PovrayFunctions, EvaluateEverySharedTermOnce) {
  for (int levels : {2, 20}) {
    const std::string text = written({{"solid", nested_levels(levels)}}).text;
    // One call for each node of the graph, besides the declaration.
    EXPECT_EQ(count(text, "test_sphere_1("), 1);
    EXPECT_EQ(count(text, "test_sardf_union_1("), levels);
  }
}

TEST(PovrayFunctions, TwentyNestedLevelsTakeTheTimeOfTwo) {
  const auto seconds = [](int levels) {
    const Written text = written({{"solid", nested_levels(levels)}});
    const std::vector<FunctionCall> calls(2000, {text.names[0], {0.5, 0.25, 0.125}});
    const auto start = std::chrono::steady_clock::now();
    evaluate_in_povray(text.text, calls);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  // 18 more doublings would be 262 144 times the work; starting POV-Ray dominates both.
  EXPECT_LT(seconds(20), 4 * seconds(2) + 2);
  expect_same_values({{"solid", nested_levels(20)}});
}

TEST(PovrayFunctions, CallNamedFieldsWhereTheirPartsAreTheirOwn) {
  const Expression ball = joined(sphere_at(1), sphere_at(2)), other = sphere_at(3);
  const Written apart = written({{"solid", joined(ball, other)}, {"ball", ball}, {"other", other}});
  EXPECT_THAT(apart.text, HasSubstr("test_sardf_union_1(test_ball(x, y, z), test_other(x, y, z))"));
  EXPECT_LT(apart.text.find("#declare test_ball "), apart.text.find("#declare test_solid "));

  // other is also part of ball: calling ball would evaluate it a second time.
  const Expression shared = joined(other, sphere_at(2));
  const Written together =
      written({{"ball", shared}, {"other", other}, {"solid", plus(shared, times(other, other))}});
  const std::string solid = together.text.substr(together.text.find("test_solid_1"));
  EXPECT_THAT(solid, Not(HasSubstr("test_ball(")));
  EXPECT_EQ(count(solid, "test_other("), 1);
  expect_same_values(
      {{"ball", shared}, {"other", other}, {"solid", plus(shared, times(other, other))}});
}

TEST(PovrayFunctions, DeclareEqualFieldsUnderBothNames) {
  expect_same_values({{"solid", sphere_at(1)},
                      {"ball", sphere_at(1)},
                      {"one", constant(1)},
                      {"x1", X},
                      {"x2", X}});
}

TEST(PovrayFunctions, EvaluateACostlyBranchOnlyWhereItIsTaken) {
  const std::string text = written({{"solid", joined(sphere_at(1), sphere_at(2))}}).text;
  // Square roots stand only in the branch of the band: in helpers that select calls.
  const std::regex root_outside("sardf_union_1\\([^}]*\\) \\{[^}]*sqrt");
  EXPECT_FALSE(std::regex_search(text, root_outside)) << text;
  EXPECT_THAT(text, HasSubstr("sqrt("));
}

TEST(PovrayFunctions, SkipACostlyPrimitiveWhereItCannotCount) {
  Ellipsoid flat;
  flat.center = {0.5, 0, 0};
  flat.radii = {1.5, 1, 0.5};
  const Expression costly = apply_to(flat, {plus(X, Y), Y, Z});
  const auto blended = [&]<class Blend>(const Blend& blend) {
    const Expression ball = sphere_at(-1);
    return std::vector<NamedExpression>{
        {"second", apply_to(UnionOf<Blend>(blend), {ball, costly})},
        {"first", apply_to(UnionOf<Blend>(blend), {costly, ball})},
        {"cut", apply_to(DifferenceOf<Blend>(blend), {ball, costly})},
        {"common", apply_to(IntersectionOf<Blend>(blend), {ball, costly})}};
  };
  const std::regex guarded("select\\([^}]*test_ellipsoid_1\\(");
  const auto guards_in = [&](const std::vector<NamedExpression>& fields) {
    const std::string text = written(fields).text;
    return std::distance(std::sregex_iterator(text.begin(), text.end(), guarded), {});
  };
  EXPECT_EQ(guards_in(blended(Sardf{.radius = 0.5})), 3);
  EXPECT_EQ(guards_in(blended(MinMax())), 3);
  EXPECT_EQ(guards_in(blended(RFunction())), 0) << "every value counts";
  expect_same_values(blended(Sardf{.radius = 0.5}), 200);
  expect_same_values(blended(SardfC1{.radius = 0.5}), 200);
  expect_same_values(blended(MinMax()), 200);
  expect_same_values(blended(Smooth{.k = 0.5}), 200);
}

TEST(PovrayFunctions, SurviveDeepTrees) {
  Expression left = X, right = X, ladder = X, formula = X;
  for (int k = 0; k < 10000; ++k) {
    left = joined(left, sphere_at(0.001 * k));
    right = joined(sphere_at(0.001 * k), right);
    ladder = joined(ladder, plus(times(constant(0.999), ladder), constant(-0.001)));
    formula = apply_to(Sine(), {plus(formula, constant(0.001 * k))});
  }
  expect_same_values({{"left", left}, {"right", right}, {"ladder", ladder}, {"formula", formula}},
                     3);
  Expression deepest = X;
  for (int k = 0; k < 100000; ++k) deepest = apply_to(Sine(), {plus(deepest, Y)});
  expect_same_values({{"deepest", deepest}}, 3);
}

TEST(PovrayFunctions, SplitBeforeTheLimitOfParameters) {
  Expression sum = constant(0), product = constant(1);
  for (int k = 0; k < 150; ++k) {
    const Expression ball = sphere_at(0.01 * k);
    sum = plus(sum, ball);
    product = times(product, plus(constant(0.5), ball));
  }
  expect_same_values({{"both", plus(sum, product)}});
  Polygon star;
  for (int k = 0; k < 260; ++k) {
    const double angle = 2 * std::numbers::pi * k / 260, radius = k % 2 ? 1 : 1.8;
    star.vertices.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  expect_same_values({{"star", apply_to(star, {X, Y})}});
}

TEST(PovrayFunctions, SayWhenNoSplitIsPossible) {
  // Every difference needs the largest of all values, and every value once more.
  std::vector<Expression> balls;
  Expression largest = sphere_at(-1);
  for (int k = 0; k < 80; ++k) {
    balls.push_back(sphere_at(0.01 * k));
    largest = apply_to(Max(), {largest, balls.back()});
  }
  Expression sum = constant(0);
  for (const Expression& ball : balls) sum = plus(sum, times(ball, largest));
  try {
    written({{"wide", sum}});
    FAIL() << "80 values at once were written";
  } catch (const Error& error) {
    EXPECT_THAT(error.message, HasSubstr("'wide' cannot be written for POV-Ray"));
    EXPECT_THAT(error.message, HasSubstr("more than 56 intermediate values at once"));
  }
}

// Random graphs over operations of every kind, with much sharing and lazy branches.
TEST(PovrayFunctions, RandomGraphsHaveOurValues) {
  std::mt19937 random(11);
  const auto below = [&](size_t n) { return size_t(random() % n); };
  std::vector<NamedExpression> fields;
  for (int graph = 0; graph < 30; ++graph) {
    std::vector<Expression> pool{X, Y, Z, constant(0.5), constant(-1.25)};
    for (int k = 0; k < 60; ++k) {
      const Expression &a = pool[below(pool.size())], &b = pool[below(pool.size())],
                       &c = pool[pool.size() - 1 - below(3)];
      switch (below(9)) {
        case 0:
          pool.push_back(joined(a, c));
          break;
        case 1:
          pool.push_back(apply_to(DifferenceOf<SardfC1>(SardfC1{}), {c, b}));
          break;
        case 2:
          pool.push_back(apply_to(Select(), {a, b, c}));
          break;
        case 3:
          pool.push_back(apply_to(Min(), {c, apply_to(Negate(), {a})}));
          break;
        case 4:
          pool.push_back(apply_to(Box(), {a, b, c}));
          break;
        case 5:
          pool.push_back(apply_to(Sine(), {plus(a, c)}));
          break;
        case 6:
          pool.push_back(apply_to(SmoothStep(), {constant(-1), constant(1), c}));
          break;
        case 7:
          pool.push_back(apply_to(Affine{.row = {0.5, 0, 0.25}, .offset = 1}, {a, b, c}));
          break;
        default:
          pool.push_back(plus(apply_to(Cosine(), {times(a, b)}), c));
          break;
      }
    }
    fields.push_back({"graph", pool.back()});
    if (graph % 2) fields.push_back({"part", pool[pool.size() / 2]});
  }
  expect_same_values(fields);
}

}  // namespace
}  // namespace sardf

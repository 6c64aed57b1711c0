// Instructions that one pass evaluates with the next one, and pairs that one call evaluates: which
// they are, and that results stay.
#include <gtest/gtest.h>

#include <bit>
#include <random>

#include "sardf/arithmetic.hpp"
#include "sardf/constructor.hpp"
#include "sardf/evaluate.hpp"

namespace sardf {
namespace {

size_t fused(const Tape& tape) {
  size_t count = 0;
  for (const Instruction& i : tape.instructions()) count += i.fused ? i.pairs : 0;
  return count;
}
size_t fused(const Field& field) { return fused(Tape(field.expression())); }

// How many pairs each call evaluates.
using Calls = std::vector<uint32_t>;
Calls calls(const Tape& tape) {
  Calls of;
  for (const Instruction& i : tape.instructions()) {
    if (i.fused) of.push_back(i.pairs);
  }
  return of;
}
Calls calls(const Field& field) { return calls(Tape(field.expression())); }

Field ball(double x) { return make_field("sphere", {Vec3{x, 0.25, 0}, 1.0}); }
Field block() { return make_field("box", {Vec3{}, Vec3{3, 2, 1}}); }
Field bar() { return make_field("cylinder", {Vec3{0, 0.5, 0}, Vec3{1, 2, 3}, 0.5, Value()}); }

Field joined(const char* name, const std::vector<Field>& of,
             const BlendPointer& blend = min_max_blend()) {
  return make_field(name, {of, blend});
}

TEST(Fused, IsEverySolidThatIsJoinedToTheOnesBefore) {
  for (const char* name : {"union", "intersection", "difference"}) {
    EXPECT_EQ(fused(joined(name, {block(), bar(), ball(0)})), 2u) << name;
  }
  const Field left = joined("union", {ball(1), ball(2)}), right = joined("union", {block(), bar()});
  EXPECT_EQ(fused(joined("difference", {left, right})), 2u);
}

TEST(Fused, IsNothingThatIsNeededElsewhere) {
  const Field a = block(), b = bar();
  const Expression apart = joined("difference", {a, b}).expression();
  EXPECT_EQ(fused(Tape(std::vector{apart})), 1u);
  EXPECT_EQ(fused(Tape(std::vector{apart, b.expression()})), 0u);
  EXPECT_EQ(fused(Tape(std::vector{b.expression(), apart})), 0u);
  EXPECT_EQ(fused(Tape(apart + b.expression())), 0u);
  EXPECT_EQ(fused(joined("union", {b, b})), 0u);
}

TEST(Fused, IsNothingInBlendsWithArcs) {
  EXPECT_EQ(fused(joined("union", {block(), bar()}, make_blend("sardf", {0.5}))), 0u);
}

Field sphere(double x, double radius = 1) {
  return make_field("sphere", {Vec3{x, -x, 0.5 * x}, radius});
}
Field upright(double x, const Value& height = Value(), double z = 0, double radius = 1) {
  return make_field("cylinder", {Vec3{x, 0.5, z}, Vec3{0, 0, 1}, radius, height});
}
Field tilted(double x) {
  return make_field("cylinder", {Vec3{x, 0.5, 0}, Vec3{0, 1, 1}, 1.0, Value()});
}
Field disc(double x) { return make_field("disc", {std::array{x, 0.5}, 1.0}); }

TEST(Fused, SolidsThatDifferInTheirMiddlesTakeOneCall) {
  for (const char* name : {"union", "intersection", "difference"}) {
    EXPECT_EQ(calls(joined(name, {block(), sphere(0), sphere(1), sphere(2)})), Calls{3}) << name;
    EXPECT_EQ(calls(joined(name, {block(), upright(0), upright(1)})), Calls{2}) << name;
    EXPECT_EQ(calls(joined(name, {block(), upright(0, 2.0), upright(1, 2.0)})), Calls{2}) << name;
    EXPECT_EQ(calls(joined(name, {disc(0), disc(1), disc(2)})), Calls{2}) << name;
  }
}

TEST(Fused, SolidsThatDifferInTheirMiddlesTakeOneCallInBlendsToo) {
  const std::vector<Field> solids{block(), upright(0), sphere(0), sphere(1), sphere(2)};
  for (const char* name : {"sardf", "sardf_c1", "smooth"}) {
    for (const char* operation : {"union", "intersection", "difference"}) {
      EXPECT_EQ(calls(joined(operation, solids, make_blend(name, {0.5}))), Calls{3}) << name;
    }
  }
  EXPECT_EQ(calls(joined("union", solids, make_blend("r_function", {}))), Calls{});
}

TEST(Fused, SolidsThatDifferElsewhereTakeCallsOfTheirOwn) {
  const auto cut = [](const Field& a, const Field& b) {
    return calls(joined("difference", {block(), a, b}));
  };
  const Calls one_by_one{1, 1};
  EXPECT_EQ(cut(sphere(0), sphere(1, 1.5)), one_by_one);
  EXPECT_EQ(cut(sphere(0), upright(1)), one_by_one);
  EXPECT_EQ(cut(upright(0), upright(1, Value(), 0, 1.5)), one_by_one);
  EXPECT_EQ(cut(upright(0), upright(1, 2.0)), one_by_one);
  EXPECT_EQ(cut(upright(0, 2.0), upright(1, 2.5)), one_by_one);
  EXPECT_EQ(cut(upright(0, 2.0), upright(1, 2.0, 0.25)), one_by_one);
  EXPECT_EQ(cut(tilted(0), tilted(1)), one_by_one);
  EXPECT_EQ(cut(sphere(0), make_field("sphere", {Vec3{1e100, 0, 0}, 1.0})), one_by_one);
  const Field moved = make_field("translate", {sphere(1), Vec3{1, 2, 3}});
  EXPECT_EQ(cut(sphere(0), moved), one_by_one);
}

TEST(Fused, SolidsTakeOneCallOnlyWhereNothingNeedsWhatLiesBetween) {
  const Field two = joined("difference", {block(), sphere(0), sphere(1)});
  const Field three = joined("difference", {two, sphere(2)});
  EXPECT_EQ(calls(three), Calls{3});
  const std::vector outputs{three.expression(), two.expression()};
  EXPECT_EQ(calls(Tape(outputs)), (Calls{2, 1}));
  const Field other = joined("union", {two, sphere(2)});
  EXPECT_EQ(calls(other), (Calls{2, 1}));
}

TEST(Fused, OneCallTakesNoMoreThanItHasRoomFor) {
  std::vector<Field> many{block()};
  for (size_t k = 0; k < 2 * most_pairs + 3; ++k) many.push_back(sphere(0.1 * double(k)));
  EXPECT_EQ(calls(joined("union", many)), (Calls{most_pairs, most_pairs, 3}));
}

// `alone`: single pairs have a call of their own.
void expect_the_bits_of_one_after_the_other(const char* name, const BlendPointer& blend,
                                            bool alone) {
  constexpr size_t n = 1000;
  std::mt19937 random(5);
  std::uniform_real_distribution<float> ordinary(-2, 2);
  std::vector<float> at;
  for (size_t i = 0; i < 3 * n; ++i) at.push_back(ordinary(random));
  at[30] = std::numeric_limits<float>::quiet_NaN();
  at[60] = std::numeric_limits<float>::infinity();
  std::vector<Field> solids{block(), bar(), ball(1), ball(-1), upright(0.3, 1.0)};
  for (int k = 0; k < 40; ++k) solids.push_back(upright(0.1 * k - 2, 2.0, 0.25, 0.375));
  // All solids are outputs as well: they are evaluated one by one.
  std::vector<Expression> outputs{joined(name, solids, blend).expression()};
  for (const Field& solid : solids) outputs.push_back(solid.expression());
  const Evaluator apart(outputs), whole(outputs[0]);
  ASSERT_EQ(fused(apart.tape()), 0u);
  // The bar and the other upright one are like no other solid.
  ASSERT_EQ(fused(whole.tape()), solids.size() - (alone ? 1 : 3));
  std::vector<float> expected(n * outputs.size()), got(n);
  apart.values(at.data(), n, expected.data());
  whole.values(at.data(), n, got.data());
  for (size_t i = 0; i < n; ++i) {
    const float wanted = expected[i * outputs.size()];
    EXPECT_TRUE(std::bit_cast<uint32_t>(got[i]) == std::bit_cast<uint32_t>(wanted) ||
                (std::isnan(got[i]) && std::isnan(wanted)))
        << name << ' ' << i << ": " << got[i] << ", " << wanted;
  }
}

// In the last block, too, which is no whole one, and where a result stands for an output.
TEST(Fused, GivesTheBitsOfOneAfterTheOther) {
  for (const char* name : {"union", "intersection", "difference"}) {
    expect_the_bits_of_one_after_the_other(name, min_max_blend(), true);
    for (const char* blend : {"sardf", "sardf_c1", "smooth"})
      expect_the_bits_of_one_after_the_other(name, make_blend(blend, {0.25}), false);
  }
}

}  // namespace
}  // namespace sardf

// Instructions that one pass evaluates with the next one: which they are, and that results stay.
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
  for (const Instruction& instruction : tape.instructions()) count += instruction.fused != nullptr;
  return count;
}
size_t fused(const Field& field) { return fused(Tape(field.expression())); }

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

// In the last block, too, which is no whole one, and where a result stands for an output.
TEST(Fused, GivesTheBitsOfOneAfterTheOther) {
  constexpr size_t n = 1000;
  std::mt19937 random(5);
  std::uniform_real_distribution<float> ordinary(-2, 2);
  std::vector<float> at;
  for (size_t i = 0; i < 3 * n; ++i) at.push_back(ordinary(random));
  at[30] = std::numeric_limits<float>::quiet_NaN();
  at[60] = std::numeric_limits<float>::infinity();
  for (const char* name : {"union", "intersection", "difference"}) {
    const std::vector<Field> solids{block(), bar(), ball(1), ball(-1)};
    // All solids are outputs as well: they are evaluated one by one.
    std::vector<Expression> outputs{joined(name, solids).expression()};
    for (const Field& solid : solids) outputs.push_back(solid.expression());
    const Evaluator apart(outputs), whole(outputs[0]);
    ASSERT_EQ(fused(apart.tape()), 0u);
    ASSERT_EQ(fused(whole.tape()), 3u);
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
}

}  // namespace
}  // namespace sardf

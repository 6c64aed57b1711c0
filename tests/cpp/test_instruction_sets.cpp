// Baseline, AVX2 and AVX-512 give the same bits for every operation and for whole trees, and a user
// can force a narrower set.
#include <gtest/gtest.h>

#include <bit>
#include <cstdlib>
#include <iostream>

#include "laws.hpp"
#include "sardf/kernels.hpp"

namespace sardf {
namespace {

using laws::Random;

constexpr size_t points = 64;
using Row = std::array<float, points>;

/// Those that this machine has.
std::vector<InstructionSet> instruction_sets() {
  std::vector<InstructionSet> sets;
  for (const auto set : {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512}) {
    if (set <= instruction_set()) sets.push_back(set);
  }
  return sets;
}

/// The same bits, where a NaN is any NaN.
bool same(float a, float b) {
  return std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b) ||
         (std::isnan(a) && std::isnan(b));
}

// Any float: denormals, infinities, zeros of both signs and NaN.
float any_float(Random& r) {
  static constexpr float special[] = {0,
                                      -0.f,
                                      1,
                                      -1,
                                      1e-45f,
                                      -1e-45f,
                                      1e-38f,
                                      3.4e38f,
                                      -3.4e38f,
                                      float(infinity),
                                      -float(infinity)};
  if (r.chance(0.3)) return r.one_of(special);
  if (r.chance(0.5)) return float(r.ordinary());
  return std::bit_cast<float>(uint32_t(r.below(1 << 16)) << 16 | uint32_t(r.below(1 << 16)));
}

TEST(InstructionSets, AgreeOnAnyBitsInEveryOperation) {
  laws::for_operations(laws::effort(40), [](auto, const Operation& op, Random& r) {
    const size_t arity = size_t(op.info().arity);
    std::array<Row, max_arity> in;
    for (Row& row : in) {
      for (float& a : row) a = any_float(r);
    }
    std::array<const float*, max_arity> at{};
    for (size_t k = 0; k < arity; ++k) at[k] = in[k].data();
    std::vector<std::array<Row, 2 + max_arity>> results;
    for (const InstructionSet set : instruction_sets()) {
      const Kernels* kernels = listed_kernels(set, op.info().name);
      ASSERT_NE(kernels, nullptr);
      auto& out = results.emplace_back();
      std::array<float*, max_arity> by{};
      for (size_t k = 0; k < arity; ++k) by[k] = out[2 + k].data();
      kernels->value(op.object(), at.data(), out[0].data(), points);
      kernels->partials(op.object(), at.data(), out[1].data(), by.data(), points);
      for (size_t row = 0; row < 2 + arity; ++row) {
        for (size_t i = 0; i < points; ++i) {
          EXPECT_TRUE(same(out[row][i], results[0][row][i]))
              << instruction_set_name(set) << ", row " << row << ": " << out[row][i]
              << ", baseline " << results[0][row][i] << " at " << in[0][i] << ", " << in[1][i]
              << ", " << in[2][i];
        }
      }
    }
  });
}

// The tape on the kernels of one set.
Row run(const Tape& tape, InstructionSet set, const std::array<Row, 3>& xyz) {
  std::vector<Row> registers(tape.registers());
  std::copy(xyz.begin(), xyz.end(), registers.begin());
  for (const Tape::Constant& c : tape.constants()) registers[c.reg].fill(float(c.value));
  for (const Instruction& i : tape.instructions()) {
    // What carries data has one kernel for all.
    const Kernels* listed = listed_kernels(set, i.operation->info().name);
    const Kernels& kernels = listed ? *listed : i.operation->kernels();
    std::array<const float*, max_arity> in{};
    for (size_t k = 0; k < in.size(); ++k) in[k] = registers[i.in[k]].data();
    kernels.value(i.operation->object(), in.data(), registers[i.out].data(), points);
  }
  return registers[tape.outputs()[0]];
}

TEST(InstructionSets, AgreeOnRandomTrees) {
  Random r(83);
  for (int tree = 0; tree < laws::effort(200); ++tree) {
    const Evaluator evaluator(random_field(r, 1 + r.below(3)).expression());
    std::array<Row, 3> xyz;
    std::vector<float> at;
    for (size_t i = 0; i < points; ++i) {
      for (Row& row : xyz)
        at.push_back(row[i] = float(r.chance(0.1) ? r.spicy(1e12) : r.ordinary()));
    }
    Row used;
    evaluator.values(at.data(), points, used.data());
    const Row baseline = run(evaluator.tape(), InstructionSet::baseline, xyz);
    for (const InstructionSet set : instruction_sets()) {
      const Row out = run(evaluator.tape(), set, xyz);
      for (size_t i = 0; i < points; ++i) {
        EXPECT_TRUE(same(out[i], baseline[i]) && same(used[i], baseline[i]))
            << instruction_set_name(set) << ' ' << out[i] << ", baseline " << baseline[i]
            << ", used " << used[i] << ", tree " << tree;
      }
    }
  }
}

// Ends a new process with the number of the set that it runs, or 9 where its kernels are another's.
void exit_with_set(const char* wanted) {
  setenv("SARDF_INSTRUCTION_SET", wanted, 1);
  Random r(84);
  const OperationPointer op = laws::listed_operations()[0].random(r);
  const InstructionSet set = instruction_set();
  std::exit(&op->kernels() == listed_kernels(set, op->info().name) ? int(set) : 9);
}

// A process decides once: each case needs one of its own, and this one's choice must not be asked
// for before.
class ForcedInstructionSetDeathTest : public testing::Test {
 protected:
  ForcedInstructionSetDeathTest() { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
};

// This is what a machine without AVX2 runs.
TEST_F(ForcedInstructionSetDeathTest, BaselineReplacesWiderSets) {
  EXPECT_EXIT(exit_with_set("baseline"), testing::ExitedWithCode(0), "");
}

// A set that the machine has not is never run: the widest that it has takes its place.
TEST_F(ForcedInstructionSetDeathTest, WiderSetsRunWhereTheMachineHasThem) {
  const auto is = [](InstructionSet set) {
    return [set](int status) {
      const auto expected = std::min(set, instruction_set());
      return testing::ExitedWithCode(int(expected))(status);
    };
  };
  EXPECT_EXIT(exit_with_set("avx2"), is(InstructionSet::avx2), "");
  EXPECT_EXIT(exit_with_set("avx512"), is(InstructionSet::avx512), "");
}

void exit_with_error(const char* wanted) {
  setenv("SARDF_INSTRUCTION_SET", wanted, 1);
  try {
    instruction_set();
  } catch (const Error& error) {
    std::cerr << error.what() << '\n';
    std::exit(3);
  }
  std::exit(0);
}

TEST_F(ForcedInstructionSetDeathTest, UnknownNamesAreErrors) {
  const char* message = "SARDF_INSTRUCTION_SET is 'sse9'; accepted are baseline, avx2 and avx512";
  EXPECT_EXIT(exit_with_error("sse9"), testing::ExitedWithCode(3), message);
  EXPECT_EXIT(exit_with_error(""), testing::ExitedWithCode(3), "accepted are baseline, avx2");
}

}  // namespace
}  // namespace sardf

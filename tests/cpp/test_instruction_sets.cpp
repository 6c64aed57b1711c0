// Baseline, AVX2 and AVX-512 give the same bits for every operation and for whole trees, and a user
// can force a narrower set.
#include <gtest/gtest.h>

#include <bit>
#include <cstdlib>
#include <iostream>
#include <map>

#include "laws.hpp"
#include "sardf/constructor.hpp"
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

/// The listed operations that can be evaluated together, in the order of their places.
std::vector<std::vector<laws::ListedOperation>> families() {
  std::map<const Together*, std::vector<laws::ListedOperation>> all;
  for (const laws::ListedOperation& listed : laws::listed_operations()) {
    const Kernels& kernels = *listed_kernels(InstructionSet::baseline, listed.name);
    if (!kernels.together) continue;
    auto& family = all[kernels.together];
    EXPECT_EQ(kernels.place, kernels.place < 0 ? -1 : int(family.size())) << listed.name;
    family.push_back(listed);
  }
  std::vector<std::vector<laws::ListedOperation>> out;
  for (const auto& [kernel, family] : all) out.push_back(family);
  return out;
}

/// As many as one call evaluates: parts of one formula with equal parameters, or any of one name.
std::vector<OperationPointer> members(const std::vector<laws::ListedOperation>& family, Random& r) {
  const Kernels& kernels = *listed_kernels(InstructionSet::baseline, family[0].name);
  const Random drawn = r;
  std::vector<OperationPointer> all;
  for (size_t k = 0; k < size_t(kernels.together->size); ++k) {
    Random again = drawn;
    all.push_back(kernels.place < 0 ? family[0].random(r) : family.at(k).random(again));
  }
  return all;
}

/// Ordinary distances, or any floats, some of them equal.
std::array<Row, max_arity> arguments(Random& r) {
  const bool ordinary = r.chance(0.5);
  std::array<Row, max_arity> in;
  for (size_t i = 0; i < points; ++i) {
    for (size_t k = 0; k < in.size(); ++k) {
      in[k][i] = ordinary ? float(r.uniform(0.5, 6)) : any_float(r);
      if (!ordinary && r.chance(0.5)) in[k][i] = std::abs(in[k][i]);
      if (k > 0 && r.chance(0.2)) in[k][i] = in[k - 1][i];
    }
  }
  return in;
}

TEST(InstructionSets, OperationsTogetherGiveTheBitsOfEach) {
  Random r(85);
  const auto all = families();
  EXPECT_EQ(all.size(), 6u);  // shares of two, three and four distances, and as many sums
  for (int i = 0; i < laws::effort(300); ++i) {
    const std::vector<OperationPointer> ops = members(all[size_t(i) % all.size()], r);
    const std::array<Row, max_arity> in = arguments(r);
    std::array<const float*, max_arity> at{};
    std::array<const void*, most_together> objects{};
    std::array<Row, most_together> together;
    std::array<float*, most_together> out{};
    for (size_t k = 0; k < size_t(ops[0]->info().arity); ++k) at[k] = in[k].data();
    for (size_t k = 0; k < ops.size(); ++k) {
      objects[k] = ops[k]->object();
      out[k] = together[k].data();
    }
    for (const InstructionSet set : instruction_sets()) {
      const auto kernels = [&](size_t k) { return listed_kernels(set, ops[k]->info().name); };
      kernels(0)->together->value(objects.data(), at.data(), out.data(), points);
      for (size_t k = 0; k < ops.size(); ++k) {
        Row alone;
        kernels(k)->value(objects[k], at.data(), alone.data(), points);
        for (size_t j = 0; j < points; ++j) {
          EXPECT_TRUE(same(together[k][j], alone[j]))
              << instruction_set_name(set) << ", " << ops[k]->info().name << ": " << together[k][j]
              << ", alone " << alone[j] << " at " << in[0][j] << ", " << in[1][j];
        }
      }
    }
  }
}

/// The result of `next` for `first` and that of `op` there.
Row one_after_the_other(InstructionSet set, const Operation& op, const Operation& next,
                        const float* const* at, const Row& first) {
  Row second, out;
  listed_kernels(set, op.info().name)->value(op.object(), at, second.data(), points);
  const std::array<const float*, max_arity> both{first.data(), second.data()};
  listed_kernels(set, next.info().name)->value(next.object(), both.data(), out.data(), points);
  return out;
}

const Fused& fused_kernels(InstructionSet set, const Operation& op, const Operation& next) {
  return *listed_kernels(set, op.info().name)->fused_with(*listed_kernels(set, next.info().name));
}

void expect_fused_gives_the_bits_of_each(InstructionSet set, const Operation& op,
                                         const Operation& next, Random& r) {
  const std::array<Row, max_arity> in = arguments(r);
  const Row& first = in[max_arity - 1];
  std::array<const float*, max_arity> at{};
  for (size_t k = 0; k < size_t(op.info().arity); ++k) at[k] = in[k].data();
  const Row expected = one_after_the_other(set, op, next, at.data(), first);
  Row got;
  fused_kernels(set, op, next)
      .value(op.object(), next.object(), at.data(), first.data(), got.data(), points);
  for (size_t i = 0; i < points; ++i) {
    EXPECT_TRUE(same(got[i], expected[i]))
        << instruction_set_name(set) << ", " << op.info().name << ", " << next.info().name << ": "
        << got[i] << ", one after the other " << expected[i] << " at " << in[0][i] << ", "
        << in[1][i] << ", " << in[2][i];
  }
}

TEST(InstructionSets, FusedOperationsGiveTheBitsOfOneAfterTheOther) {
  Random r(87);
  int pairs = 0;
  for (const laws::ListedOperation& listed : laws::listed_operations()) {
    if (listed_kernels(InstructionSet::baseline, listed.name)->fused.empty()) continue;
    for (const laws::ListedOperation& other : laws::listed_operations()) {
      for (const InstructionSet set : instruction_sets()) {
        const Kernels& kernels = *listed_kernels(set, listed.name);
        const Fused* const fused = kernels.fused_with(*listed_kernels(set, other.name));
        if (!fused || !fused->value) continue;
        ++pairs;
        for (int i = 0; i < laws::effort(20); ++i) {
          expect_fused_gives_the_bits_of_each(set, *listed.random(r), *other.random(r), r);
        }
      }
    }
  }
  // Nine solids and four of the plane; the union, the intersection and the difference.
  EXPECT_EQ(pairs, 39 * int(instruction_sets().size()));
}

OperationPointer operation(const char* name, const std::vector<Value>& values) {
  return make_field(name, values).expression()->operation;
}

/// Solids that differ in their middles only.
std::vector<OperationPointer> alike(int kind, size_t count, Random& r) {
  const double radius = r.uniform(0.1, 3), height = r.uniform(0.1, 3), z = r.ordinary();
  std::vector<OperationPointer> all;
  while (all.size() < count) {
    const double x = r.chance(0.1) ? r.spicy(1e30) : r.ordinary(), y = r.ordinary();
    const auto bar = [&](const Value& of) {
      return operation("cylinder", {Vec3{x, y, z}, Vec3{0, 0, 1}, radius, of});
    };
    all.push_back(kind == 0   ? operation("sphere", {Vec3{x, y, r.ordinary()}, radius})
                  : kind == 1 ? operation("disc", {std::array{x, y}, radius})
                  : kind == 2 ? bar(Value())
                              : bar(height));
  }
  return all;
}

void expect_several_give_the_bits_of_each(InstructionSet set, const Operation& next,
                                          const std::vector<OperationPointer>& ops, Random& r) {
  const Fused& fused = fused_kernels(set, *ops[0], next);
  std::array<Row, max_arity> in = arguments(r);
  // A blend's result before lies in its band, or near it.
  if (r.chance(0.5)) {
    for (float& first : in[3]) first = float(r.uniform(-4, 1));
  }
  const std::array<const float*, max_arity> at{in[0].data(), in[1].data(), in[2].data()};
  std::vector<const void*> objects;
  Row expected = in[3], got;
  for (const OperationPointer& op : ops) {
    ASSERT_TRUE(fused.alike(ops[0]->object(), op->object()));
    objects.push_back(op->object());
    expected = one_after_the_other(set, *op, next, at.data(), expected);
  }
  fused.several(objects.data(), objects.size(), next.object(), at.data(), in[3].data(), got.data(),
                points);
  for (size_t i = 0; i < points; ++i) {
    EXPECT_TRUE(same(got[i], expected[i]))
        << instruction_set_name(set) << ", " << ops.size() << " of " << ops[0]->info().name << ", "
        << next.info().name << ": " << got[i] << ", one after the other " << expected[i] << " at "
        << in[0][i] << ", " << in[1][i] << ", " << in[2][i] << " of " << in[3][i];
  }
}

TEST(InstructionSets, SolidsThatAreAlikeGiveTheBitsOfOneAfterTheOther) {
  Random r(88);
  const std::vector solids{make_field("sphere", {Vec3{}, 1.0}),
                           make_field("box", {Vec3{}, Vec3{1, 1, 1}})};
  for (const char* name : {"union", "intersection", "difference"}) {
    for (int i = 0; i < laws::effort(800); ++i) {
      const double width = r.chance(0.1) ? r.decades(-50, 50) : r.decades(-2, 0.5);
      const BlendPointer blends[] = {min_max_blend(), make_blend("sardf", {width}),
                                     make_blend("sardf_c1", {width}),
                                     make_blend("smooth", {width})};
      const Field joined = make_field(name, {solids, r.one_of(blends)});
      const size_t count = r.chance(0.1) ? most_pairs : size_t(2 + r.below(5));
      const std::vector<OperationPointer> ops = alike(i % 4, count, r);
      for (const InstructionSet set : instruction_sets()) {
        expect_several_give_the_bits_of_each(set, *joined.expression()->operation, ops, r);
      }
    }
  }
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

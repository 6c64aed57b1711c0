// Laws of every operation: bulk kernels agree with the scalar double, and with one another.
#include <gtest/gtest.h>

#include <bit>

#include "laws.hpp"
#include "sardf/kernels.hpp"

namespace sardf {
namespace {

using laws::Random;

constexpr size_t points = 64;
/// Allowed float error, relative to the largest argument, scale or result.
constexpr double float_tolerance = 8e-7;
/// Squares of floats below this are 0.
constexpr double vanishing = 2e-19;

std::vector<InstructionSet> instruction_sets() {
  std::vector<InstructionSet> sets;
  for (const auto set : {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512}) {
    if (set <= instruction_set()) sets.push_back(set);
  }
  return sets;
}

struct Batch {
  explicit Batch(int arity) : inputs(size_t(arity), std::vector<float>(points)) {}
  Batch(Random& r, int arity) : Batch(arity) {
    for (size_t i = 0; i < points; ++i) {
      const std::vector<double> at = r.values(arity, 0.1, 1e12);
      for (size_t k = 0; k < at.size(); ++k) inputs[k][i] = float(at[k]);
    }
  }
  std::array<const float*, max_arity> pointers() const {
    std::array<const float*, max_arity> at{};
    for (size_t k = 0; k < inputs.size(); ++k) at[k] = inputs[k].data();
    return at;
  }
  std::vector<double> at(size_t i) const {
    std::vector<double> values;
    for (const std::vector<float>& input : inputs) values.push_back(input[i]);
    return values;
  }
  std::vector<std::vector<float>> inputs;
};

struct Result {
  std::vector<float> value = std::vector<float>(points);
  std::vector<std::vector<float>> partial;
};

Result run(const Operation& op, const Kernels& kernels, const Batch& batch) {
  Result result;
  result.partial.assign(batch.inputs.size(), std::vector<float>(points));
  std::array<float*, max_arity> partial{};
  for (size_t k = 0; k < result.partial.size(); ++k) partial[k] = result.partial[k].data();
  std::vector<float> again(points);
  kernels.partials(op.object(), batch.pointers().data(), again.data(), partial.data(), points);
  kernels.value(op.object(), batch.pointers().data(), result.value.data(), points);
  for (size_t i = 0; i < points; ++i) {
    // The value that comes with the partials is the value.
    EXPECT_TRUE(std::isnan(again[i]) || again[i] == result.value[i]);
  }
  return result;
}

// What the result can be where the arguments are right within float rounding. It judges functions
// that amplify rounding (a sum that cancels, floor, a quotient) and comparisons.
Interval around(const Operation& op, const std::vector<double>& in, double most) {
  std::array<Interval, max_arity> near;
  for (size_t k = 0; k < in.size(); ++k) {
    const double slack = 4 * 0x1p-24 * most;
    near[k] = {in[k] - slack, in[k] + slack};
  }
  return op.interval(near.data());
}

// The terms of a polynomial may be larger than all of these: a factor by two coordinates.
double largest_term(const Operation& op, const std::vector<double>& in) {
  double factor = 0, at = 1;
  for (const double number : op.numbers()) factor = std::max(factor, std::abs(number));
  for (const double a : in) at = std::max(at, std::abs(a));
  return factor * at * at;
}

void expect_near_scalar(const Operation& op, const std::vector<double>& in, float result) {
  const double expected = op.evaluate(in.data());
  // Beyond the range of float squares overflow.
  if (std::isnan(expected) || std::abs(expected) > 1e30) return;
  double most = std::max(std::abs(expected), op.scale());
  for (const double a : in) most = std::max(most, std::abs(a));
  const bool is_function = op.info().kind == Kind::function || op.info().name == "integer_power";
  const bool is_polynomial = op.info().kind == Kind::solid && !op.is_distance();
  const double largest = is_polynomial ? std::max(most, largest_term(op, in)) : most;
  const double slack = float_tolerance * largest + vanishing;
  if (std::abs(result - expected) <= slack) return;
  const Interval near = is_function || is_polynomial ? around(op, in, most) : Interval(expected);
  EXPECT_TRUE(near.lo - slack <= result && result <= near.hi + slack)
      << "float " << result << ", double " << expected << " at " << testing::PrintToString(in)
      << ", parameters " << testing::PrintToString(op.numbers());
}

TEST(BatchLaws, KernelsEqualScalars) {
  laws::for_operations(laws::effort(60), [](auto, const Operation& op, Random& r) {
    const Batch batch(r, op.info().arity);
    const Result result = run(op, op.kernels(), batch);
    for (size_t i = 0; i < points; ++i) expect_near_scalar(op, batch.at(i), result.value[i]);
  });
}

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

// Blocks of doubles are computed two at a time, with the bits of one at a time.
TEST(BatchLaws, BlocksOfDoublesEqualPoints) {
  laws::for_operations(laws::effort(60), [](auto, const Operation& op, Random& r) {
    constexpr size_t odd = points - 1;
    const size_t arity = size_t(op.info().arity);
    std::vector<std::vector<double>> inputs(arity, std::vector<double>(odd)), partial = inputs;
    for (size_t i = 0; i < odd; ++i) {
      const std::vector<double> at = r.values(op.info().arity, 0.1, 1e12);
      for (size_t k = 0; k < arity; ++k) inputs[k][i] = at[k];
    }
    std::array<const double*, max_arity> in{};
    std::array<double*, max_arity> by{};
    for (size_t k = 0; k < arity; ++k) {
      in[k] = inputs[k].data();
      by[k] = partial[k].data();
    }
    std::vector<double> block(odd), with_partials(odd);
    op.evaluate(in.data(), block.data(), odd);
    op.partials(in.data(), with_partials.data(), by.data(), odd);
    for (size_t i = 0; i < odd; ++i) {
      std::vector<double> at;
      for (const std::vector<double>& input : inputs) at.push_back(input[i]);
      const double one = op.evaluate(at.data());
      EXPECT_TRUE(same(block[i], one) && same(with_partials[i], one))
          << block[i] << ", " << with_partials[i] << " and " << one << " at "
          << testing::PrintToString(at) << ", parameters " << testing::PrintToString(op.numbers());
      const std::vector<double> partial_of_one = laws::partials_at(op, at);
      for (size_t k = 0; k < arity; ++k) {
        EXPECT_TRUE(same(partial[k][i], partial_of_one[k]))
            << "partial " << k << ": " << partial[k][i] << " and " << partial_of_one[k] << " at "
            << testing::PrintToString(at) << ", parameters "
            << testing::PrintToString(op.numbers());
      }
    }
  });
}

TEST(BatchLaws, InstructionSetsAgreeExactly) {
  laws::for_operations(laws::effort(60), [](auto, const Operation& op, Random& r) {
    const Batch batch(r, op.info().arity);
    const Kernels* baseline = listed_kernels(InstructionSet::baseline, op.info().name);
    ASSERT_NE(baseline, nullptr);
    const Result expected = run(op, *baseline, batch);
    for (const InstructionSet set : instruction_sets()) {
      SCOPED_TRACE(instruction_set_name(set));
      const Kernels* kernels = listed_kernels(set, op.info().name);
      ASSERT_NE(kernels, nullptr);
      EXPECT_EQ(kernels == baseline, set == InstructionSet::baseline);
      const Result result = run(op, *kernels, batch);
      for (size_t i = 0; i < points; ++i) {
        EXPECT_TRUE(same(result.value[i], expected.value[i]))
            << result.value[i] << " and " << expected.value[i] << " at "
            << testing::PrintToString(batch.at(i)) << ", parameters "
            << testing::PrintToString(op.numbers());
        for (size_t k = 0; k < result.partial.size(); ++k) {
          EXPECT_TRUE(same(result.partial[k][i], expected.partial[k][i]))
              << "partial " << k << ": " << result.partial[k][i] << " and "
              << expected.partial[k][i] << " at " << testing::PrintToString(batch.at(i));
        }
      }
    }
  });
}

// Float partials match where the exact ones hardly change within the rounding of the arguments.
TEST(BatchLaws, FloatPartialsEqualDoublePartials) {
  laws::for_operations(laws::effort(30), [](auto, const Operation& op, Random& r) {
    Batch batch(op.info().arity);
    for (size_t i = 0; i < points; ++i) {
      for (std::vector<float>& input : batch.inputs) input[i] = float(r.ordinary());
    }
    const Result result = run(op, op.kernels(), batch);
    size_t compared = 0;
    for (size_t i = 0; i < points; ++i) {
      const std::vector<double> in = batch.at(i), expected = laws::partials_at(op, in);
      double change = 0, most = 1;
      for (size_t k = 0; k < in.size(); ++k) {
        for (const double step : {-1e-4, 1e-4}) {
          std::vector<double> beside = in;
          beside[k] += step;
          const std::vector<double> partial = laws::partials_at(op, beside);
          for (size_t j = 0; j < in.size(); ++j) {
            const double difference = std::abs(partial[j] - expected[j]);
            change = std::isnan(difference) ? infinity : std::max(change, difference);
            most = std::max(most, std::abs(expected[j]));
          }
        }
      }
      if (!(change < 0.01 * most)) continue;
      ++compared;
      for (size_t k = 0; k < in.size(); ++k) {
        EXPECT_NEAR(result.partial[k][i], expected[k], change + 2e-3 * most)
            << "partial " << k << " at " << testing::PrintToString(in) << ", parameters "
            << testing::PrintToString(op.numbers());
      }
    }
    EXPECT_GT(compared, 0u);
  });
}

// Every constructor as a whole, its shapes' compositions included.
TEST(BatchLaws, FieldsInFloatEqualFieldsInDouble) {
  Random r(7);
  size_t tested = 0;
  for (const Constructor& constructor : constructors()) {
    if (!laws::can_be_random(constructor)) continue;
    ++tested;
    SCOPED_TRACE(constructor.name);
    for (int i = 0; i < laws::effort(30); ++i) {
      const Evaluator evaluator(random_field(r, constructor, 1).expression());
      std::vector<float> at(3 * points), out(points);
      for (float& a : at) a = float(r.ordinary());
      const std::vector<double> exact(at.begin(), at.end());
      std::vector<double> expected(points);
      evaluator.values(at.data(), points, out.data());
      evaluator.values(exact.data(), points, expected.data());
      for (size_t k = 0; k < points; ++k) {
        // Rounded coordinates move the value by as much as it is steep.
        double gradient[3];
        evaluator.gradients(&exact[3 * k], 1, nullptr, gradient);
        const double steepness = std::hypot(gradient[0], gradient[1], gradient[2]);
        const double tolerance = 1e-4 * (steepness > 1 ? steepness : 1);
        EXPECT_NEAR(out[k], expected[k], tolerance) << testing::PrintToString(at);
      }
    }
  }
  EXPECT_GT(tested, 20u);
}

}  // namespace
}  // namespace sardf

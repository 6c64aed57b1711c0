// The exponential, the logarithm and powers of floats, against those of the C library in long
// double.
#include "sardf/numbers/exponentials.hpp"

#include <gtest/gtest.h>

#include <random>

#include "float_functions.hpp"
#include "sardf/numbers/powers.hpp"

namespace sardf {
namespace {

using namespace float_functions;

TEST(Exponentials, AreWithinTheirBounds) {
  const InstructionSet set = instruction_set();
  for_floats(9973, [&](const Row& in) {
    const Row exponential = apply(set, "exp", in), logarithm = apply(set, "log", in);
    for (size_t i = 0; i < n; ++i) {
      const auto exact = static_cast<long double>(in[i]);
      EXPECT_TRUE(is_near(exponential[i], std::exp(exact), largest_ulps_of_exp)) << in[i];
      EXPECT_TRUE(is_near(logarithm[i], std::log(exact), largest_ulps_of_log)) << in[i];
    }
  });
}

TEST(Exponentials, AreExactWhereTheResultIs) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  Row in{};
  const float at[] = {0, -0.0f, 1, inf, -inf, -1, NAN, 200, -200, 0x1p-149f};
  std::copy(std::begin(at), std::end(at), in.begin());
  const Row e = apply(instruction_set(), "exp", in), l = apply(instruction_set(), "log", in);
  EXPECT_EQ(e[0], 1);
  EXPECT_EQ(e[1], 1);
  EXPECT_EQ(e[3], inf);
  EXPECT_EQ(e[4], 0);
  EXPECT_TRUE(std::isnan(e[6]));
  EXPECT_EQ(e[7], inf);
  EXPECT_EQ(e[8], 0);
  EXPECT_EQ(l[0], -inf);
  EXPECT_EQ(l[1], -inf);
  EXPECT_EQ(l[2], 0);
  EXPECT_EQ(l[3], inf);
  EXPECT_TRUE(std::isnan(l[4]));
  EXPECT_TRUE(std::isnan(l[5]));
  EXPECT_TRUE(std::isnan(l[6]));
  EXPECT_FLOAT_EQ(l[9], float(-149 * std::log(2.0)));
}

TEST(Exponentials, HaveTheSameBitsOnEveryInstructionSet) {
  for_floats(99991, [&](const Row& in) {
    expect_same_bits("exp", in);
    expect_same_bits("log", in);
  });
}

void expect_powers_near(const Row& base, const Row& exponent) {
  const Row got = apply(instruction_set(), "pow", base, exponent);
  for (size_t i = 0; i < n; ++i) {
    const auto a = static_cast<long double>(base[i]), b = static_cast<long double>(exponent[i]);
    // The C library's own function, where it takes over, is right within one unit.
    const bool is_own = a >= 0x1p-126L && std::isfinite(a) && std::isfinite(b);
    EXPECT_TRUE(is_near(got[i], std::pow(a, b), is_own ? largest_ulps_of_pow : 1))
        << base[i] << " to the power " << exponent[i] << ": " << got[i];
  }
}

/// work(bases, exponents) on rows of random numbers: any bits, bases near 1 whose powers are
/// ordinary all the same, and what formulas have.
template <class Work>
void for_random_powers(int rows, Work work) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(0, 1);
  for (int row = 0; row < rows; ++row) {
    Row base, exponent;
    for (size_t i = 0; i < n; ++i) {
      base[i] = std::bit_cast<float>(uint32_t(random()));
      exponent[i] = std::bit_cast<float>(uint32_t(random()));
      if (i % 4 == 0) continue;
      base[i] = i % 4 == 1 ? 1 + 0.001f * (unit(random) - 0.5f) : 20 * unit(random);
      exponent[i] = (i % 4 == 1 ? 300000 : 20) * (unit(random) - 0.5f);
    }
    work(base, exponent);
  }
}

TEST(Powers, AreWithinTheirBounds) { for_random_powers(400, expect_powers_near); }

// Zeros and infinities of both signs, NaN, negative bases, denormals, the ends of the floats, whole
// powers: each with each, where ordinary numbers stand beside them.
TEST(Powers, OfSpecialNumbers) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  const float special[] = {0,
                           -0.0f,
                           1,
                           -1,
                           2,
                           -2,
                           3,
                           -3,
                           0.5f,
                           -0.5f,
                           inf,
                           -inf,
                           NAN,
                           0x1p-149f,
                           -0x1p-149f,
                           0x1p-127f,
                           0x1p-126f,
                           0x1.fffffep127f,
                           1e30f,
                           1e-30f,
                           0x1.000002p0f,
                           0x1.fffffep-1f,
                           126,
                           -149,
                           0x1p23f,
                           0x1p24f};
  Row base, exponent;
  size_t filled = 0;
  for (const float a : special) {
    for (const float b : special) {
      base[filled] = a;
      exponent[filled++] = b;
    }
  }
  ASSERT_LE(filled, n);
  std::fill(base.begin() + filled, base.end(), 3.0f);
  std::fill(exponent.begin() + filled, exponent.end(), 2.0f);
  expect_powers_near(base, exponent);
  expect_same_bits("pow", base, exponent);
}

TEST(Powers, HaveTheSameBitsOnEveryInstructionSet) {
  for_random_powers(40, [](const Row& base, const Row& by) { expect_same_bits("pow", base, by); });
}

}  // namespace
}  // namespace sardf

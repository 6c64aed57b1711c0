// The sine and the cosine of floats, against those of the C library in long double.
#include "sardf/numbers/sines.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "float_functions.hpp"

namespace sardf {
namespace {

using namespace float_functions;

void expect_near(const Row& in) {
  const Row sine = apply(instruction_set(), "sin", in),
            cosine = apply(instruction_set(), "cos", in);
  for (size_t i = 0; i < n; ++i) {
    // The C library's own functions, where they take over, are right within one unit.
    const bool is_own = std::abs(in[i]) <= float(largest_reduced_angle);
    const auto angle = static_cast<long double>(in[i]);
    EXPECT_TRUE(is_near(sine[i], std::sin(angle), is_own ? largest_ulps_of_sin : 1)) << in[i];
    EXPECT_TRUE(is_near(cosine[i], std::cos(angle), is_own ? largest_ulps_of_cos : 1)) << in[i];
  }
}

// Denormals, huge numbers, infinities and NaN are among them.
TEST(Sines, AreWithinTheirBounds) { for_floats(9973, expect_near); }

// Where one of them is small and what is left of the angle has cancelled, for all quarter turns up
// to the largest reduced angle and some beyond.
TEST(Sines, AreWithinTheirBoundsNearEveryQuarterTurn) {
  constexpr long double quarter = std::numbers::pi_v<long double> / 2;
  constexpr float inf = std::numeric_limits<float>::infinity();
  Row row;
  size_t filled = 0;
  for (int turns = 0; turns * quarter < 1.01L * largest_reduced_angle; ++turns) {
    const float nearest = float(turns * quarter);
    for (const float angle :
         {nearest, -nearest, std::nextafter(nearest, inf), std::nextafter(nearest, -inf)}) {
      row[filled++] = angle;
    }
    if (filled < n) continue;
    expect_near(row);
    filled = 0;
  }
}

TEST(Sines, OfZerosAndDenormalsAreExact) {
  constexpr float tiny = 0x1p-149f;
  Row in{};
  const float at[] = {0, -0.0f, tiny, -tiny, 0x1.23p-130f};
  std::copy(std::begin(at), std::end(at), in.begin());
  const Row sine = apply(instruction_set(), "sin", in),
            cosine = apply(instruction_set(), "cos", in);
  for (size_t i = 0; i < std::size(at); ++i) {
    EXPECT_EQ(std::bit_cast<uint32_t>(sine[i]), std::bit_cast<uint32_t>(at[i])) << at[i];
    EXPECT_EQ(cosine[i], 1) << at[i];
  }
}

// Mirrored solids are mirrored in every bit.
TEST(Sines, AreOddAndEven) {
  for_floats(999983, [](const Row& in) {
    Row mirrored;
    for (size_t i = 0; i < n; ++i) mirrored[i] = -in[i];
    const InstructionSet set = instruction_set();
    const Row sine = apply(set, "sin", in), other_sine = apply(set, "sin", mirrored);
    const Row cosine = apply(set, "cos", in), other_cosine = apply(set, "cos", mirrored);
    for (size_t i = 0; i < n; ++i) {
      if (!std::isfinite(in[i])) continue;
      EXPECT_EQ(sine[i], -other_sine[i]) << in[i];
      EXPECT_EQ(cosine[i], other_cosine[i]) << in[i];
    }
  });
}

// Some numbers of a vector are beyond the largest reduced angle: the others keep their bits.
TEST(Sines, DoNotDependOnTheNumbersBeside) {
  constexpr float beyond[] = {3e7f, std::numeric_limits<float>::infinity(), NAN};
  Row alone, beside;
  for (size_t i = 0; i < n; ++i) {
    alone[i] = 0.37f * float(i) - 150;
    beside[i] = i % 3 == 0 ? beyond[i / 3 % 3] : alone[i];
  }
  for (const char* name : {"sin", "cos"}) {
    const Row expected = apply(instruction_set(), name, alone);
    const Row got = apply(instruction_set(), name, beside);
    for (size_t i = 0; i < n; ++i) {
      if (i % 3 == 0) continue;
      EXPECT_EQ(got[i], expected[i]) << name << ' ' << alone[i];
    }
  }
}

TEST(Sines, HaveTheSameBitsOnEveryInstructionSet) {
  for_floats(99991, [](const Row& in) {
    expect_same_bits("sin", in);
    expect_same_bits("cos", in);
  });
}

}  // namespace
}  // namespace sardf

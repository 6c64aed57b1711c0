// The exponential and the logarithm of floats, against those of the C library in double.
#include "sardf/numbers/exponentials.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>

#include "sardf/kernels.hpp"
#include "sardf/ops_functions.hpp"

namespace sardf {
namespace {

constexpr size_t n = 1024;
using Row = std::array<float, n>;

Row apply(InstructionSet set, const char* name, const Row& in) {
  Row out;
  const float* from[] = {in.data()};
  const Exponential operation;  // neither operation has parameters
  listed_kernels(set, name)->value(&operation, from, out.data(), n);
  return out;
}

/// work(row) on rows that hold every `stride`th of all floats.
template <class Work>
void for_floats(uint64_t stride, Work work) {
  Row row;
  size_t filled = 0;
  for (uint64_t bits = 0; bits < (uint64_t(1) << 32); bits += stride) {
    row[filled++] = std::bit_cast<float>(static_cast<uint32_t>(bits));
    if (filled < n) continue;
    work(row);
    filled = 0;
  }
}

double unit_in_last_place(double exact) {
  if (std::abs(exact) < 0x1p-126) return 0x1p-149;
  return std::ldexp(1.0, std::ilogb(exact) - 23);
}

void expect_near(double x, double got, double exact, double ulps) {
  if (std::isnan(exact)) {
    EXPECT_TRUE(std::isnan(got)) << x;
  } else if (std::isinf(float(exact)) || exact == 0) {
    EXPECT_EQ(got, double(float(exact))) << x;
  } else {
    EXPECT_LE(std::abs(got - exact), ulps * unit_in_last_place(exact)) << x;
  }
}

TEST(Exponentials, AreWithinTheirBounds) {
  const InstructionSet set = instruction_set();
  for_floats(9973, [&](const Row& in) {
    const Row exponential = apply(set, "exp", in), logarithm = apply(set, "log", in);
    for (size_t i = 0; i < n; ++i) {
      expect_near(in[i], exponential[i], std::exp(double(in[i])), largest_ulps_of_exp);
      expect_near(in[i], logarithm[i], std::log(double(in[i])), largest_ulps_of_log);
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
  for (const char* name : {"exp", "log"})
    for_floats(99991, [&](const Row& in) {
      const Row expected = apply(InstructionSet::baseline, name, in);
      for (InstructionSet set = InstructionSet::avx2; set <= instruction_set();
           set = InstructionSet(int(set) + 1)) {
        const Row got = apply(set, name, in);
        for (size_t i = 0; i < n; ++i) {
          if (std::isnan(expected[i]) && std::isnan(got[i])) continue;
          EXPECT_EQ(std::bit_cast<uint32_t>(got[i]), std::bit_cast<uint32_t>(expected[i])) << in[i];
        }
      }
    });
}

}  // namespace
}  // namespace sardf

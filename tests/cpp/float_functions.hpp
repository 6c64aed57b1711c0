// The kernels of functions of floats, and the comparison of their results with exact ones.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "sardf/kernels.hpp"
#include "sardf/ops_functions.hpp"

namespace sardf::float_functions {

inline constexpr size_t n = 1024;
using Row = std::array<float, n>;

/// The function of the formula language with this name, which has no parameters, of all numbers in
/// a row; the second row is for functions of two arguments.
inline Row apply(InstructionSet set, const char* name, const Row& a, const Row& b = {}) {
  Row out;
  const float* from[] = {a.data(), b.data()};
  const Exponential any;
  listed_kernels(set, name)->value(&any, from, out.data(), n);
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

inline long double unit_in_last_place(long double exact) {
  if (std::abs(exact) < 0x1p-126L) return 0x1p-149L;
  return std::ldexp(1.0L, std::ilogb(exact) - 23);
}

/// Whether `got` is within `ulps` units in the last place of `exact`; infinities, zeros with their
/// signs, and NaN must be the same.
inline bool is_near(float got, long double exact, double ulps) {
  const float nearest = float(exact);
  if (std::isnan(exact)) return std::isnan(got);
  if (std::isinf(nearest) || exact == 0) {
    return got == nearest && std::signbit(got) == std::signbit(nearest);
  }
  return std::abs(got - exact) <= ulps * unit_in_last_place(exact);
}

/// Every instruction set of this machine gives the bits of the baseline, where a NaN is any NaN.
inline void expect_same_bits(const char* name, const Row& a, const Row& b = {}) {
  const Row expected = apply(InstructionSet::baseline, name, a, b);
  for (InstructionSet set = InstructionSet::avx2; set <= instruction_set();
       set = InstructionSet(int(set) + 1)) {
    const Row got = apply(set, name, a, b);
    for (size_t i = 0; i < n; ++i) {
      if (std::isnan(expected[i]) && std::isnan(got[i])) continue;
      EXPECT_EQ(std::bit_cast<uint32_t>(got[i]), std::bit_cast<uint32_t>(expected[i]))
          << name << ' ' << a[i] << ' ' << b[i] << ' ' << instruction_set_name(set);
    }
  }
}

}  // namespace sardf::float_functions

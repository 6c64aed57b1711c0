// Powers of several floats at once: a^b = 2^(b log2 a).
//
// Computed in double, in one order and never fused, so every instruction set gives the same bits.
// The polynomials were found by Remez's algorithm. Where a is not a positive normal number, or b is
// not finite, the C library's function is called for each.
#pragma once

#include <cmath>
#include <limits>

#include "sardf/numbers/exponentials.hpp"
#include "sardf/numbers/halves.hpp"

namespace sardf {

/// A bound of the error in units in the last place of the exact result: half a unit, and what the
/// two polynomials' relative errors come to, 2^-34.3 and, for a result of 2^150, 150 ln 2 2^-37.8.
inline constexpr double largest_ulps_of_pow = 0.51;

namespace powers {

inline constexpr int exponent_shift = 52;
inline constexpr long long exponent_bias = 1023;
// Adding it rounds to a whole number, which the sum's lowest bits hold.
inline constexpr double rounder = 0x1.8p52;
// Powers of two beyond are 0 or infinite in floats.
inline constexpr double largest_exponent = 200;

/// log2 m for m between sqrt(1/2) and sqrt(2): odd in (m - 1) / (m + 1).
template <class H>
H log2_near_one(H m) {
  const H s = (m - H(1.0)) / (m + H(1.0));
  return s * exponentials::polynomial(s * s, 0x1.5ce7cee13f35ap-2, 0x1.a58d8fb149cbcp-2,
                                      0x1.27777fda7f056p-1, 0x1.ec709d12e1456p-1,
                                      0x1.71547652bede5p+1);
}

template <class H>
H two_to(H a) {
  // Constants stand first: a NaN must stay.
  const H t = min(H(largest_exponent), max(H(-largest_exponent), a));
  const H sum = t + H(rounder), r = t - (sum - H(rounder));
  const H power_of_rest = exponentials::polynomial(
      r, 0x1.fde5fdafe4c5ep-17, 0x1.445c842f143c7p-13, 0x1.5d8a85ff6bf29p-10, 0x1.3b29f39d1b8bcp-7,
      0x1.c6b08ac06ac77p-5, 0x1.ebfbe0778756cp-3, 0x1.62e42ff0e1929p-1, 1.0);
  const auto exponent = ((typename H::Ints)sum.v + exponent_bias) << exponent_shift;
  return power_of_rest * H((typename H::Values)exponent);
}

}  // namespace powers

template <class Isa>
Lanes<Isa> pow_of_floats(Lanes<Isa> a, Lanes<Isa> b) {
  using L = Lanes<Isa>;
  using Ints = typename L::Ints;
  using Values = typename L::Values;
  // a = 2^n m with m between sqrt(1/2) and sqrt(2).
  const Ints bits = (Ints)a.v;
  const Ints whole = (bits - exponentials::sqrt_half_bits) >> exponentials::exponent_shift;
  const L m = L((Values)(bits - (whole << exponentials::exponent_shift)));
  const L n = L(__builtin_convertvector(whole, Values));
  const auto power = [](auto factor, auto exponent, auto by) {
    return powers::two_to(by * (exponent + powers::log2_near_one(factor)));
  };
  const L most = double(std::numeric_limits<float>::max());
  const auto is_ordinary = a >= L(0x1p-126) && a <= most && abs(b) <= most;
  return shortcut(is_ordinary, in_double<Isa>(power, m, n, b),
                  [&] { return L::each(a, b, [](float s, float t) { return std::pow(s, t); }); });
}

}  // namespace sardf

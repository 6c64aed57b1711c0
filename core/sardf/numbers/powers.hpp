// Powers of several floats at once: a^b = 2^(b log2 a).
//
// Computed in double, in one order and never fused, so every instruction set gives the same bits.
// The polynomials were found by Remez's algorithm. Where a is -0, denormal or not finite, or b is
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

/// a^b for a > 0, a normal number.
template <class Isa>
Lanes<Isa> power_of_positive(Lanes<Isa> a, Lanes<Isa> b) {
  using L = Lanes<Isa>;
  using Ints = typename L::Ints;
  using Values = typename L::Values;
  // a = 2^n m with m between sqrt(1/2) and sqrt(2).
  const Ints bits = (Ints)a.v;
  const Ints whole = (bits - exponentials::sqrt_half_bits) >> exponentials::exponent_shift;
  const L m = L((Values)(bits - (whole << exponentials::exponent_shift)));
  const L n = L(__builtin_convertvector(whole, Values));
  const auto power = [](auto factor, auto exponent, auto by) {
    return two_to(by * (exponent + log2_near_one(factor)));
  };
  return in_double<Isa>(power, m, n, b);
}

template <class L>
auto is_whole(L a) {
  // Floats from 2^23 on are whole; adding it rounds smaller ones. A floor costs the baseline calls.
  const L size = abs(a), rounded = (size + L(0x1p23)) - L(0x1p23);
  return size >= L(0x1p23) || (rounded <= size && rounded >= size);
}

/// a^b from |a|^b: NaN for a negative a and a broken b.
template <class L>
L with_sign(L power, L a, L b) {
  const L broken(std::numeric_limits<double>::quiet_NaN());
  const L signed_power = select(is_whole(L(0.5) * b), power, -power);
  return select(a < L(0.0), select(is_whole(b), signed_power, broken), power);
}

}  // namespace powers

template <class Isa>
Lanes<Isa> pow_of_floats(Lanes<Isa> a, Lanes<Isa> b) {
  using L = Lanes<Isa>;
  const L size = abs(a), least(0x1p-126), most = double(std::numeric_limits<float>::max());
  const L power = powers::power_of_positive(size, b);
  const auto is_ordinary = a >= least && a <= most && abs(b) <= most;
  return shortcut(is_ordinary, power, [&] {
    constexpr double inf = std::numeric_limits<double>::infinity();
    const auto is_zero = size <= L(0.0);
    const L of_zero = select(b > L(0.0), L(0.0), select(b < L(0.0), L(inf), L(1.0)));
    const L result = powers::with_sign(select(is_zero, of_zero, power), a, b);
    // The sign of a power of -0 is left to the C library.
    const auto is_known = size >= least || (is_zero && L(1.0) / a > L(0.0));
    return shortcut(is_known && size <= most && abs(b) <= most, result,
                    [&] { return L::each(a, b, [](float s, float t) { return std::pow(s, t); }); });
  });
}

}  // namespace sardf

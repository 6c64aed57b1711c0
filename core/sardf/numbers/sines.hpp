// The sine and the cosine of several floats at once.
//
// An angle is x = (n + s) π + r, n a whole number, |r| <= π / 2; s is 0 for the sine and -1/2 for
// the cosine. Both functions are then (-1)^n sin r, so that one odd polynomial, small where the
// result is, serves all. π is in four parts (W. Cody, W. Waite: Software Manual for the Elementary
// Functions): products of the first three with n + s are exact, and so are their differences where
// r is small. Sums and products only, in one order and never fused, so every instruction set gives
// the same bits. Beyond the largest reduced angle, and for what is no angle, the C library's
// function is called for each.
#pragma once

#include <cmath>

#include "sardf/numbers/exponentials.hpp"

namespace sardf {

/// The largest magnitude of an angle, in radians, that takes the fast way.
inline constexpr double largest_reduced_angle = 0x1p13;
/// Bounds of the errors up to there, in units in the last place of the exact result, as found by
/// trying every float.
inline constexpr double largest_ulps_of_sin = 2.432, largest_ulps_of_cos = 2.424;

namespace sines {

inline constexpr double one_over_pi = 0x1.45f306dc9c883p-2;
// The parts of π: three of 11 bits and the rest. n + 1/2 has 13 bits.
inline constexpr double pi_parts[] = {0x1.92p+1, 0x1.fbp-11, 0x1.51p-21, 0x1.0b4612p-33};

/// (-1)^n sin(x - turns π), where n are the lowest bits of `whole`. The polynomial, found by
/// Remez's algorithm, has a relative error of at most 2^-27.2.
template <class L>
L sine_beyond(L x, L turns, L whole) {
  L r = x;
  for (const double part : pi_parts) r = r - turns * L(part);
  const L squared = r * r;
  const L rest = exponentials::polynomial(squared, 0x1.5db0d9178efa3p-19, -0x1.9f6f1ec90e8dbp-13,
                                          0x1.110ecf06e4586p-7, -0x1.55554bae8847fp-3);
  const L sine = r + r * squared * rest;
  return L((typename L::Values)((typename L::Ints)sine.v ^ ((typename L::Ints)whole.v << 31)));
}

/// a with its sign changed where b is negative.
template <class L>
L with_sign(L a, L b) {
  using Ints = typename L::Ints;
  const Ints sign = (Ints)(-typename L::Values{});
  return L((typename L::Values)((Ints)a.v ^ ((Ints)b.v & sign)));
}

}  // namespace sines

template <class L>
L sin_of_floats(L a) {
  using namespace sines;
  const L x = abs(a), whole = x * L(one_over_pi) + L(exponentials::rounder);
  // Of the magnitude: the same bits for a and -a, and the sign of 0 stays.
  const L sine = with_sign(sine_beyond(x, whole - L(exponentials::rounder), whole), a);
  return shortcut(x <= L(largest_reduced_angle), sine,
                  [&] { return L::each(a, [](float s) { return std::sin(s); }); });
}

template <class L>
L cos_of_floats(L a) {
  using namespace sines;
  const L x = abs(a), whole = (x * L(one_over_pi) + L(0.5)) + L(exponentials::rounder);
  const L cosine = sine_beyond(x, (whole - L(exponentials::rounder)) - L(0.5), whole);
  return shortcut(x <= L(largest_reduced_angle), cosine,
                  [&] { return L::each(a, [](float s) { return std::cos(s); }); });
}

}  // namespace sardf

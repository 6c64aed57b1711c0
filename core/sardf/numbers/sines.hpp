// The sine and the cosine of several floats at once.
//
// An angle is x = (n + s) π + r, n a whole number, |r| <= π / 2; s is 0 for the sine and -1/2 for
// the cosine. Both functions are then (-1)^n sin r, so that one odd polynomial, small where the
// result is, serves all. π is in two parts (W. Cody, W. Waite: Software Manual for the Elementary
// Functions): products of the first with n + s are exact. Computed in double, in one order and
// never fused, so every instruction set gives the same bits. Beyond the largest reduced angle, and
// for what is no angle, the C library's function is called for each.
#pragma once

#include <cmath>

#include "sardf/numbers/exponentials.hpp"
#include "sardf/numbers/halves.hpp"

namespace sardf {

/// The largest magnitude of an angle, in radians, that takes the fast way.
inline constexpr double largest_reduced_angle = 0x1p20;
/// Bounds of the errors up to there, in units in the last place of the exact result, as found by
/// trying every float.
inline constexpr double largest_ulps_of_sin = 0.501, largest_ulps_of_cos = 0.501;

namespace sines {

inline constexpr double one_over_pi = 0x1.45f306dc9c883p-2;
// n times the first is exact below 2^22; both together are π within 2^-86.
inline constexpr double pi_high = 0x1.921fb544p+1, pi_low = 0x1.0b4611a626331p-33;
// Adding it rounds to a whole number, which the sum's lowest bits hold.
inline constexpr double rounder = 0x1.8p52;

/// (-1)^n sin(x - turns π), where n are the lowest bits of `whole`. The polynomial, found by
/// Remez's algorithm, has a relative error of at most 2^-35.3.
template <class H>
H sine_beyond(H x, H turns, H whole) {
  const H r = (x - turns * H(pi_high)) - turns * H(pi_low);
  // r times all, and 1 last, keep the sign of 0.
  const H sine = r * exponentials::polynomial(r * r, -0x1.9a6885634f156p-26, 0x1.7170800a96ec3p-19,
                                              -0x1.a017d99f82e76p-13, 0x1.11110c49fecb2p-7,
                                              -0x1.55555547695eep-3, 1.0);
  return H((typename H::Values)((typename H::Ints)sine.v ^ ((typename H::Ints)whole.v << 63)));
}

}  // namespace sines

template <class Isa>
Lanes<Isa> sin_of_floats(Lanes<Isa> a) {
  using namespace sines;
  const auto reduced = [](auto x) {
    using H = decltype(x);
    const H whole = x * H(one_over_pi) + H(rounder);
    return sine_beyond(x, whole - H(rounder), whole);
  };
  return shortcut(abs(a) <= Lanes<Isa>(largest_reduced_angle), in_double<Isa>(reduced, a),
                  [&] { return Lanes<Isa>::each(a, [](float s) { return std::sin(s); }); });
}

template <class Isa>
Lanes<Isa> cos_of_floats(Lanes<Isa> a) {
  using namespace sines;
  const auto reduced = [](auto x) {
    using H = decltype(x);
    const H whole = (x * H(one_over_pi) + H(0.5)) + H(rounder);
    return sine_beyond(x, (whole - H(rounder)) - H(0.5), whole);
  };
  // Of the magnitude: the same bits for a and -a.
  return shortcut(abs(a) <= Lanes<Isa>(largest_reduced_angle), in_double<Isa>(reduced, abs(a)),
                  [&] { return Lanes<Isa>::each(a, [](float s) { return std::cos(s); }); });
}

}  // namespace sardf

// The exponential and the natural logarithm of several floats at once.
//
// Both use sums and products only, in one order and never fused, so every instruction set gives the
// same bits. Polynomials and the splitting of ln 2 are those of S. Moshier's Cephes library (expf,
// logf). The largest errors, over all floats: see largest_ulps_of_exp and largest_ulps_of_log.
#pragma once

#include <limits>

namespace sardf {

/// Bounds of the errors in units in the last place of the exact result, as found by trying every
/// float; results below 2^-126 have the ulp of denormal numbers, 2^-149.
inline constexpr double largest_ulps_of_exp = 0.991, largest_ulps_of_log = 0.830;

namespace exponentials {

// ln 2 in two parts: products of the first with whole numbers up to 2^15 are exact.
inline constexpr double ln2_high = 0.693359375, ln2_low = -2.12194440e-4;
// Adding it rounds to a whole number, which the sum's lowest bits hold.
inline constexpr double rounder = 0x1.8p23;
inline constexpr int rounder_bits = 0x4B400000;
inline constexpr int exponent_shift = 23, exponent_bias = 127;
inline constexpr int sqrt_half_bits = 0x3F3504F3;

/// The polynomial with these coefficients, the highest first.
template <class L, class... Coefficients>
L polynomial(L x, double highest, Coefficients... lower) {
  L sum(highest);
  ((sum = sum * x + L(lower)), ...);
  return sum;
}

template <class L>
L power_of_two(typename L::Ints n) {
  return L((typename L::Values)((n + exponent_bias) << exponent_shift));
}

}  // namespace exponentials

/// e to the power a; 0 and infinity beyond the floats, NaN for NaN.
template <class L>
L exp_of_floats(L a) {
  using namespace exponentials;
  using Ints = typename L::Ints;
  // Constants stand first: a NaN must stay.
  const L x = min(L(89.0), max(L(-104.0), a));
  const L sum = x * L(1.44269504088896341) + L(rounder);
  const L n = sum - L(rounder);
  const L r = (x - n * L(ln2_high)) - n * L(ln2_low);
  const L p = polynomial(r, 1.9875691500e-4, 1.3981999507e-3, 8.3334519073e-3, 4.1665795894e-2,
                         1.6666665459e-1, 5.0000001201e-1);
  const L q = (p * (r * r) + r) + L(1.0);
  // In two steps, since 2^n alone may be beyond the floats.
  const Ints whole = (Ints)sum.v - rounder_bits, half = whole >> 1;
  return q * power_of_two<L>(half) * power_of_two<L>(whole - half);
}

/// The natural logarithm of a: -infinity of 0, NaN of negative numbers and of NaN.
template <class L>
L log_of_floats(L a) {
  using namespace exponentials;
  using Ints = typename L::Ints;
  const auto is_small = a < L(0x1p-126);
  const L scaled = select(is_small, a * L(0x1p23), a);
  // a = 2^n m with m between sqrt(1/2) and sqrt(2).
  const Ints bits = (Ints)scaled.v, whole = (bits - sqrt_half_bits) >> exponent_shift;
  const L m = L((typename L::Values)(bits - (whole << exponent_shift)));
  const L n =
      L(__builtin_convertvector(whole, typename L::Values)) - select(is_small, L(23.0), L(0.0));
  const L f = m - L(1.0), squared = f * f;
  const L p = polynomial(f, 7.0376836292e-2, -1.1514610310e-1, 1.1676998740e-1, -1.2420140846e-1,
                         1.4249322787e-1, -1.6668057665e-1, 2.0000714765e-1, -2.4999993993e-1,
                         3.3333331174e-1);
  const L rest = (p * f * squared + n * L(ln2_low)) - L(0.5) * squared;
  const L result = (f + rest) + n * L(ln2_high);
  constexpr double inf = std::numeric_limits<double>::infinity();
  const L beyond = select(a < L(0.0), L(std::numeric_limits<double>::quiet_NaN()), L(-inf));
  return select(a < L(inf), select(a > L(0.0), result, beyond), a);
}

}  // namespace sardf

// The number type for bulk evaluation: several floats at once, or two doubles.
//
// One class for each instruction set, so that the templates instantiated for it are distinct types:
// code compiled for AVX-512 can never be merged by the linker into the baseline's.
#pragma once

#include <cmath>
#include <cstring>
#include <type_traits>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "sardf/numbers/exponentials.hpp"
#include "sardf/numbers/powers.hpp"
#include "sardf/numbers/real.hpp"
#include "sardf/numbers/sines.hpp"

namespace sardf {

struct Baseline {
  static constexpr int width = 4;
  using Number = float;
  typedef float Values __attribute__((vector_size(16)));
  typedef int Ints __attribute__((vector_size(16)));
};
struct Avx2 {
  static constexpr int width = 8;
  using Number = float;
  typedef float Values __attribute__((vector_size(32)));
  typedef int Ints __attribute__((vector_size(32)));
};
struct Avx512 {
  static constexpr int width = 16;
  using Number = float;
  typedef float Values __attribute__((vector_size(64)));
  typedef int Ints __attribute__((vector_size(64)));
};
/// Doubles with the same results as one by one; on every machine that compiles for the baseline.
struct TwoDoubles {
  static constexpr int width = 2;
  using Number = double;
  typedef double Values __attribute__((vector_size(16)));
  typedef long long Ints __attribute__((vector_size(16)));
};

template <class Isa>
struct LanesMask {
  typename Isa::Ints bits;
  friend LanesMask operator&&(LanesMask a, LanesMask b) { return {a.bits & b.bits}; }
  friend LanesMask operator||(LanesMask a, LanesMask b) { return {a.bits | b.bits}; }
  friend LanesMask operator!(LanesMask a) { return {~a.bits}; }
};
#if defined(__AVX512F__)
/// AVX-512 has registers for masks, and moves between them and vectors are dear.
template <>
struct LanesMask<Avx512> {
  __mmask16 bits;
  friend LanesMask operator&&(LanesMask a, LanesMask b) { return {__mmask16(a.bits & b.bits)}; }
  friend LanesMask operator||(LanesMask a, LanesMask b) { return {__mmask16(a.bits | b.bits)}; }
  friend LanesMask operator!(LanesMask a) { return {__mmask16(~a.bits)}; }
};
#endif

template <class Isa>
bool all(LanesMask<Isa> mask) {
#if defined(__AVX512F__)
  if constexpr (Isa::width == 16) return mask.bits == 0xFFFF;
#endif
#if defined(__AVX2__)
  if constexpr (Isa::width == 8) return _mm256_movemask_ps((__m256)mask.bits) == 0xFF;
#endif
#if defined(__SSE2__)
  if constexpr (Isa::width == 4) return _mm_movemask_ps((__m128)mask.bits) == 0xF;
  if constexpr (Isa::width == 2) return _mm_movemask_pd((__m128d)mask.bits) == 0x3;
#endif
  if constexpr (Isa::width < 16) {
    bool every = true;
    for (int i = 0; i < Isa::width; ++i) every = every && mask.bits[i] != 0;
    return every;
  }
}

template <class Isa>
struct Lanes {
  static constexpr int width = Isa::width;
  using Mask = LanesMask<Isa>;
  using Number = typename Isa::Number;
  using Values = typename Isa::Values;
  using Ints = typename Isa::Ints;
  Values v;

  Lanes() = default;
  Lanes(double a) : v(Number(a) - Values{}) {}
  explicit Lanes(Values values) : v(values) {}

  static Lanes load(const Number* from) {
    Lanes a;
    std::memcpy(&a.v, from, sizeof a.v);
    return a;
  }
  void store(Number* to) const { std::memcpy(to, &v, sizeof v); }

  template <class F>
  static Lanes each(const Lanes& a, F f) {
    Lanes out;
    for (int i = 0; i < width; ++i) out.v[i] = f(a.v[i]);
    return out;
  }
  template <class F>
  static Lanes each(const Lanes& a, const Lanes& b, F f) {
    Lanes out;
    for (int i = 0; i < width; ++i) out.v[i] = f(a.v[i], b.v[i]);
    return out;
  }

  friend Lanes operator+(Lanes a, Lanes b) { return Lanes(a.v + b.v); }
  friend Lanes operator-(Lanes a, Lanes b) { return Lanes(a.v - b.v); }
  friend Lanes operator*(Lanes a, Lanes b) { return Lanes(a.v * b.v); }
  friend Lanes operator/(Lanes a, Lanes b) { return Lanes(a.v / b.v); }
  friend Lanes operator-(Lanes a) { return Lanes(-a.v); }
  friend Mask operator<(Lanes a, Lanes b) {
#if defined(__AVX512F__)
    if constexpr (width == 16)
      return {_mm512_cmp_ps_mask((__m512)a.v, (__m512)b.v, _CMP_LT_OQ)};
    else
#endif
      return {a.v < b.v};
  }
  friend Mask operator<=(Lanes a, Lanes b) {
#if defined(__AVX512F__)
    if constexpr (width == 16)
      return {_mm512_cmp_ps_mask((__m512)a.v, (__m512)b.v, _CMP_LE_OQ)};
    else
#endif
      return {a.v <= b.v};
  }
  friend Mask operator>(Lanes a, Lanes b) { return b < a; }
  friend Mask operator>=(Lanes a, Lanes b) { return b <= a; }
  friend Lanes select(Mask m, Lanes a, Lanes b) {
#if defined(__AVX512F__)
    if constexpr (width == 16)
      return Lanes((Values)_mm512_mask_blend_ps(m.bits, (__m512)b.v, (__m512)a.v));
    else
#endif
      return Lanes(m.bits ? a.v : b.v);
  }

  friend Lanes min(Lanes a, Lanes b) {
    constexpr size_t bytes = sizeof(Values);
    constexpr bool floats = std::is_same_v<Number, float>;
#if defined(__AVX512F__)
    if constexpr (bytes == 64 && floats)
      return Lanes((Values)_mm512_min_ps((__m512)a.v, (__m512)b.v));
    if constexpr (bytes == 64 && !floats)
      return Lanes((Values)_mm512_min_pd((__m512d)a.v, (__m512d)b.v));
#endif
#if defined(__AVX__)
    if constexpr (bytes == 32 && floats)
      return Lanes((Values)_mm256_min_ps((__m256)a.v, (__m256)b.v));
    if constexpr (bytes == 32 && !floats)
      return Lanes((Values)_mm256_min_pd((__m256d)a.v, (__m256d)b.v));
#endif
#if defined(__SSE2__)
    if constexpr (bytes == 16 && floats) return Lanes((Values)_mm_min_ps((__m128)a.v, (__m128)b.v));
    if constexpr (bytes == 16 && !floats)
      return Lanes((Values)_mm_min_pd((__m128d)a.v, (__m128d)b.v));
#endif
    return select(a < b, a, b);
  }
  friend Lanes max(Lanes a, Lanes b) {
    constexpr size_t bytes = sizeof(Values);
    constexpr bool floats = std::is_same_v<Number, float>;
#if defined(__AVX512F__)
    if constexpr (bytes == 64 && floats)
      return Lanes((Values)_mm512_max_ps((__m512)a.v, (__m512)b.v));
    if constexpr (bytes == 64 && !floats)
      return Lanes((Values)_mm512_max_pd((__m512d)a.v, (__m512d)b.v));
#endif
#if defined(__AVX__)
    if constexpr (bytes == 32 && floats)
      return Lanes((Values)_mm256_max_ps((__m256)a.v, (__m256)b.v));
    if constexpr (bytes == 32 && !floats)
      return Lanes((Values)_mm256_max_pd((__m256d)a.v, (__m256d)b.v));
#endif
#if defined(__SSE2__)
    if constexpr (bytes == 16 && floats) return Lanes((Values)_mm_max_ps((__m128)a.v, (__m128)b.v));
    if constexpr (bytes == 16 && !floats)
      return Lanes((Values)_mm_max_pd((__m128d)a.v, (__m128d)b.v));
#endif
    return select(a > b, a, b);
  }
  friend Lanes sqrt(Lanes a) {
#if defined(__AVX512F__)
    if constexpr (width == 16) return Lanes((Values)_mm512_sqrt_ps((__m512)a.v));
#endif
#if defined(__AVX__)
    if constexpr (width == 8) return Lanes((Values)_mm256_sqrt_ps((__m256)a.v));
#endif
#if defined(__SSE2__)
    if constexpr (width == 4) return Lanes((Values)_mm_sqrt_ps((__m128)a.v));
    if constexpr (width == 2) return Lanes((Values)_mm_sqrt_pd((__m128d)a.v));
#endif
    return each(a, [](Number s) { return std::sqrt(s); });
  }
  friend Lanes floor(Lanes a) {
#if defined(__AVX512F__)
    if constexpr (width == 16) return Lanes((Values)_mm512_floor_ps((__m512)a.v));
#endif
#if defined(__AVX__)
    if constexpr (width == 8) return Lanes((Values)_mm256_floor_ps((__m256)a.v));
#endif
    return each(a, [](Number s) { return std::floor(s); });
  }
  friend Lanes abs(Lanes a) {
    const Values signs = -Values{};
    return Lanes((Values)((Ints)a.v & ~(Ints)signs));
  }
  friend Lanes square(Lanes a) { return a * a; }
  friend Lanes freeze(Lanes a) { return a; }
  friend bool is_at_rest(Lanes before, Lanes after) {
    return all(before <= after && before >= after);
  }
  friend Lanes cosine(Lanes a, Lanes b) { return a / b; }

  friend Lanes exp(Lanes a) {
    if constexpr (std::is_same_v<Number, float>) return exp_of_floats(a);
    return each(a, [](Number s) { return std::exp(s); });
  }
  friend Lanes log(Lanes a) {
    if constexpr (std::is_same_v<Number, float>) return log_of_floats(a);
    return each(a, [](Number s) { return std::log(s); });
  }
  friend Lanes sin(Lanes a) {
    if constexpr (std::is_same_v<Number, float>) return sin_of_floats(a);
    return each(a, [](Number s) { return std::sin(s); });
  }
  friend Lanes cos(Lanes a) {
    if constexpr (std::is_same_v<Number, float>) return cos_of_floats(a);
    return each(a, [](Number s) { return std::cos(s); });
  }
  friend Lanes pow(Lanes a, Lanes b) {
    if constexpr (std::is_same_v<Number, float>) return pow_of_floats(a, b);
    return each(a, b, [](Number s, Number t) { return std::pow(s, t); });
  }
  // The C library's scalar functions: the same result for every instruction set.
  friend Lanes tan(Lanes a) {
    return each(a, [](Number s) { return std::tan(s); });
  }
  friend Lanes asin(Lanes a) {
    return each(a, [](Number s) { return std::asin(s); });
  }
  friend Lanes acos(Lanes a) {
    return each(a, [](Number s) { return std::acos(s); });
  }
  friend Lanes atan2(Lanes a, Lanes b) {
    return each(a, b, [](Number s, Number t) { return std::atan2(s, t); });
  }
};

template <class Isa, class T, class Full>
T shortcut(LanesMask<Isa> mask, const T& cheap, Full full) {
  if (all(mask)) [[likely]]
    return cheap;
  return select(mask, cheap, full());
}

}  // namespace sardf

// Several floats computed as doubles, half of them at a time: these fill as many bits.
//
// A result is rounded once more, to a float: so it is right within little more than half a unit in
// the last place, and nearly always the nearest float.
#pragma once

#include <utility>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace sardf {

template <class Isa>
struct Lanes;

/// Half as many doubles as Isa has floats; a type of its own for every instruction set.
template <class Isa>
struct HalfInDouble {
  static constexpr int width = Isa::width / 2;
  using Number = double;
  typedef double Values __attribute__((vector_size(width * 8)));
  typedef long long Ints __attribute__((vector_size(width * 8)));
};

namespace halves {

/// The lanes first, first + 1, ... of a.
template <int first, class Isa, size_t... k>
Lanes<HalfInDouble<Isa>> half_of(Lanes<Isa> a, std::index_sequence<k...>) {
  using Half = Lanes<HalfInDouble<Isa>>;
#if defined(__SSE2__)
  // Compilers take vectors of two floats through memory.
  if constexpr (Isa::width == 4) {
    const __m128 all = (__m128)a.v;
    const __m128 floats = first == 0 ? all : _mm_movehl_ps(all, all);
    return Half((typename Half::Values)_mm_cvtps_pd(floats));
  }
#endif
  return Half(__builtin_convertvector(__builtin_shufflevector(a.v, a.v, (first + int(k))...),
                                      typename Half::Values));
}

template <class Isa, size_t... k>
Lanes<Isa> joined(Lanes<HalfInDouble<Isa>> low, Lanes<HalfInDouble<Isa>> high,
                  std::index_sequence<k...>) {
#if defined(__SSE2__)
  if constexpr (Isa::width == 4) {
    return Lanes<Isa>((typename Isa::Values)_mm_movelh_ps(_mm_cvtpd_ps((__m128d)low.v),
                                                          _mm_cvtpd_ps((__m128d)high.v)));
  }
#endif
  typedef float Floats __attribute__((vector_size(sizeof(typename Isa::Values) / 2)));
  return Lanes<Isa>(__builtin_shufflevector(__builtin_convertvector(low.v, Floats),
                                            __builtin_convertvector(high.v, Floats), int(k)...));
}

}  // namespace halves

/// f(arguments...), where f takes and gives Lanes<HalfInDouble<Isa>>.
template <class Isa, class F, class... Arguments>
Lanes<Isa> in_double(F f, Arguments... arguments) {
  constexpr int half = Isa::width / 2;
  constexpr std::make_index_sequence<half> lanes;
  return halves::joined<Isa>(f(halves::half_of<0>(arguments, lanes)...),
                             f(halves::half_of<half>(arguments, lanes)...),
                             std::make_index_sequence<2 * half>());
}

}  // namespace sardf

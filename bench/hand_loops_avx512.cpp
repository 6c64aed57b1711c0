#include <immintrin.h>

#include "hand_shapes.hpp"

namespace sardf::bench {

namespace {

struct Sixteen {
  static constexpr size_t width = 16;
  __m512 v;
  Sixteen(__m512 values) : v(values) {}
  explicit Sixteen(float a) : v(_mm512_set1_ps(a)) {}
  static Sixteen load(const float* from) { return _mm512_loadu_ps(from); }
  void store(float* to) const { _mm512_storeu_ps(to, v); }
};

Sixteen operator+(Sixteen a, Sixteen b) { return a.v + b.v; }
Sixteen operator-(Sixteen a, Sixteen b) { return a.v - b.v; }
Sixteen operator*(Sixteen a, Sixteen b) { return a.v * b.v; }
Sixteen minimum(Sixteen a, Sixteen b) { return _mm512_min_ps(a.v, b.v); }
Sixteen maximum(Sixteen a, Sixteen b) { return _mm512_max_ps(a.v, b.v); }
Sixteen root(Sixteen a) { return _mm512_sqrt_ps(a.v); }
Sixteen magnitude(Sixteen a) { return _mm512_abs_ps(a.v); }
__mmask16 less(Sixteen a, Sixteen b) { return _mm512_cmp_ps_mask(a.v, b.v, _CMP_LT_OQ); }
bool any_less(Sixteen a, Sixteen b) { return less(a, b) != 0; }
Sixteen choose_less(Sixteen a, Sixteen b, Sixteen yes, Sixteen no) {
  return _mm512_mask_blend_ps(less(a, b), no.v, yes.v);
}

}  // namespace

const HandLoops& hand_loops_avx512() { return loops_of<Sixteen>; }

}  // namespace sardf::bench

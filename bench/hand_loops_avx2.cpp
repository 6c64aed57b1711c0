#include <immintrin.h>

#include "hand_shapes.hpp"

namespace sardf::bench {

namespace {

struct Eight {
  static constexpr size_t width = 8;
  __m256 v;
  Eight(__m256 values) : v(values) {}
  explicit Eight(float a) : v(_mm256_set1_ps(a)) {}
  static Eight load(const float* from) { return _mm256_loadu_ps(from); }
  void store(float* to) const { _mm256_storeu_ps(to, v); }
};

Eight operator+(Eight a, Eight b) { return a.v + b.v; }
Eight operator-(Eight a, Eight b) { return a.v - b.v; }
Eight operator*(Eight a, Eight b) { return a.v * b.v; }
Eight minimum(Eight a, Eight b) { return _mm256_min_ps(a.v, b.v); }
Eight maximum(Eight a, Eight b) { return _mm256_max_ps(a.v, b.v); }
Eight root(Eight a) { return _mm256_sqrt_ps(a.v); }
Eight magnitude(Eight a) { return _mm256_andnot_ps(_mm256_set1_ps(-0.f), a.v); }
__m256 less(Eight a, Eight b) { return _mm256_cmp_ps(a.v, b.v, _CMP_LT_OQ); }
bool any_less(Eight a, Eight b) { return _mm256_movemask_ps(less(a, b)) != 0; }
Eight choose_less(Eight a, Eight b, Eight yes, Eight no) {
  return _mm256_blendv_ps(no.v, yes.v, less(a, b));
}

}  // namespace

const HandLoops& hand_loops_avx2() { return loops_of<Eight>; }

}  // namespace sardf::bench

// Loops written by hand for three shapes: the speed that evaluation is measured against.
#pragma once

#include <cstddef>

namespace sardf::bench {

/// Evaluates n points; n is a multiple of 16.
using Loop = void (*)(const float* x, const float* y, const float* z, float* out, size_t n);

struct HandLoops {
  /// The spheres, the drilled block with min and max, and the same with SARDF blends that take no
  /// root where no lane is in a band.
  Loop spheres, block, blended_block;
};

const HandLoops& hand_loops_avx2();
const HandLoops& hand_loops_avx512();

}  // namespace sardf::bench

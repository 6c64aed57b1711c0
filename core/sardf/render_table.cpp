#include "sardf/kernels.hpp"
#include "sardf/render_kernels.hpp"

namespace sardf::rendering {

const RayKernels& ray_kernels() {
#if defined(SARDF_X86)
  if (instruction_set() == InstructionSet::avx512) return avx512_ray_kernels();
  if (instruction_set() == InstructionSet::avx2) return avx2_ray_kernels();
#endif
  return RayKernelsOf<Baseline>::all_kernels;
}

}  // namespace sardf::rendering

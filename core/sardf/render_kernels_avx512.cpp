#include "sardf/render_kernels.hpp"

namespace sardf::rendering {

const RayKernels& avx512_ray_kernels() { return RayKernelsOf<Avx512>::all_kernels; }

}  // namespace sardf::rendering

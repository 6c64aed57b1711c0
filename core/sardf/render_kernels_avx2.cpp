#include "sardf/render_kernels.hpp"

namespace sardf::rendering {

const RayKernels& avx2_ray_kernels() { return RayKernelsOf<Avx2>::all_kernels; }

}  // namespace sardf::rendering

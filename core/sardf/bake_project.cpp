// Moving points that are almost on a solid's surface onto it.

#include <cmath>

#include "sardf/bake_stages.hpp"

namespace sardf::baking {
namespace {

constexpr int steps = 3;
/// Smallest squared cosine between the gradient and the face's normal: 45 degrees. Beyond, the
/// nearest zero set is that of another face.
constexpr float aligned = 0.5f;

struct Block {
  using Values = std::array<float, Evaluator::block_size>;
  std::array<Values, 3> start, at, gradient;
  Values value, first;
  std::array<bool, Evaluator::block_size> stopped{};

  /// Newton's step along the gradient; false where none is taken.
  bool step(size_t i, const std::array<float, 3>& normal, float limit, float tolerance) {
    // Written so that a NaN takes no step.
    if (stopped[i] || !(std::abs(value[i]) > tolerance)) return false;
    const float x = gradient[0][i], y = gradient[1][i], z = gradient[2][i];
    const float squared = x * x + y * y + z * z;
    const float cosine = x * normal[0] + y * normal[1] + z * normal[2];
    if (!(cosine * cosine >= aligned * squared) || !(squared > 0)) return false;
    const float scale = value[i] / squared;
    float moved = 0;
    std::array<float, 3> to;
    for (size_t axis = 0; axis < 3; ++axis) {
      to[axis] = at[axis][i] - scale * gradient[axis][i];
      const float d = to[axis] - start[axis][i];
      moved += d * d;
    }
    stopped[i] = !(moved <= limit * limit);
    for (size_t axis = 0; axis < 3; ++axis) at[axis][i] = stopped[i] ? start[axis][i] : to[axis];
    return !stopped[i];
  }
};

}  // namespace

void project(const Evaluator& solid, TilePoints& points, size_t first, size_t n, float tolerance) {
  Block block;
  for (size_t axis = 0; axis < 3; ++axis) {
    std::copy_n(points.point[axis].data() + first, n, block.start[axis].data());
    std::copy_n(points.point[axis].data() + first, n, block.at[axis].data());
  }
  const float *x = block.at[0].data(), *y = block.at[1].data(), *z = block.at[2].data();
  float* const gradient[3] = {block.gradient[0].data(), block.gradient[1].data(),
                              block.gradient[2].data()};
  bool any = true;
  for (int step = 0; step < steps && any; ++step) {
    solid.gradient_block(x, y, z, n, block.value.data(), gradient);
    if (step == 0) block.first = block.value;
    any = false;
    for (size_t i = 0; i < n; ++i) {
      const size_t p = first + i;
      any |= block.step(i, {points.normal[0][p], points.normal[1][p], points.normal[2][p]},
                        points.limit[p], tolerance);
    }
    if (step == 0 && !any) return;
  }
  float* value = block.value.data();
  solid.block(x, y, z, n, &value);
  for (size_t i = 0; i < n; ++i)
    if (std::abs(block.value[i]) <= std::abs(block.first[i]))
      for (size_t axis = 0; axis < 3; ++axis) points.point[axis][first + i] = block.at[axis][i];
}

}  // namespace sardf::baking

#include "sardf/volume.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <mutex>

namespace sardf {

namespace {

constexpr int block_cells = 6;  // 6³ = 216 points fit one evaluator block

// The volume of the part of a unit cube where the linear function value + slope · (p - centre) is
// not negative. With a box filter along the steepest direction this is exact for slopes along an
// axis and right to second order elsewhere.
double covered_share(double value, const Vec3& slope, double cell) {
  const double rise = cell * (std::abs(slope[0]) + std::abs(slope[1]) + std::abs(slope[2]));
  if (!(rise > 0)) return value >= 0;
  // The profile of a cube cut by a plane, between its box (axis) and diagonal form.
  const double t = std::clamp(0.5 + value / rise, 0.0, 1.0);
  const double steepest =
      cell * std::max({std::abs(slope[0]), std::abs(slope[1]), std::abs(slope[2])});
  const double box = std::clamp(0.5 + value / steepest, 0.0, 1.0);
  const double smooth = t * t * (3 - 2 * t);
  const double mix = std::clamp((rise - steepest) / (2 * steepest), 0.0, 1.0);
  return box + mix * (smooth - box);
}

struct Grid {
  Vec3 origin;
  double cell;
  std::array<int, 3> blocks;
  size_t count() const { return size_t(blocks[0]) * blocks[1] * blocks[2]; }
};

class BlockSum {
 public:
  BlockSum(const Scene& scene, const Grid& grid)
      : grid_(grid), field_(scene.solid()), fractions_(scene.fractions()) {}

  // Adds the materials' volumes of one block to `sum`.
  void operator()(size_t block, std::vector<double>& sum) const {
    const int i = int(block % grid_.blocks[0]);
    const int j = int(block / grid_.blocks[0] % grid_.blocks[1]);
    const int k = int(block / grid_.blocks[0] / grid_.blocks[1]);
    const double side = block_cells * grid_.cell;
    const Vec3 lo = grid_.origin + Vec3{i * side, j * side, k * side};
    const Vec3 hi = lo + Vec3{side, side, side};
    if (field_.interval({lo, hi}).hi < 0) return;
    constexpr size_t n = block_cells * block_cells * block_cells;
    double xyz[3][n], value[n], slope[3][n];
    for (size_t p = 0; p < n; ++p) {
      const size_t at[3] = {p % block_cells, p / block_cells % block_cells,
                            p / block_cells / block_cells};
      for (int axis = 0; axis < 3; ++axis)
        xyz[axis][p] = lo[axis] + (double(at[axis]) + 0.5) * grid_.cell;
    }
    double* const slopes[3] = {slope[0], slope[1], slope[2]};
    field_.gradient_block(xyz[0], xyz[1], xyz[2], n, value, slopes);
    std::vector<double> shares(fractions_.outputs() * n);
    std::vector<double*> to(fractions_.outputs());
    for (size_t m = 0; m < to.size(); ++m) to[m] = &shares[m * n];
    fractions_.block(xyz[0], xyz[1], xyz[2], n, to.data());
    const double volume = grid_.cell * grid_.cell * grid_.cell;
    for (size_t p = 0; p < n; ++p) {
      const double share =
          volume * covered_share(value[p], {slope[0][p], slope[1][p], slope[2][p]}, grid_.cell);
      if (!(share > 0)) continue;
      for (size_t m = 0; m < to.size(); ++m) sum[m] += share * to[m][p];
    }
  }

 private:
  Grid grid_;
  Evaluator field_, fractions_;
};

}  // namespace

MaterialVolumes measure_volumes(const Scene& scene, int resolution, const Progress& progress) {
  const Vec3 size = scene.bounds().size();
  Grid grid;
  grid.origin = scene.bounds().lo;
  grid.cell = std::max({size[0], size[1], size[2]}) / resolution;
  for (int axis = 0; axis < 3; ++axis) {
    grid.blocks[axis] = int(std::ceil(size[axis] / grid.cell / block_cells));
  }
  const BlockSum add(scene, grid);
  const size_t materials = scene.fractions().size();
  // One sum for each layer of blocks, added in order: the result does not depend on threads.
  const size_t layer = size_t(grid.blocks[0]) * grid.blocks[1];
  std::vector<std::vector<double>> sums(grid.blocks[2], std::vector<double>(materials, 0.0));
  std::atomic<bool> cancelled{false};
  int done = 0;
  std::mutex reporting;
  tbb::parallel_for(0, grid.blocks[2], [&](int k) {
    for (size_t b = 0; b < layer && !cancelled; ++b) add(size_t(k) * layer + b, sums[k]);
    const std::scoped_lock lock(reporting);
    if (progress && !cancelled && !progress(double(++done) / grid.blocks[2])) cancelled = true;
  });
  if (cancelled) throw Cancelled();
  MaterialVolumes volumes;
  volumes.materials.assign(materials, 0.0);
  for (const auto& sum : sums) {
    for (size_t m = 0; m < materials; ++m) volumes.materials[m] += sum[m];
  }
  for (double v : volumes.materials) volumes.total += v;
  return volumes;
}

}  // namespace sardf

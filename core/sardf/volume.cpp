#include "sardf/volume.hpp"

#include <algorithm>

#include "sardf/work.hpp"

namespace sardf {

namespace {

constexpr int block_cells = 6;  // 6³ = 216 points fit one evaluator block
constexpr int most_halvings = 5;
// Of the total volume: what the halving of all cells together may change where it stops.
constexpr double wanted_error = 3e-3;
// Fractions that differ by less within a block are summed well enough.
constexpr double smooth_fractions = 0.25;

// The share of a cell where the linear function value + slope · (p - centre) is not negative. With
// a box filter along the steepest direction this is exact for slopes along an axis and right to
// second order elsewhere.
double covered_share(double value, const Vec3& slope, const Vec3& cell) {
  const Vec3 across{cell[0] * std::abs(slope[0]), cell[1] * std::abs(slope[1]),
                    cell[2] * std::abs(slope[2])};
  const double rise = across[0] + across[1] + across[2];
  if (!(rise > 0)) return value >= 0;
  // The profile of a cube cut by a plane, between its box (axis) and diagonal form.
  const double t = std::clamp(0.5 + value / rise, 0.0, 1.0);
  const double steepest = std::max({across[0], across[1], across[2]});
  const double box = std::clamp(0.5 + value / steepest, 0.0, 1.0);
  const double smooth = t * t * (3 - 2 * t);
  const double mix = std::clamp((rise - steepest) / (2 * steepest), 0.0, 1.0);
  return box + mix * (smooth - box);
}

/// 6³ cells.
struct Block {
  Vec3 lo, cell;

  Vec3 side() const { return double(block_cells) * cell; }
  Block octant(int i) const {
    Block part{lo, 0.5 * cell};
    for (int axis = 0; axis < 3; ++axis) {
      if (i >> axis & 1) part.lo[axis] += part.side()[axis];
    }
    return part;
  }
};

struct Sum {
  std::vector<double> materials;
  bool settled = false;  // smaller cells would not change it
};

class Summing {
 public:
  explicit Summing(const Scene& scene) : field_(scene.solid()), fractions_(scene.fractions()) {}

  Sum of(const Block& block) const {
    Sum sum{std::vector<double>(fractions_.outputs()), true};
    const Interval bound = field_.interval({block.lo, block.lo + block.side()});
    if (bound.hi < 0) return sum;
    constexpr size_t n = block_cells * block_cells * block_cells;
    double xyz[3][n], value[n], slope[3][n];
    for (size_t p = 0; p < n; ++p) {
      const size_t at[3] = {p % block_cells, p / block_cells % block_cells,
                            p / block_cells / block_cells};
      for (int axis = 0; axis < 3; ++axis)
        xyz[axis][p] = block.lo[axis] + (double(at[axis]) + 0.5) * block.cell[axis];
    }
    double* const slopes[3] = {slope[0], slope[1], slope[2]};
    field_.gradient_block(xyz[0], xyz[1], xyz[2], n, value, slopes);
    std::vector<double> shares(fractions_.outputs() * n);
    std::vector<double*> to(fractions_.outputs());
    for (size_t m = 0; m < to.size(); ++m) to[m] = &shares[m * n];
    fractions_.block(xyz[0], xyz[1], xyz[2], n, to.data());
    const double volume = block.cell[0] * block.cell[1] * block.cell[2];
    for (size_t p = 0; p < n; ++p) {
      const double share =
          volume * covered_share(value[p], {slope[0][p], slope[1][p], slope[2][p]}, block.cell);
      if (!(share > 0)) continue;
      for (size_t m = 0; m < to.size(); ++m) sum.materials[m] += share * to[m][p];
    }
    sum.settled = bound.lo > 0 && is_smooth(shares, n);
    return sum;
  }

  /// Adds the block's materials to `total` and what the last halving changed to `error`; `rough` is
  /// what of(block) gave.
  void refine(const Block& block, const Sum& rough, double tolerance, int halvings, Sum& total,
              double& error) const {
    std::array<Sum, 8> parts;
    std::vector<double> fine(rough.materials.size());
    for (int i = 0; i < 8; ++i) {
      parts[i] = of(block.octant(i));
      for (size_t m = 0; m < fine.size(); ++m) fine[m] += parts[i].materials[m];
    }
    double change = 0;
    for (size_t m = 0; m < fine.size(); ++m) change += std::abs(fine[m] - rough.materials[m]);
    if (change <= tolerance || halvings == 1) {
      for (size_t m = 0; m < fine.size(); ++m) total.materials[m] += fine[m];
      error += change;
      return;
    }
    for (int i = 0; i < 8; ++i) {
      if (parts[i].settled) {
        for (size_t m = 0; m < fine.size(); ++m) total.materials[m] += parts[i].materials[m];
      } else {
        // A surface runs through about four of the eight.
        refine(block.octant(i), parts[i], tolerance / 4, halvings - 1, total, error);
      }
    }
  }

 private:
  static bool is_smooth(const std::vector<double>& shares, size_t n) {
    for (auto of = shares.begin(); of != shares.end(); of += std::ptrdiff_t(n)) {
      const auto [least, most] = std::minmax_element(of, of + std::ptrdiff_t(n));
      if (*most - *least > smooth_fractions) return false;
    }
    return true;
  }

  Evaluator field_, fractions_;
};

}  // namespace

MaterialVolumes measure_volumes(const Scene& scene, int resolution, const Progress& progress) {
  const int across = (resolution + block_cells - 1) / block_cells;  // blocks along each side
  const Vec3 cell = (1.0 / (across * block_cells)) * scene.bounds().size();
  const size_t count = size_t(across) * across * across, materials = scene.fractions().size();
  const auto block = [&](size_t i) {
    const size_t at[3] = {i % across, i / across % across, i / across / across};
    Block result{scene.bounds().lo, cell};
    for (int axis = 0; axis < 3; ++axis) result.lo[axis] += double(at[axis]) * result.side()[axis];
    return result;
  };
  const Summing summing(scene);
  std::vector<Sum> sums(count);
  Work work(progress);
  work.stage(0.3);
  work.run(count, 1, [&](size_t i, size_t) { sums[i] = summing.of(block(i)); });
  double volume = 0;
  std::vector<size_t> unsettled;
  for (size_t i = 0; i < count; ++i) {
    for (const double v : sums[i].materials) volume += v;
    if (!sums[i].settled) unsettled.push_back(i);
  }
  // Each block has a sum of its own and they are added in order: threads change nothing.
  const double tolerance = wanted_error * volume / double(std::max<size_t>(unsettled.size(), 1));
  std::vector<double> errors(count);
  work.stage(1);
  work.run(unsettled.size(), 1, [&](size_t k, size_t) {
    const size_t i = unsettled[k];
    Sum total{std::vector<double>(materials), true};
    summing.refine(block(i), sums[i], tolerance, most_halvings, total, errors[i]);
    sums[i] = std::move(total);
  });
  MaterialVolumes volumes;
  volumes.materials.assign(materials, 0.0);
  for (size_t i = 0; i < count; ++i) {
    for (size_t m = 0; m < materials; ++m) volumes.materials[m] += sums[i].materials[m];
    volumes.error += errors[i];
  }
  for (double v : volumes.materials) volumes.total += v;
  return volumes;
}

}  // namespace sardf

#include "sardf/volume.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sardf/work.hpp"

namespace sardf {

namespace {

constexpr int block_cells = 6;  // 6³ = 216 points fit one evaluator block
constexpr int most_halvings = 5;
// Blocks that halving may look at, for each block of the first grid: thin stripes everywhere would
// otherwise take minutes.
constexpr size_t most_blocks = 96;
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
  double doubt = 0;      // what the halving that made it changed

  double total() const { return std::accumulate(materials.begin(), materials.end(), 0.0); }
};

void add(const Sum& part, Sum& to) {
  for (size_t m = 0; m < to.materials.size(); ++m) to.materials[m] += part.materials[m];
}

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

/// A block whose cells are to be halved, with what it was found to hold.
struct Pending {
  Block block;
  Sum rough;
};

struct Halved {
  std::array<Sum, 8> parts;
  Sum fine;
  double change = 0;
};

Halved halved(const Summing& summing, const Pending& pending) {
  Halved result;
  result.fine.materials.assign(pending.rough.materials.size(), 0.0);
  for (int i = 0; i < 8; ++i) {
    result.parts[i] = summing.of(pending.block.octant(i));
    add(result.parts[i], result.fine);
  }
  for (size_t m = 0; m < result.fine.materials.size(); ++m) {
    result.change += std::abs(result.fine.materials[m] - pending.rough.materials[m]);
  }
  return result;
}

std::vector<Block> blocks_of(const BoundingBox& box, int resolution) {
  const int across = (resolution + block_cells - 1) / block_cells;
  std::vector<Block> blocks(size_t(across) * across * across);
  for (size_t i = 0; i < blocks.size(); ++i) {
    const size_t at[3] = {i % across, i / across % across, i / across / across};
    Block& block = blocks[i];
    block = {box.lo, (1.0 / (across * block_cells)) * box.size()};
    for (int axis = 0; axis < 3; ++axis) block.lo[axis] += double(at[axis]) * block.side()[axis];
  }
  return blocks;
}

}  // namespace

// Rounds, each of which halves the cells of all blocks that still change. Sums are added in order,
// so that threads change nothing.
MaterialVolumes measure_volumes(const Scene& scene, int resolution, const Progress& progress) {
  const Summing summing(scene);
  const std::vector<Block> blocks = blocks_of(scene.bounds(), resolution);
  std::vector<Pending> pending(blocks.size());
  Work work(progress);
  work.stage(0.2);
  work.run(blocks.size(), 1, [&](size_t i, size_t) {
    pending[i] = {blocks[i], summing.of(blocks[i])};
  });
  Sum total{std::vector<double>(scene.fractions().size()), true};
  double volume = 0, error = 0;
  for (const Pending& each : pending) volume += each.rough.total();
  std::erase_if(pending, [&](const Pending& each) {
    if (each.rough.settled) add(each.rough, total);
    return each.rough.settled;
  });
  size_t budget = most_blocks * blocks.size();
  for (int round = 1; !pending.empty(); ++round) {
    work.stage(1 - 0.8 * std::pow(0.5, round));
    std::vector<Halved> fine(pending.size());
    work.run(pending.size(), 1, [&](size_t i, size_t) { fine[i] = halved(summing, pending[i]); });
    budget -= std::min(budget, 8 * pending.size());
    const double tolerance = wanted_error * volume / double(pending.size());
    std::vector<Pending> next;
    for (size_t i = 0; i < pending.size(); ++i) {
      if (fine[i].change <= tolerance) {
        add(fine[i].fine, total);
        error += fine[i].change;
        continue;
      }
      for (int k = 0; k < 8; ++k) {
        Sum& part = fine[i].parts[k];
        if (part.settled) {
          add(part, total);
        } else {
          part.doubt = fine[i].change / 8;
          next.push_back({pending[i].block.octant(k), std::move(part)});
        }
      }
    }
    pending = std::move(next);
    if (round == most_halvings || 8 * pending.size() > budget) {
      for (const Pending& each : pending) {
        add(each.rough, total);
        error += each.rough.doubt;
      }
      break;
    }
  }
  work.stage(1);
  work.run(1, 1, [](size_t, size_t) {});
  return {total.total(), total.materials, error};
}

}  // namespace sardf

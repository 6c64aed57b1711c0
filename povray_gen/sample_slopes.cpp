#include "povray_gen/sample_slopes.hpp"

#include <algorithm>
#include <cmath>

namespace sardf::povray {

namespace {

// Cells along an axis of the smallest blocks, 2^first_shift.
constexpr int first_shift = 2;
constexpr size_t blocks_at_once = 1024;
// So many bounds are joined for a box.
constexpr double most_joined = 343;

int blocks(int cells, int shift) { return (cells + (1 << shift) - 1) >> shift; }

}  // namespace

void SampleBounds::add(const SampleBounds& other) {
  codes = hull(codes, other.codes);
  for (size_t k = 0; k < 3; ++k) partials[k] = hull(partials[k], other.partials[k]);
  squares = max(squares, other.squares);
}

template <class Bounds>
SampleBounds SampleSlopes::joined(const CellRange& range, int shift, const Bounds& bounds) {
  SampleBounds out;
  std::array<int, 3> at;
  for (at[2] = range.first[2] >> shift; at[2] <= range.last[2] >> shift; ++at[2]) {
    for (at[1] = range.first[1] >> shift; at[1] <= range.last[1] >> shift; ++at[1]) {
      for (at[0] = range.first[0] >> shift; at[0] <= range.last[0] >> shift; ++at[0]) {
        out.add(bounds(at));
      }
    }
  }
  return out;
}

SampleSlopes::SampleSlopes(const SampleGrid& grid, std::span<const uint32_t> codes, Work& work)
    : grid_(grid) {
  size_t stride = 1;
  for (int k = 0; k < 3; ++k) {
    cells_[k] = std::max(1, grid.counts[k] - 1);
    if (grid.varies(k)) {
      stride_[k] = stride;
      per_step_[k] = 1 / grid.step(k);
    }
    stride *= size_t(grid.counts[k]);
  }
  for (int shift = first_shift;; ++shift) {
    Level level;
    for (int k = 0; k < 3; ++k) level.counts[k] = blocks(cells_[k], shift);
    level.blocks.resize(size_t(level.counts[0]) * size_t(level.counts[1]) *
                        size_t(level.counts[2]));
    const Level* finer = levels_.empty() ? nullptr : &levels_.back();
    const int below = finer ? 1 : first_shift;
    const std::array<int, 3>& parts = finer ? finer->counts : cells_;
    work.run(level.blocks.size(), blocks_at_once, [&](size_t first, size_t last) {
      for (size_t i = first; i < last; ++i) {
        CellRange range;
        const std::array<int, 3> at = position_of(level.counts, i);
        for (int k = 0; k < 3; ++k) {
          range.first[k] = at[k] << below;
          range.last[k] = std::min(parts[k], (at[k] + 1) << below) - 1;
        }
        level.blocks[i] = joined(range, 0, [&](const std::array<int, 3>& part) {
          return finer ? finer->blocks[index_of(parts, part)] : of_cell(part, codes);
        });
      }
    });
    const bool is_last = level.blocks.size() == 1;
    levels_.push_back(std::move(level));
    if (is_last) break;
  }
}

// A partial derivative of a trilinear cell is a mean of the difference quotients along its four
// edges in that direction, with weights that are linear in each of the other coordinates. So the
// square of the gradient is convex along each axis: the longest gradient is that at a corner, where
// it is made of the quotients of the three edges that meet there.
SampleBounds SampleSlopes::of_cell(const std::array<int, 3>& cell,
                                   std::span<const uint32_t> codes) const {
  const size_t from = grid_.index(cell);
  std::array<double, 8> at;
  SampleBounds out;
  for (size_t corner = 0; corner < 8; ++corner) {
    size_t sample = from;
    for (size_t k = 0; k < 3; ++k) sample += (corner >> k & 1) * stride_[k];
    at[corner] = double(codes[sample]);
    out.codes = hull(out.codes, at[corner]);
  }
  for (size_t corner = 0; corner < 8; ++corner) {
    double squares = 0;
    for (size_t k = 0; k < 3; ++k) {
      const size_t bit = size_t(1) << k;
      const double slope = (at[corner | bit] - at[corner & ~bit]) * per_step_[k];
      out.partials[k] = hull(out.partials[k], slope);
      squares += slope * slope;
    }
    out.squares = max(out.squares, squares);
  }
  return out;
}

SampleBounds SampleSlopes::over(const std::array<Interval, 3>& box,
                                std::span<const uint32_t> codes) const {
  // Neighbours count where the box ends at a face between cells, but for rounding.
  constexpr double slack = 1e-6;
  CellRange range{};
  std::array<bool, 3> leaves{};
  for (int k = 0; k < 3; ++k) {
    if (!grid_.varies(k)) continue;
    const auto cell = [&](double place) {
      return int(min(max(std::floor(place), 0.0), double(cells_[k] - 1)));
    };
    const double low = (box[k].lo - grid_.box[k].lo) * per_step_[k] - slack;
    const double high = (box[k].hi - grid_.box[k].lo) * per_step_[k] + slack;
    range.first[k] = cell(low);
    range.last[k] = cell(high);
    leaves[k] = !(low >= 0 && high <= cells_[k]);
  }
  const auto count = [&](int shift) {
    double all = 1;
    for (int k = 0; k < 3; ++k) all *= (range.last[k] >> shift) - (range.first[k] >> shift) + 1;
    return all;
  };
  SampleBounds out;
  if (count(0) <= most_joined) {
    out = joined(range, 0, [&](const std::array<int, 3>& at) { return of_cell(at, codes); });
  } else {
    size_t level = 0;
    while (level + 1 < levels_.size() && count(first_shift + int(level)) > most_joined) ++level;
    const Level& chosen = levels_[level];
    out = joined(range, first_shift + int(level), [&](const std::array<int, 3>& at) {
      return chosen.blocks[index_of(chosen.counts, at)];
    });
  }
  // Outside of the grid the function does not change along that axis.
  for (size_t k = 0; k < 3; ++k) {
    if (leaves[k]) out.partials[k] = hull(out.partials[k], 0);
  }
  return out;
}

}  // namespace sardf::povray

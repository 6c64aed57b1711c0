// Blocks of a grid of samples, and what is found from the samples of one; private to
// core/sardf/volume_*.cpp.
#pragma once

#include <algorithm>

#include "sardf/volume_samples.hpp"

namespace sardf::volume {

using Index = std::array<int, 3>;

/// Samples along the edge of the blocks that are shared among threads.
inline constexpr int block_edge = 16;

/// The samples from first up to last, exclusively.
struct Block {
  Index first, last;

  size_t size() const {
    size_t n = 1;
    for (int axis = 0; axis < 3; ++axis) n *= size_t(last[axis] - first[axis]);
    return n;
  }
};

/// A grid divided into blocks, in order, x fastest.
class Blocks {
 public:
  Blocks(const Block& all, int edge) : all_(all), edge_(edge) {
    for (int axis = 0; axis < 3; ++axis) {
      across_[axis] = (all.last[axis] - all.first[axis] + edge - 1) / edge;
    }
  }
  size_t size() const { return size_t(across_[0]) * across_[1] * across_[2]; }
  Block operator[](size_t i) const {
    const Index at{int(i % across_[0]), int(i / across_[0] % across_[1]),
                   int(i / across_[0] / across_[1])};
    Block block;
    for (int axis = 0; axis < 3; ++axis) {
      block.first[axis] = all_.first[axis] + at[axis] * edge_;
      block.last[axis] = std::min(block.first[axis] + edge_, all_.last[axis]);
    }
    return block;
  }
  /// The number of the block that holds a sample.
  size_t number(const Index& sample) const {
    return size_t(sample[0] / edge_) +
           size_t(across_[0]) * (sample[1] / edge_ + size_t(across_[1]) * (sample[2] / edge_));
  }

 private:
  Block all_;
  int edge_;
  std::array<int, 3> across_;
};

/// The number of a sample.
inline size_t number(const TexelGrid& grid, const Index& at) {
  return size_t(at[0]) +
         size_t(grid.counts[0]) * (size_t(at[1]) + size_t(grid.counts[1]) * size_t(at[2]));
}

/// work(number of the first sample, how many) for each row of a block.
template <class RowWork>
void for_rows(const TexelGrid& grid, const Block& block, const RowWork& work) {
  for (int z = block.first[2]; z < block.last[2]; ++z) {
    for (int y = block.first[1]; y < block.last[1]; ++y) {
      work(number(grid, {block.first[0], y, z}), size_t(block.last[0] - block.first[0]));
    }
  }
}

/// each(index, number) for each sample of a block.
template <class Each>
void for_samples(const TexelGrid& grid, const Block& block, const Each& each) {
  for (int z = block.first[2]; z < block.last[2]; ++z) {
    for (int y = block.first[1]; y < block.last[1]; ++y) {
      size_t to = number(grid, {block.first[0], y, z});
      for (int x = block.first[0]; x < block.last[0]; ++x) each(Index{x, y, z}, to++);
    }
  }
}

/// The largest slope of the interpolated field in the cubes of eight samples whose lowest corners
/// are in the block.
float steepness_in(const TexelGrid& grid, const float* field, const Block& block);

/// The numbers of the block's samples that get a colour.
std::vector<size_t> colored_in(const TexelGrid& grid, const float* field, Colored colored,
                               const Block& block);

}  // namespace sardf::volume

#include "sardf/volume_blocks.hpp"

#include <bit>
#include <cmath>
#include <functional>

namespace sardf::volume {

namespace {

// A byte for each sample of a block and of one more on each side.
constexpr size_t step_y = block_edge + 2, step_z = step_y * step_y;
using Bytes = std::array<uint8_t, step_y * step_z>;

// Each byte with the other seven of the cube of eight that begins there.
template <class Join>
Bytes joined(Bytes bytes, Join join) {
  for (const size_t step : {size_t(1), step_y, step_z}) {
    for (size_t i = 0; i + step < bytes.size(); ++i) {
      bytes[i] = uint8_t(join(bytes[i], bytes[i + step]));
    }
  }
  return bytes;
}

// By their lowest corners.
Bytes colored_cubes(const Bytes& inside, Colored colored) {
  Bytes any = joined(inside, std::bit_or());
  if (colored == Colored::inside) return any;
  const Bytes all = joined(inside, std::bit_and());
  for (size_t i = 0; i < any.size(); ++i) any[i] = uint8_t(any[i] & ~all[i]);
  return any;
}

}  // namespace

// Interpolation's derivative along an axis lies, in a cube of eight samples, between the slopes
// of its four edges along that axis.
float steepness_in(const TexelGrid& grid, const float* field, const Block& block) {
  constexpr size_t edge = block_edge + 1, size = edge * edge * edge;
  constexpr size_t step[3] = {1, edge, edge * edge};
  std::array<float, size> value{}, slope{}, square{};
  // One more on each upper side; beyond the grid its last samples go on, as textures do.
  const int nx = grid.counts[0];
  for (size_t row = 0; row < edge * edge; ++row) {
    const int y = std::min(block.first[1] + int(row % edge), grid.counts[1] - 1);
    const int z = std::min(block.first[2] + int(row / edge), grid.counts[2] - 1);
    const size_t n = size_t(std::min(nx - block.first[0], int(edge)));
    float* to = std::copy_n(&field[number(grid, {block.first[0], y, z})], n, &value[edge * row]);
    std::fill_n(to, edge - n, to[-1]);
  }
  for (size_t axis = 0; axis < 3; ++axis) {
    const float per_cell = float(1 / grid.cell(int(axis)));
    for (size_t i = 0; i + step[axis] < size; ++i) {
      slope[i] = std::abs(value[i + step[axis]] - value[i]) * per_cell;
    }
    for (size_t other = 0; other < 3; ++other) {
      if (other == axis) continue;
      for (size_t i = 0; i + step[other] < size; ++i) {
        slope[i] = slope[i] < slope[i + step[other]] ? slope[i + step[other]] : slope[i];
      }
    }
    for (size_t i = 0; i < size; ++i) square[i] += slope[i] * slope[i];
  }
  // The bits of floats that are not negative are in the floats' order, and the largest is found
  // among many at once.
  uint32_t largest = 0;
  const size_t nx_here = size_t(block.last[0] - block.first[0]);
  for (int z = 0; z < block.last[2] - block.first[2]; ++z) {
    for (int y = 0; y < block.last[1] - block.first[1]; ++y) {
      const float* row = &square[edge * (size_t(y) + edge * size_t(z))];
      for (size_t x = 0; x < nx_here; ++x) {
        largest = std::max(largest, std::bit_cast<uint32_t>(row[x]));
      }
    }
  }
  return std::sqrt(std::bit_cast<float>(largest));
}

std::vector<size_t> colored_in(const TexelGrid& grid, const float* field, Colored colored,
                               const Block& block) {
  const auto place = [&](const Index& at) {
    return size_t(at[0] - block.first[0] + 1) + step_y * size_t(at[1] - block.first[1] + 1) +
           step_z * size_t(at[2] - block.first[2] + 1);
  };
  // Whether samples are inside; one more on each side, unless the grid ends there.
  Block around = block;
  for (int axis = 0; axis < 3; ++axis) {
    around.first[axis] = std::max(block.first[axis] - 1, 0);
    around.last[axis] = std::min(block.last[axis] + 1, grid.counts[axis]);
  }
  Bytes inside{};
  size_t inside_count = 0;
  for_samples(grid, around, [&](const Index& at, size_t i) {
    inside_count += inside[place(at)] = field[i] >= 0;
  });
  if (inside_count == 0 || (colored == Colored::surface && inside_count == inside.size())) {
    return {};
  }
  const Bytes cubes = colored_cubes(inside, colored);
  // Of the cubes that a sample is a corner of, the lowest one counts for all.
  const Bytes corners = joined(cubes, std::bit_or());
  std::vector<size_t> wanted;
  for_samples(grid, block, [&](const Index& at, size_t i) {
    if (corners[place(at) - 1 - step_y - step_z]) wanted.push_back(i);
  });
  return wanted;
}

}  // namespace sardf::volume

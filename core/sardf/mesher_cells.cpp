// Samples the blocks and lists the cells with surface and the grid edges that it crosses.
#include <algorithm>
#include <bit>

#include "sardf/mesher_blocks.hpp"

namespace sardf::mesher {

namespace {

constexpr int side = block_cells + 1;  // samples along the edge of a block
constexpr int samples = side * side * side;

constexpr int sample_index(int x, int y, int z) { return x + side * (y + side * z); }

struct Sampled {
  Index3 block{};
  Cells::Block occupied;
  std::vector<Index3> at;
  std::vector<uint8_t> inside, joined;
  std::vector<Crossing> crossings;
  std::vector<Index3> neighbours;  // blocks that share a crossed edge
  std::vector<NodeProgram> programs;
};

template <class T>
void evaluate_samples(const Field& field, const Grid& grid, const Index3& block, float* values) {
  std::array<std::array<T, side>, 3> at;
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < side; ++i) {
      at[axis][i] = T(grid.coordinate(axis, block[axis] * block_cells + i));
    }
  }
  const Evaluator& program = field.program(block, block_level);
  constexpr int rows_at_once = int(Points<T>::capacity) / side;
  Points<T> points;
  for (int row = 0; row < side * side; row += rows_at_once) {
    const int rows = std::min(side * side - row, rows_at_once), count = rows * side;
    for (int r = 0; r < rows; ++r) {
      std::copy_n(at[0].data(), side, points.xyz[0] + side * r);
      std::fill_n(points.xyz[1] + side * r, side, at[1][(row + r) % side]);
      std::fill_n(points.xyz[2] + side * r, side, at[2][(row + r) / side]);
    }
    field.evaluate(program, points, size_t(count));
    for (int i = 0; i < count; ++i) values[side * row + i] = float(points.value[i]);
  }
}

// The ambiguous faces whose inside corners are joined: the saddle of the bilinear interpolation is
// inside (Nielson and Hamann 1991, "The asymptotic decider").
uint8_t joined_faces(uint8_t inside, const std::array<float, 8>& corner) {
  uint8_t joined = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const int e = 1 << (axis + 1) % 3, g = 1 << (axis + 2) % 3;
    for (int s = 0; s < 2; ++s) {
      const int c = s << axis;
      const auto is_inside = [&](int k) { return (inside >> k & 1) != 0; };
      if (is_inside(c) != is_inside(c + e + g) || is_inside(c + e) != is_inside(c + g) ||
          is_inside(c) == is_inside(c + e)) {
        continue;
      }
      const double straight = double(corner[c]) * corner[c + e + g];
      const double crossed = double(corner[c + e]) * corner[c + g];
      if (is_inside(c) ? straight > crossed : crossed > straight) {
        joined |= uint8_t(1 << (2 * axis + s));
      }
    }
  }
  return joined;
}

// The blocks that share the crossed edges of the cell at `local` in its block.
void add_neighbours(const Index3& block, const std::array<int, 3>& local, uint8_t inside,
                    std::vector<Index3>& to) {
  const auto is_inner = [](int i) { return i > 0 && i < block_cells - 1; };
  if (is_inner(local[0]) && is_inner(local[1]) && is_inner(local[2])) return;
  for (int edge = 0; edge < 12; ++edge) {
    const int d = edge / 4, e = (d + 1) % 3, g = (d + 2) % 3;
    const int at_e = edge & 1, at_g = edge >> 1 & 1;
    const int corner = at_e << e | at_g << g;
    if ((inside >> corner & 1) == (inside >> (corner + (1 << d)) & 1)) continue;
    const bool border_e = local[e] == (at_e ? block_cells - 1 : 0);
    const bool border_g = local[g] == (at_g ? block_cells - 1 : 0);
    for (int k = 1; k < 4; ++k) {
      if (((k & 1) && !border_e) || ((k & 2) && !border_g)) continue;
      Index3 next = block;
      if (k & 1) next[e] += at_e ? 1 : -1;
      if (k & 2) next[g] += at_g ? 1 : -1;
      to.push_back(next);
    }
  }
}

void add_crossings(const Index3& at, uint8_t inside, const std::array<float, 8>& corner,
                   std::vector<Crossing>& to) {
  for (int axis = 0; axis < 3; ++axis) {
    const bool start = inside & 1, end = (inside >> (1 << axis) & 1) != 0;
    if (start != end) to.push_back({at, uint8_t(axis), start, corner[0], corner[1 << axis]});
  }
}

// The signs of a block's samples, a row along x in each number: bit x is set inside.
class Signs {
 public:
  explicit Signs(const std::array<float, samples>& values) {
    for (int i = 0; i < samples; ++i) rows_[i / side] |= uint16_t((values[i] >= 0) << i % side);
  }

  /// Bit x: cell x of the row of cells has corners on both sides.
  int mixed(int y, int z) const {
    const int any = row(y, z) | row(y + 1, z) | row(y, z + 1) | row(y + 1, z + 1);
    const int all = row(y, z) & row(y + 1, z) & row(y, z + 1) & row(y + 1, z + 1);
    return (any | any >> 1) & ~(all & all >> 1) & ((1 << block_cells) - 1);
  }
  /// Bit c: corner c of the cell is inside.
  uint8_t inside(int x, int y, int z) const {
    const auto pair = [&](int dy, int dz) { return row(y + dy, z + dz) >> x & 3; };
    return uint8_t(pair(0, 0) | pair(1, 0) << 2 | pair(0, 1) << 4 | pair(1, 1) << 6);
  }

 private:
  int row(int y, int z) const { return rows_[y + side * z]; }

  std::array<uint16_t, side * side> rows_{};
};

Sampled sample(const Field& field, const Grid& grid, const Index3& block) {
  std::array<float, samples> values;
  const Index3 first{block[0] * block_cells, block[1] * block_cells, block[2] * block_cells};
  if (grid.single) {
    evaluate_samples<float>(field, grid, block, values.data());
  } else {
    evaluate_samples<double>(field, grid, block, values.data());
  }
  Sampled result;
  result.block = block;
  const Signs signs(values);
  size_t count = 0;
  for (int z = 0; z < block_cells; ++z) {
    for (int y = 0; y < block_cells; ++y) {
      result.occupied.occupied[z] |= uint64_t(signs.mixed(y, z)) << 8 * y;
    }
    count += size_t(std::popcount(result.occupied.occupied[z]));
  }
  if (count == 0) return result;
  result.at.reserve(count);
  result.inside.reserve(count);
  result.joined.reserve(count);
  result.crossings.reserve(count + count / 2);
  for (int z = 0; z < block_cells; ++z) {
    for (int y = 0; y < block_cells; ++y) {
      for (int row = signs.mixed(y, z); row != 0; row &= row - 1) {
        const int x = std::countr_zero(unsigned(row));
        const uint8_t inside = signs.inside(x, y, z);
        std::array<float, 8> corner;
        for (int c = 0; c < 8; ++c) {
          corner[c] = values[sample_index(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2))];
        }
        const Index3 at{first[0] + x, first[1] + y, first[2] + z};
        result.at.push_back(at);
        result.inside.push_back(inside);
        result.joined.push_back(joined_faces(inside, corner));
        add_crossings(at, inside, corner, result.crossings);
        add_neighbours(block, {x, y, z}, inside, result.neighbours);
      }
    }
  }
  std::sort(result.neighbours.begin(), result.neighbours.end());
  result.neighbours.erase(std::unique(result.neighbours.begin(), result.neighbours.end()),
                          result.neighbours.end());
  shorten_parts(field, block, result.occupied.occupied, result.programs);
  return result;
}

void reserve_for(const std::vector<Sampled>& parts, Cells& cells) {
  size_t count = cells.at.size(), crossings = cells.crossings.size(), blocks = cells.blocks.size();
  for (const Sampled& part : parts) {
    count += part.at.size();
    crossings += part.crossings.size();
    blocks += !part.at.empty();
  }
  cells.at.reserve(count);
  cells.inside.reserve(count);
  cells.joined.reserve(count);
  cells.crossings.reserve(crossings);
  cells.blocks.reserve(blocks);
  cells.block_at.reserve(blocks);
}

void append(Sampled& part, Cells& cells) {
  if (part.at.empty()) return;
  cells.block_at[key(part.block)] = uint32_t(cells.blocks.size());
  uint32_t number = uint32_t(cells.at.size());
  for (int z = 0; z < block_cells; ++z) {
    part.occupied.first[z] = number;
    number += uint32_t(std::popcount(part.occupied.occupied[z]));
  }
  cells.blocks.push_back(part.occupied);
  const auto add = [](auto& from, auto& to) { to.insert(to.end(), from.begin(), from.end()); };
  add(part.at, cells.at);
  add(part.inside, cells.inside);
  add(part.joined, cells.joined);
  add(part.crossings, cells.crossings);
  part = {};
}

}  // namespace

uint32_t CellFinder::operator()(const Index3& cell) {
  static_assert(block_cells == 8);
  const Index3 place{cell[0] >> 3, cell[1] >> 3, cell[2] >> 3};
  if (place != place_) {
    const auto found = cells_.block_at.find(key(place));
    block_ = found == cells_.block_at.end() ? nullptr : &cells_.blocks[found->second];
    place_ = place;
  }
  if (!block_) return none;
  const int layer = cell[2] & 7, bit = (cell[0] & 7) + 8 * (cell[1] & 7);
  const uint64_t occupied = block_->occupied[layer];
  if (!(occupied >> bit & 1)) return none;
  return block_->first[layer] + uint32_t(std::popcount(occupied & ((uint64_t(1) << bit) - 1)));
}

Cells find_cells(Field& field, const Grid& grid, size_t memory_limit, Work& work) {
  std::vector<Index3> blocks = find_blocks(field, grid, memory_limit, work);
  std::unordered_map<uint64_t, bool> known;
  for (const Index3& block : blocks) known[key(block)] = true;
  Cells cells;
  // The samples are rounded: one near 0 may have another sign than was proven for the block next
  // to it. Such a block is sampled as well, so that no face lacks a vertex.
  while (!blocks.empty()) {
    std::vector<Sampled> parts(blocks.size());
    work.run(blocks.size(), 4, [&](size_t first, size_t last) {
      for (size_t i = first; i < last; ++i) parts[i] = sample(field, grid, blocks[i]);
    });
    reserve_for(parts, cells);
    std::vector<Index3> missing;
    for (Sampled& part : parts) {
      for (const Index3& next : part.neighbours) {
        const bool in_grid = next[0] >= 0 && next[1] >= 0 && next[2] >= 0 &&
                             next[0] < grid.blocks[0] && next[1] < grid.blocks[1] &&
                             next[2] < grid.blocks[2];
        if (in_grid && known.emplace(key(next), true).second) missing.push_back(next);
      }
      for (NodeProgram& n : part.programs) {
        field.programs()->add(n.node, n.level, std::move(n.program));
      }
      append(part, cells);
    }
    blocks = std::move(missing);
  }
  return cells;
}

}  // namespace sardf::mesher

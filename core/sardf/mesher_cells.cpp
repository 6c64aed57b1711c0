// Samples the blocks and lists the cells with surface and the grid edges that it crosses.
#include <algorithm>
#include <bit>
#include <cstring>
#include <memory>
#include <unordered_set>

#include "sardf/mesher_blocks.hpp"

namespace sardf::mesher {

namespace {

constexpr int side = block_cells + 1;  // samples along the edge of a block
constexpr int samples = side * side * side;

constexpr int sample_index(int x, int y, int z) { return x + side * (y + side * z); }

// Which blocks around a block share a crossed edge with it: bit x + 3 y + 9 z, each of them 0 to 2.
using Neighbours = uint32_t;

// The corners of a cell: Cells::inside and Cells::joined.
struct Corners {
  uint8_t inside, joined;
};

struct Sampled {
  Cells::Block block;
  std::vector<Corners> corners;     // of each cell
  std::vector<Crossing> crossings;  // their cells are numbered from 0
  Neighbours neighbours = 0;
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
      if (!is_ambiguous(inside, axis, s)) continue;
      const int c = s << axis;
      const double straight = double(corner[c]) * corner[c + e + g];
      const double crossed = double(corner[c + e]) * corner[c + g];
      if (inside >> c & 1 ? straight > crossed : crossed > straight) {
        joined |= uint8_t(1 << (2 * axis + s));
      }
    }
  }
  return joined;
}

// The signs of a block's samples, a row along x in each number: bit x is set inside.
class Signs {
 public:
  explicit Signs(const float* values) {
    static_assert(side == 9 && std::endian::native == std::endian::little);
    uint8_t inside[samples];
    for (int i = 0; i < samples; ++i) inside[i] = values[i] >= 0;
    for (int r = 0; r < side * side; ++r) {
      uint64_t eight;
      std::memcpy(&eight, inside + side * r, 8);
      // The product's top byte gathers the lowest bits of the eight bytes.
      rows_[r] = uint16_t(eight * 0x0102040810204080u >> 56 | inside[side * r + 8] << 8);
    }
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
  /// A side of the block has a crossed edge where its samples have both signs, and so has an edge
  /// of the block.
  Neighbours neighbours() const {
    // Of the rows with y and z first, anywhere, and last: all of them together.
    std::array<std::array<Both, 3>, 3> of;
    for (int z = 0; z < side; ++z) {
      Both inner;
      for (int y = 0; y < side; ++y) inner.add(row(y, z));
      const std::array<Both, 3> rows{Both(row(0, z)), inner, Both(row(side - 1, z))};
      for (size_t y = 0; y < 3; ++y) {
        if (z == 0) of[0][y] = rows[y];
        of[1][y].add(rows[y]);
        if (z == side - 1) of[2][y] = rows[y];
      }
    }
    constexpr int mask[] = {1, (1 << side) - 1, 1 << (side - 1)};
    Neighbours result = 0;
    for (int k = 0; k < 27; ++k) {
      const int x = k % 3, y = k / 3 % 3, z = k / 9;
      const int outer = (x != 1) + (y != 1) + (z != 1);
      if (outer < 1 || outer > 2) continue;
      const Both& both = of[size_t(z)][size_t(y)];
      if ((both.any & mask[x]) != 0 && (both.all & mask[x]) != mask[x]) {
        result |= Neighbours(1) << k;
      }
    }
    return result;
  }

 private:
  int row(int y, int z) const { return rows_[y + side * z]; }

  // Bit x: any sample there is inside, and all are.
  struct Both {
    int any = 0, all = -1;
    Both() = default;
    explicit Both(int row) : any(row), all(row) {}
    void add(int row) {
      any |= row;
      all &= row;
    }
    void add(const Both& other) {
      any |= other.any;
      all &= other.all;
    }
  };

  std::array<uint16_t, side * side> rows_{};
};

// The cells with surface in a block and its crossed edges, in room for the most that there can be.
struct Found {
  std::array<Corners, block_cells * block_cells * block_cells> corners;
  std::array<Edge, 3 * block_cells * block_cells * block_cells> edges;
  std::array<Crossing, 3 * block_cells * block_cells * block_cells> crossings;
  uint32_t cells = 0;
  size_t crossed = 0;
};

void find_in_block(const Signs& signs, const float* values, const Index3& first, Found& to) {
  to.cells = 0;
  to.crossed = 0;
  for (int z = 0; z < block_cells; ++z) {
    for (int y = 0; y < block_cells; ++y) {
      for (int row = signs.mixed(y, z); row != 0; row &= row - 1) {
        const int x = std::countr_zero(unsigned(row));
        const uint8_t inside = signs.inside(x, y, z);
        const float* at = values + sample_index(x, y, z);
        uint8_t joined = 0;
        if (has_ambiguous_face[inside]) {
          std::array<float, 8> corner;
          for (int c = 0; c < 8; ++c) corner[c] = at[sample_index(c & 1, c >> 1 & 1, c >> 2)];
          joined = joined_faces(inside, corner);
        }
        to.corners[to.cells] = {inside, joined};
        constexpr int step[3] = {1, side, side * side};
        for (uint8_t axis = 0; axis < 3; ++axis) {
          const bool leaves = inside & 1, ends_inside = (inside >> (1 << axis) & 1) != 0;
          if (leaves == ends_inside) continue;
          to.edges[to.crossed] = {
              {first[0] + x, first[1] + y, first[2] + z}, at[0], at[step[axis]]};
          to.crossings[to.crossed++] = {to.cells, 0, {}, axis, leaves};
        }
        ++to.cells;
      }
    }
  }
}

Sampled sample(const Field& field, const Grid& grid, const Index3& block, Found& found) {
  std::array<float, samples> values;
  if (grid.single) {
    evaluate_samples<float>(field, grid, block, values.data());
  } else {
    evaluate_samples<double>(field, grid, block, values.data());
  }
  Sampled result;
  result.block.place = block;
  const Signs signs(values.data());
  uint64_t any = 0;
  for (int z = 0; z < block_cells; ++z) {
    for (int y = 0; y < block_cells; ++y) {
      result.block.occupied[z] |= uint64_t(signs.mixed(y, z)) << 8 * y;
    }
    any |= result.block.occupied[z];
  }
  if (any == 0) return result;
  const Index3 first{block[0] * block_cells, block[1] * block_cells, block[2] * block_cells};
  find_in_block(signs, values.data(), first, found);
  locate(field, grid, field.program(block, block_level), found.edges.data(), found.crossed,
         found.crossings.data());
  result.corners.assign(found.corners.data(), found.corners.data() + found.cells);
  result.crossings.assign(found.crossings.data(), found.crossings.data() + found.crossed);
  result.neighbours = signs.neighbours();
  shorten_parts(field, block, result.block.occupied, result.programs);
  return result;
}

// Appends the parts, each at its place.
void append(const std::vector<Sampled>& parts, Cells& cells, Work& work) {
  struct Place {
    size_t cell, crossing;
  };
  std::vector<Place> places(parts.size());
  Place end{cells.at.size(), cells.crossings.size()};
  for (size_t i = 0; i < parts.size(); ++i) {
    places[i] = end;
    if (parts[i].corners.empty()) continue;
    end.cell += parts[i].corners.size();
    end.crossing += parts[i].crossings.size();
    cells.block_at[key(parts[i].block.place)] = uint32_t(cells.blocks.size());
    cells.blocks.push_back(parts[i].block);
    uint32_t number = uint32_t(places[i].cell);
    for (int z = 0; z < block_cells; ++z) {
      cells.blocks.back().first[z] = number;
      number += uint32_t(std::popcount(parts[i].block.occupied[z]));
    }
  }
  cells.at.resize(end.cell);
  cells.inside.resize(end.cell);
  cells.joined.resize(end.cell);
  cells.first_crossing.resize(end.cell);
  cells.crossings.resize(end.crossing);
  const auto copy = [&](const Sampled& part, const Place& to) {
    size_t i = to.cell;
    for (const Corners& corners : part.corners) {
      cells.inside[i] = corners.inside;
      cells.joined[i++] = corners.joined;
    }
    i = to.cell;
    for (int z = 0; z < block_cells; ++z) {
      for (uint64_t left = part.block.occupied[z]; left != 0; left &= left - 1) {
        const int bit = std::countr_zero(left);
        const Index3 local{bit & 7, bit >> 3, z};
        for (int a = 0; a < 3; ++a) {
          cells.at[i][a] = part.block.place[a] * block_cells + local[a];
        }
        ++i;
      }
    }
    size_t c = to.crossing;
    i = to.cell;
    for (Crossing crossing : part.crossings) {
      crossing.cell += uint32_t(to.cell);
      for (; i <= crossing.cell; ++i) cells.first_crossing[i] = uint32_t(c);
      cells.crossings[c++] = crossing;
    }
  };
  work.run(parts.size(), 16, [&](size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) copy(parts[i], places[i]);
  });
}

}  // namespace

const Cells::Block& CellFinder::block_at(const Index3& place) {
  const int parity = (place[0] & 1) | (place[1] & 1) << 1 | (place[2] & 1) << 2;
  const Cells::Block*& block = blocks_[size_t(parity)];
  const auto is_at = [&](const Index3& p) {
    return p[0] == place[0] && p[1] == place[1] && p[2] == place[2];
  };
  if (!block || !is_at(block->place)) block = &cells_.blocks[cells_.block_at.at(key(place))];
  return *block;
}

uint32_t CellFinder::operator()(const Index3& cell) {
  static_assert(block_cells == 8);
  const Cells::Block& block = block_at({cell[0] >> 3, cell[1] >> 3, cell[2] >> 3});
  const size_t layer = size_t(cell[2] & 7);
  const int bit = (cell[0] & 7) + 8 * (cell[1] & 7);
  const uint64_t before = (uint64_t(1) << bit) - 1;
  return block.first[layer] + uint32_t(std::popcount(block.occupied[layer] & before));
}

Cells find_cells(Field& field, const Grid& grid, size_t memory_limit, Work& work) {
  std::vector<Index3> blocks = find_blocks(field, grid, memory_limit, work);
  std::unordered_set<uint64_t> known;
  for (const Index3& block : blocks) known.insert(key(block));
  Cells cells;
  // The samples are rounded: one near 0 may have another sign than was proven for the block next
  // to it. Such a block is sampled as well, so that no face lacks a vertex.
  while (!blocks.empty()) {
    std::vector<Sampled> parts(blocks.size());
    work.run(blocks.size(), 8, [&](size_t first, size_t last) {
      const auto found = std::make_unique_for_overwrite<Found>();
      for (size_t i = first; i < last; ++i) parts[i] = sample(field, grid, blocks[i], *found);
    });
    append(parts, cells, work);
    std::vector<Index3> missing;
    for (Sampled& part : parts) {
      for (Neighbours left = part.neighbours; left != 0; left &= left - 1) {
        const int k = std::countr_zero(left);
        Index3 next = part.block.place;
        next[0] += k % 3 - 1;
        next[1] += k / 3 % 3 - 1;
        next[2] += k / 9 - 1;
        if (grid.has_block(next) && known.insert(key(next)).second) missing.push_back(next);
      }
      for (NodeProgram& n : part.programs) {
        field.programs()->add(n.node, n.level, std::move(n.program));
      }
    }
    blocks = std::move(missing);
  }
  return cells;
}

}  // namespace sardf::mesher

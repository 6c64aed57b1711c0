// Samples the blocks and lists the cells with surface and the grid edges that it crosses.
#include <algorithm>

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
void evaluate_samples(const Field& field, const Grid& grid, const Index3& first, float* values) {
  Points<T> points;
  for (int begin = 0; begin < samples; begin += int(points.capacity)) {
    const int count = std::min(samples - begin, int(points.capacity));
    for (int i = 0; i < count; ++i) {
      const int s = begin + i;
      points.xyz[0][i] = T(grid.coordinate(0, first[0] + s % side));
      points.xyz[1][i] = T(grid.coordinate(1, first[1] + s / side % side));
      points.xyz[2][i] = T(grid.coordinate(2, first[2] + s / (side * side)));
    }
    field.evaluate(points, size_t(count));
    for (int i = 0; i < count; ++i) values[begin + i] = float(points.value[i]);
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

Sampled sample(const Field& field, const Grid& grid, const Index3& block) {
  std::array<float, samples> values;
  const Index3 first{block[0] * block_cells, block[1] * block_cells, block[2] * block_cells};
  if (grid.single) {
    evaluate_samples<float>(field, grid, first, values.data());
  } else {
    evaluate_samples<double>(field, grid, first, values.data());
  }
  Sampled result;
  result.block = block;
  std::array<uint8_t, samples> sign;
  for (int i = 0; i < samples; ++i) sign[i] = values[i] >= 0;
  for (int z = 0; z < block_cells; ++z) {
    for (int y = 0; y < block_cells; ++y) {
      for (int x = 0; x < block_cells; ++x) {
        uint8_t inside = 0;
        const auto index = [&](int c) {
          return sample_index(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2));
        };
        for (int c = 0; c < 8; ++c) inside |= uint8_t(sign[index(c)] << c);
        if (inside == 0 || inside == 255) continue;
        std::array<float, 8> corner;
        for (int c = 0; c < 8; ++c) corner[c] = values[index(c)];
        const Index3 at{first[0] + x, first[1] + y, first[2] + z};
        result.occupied.occupied[z] |= uint64_t(1) << (x + 8 * y);
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

void append(Sampled& part, Cells& cells) {
  if (part.at.empty()) return;
  cells.block_at[key(part.block)] = uint32_t(cells.blocks.size());
  uint32_t number = uint32_t(cells.at.size());
  for (int z = 0; z < block_cells; ++z) {
    part.occupied.first[z] = number;
    number += uint32_t(__builtin_popcountll(part.occupied.occupied[z]));
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

uint32_t Cells::find(const Index3& cell) const {
  const auto found =
      block_at.find(key({cell[0] / block_cells, cell[1] / block_cells, cell[2] / block_cells}));
  if (found == block_at.end()) return none;
  const Block& block = blocks[found->second];
  const int layer = cell[2] % block_cells;
  const int bit = cell[0] % block_cells + 8 * (cell[1] % block_cells);
  const uint64_t occupied = block.occupied[layer];
  if (!(occupied >> bit & 1)) return none;
  const uint64_t before = occupied & ((uint64_t(1) << bit) - 1);
  return block.first[layer] + uint32_t(__builtin_popcountll(before));
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

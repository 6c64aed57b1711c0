// Which blocks of cells can hold surface: an octree whose nodes are dropped where the field is
// proven to keep its sign (after Barbier et al. 2025, "Lipschitz pruning"). Each node that stays
// gets a program of its own, shortened from that of the node above it.
#include "sardf/mesher_blocks.hpp"

#include <algorithm>
#include <cmath>

#include "sardf/error.hpp"
#include "sardf/short_number.hpp"
#include "sardf/shorten.hpp"

namespace sardf::mesher {

namespace {

// What a cell with surface takes in all stages together (measured), and how many there are at
// least and at most in a node of n cells cubed that was not dropped, in units of n².
constexpr double bytes_per_cell = 260;
constexpr double fewest_cells = 0.1, most_cells = 0.8;

// Where a field is this much steeper than a distance, intervals drop nodes that its values do not.
constexpr double steep = 1.2;

// A program of this many instructions is not shortened: it costs less than finding out.
constexpr size_t short_program = 4;
// How far beyond its node a program is good, in cells: rounded points stay within.
constexpr double room_in_cells = 0.125;

ProgramPointer if_shorter(Evaluator program, size_t steps) {
  if (program.tape().instructions().size() >= steps) return nullptr;
  return std::make_shared<const Evaluator>(std::move(program));
}

// Shortens a program for a box, if that is worth it: null where it is not.
ProgramPointer shortened(const Evaluator& above, const BoundingBox& box, size_t short_enough) {
  const size_t steps = above.tape().instructions().size();
  if (steps <= short_enough) return nullptr;
  return if_shorter(Shortening(above, box).shortened(), steps);
}

Programs no_programs(const Grid& grid) {
  return {grid.origin, grid.cell, room_in_cells * grid.cell};
}

class Pruning {
 public:
  Pruning(Field& field, const Grid& grid) : field_(field), grid_(grid), boxes_(no_programs(grid)) {
    field_.use(no_programs(grid));
    const int32_t most = std::max({grid.blocks[0], grid.blocks[1], grid.blocks[2]});
    while ((int64_t(1) << levels_) < most) ++levels_;
    const BoundingBox all = box({0, 0, 0}, levels_);
    slope_ = field.lipschitz(all);
    rounding_ = 1e-12 * std::max(norm(all.lo), norm(all.hi));
  }

  int levels() const { return levels_; }

  // For each of up to Points::capacity nodes whether it can hold surface, and the program of one
  // that can where it is shorter than the one above.
  void test(const Index3* nodes, size_t n, int level, uint8_t* keep, ProgramPointer* programs) {
    Points<double> centres;
    for (size_t i = 0; i < n; ++i) centres.set(i, box(nodes[i], level).center());
    field_.evaluate(centres, n);
    const double radius = 0.5 * box({0, 0, 0}, level).diagonal();
    const double reach = slope_ * (radius + rounding_) * (1 + 1e-12);
    for (size_t i = 0; i < n; ++i) {
      keep[i] = !(std::abs(centres.value[i]) > reach);
      if (keep[i]) keep[i] = examine(nodes[i], level, programs[i]);
    }
  }

  void add(const Index3& node, int level, ProgramPointer program) {
    if (program) field_.programs()->add(node, level + block_level, std::move(program));
  }

  // The children of a node that lie in the grid, appended.
  void split(const Index3& node, int level, std::vector<Index3>& to) const {
    for (int child = 0; child < 8; ++child) {
      Index3 at;
      bool in_grid = true;
      for (int axis = 0; axis < 3; ++axis) {
        at[axis] = 2 * node[axis] + (child >> axis & 1);
        in_grid = in_grid && (int64_t(at[axis]) << (level - 1)) < grid_.blocks[axis];
      }
      if (in_grid) to.push_back(at);
    }
  }

 private:
  BoundingBox box(const Index3& node, int level) const {
    return boxes_.box(node, level + block_level);
  }

  // Whether intervals leave a node in, too; and its program.
  bool examine(const Index3& node, int level, ProgramPointer& program) const {
    const Evaluator& above = field_.program(node, level + block_level);
    const BoundingBox here = box(node, level);
    const auto can_vanish = [&](const Interval& solid) {
      const Interval range = field_.clipped(solid, here);
      return !(range.hi < 0 || range.lo > 0);
    };
    const size_t steps = above.tape().instructions().size();
    if (steps <= short_program) return slope_ < steep || can_vanish(above.interval(here));
    const Shortening shortening(above, boxes_.valid_box(node, level + block_level));
    if (!can_vanish(shortening.range())) return false;
    program = if_shorter(shortening.shortened(), steps);
    return true;
  }

  Field& field_;
  const Grid& grid_;
  const Programs boxes_;
  int levels_ = 0;
  double slope_, rounding_;
};

void check_memory(size_t nodes, int level, const Grid& grid, size_t limit) {
  const double edge = std::ldexp(double(block_cells), level);
  const double cells = double(nodes) * edge * edge * (level > 0 ? fewest_cells : most_cells);
  const double needed = bytes_per_cell * cells;
  if (needed <= double(limit)) return;
  const auto gib = [](double bytes) { return short_number(bytes / double(1 << 30)); };
  throw Failure("a mesh with cells of " + short_number(grid.cell) + " scene units needs " +
                (level > 0 ? "more than " : "about ") + gib(needed) + " GiB of memory, " +
                gib(double(limit)) + " GiB are free; cells of " +
                short_number(grid.cell * 1.1 * std::sqrt(needed / double(limit))) + " fit");
}

}  // namespace

void shorten_parts(const Field& field, const Index3& block,
                   const std::array<uint64_t, block_cells>& occupied,
                   std::vector<NodeProgram>& to) {
  const Programs& programs = *field.programs();
  const auto holds_surface = [&](const Index3& part, int edge) {
    for (int z = part[2] * edge; z < (part[2] + 1) * edge; ++z) {
      for (int y = part[1] * edge; y < (part[1] + 1) * edge; ++y) {
        const int row = int(occupied[size_t(z)] >> (8 * y) & 0xFF);
        if (row >> (part[0] * edge) & ((1 << edge) - 1)) return true;
      }
    }
    return false;
  };
  // Depth first, so that each part starts from the program of the larger one.
  const auto visit = [&](auto& self, const Evaluator& above, const Index3& part,
                         int level) -> void {
    const int parts = block_level - level;  // halvings since the block
    if (!holds_surface(part, block_cells >> parts)) return;
    Index3 node;
    for (int axis = 0; axis < 3; ++axis) node[axis] = (block[axis] << parts) + part[axis];
    ProgramPointer program;
    if (level < block_level) {
      program = shortened(above, programs.valid_box(node, level), long_program);
      if (program) to.push_back({node, level, program});
    }
    if (level == 0) return;
    const Evaluator& here = program ? *program : above;
    if (here.tape().instructions().size() <= long_program) return;
    for (int k = 0; k < 8; ++k) {
      self(self, here, {2 * part[0] + (k & 1), 2 * part[1] + (k >> 1 & 1), 2 * part[2] + (k >> 2)},
           level - 1);
    }
  };
  visit(visit, field.program(block, block_level), {0, 0, 0}, block_level);
}

std::vector<Index3> find_blocks(Field& field, const Grid& grid, size_t memory_limit, Work& work) {
  Pruning pruning(field, grid);
  std::vector<Index3> nodes{{0, 0, 0}};
  for (int level = pruning.levels();; --level) {
    std::vector<uint8_t> keep(nodes.size());
    std::vector<ProgramPointer> programs(nodes.size());
    work.run(nodes.size(), 64, [&](size_t first, size_t last) {
      pruning.test(&nodes[first], last - first, level, &keep[first], &programs[first]);
    });
    std::vector<Index3> kept;
    for (size_t i = 0; i < nodes.size(); ++i) {
      if (!keep[i]) continue;
      kept.push_back(nodes[i]);
      pruning.add(nodes[i], level, std::move(programs[i]));
    }
    check_memory(kept.size(), level, grid, memory_limit);
    if (level == 0) return kept;
    nodes.clear();
    for (const Index3& node : kept) pruning.split(node, level, nodes);
  }
}

}  // namespace sardf::mesher

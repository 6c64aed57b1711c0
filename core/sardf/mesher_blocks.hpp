// Private to core/sardf/mesher*.cpp.
#pragma once

#include "sardf/mesher_stages.hpp"

namespace sardf::mesher {

/// The blocks of the grid that can hold surface; the field gets shorter programs for them. Throws
/// Error when the mesh would not fit into `memory_limit` bytes.
std::vector<Index3> find_blocks(Field& field, const Grid& grid, size_t memory_limit, Work& work);

/// The level of blocks in the octree of programs.
inline constexpr int block_level = 2;
static_assert(Programs::least_cells << block_level == block_cells);

/// Parts of blocks get programs of their own where the block's has more instructions than this.
inline constexpr size_t long_program = 12;

struct NodeProgram {
  Index3 node;
  int level;
  ProgramPointer program;
};

/// Shorter programs for the parts of a block that hold surface, appended, where the block's own is
/// long. `occupied`: bit x + 8 y of entry z: a cell with surface.
void shorten_parts(const Field& field, const Index3& block,
                   const std::array<uint64_t, block_cells>& occupied, std::vector<NodeProgram>& to);

}  // namespace sardf::mesher

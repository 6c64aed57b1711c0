// Private to core/sardf/mesher*.cpp.
#pragma once

#include "sardf/mesher_stages.hpp"

namespace sardf::mesher {

/// The blocks of the grid that can hold surface; the field gets shorter programs for them. Throws
/// Error when the mesh would not fit into `memory_limit` bytes.
std::vector<Index3> find_blocks(Field& field, const Grid& grid, size_t memory_limit, Work& work);

}  // namespace sardf::mesher

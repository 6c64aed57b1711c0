// Whether triangles of a mesh run into each other.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "sardf/triangle_tree.hpp"

namespace sardf {

/// Two triangles, in the tree's order, that are not proven to meet in common corners and edges
/// alone; nullopt when every two are. Those that touch, or are nearer to it than rounding can tell,
/// count as meeting. Of several pairs, the first.
std::optional<std::array<uint32_t, 2>> meeting_triangles(const TriangleTree& tree,
                                                         Pulse& pulse = Pulse::none());

}  // namespace sardf

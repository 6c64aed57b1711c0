// Plane polygons in space, cut into triangles.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sardf/pulse.hpp"
#include "sardf/vec.hpp"

namespace sardf {

/// The triangles of a polygon with n >= 3 corners, as n - 2 triples of places in `corners`, wound
/// as the polygon is. A convex polygon is a fan around its first corner; any other is cut at its
/// ears (Meisters 1975), seen along its area vector, in O(n²). Where there is no ear, as in a
/// polygon that crosses itself, the next corner is cut off all the same.
/// Throws Cancelled where the pulse does.
std::vector<std::array<uint32_t, 3>> triangulated(std::span<const Vec3> corners,
                                                  Pulse& pulse = Pulse::none());

}  // namespace sardf

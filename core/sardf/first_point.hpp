// Where a ray meets what is drawn of a scene: what a probe under a cursor asks.
#pragma once

#include <array>
#include <optional>

#include "sardf/scene.hpp"

namespace sardf {

/// A plane a x + b y + c z + d = 0; all 0: there is none.
using Plane = std::array<double, 4>;

/// The first point of the drawn solid on the ray from `origin`, within 1e-7 of the bounds'
/// diagonal, or none. What lies above `plane` (a x + b y + c z + d > 0) is cut away, too. A wall
/// that is thinner along the ray than a thousandth of its way through the bounds may be missed.
/// Throws Error: numbers that are not finite, a direction without length.
std::optional<Vec3> first_point(const Scene& scene, const Vec3& origin, const Vec3& direction,
                                const Plane& plane = {});

}  // namespace sardf

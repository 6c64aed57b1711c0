// Closed contours in the plane: what polygons, in either form, and lofts are made of.
#pragma once

#include <string>
#include <vector>

#include "sardf/vec.hpp"

namespace sardf {

/// Corners in order, either way round; the last is joined to the first.
using Contour = std::vector<Vec2>;

/// Twice the area of the triangle o, a, b, positive where it runs counter-clockwise.
inline double cross(const Vec2& o, const Vec2& a, const Vec2& b) {
  return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
}

/// Twice the area, positive where the corners run counter-clockwise.
double doubled_area(const Contour& contour);

/// Throws Error for repeated corners, for edges that cross or touch, naming both, and for a contour
/// without area. `what` is what the message calls it. Takes n² steps.
void check_contour(const Contour& contour, const std::string& what);

}  // namespace sardf

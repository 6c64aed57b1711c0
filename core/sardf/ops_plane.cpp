#include "sardf/ops_plane.hpp"

#include "sardf/contour.hpp"

namespace sardf {

void HalfPlane::prepare() {
  const double size = std::hypot(normal[0], normal[1]);
  if (!(size > 0)) throw Error("normal is the zero vector; give a direction such as [1, 0]");
  unit_ = {normal[0] / size, normal[1] / size};
}

void Polygon::prepare() {
  check_contour(vertices, "polygon");
  turn_ = doubled_area(vertices) > 0 ? 1 : -1;
}

}  // namespace sardf

#include "sardf/render_rays.hpp"

#include <algorithm>
#include <cmath>

namespace sardf::rendering {

Rays::Rays(const Camera& camera, int width, int height)
    : perspective_(camera.type == Camera::Type::perspective),
      middle_x_(0.5 * width),
      middle_y_(0.5 * height) {
  const View view = view_of(camera, width, height);
  axes_ = {normalized(view.right), normalized(view.up), normalized(cross(view.up, view.right))};
  // Along a perspective view's direction the depth grows by this; the shift does not add to it.
  const double scale = perspective_ ? 1 / dot(view.direction, axes_[2]) : 1;
  location_ = view.location;
  view_ = scale * view.direction;
  right_ = scale / width * view.right;
  up_ = scale / height * view.up;
}

Line Rays::through(double x, double y) const {
  const Vec3 across = (x - middle_x_) * right_ + (middle_y_ - y) * up_;
  return perspective_ ? Line{location_, view_ + across} : Line{location_ + across, view_};
}

Spread Rays::spread(double x, double y, double edge) const {
  const Vec3 u = 0.5 * edge * right_, v = 0.5 * edge * up_;
  const double corner = norm(u + v);  // u and v are perpendicular
  if (!perspective_) return {corner, 0, 0};
  const Vec3 along = through(x, y).along;
  return {0, corner, std::abs(dot(along, u)) + std::abs(dot(along, v))};
}

double Rays::shortest_step(double x, double y, double edge) const {
  return 1 / std::sqrt(spread(x, y, edge).longest_square(through(x, y).along));
}

Stretch Rays::depths(const BoundingBox& box) const {
  Stretch depths{infinity, -infinity};
  for (int k = 0; k < 8; ++k) {
    const Vec3 corner{k & 1 ? box.hi[0] : box.lo[0], k & 2 ? box.hi[1] : box.lo[1],
                      k & 4 ? box.hi[2] : box.lo[2]};
    const double depth = dot(corner - location_, axes_[2]);
    depths.begin = std::min(depths.begin, depth);
    depths.end = std::max(depths.end, depth);
  }
  const double slack = 1e-9 * (std::abs(depths.begin) + std::abs(depths.end));
  return {std::max(0.0, depths.begin - slack), depths.end + slack};
}

Stretch stretch_in(const Line& line, const BoundingBox& box) {
  Stretch stretch{0, infinity};
  for (int axis = 0; axis < 3; ++axis) {
    const double a = line.along[axis], below = box.lo[axis] - line.from[axis],
                 above = box.hi[axis] - line.from[axis];
    if (a == 0) {
      if (below > 0 || above < 0) return {1, 0};
      continue;
    }
    stretch.begin = std::max(stretch.begin, std::min(below / a, above / a));
    stretch.end = std::min(stretch.end, std::max(below / a, above / a));
  }
  return stretch;
}

}  // namespace sardf::rendering

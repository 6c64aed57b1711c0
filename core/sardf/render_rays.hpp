// The rays of a picture; private to core/sardf/render*.cpp.
#pragma once

#include "sardf/camera.hpp"

namespace sardf::rendering {

/// A ray: from + t along, t >= 0 the depth along the view in scene units. |along| >= 1.
struct Line {
  Vec3 from, along;
  Vec3 at(double t) const { return from + t * along; }
};

/// How far the rays of a square of pixels stray from that through its middle: at the depth t by at
/// most constant + t growth, at the corners; `lean` is the most that dot(along, what a corner adds
/// to it) is.
struct Spread {
  double constant = 0, growth = 0, lean = 0;
  double at(double t) const { return constant + t * growth; }
  /// The square of a corner ray's `along`, at most; `along` is the middle one's.
  double longest_square(const Vec3& along) const {
    return dot(along, along) + growth * growth + 2 * lean;
  }
};

/// The part of a line with t >= 0 that lies in the box; begin > end: none.
struct Stretch {
  double begin, end;
};
Stretch stretch_in(const Line& line, const BoundingBox& box);

class Rays {
 public:
  Rays(const Camera& camera, int width, int height);

  /// The ray through a place of the picture in pixels, the top left corner at (0, 0).
  Line through(double x, double y) const;
  /// The spread of the square of this edge, in pixels, around the place.
  Spread spread(double x, double y, double edge) const;
  /// The least depth that a unit of length makes along any ray of such a square.
  double shortest_step(double x, double y, double edge) const;
  /// The depths >= 0 between which the box lies.
  Stretch depths(const BoundingBox& box) const;
  /// Unit vectors of the picture: to its right, its top, and into it.
  const std::array<Vec3, 3>& axes() const { return axes_; }

 private:
  bool perspective_;
  Vec3 location_, right_, up_, view_;  // per pixel; the view is such that t is the depth
  double middle_x_, middle_y_;
  std::array<Vec3, 3> axes_;
};

}  // namespace sardf::rendering

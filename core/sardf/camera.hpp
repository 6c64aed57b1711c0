// A camera, described as Blender and other programs with a film or sensor describe it, and the one
// place where a picture is framed: every renderer gets the same camera.
#pragma once

#include <array>

#include "sardf/evaluate.hpp"

namespace sardf {

struct Camera {
  enum class Type { perspective, orthographic };
  /// Which edge of the picture the sensor's size belongs to; automatic: the longer one.
  enum class Fit { automatic, horizontal, vertical };

  /// Row-major. The columns are its right, its up, the direction opposite to its view, and its
  /// place, in scene units; the first three need not be unit but must be perpendicular.
  std::array<std::array<double, 4>, 4> matrix_world{
      {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
  Type type = Type::perspective;
  Fit sensor_fit = Fit::automatic;
  double lens = 50;           ///< focal length, mm
  double sensor_width = 36;   ///< mm
  double sensor_height = 24;  ///< mm, used by the fit `vertical`
  double ortho_scale = 1;     ///< scene units along the edge that the fit names
  double shift_x = 0;         ///< as a share of that edge
  double shift_y = 0;
  double clip_start = 0.1;  ///< scene units
  double clip_end = 1000;
};

/// Where the camera's picture lies in space: pixel (u, v), each in [-0.5, 0.5] from left to right
/// and from bottom to top, is seen along `direction` + u `right` + v `up` from `location`; or, for
/// an orthographic camera, along `direction` from `location` + u `right` + v `up`.
struct View {
  Vec3 location, right, up, direction;
};

/// The view of a camera for a picture of this size in pixels. In double precision and exactly
/// perpendicular. Throws Error for a camera whose axes vanish or lie in a plane.
View view_of(const Camera& camera, int width, int height);

/// From above, between the front and its right: three faces of a block are seen, the front most.
inline constexpr Vec3 three_quarter_view{-0.5, 0.78, -0.42};

/// A perspective camera that looks along `direction`, z upright, at the whole box, which fills the
/// picture but for a margin of 4 % on each side. Throws Error for a box without extent or an
/// empty picture.
Camera frame_camera(const BoundingBox& box, int width, int height,
                    const Vec3& direction = three_quarter_view);

}  // namespace sardf

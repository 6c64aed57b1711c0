#include "sardf/camera.hpp"

#include <algorithm>
#include <vector>

#include "sardf/error.hpp"

namespace sardf {

namespace {

constexpr double margin = 0.04;

Vec3 column(const Camera& camera, int i) {
  const auto& m = camera.matrix_world;
  return {m[0][i], m[1][i], m[2][i]};
}

std::vector<Vec3> corners_of(const BoundingBox& box) {
  std::vector<Vec3> out;
  for (int i = 0; i < 8; ++i) {
    out.push_back({i & 1 ? box.hi[0] : box.lo[0], i & 2 ? box.hi[1] : box.lo[1],
                   i & 4 ? box.hi[2] : box.lo[2]});
  }
  return out;
}

bool is_landscape(const Camera& camera, int width, int height) {
  if (camera.sensor_fit == Camera::Fit::automatic) return width >= height;
  return camera.sensor_fit == Camera::Fit::horizontal;
}

void check_picture(int width, int height) {
  if (width < 1 || height < 1) {
    throw Error("the picture has " + std::to_string(width) + " x " + std::to_string(height) +
                " pixels; both must be positive");
  }
}

// Two opposite edges of the picture see the points along tangents in [-tangent, tangent]. Where the
// camera has to stand along one of the picture's axes, and how far back.
struct Fitted {
  double across, back;
};

// With q the coordinate along the axis and d the depth along the view, a point is inside when
// |q - across| <= tangent (d + back): two half-planes, whose tightest lines meet at the answer.
Fitted fit(const std::vector<std::array<double, 2>>& points, double tangent) {
  double upper = -infinity, lower = -infinity;
  for (const auto& [q, d] : points) {
    upper = std::max(upper, q - tangent * d);
    lower = std::max(lower, -q - tangent * d);
  }
  return {0.5 * (upper - lower), 0.5 * (upper + lower) / tangent};
}

}  // namespace

View view_of(const Camera& camera, int width, int height) {
  check_picture(width, height);
  Vec3 back = column(camera, 2), up = column(camera, 1);
  const double volume = dot(cross(column(camera, 0), up), back);
  if (!(std::abs(volume) > 0)) throw Error("the camera's axes vanish or lie in one plane");
  // Matrices of single precision are perpendicular to 1e-7 only.
  back = normalized(back);
  up = normalized(up - dot(up, back) * back);
  const Vec3 right = cross(up, back);
  const double aspect = double(width) / height;
  const bool landscape = is_landscape(camera, width, height);
  const double edge = camera.type == Camera::Type::orthographic ? camera.ortho_scale : 1;
  const double picture_width = landscape ? edge : edge * aspect;
  View view;
  view.location = column(camera, 3);
  view.right = picture_width * right;
  view.up = (picture_width / aspect) * up;
  const Vec3 shift = camera.shift_x * right + camera.shift_y * up;
  if (camera.type == Camera::Type::orthographic) {
    view.direction = -1.0 * back;
    view.location = view.location + camera.ortho_scale * shift;
  } else {
    const bool vertical = camera.sensor_fit == Camera::Fit::vertical;
    const double sensor = vertical ? camera.sensor_height : camera.sensor_width;
    view.direction = (-camera.lens / sensor) * back + shift;
  }
  return view;
}

Camera frame_camera(const BoundingBox& box, int width, int height, const Vec3& direction) {
  check_picture(width, height);
  const double diagonal = box.diagonal();
  if (!(diagonal > 0 && diagonal < infinity)) throw Error("there is nothing to frame: no extent");
  if (!(norm(direction) > 0)) throw Error("the camera's direction is the zero vector");
  Camera camera;
  const Vec3 back = -1 / norm(direction) * direction;
  const bool from_top = std::abs(back[2]) > 0.9999;
  const Vec3 right = normalized(cross(from_top ? Vec3{0, 1, 0} : Vec3{0, 0, 1}, back));
  const Vec3 up = cross(back, right);

  const double longer = 0.5 * camera.sensor_width / camera.lens * (1 - 2 * margin);
  const double tangent_x = width >= height ? longer : longer * width / height;
  const double tangent_y = tangent_x * height / width;
  std::vector<std::array<double, 2>> along_x, along_y;
  double nearest = infinity, farthest = -infinity;
  for (const Vec3& corner : corners_of(box)) {
    const Vec3 p = corner - box.center();
    const double depth = -dot(p, back);
    along_x.push_back({dot(p, right), depth});
    along_y.push_back({dot(p, up), depth});
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  }
  const Fitted x = fit(along_x, tangent_x), y = fit(along_y, tangent_y);
  const double distance = std::max(x.back, y.back);
  const Vec3 place = box.center() + x.across * right + y.across * up + distance * back;
  for (int i = 0; i < 3; ++i) {
    camera.matrix_world[i] = {right[i], up[i], back[i], place[i]};
  }
  camera.clip_start = 0.5 * (distance + nearest);
  camera.clip_end = 2 * (distance + farthest);
  return camera;
}

}  // namespace sardf

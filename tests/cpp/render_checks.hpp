// Rays and where they meet simple solids, by closed forms; for the tests of the ray caster.
#pragma once

#include "mesh_checks.hpp"
#include "sardf/render.hpp"

namespace sardf::checks {

/// A ray as camera.hpp describes it: from + t along, t the depth along the view.
struct TestRay {
  Vec3 from, along;
  Vec3 at(double t) const { return from + t * along; }
};

inline TestRay ray_of(const RenderOptions& options, int x, int y) {
  const View view = view_of(options.camera, options.width, options.height);
  const double u = (x + 0.5) / options.width - 0.5, v = 0.5 - (y + 0.5) / options.height;
  const Vec3 across = u * view.right + v * view.up;
  if (options.camera.type == Camera::Type::orthographic) {
    return {view.location + across, view.direction};
  }
  const Vec3 axis = normalized(cross(view.up, view.right));
  return {view.location, (1 / dot(view.direction, axis)) * (view.direction + across)};
}

// Where a ray is in the solid, by a closed formula; `from` > `to`: nowhere.
struct Inside {
  double from = infinity, to = -infinity;
};

inline Inside in_ball(const TestRay& ray, const Vec3& center, double radius) {
  const Vec3 to = ray.from - center;
  const double a = dot(ray.along, ray.along), b = dot(ray.along, to);
  const double d = b * b - a * (dot(to, to) - radius * radius);
  if (d < 0) return {};
  return {(-b - std::sqrt(d)) / a, (-b + std::sqrt(d)) / a};
}

inline Inside in_box(const TestRay& ray, const Vec3& half) {
  Inside in{-infinity, infinity};
  for (int i = 0; i < 3; ++i) {
    const double one = (-half[i] - ray.from[i]) / ray.along[i];
    const double other = (half[i] - ray.from[i]) / ray.along[i];
    in.from = std::max(in.from, std::min(one, other));
    in.to = std::min(in.to, std::max(one, other));
  }
  return in;
}

inline RenderOptions options_of(const BoundingBox& bounds,
                                const Vec3& direction = three_quarter_view) {
  RenderOptions options;
  options.width = 150;
  options.height = 110;
  options.camera = frame_camera(bounds, options.width, options.height, direction);
  options.tolerance = 1e-4 * bounds.diagonal();
  return options;
}

inline RenderOptions orthographic(RenderOptions options, double scale) {
  options.camera.type = Camera::Type::orthographic;
  options.camera.ortho_scale = scale;
  return options;
}

}  // namespace sardf::checks

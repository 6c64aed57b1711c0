// Rays that balls bring forward slowly: stretches of them are proven clear as boxes, by the range
// of the field, or by how fast it grows along the ray.
#include <algorithm>
#include <cmath>

#include "sardf/render_stages.hpp"

namespace sardf::rendering {

namespace {

// Stretches are tried from this many tolerances on; no shorter ones than `shortest`.
constexpr double first_trial = 16, shortest = 4;
// Samples after a trial that proved nothing.
constexpr int samples_between = 8;

BoundingBox box_of(const Line& line, double begin, double end) {
  const Vec3 a = line.at(begin), b = line.at(end);
  BoundingBox box;
  for (int axis = 0; axis < 3; ++axis) {
    // Room for the roundings of line.at.
    const double slack =
        1e-14 * (std::abs(line.from[axis]) + std::abs(a[axis]) + std::abs(b[axis]));
    box.lo[axis] = std::min(a[axis], b[axis]) - slack;
    box.hi[axis] = std::max(a[axis], b[axis]) + slack;
  }
  return box;
}

// Of the values of the box, or of their growth from the sample at `before`, along the ray.
bool is_clear(const Subject& subject, const Ray& ray, double end) {
  if (subject.solid.whole().interval(box_of(ray.line, ray.clear, end)).hi < 0) return true;
  if (!(ray.before_value < 0)) return false;
  const Slope slope = subject.solid.whole().slope(box_of(ray.line, ray.before, end));
  Interval growth;
  for (int axis = 0; axis < 3; ++axis) {
    growth = growth + slope.partial[axis] * Interval(ray.line.along[axis]);
  }
  const double highest = ray.before_value + std::max(0.0, growth.hi) * (end - ray.before);
  return highest < -2 * subject.error_double;
}

// Proves stretch after stretch, each twice as long as the one before, until one is not clear.
void clear_stretches(const Subject& subject, Ray& ray, Watch& watch) {
  double length = first_trial * ray.tolerance;
  while (ray.state == Ray::State::on_its_way) {
    watch.check();
    const double end = std::min(ray.clear + length, ray.end);
    if (is_clear(subject, ray, end)) {
      ray.clear = end;
      length *= 2;
      ray.trial = std::min(ray.clear + ray.tolerance, ray.end);
      if (!(ray.clear < ray.end)) ray.state = Ray::State::missed;
    } else {
      length *= 0.25;
      if (length < shortest * ray.tolerance) return;
    }
  }
}

}  // namespace

void march_by_intervals(const Subject& subject, std::span<Ray> rays, Watch& watch) {
  const auto is_on_its_way = [](const Ray& ray) { return ray.state == Ray::State::on_its_way; };
  while (std::any_of(rays.begin(), rays.end(), is_on_its_way)) {
    for (Ray& ray : rays) clear_stretches(subject, ray, watch);
    march(subject, rays, samples_between, watch);
  }
}

}  // namespace sardf::rendering

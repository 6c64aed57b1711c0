#include "sardf/first_point.hpp"

#include <algorithm>
#include <cmath>

#include "sardf/error.hpp"
#include "sardf/short_number.hpp"

namespace sardf {

namespace {

// Samples along the ray, and in each of the rounds that follow, which divide what is left: together
// 1024 · 64³ steps, 4e-9 of the way.
constexpr size_t first_samples = 1025, samples = 65;
constexpr int rounds = 3;

struct Stretch {
  double from = 0, to = infinity;  // along the unit direction

  bool is_empty() const { return !(from < to); }
  // Leaves what has height + rise · t <= 0.
  void cut(double height, double rise) {
    if (rise == 0) {
      if (height > 0) to = -infinity;
    } else if (rise > 0) {
      to = std::min(to, -height / rise);
    } else {
      from = std::max(from, -height / rise);
    }
  }
};

void check(const Vec3& origin, const Vec3& direction, const Plane& plane) {
  const double length = norm(direction);
  if (!(length > 0) || !std::isfinite(length)) {
    throw Error("the direction is " + short_point(direction.data()) +
                "; three finite numbers that are not all 0 are accepted");
  }
  const bool is_finite =
      std::isfinite(norm(origin)) &&
      std::all_of(plane.begin(), plane.end(), [](double a) { return std::isfinite(a); });
  if (!is_finite) throw Error("a ray or a plane is not finite; finite numbers are accepted");
}

}  // namespace

std::optional<Vec3> first_point(const Scene& scene, const Vec3& origin, const Vec3& direction,
                                const Plane& plane) {
  check(origin, direction, plane);
  const Vec3 way = normalized(direction);
  Stretch left;
  for (int axis = 0; axis < 3; ++axis) {
    left.cut(scene.bounds().lo[axis] - origin[axis], -way[axis]);
    left.cut(origin[axis] - scene.bounds().hi[axis], way[axis]);
  }
  const Vec3 normal{plane[0], plane[1], plane[2]};
  if (norm(normal) > 0) left.cut(dot(normal, origin) + plane[3], dot(normal, way));
  if (left.is_empty()) return {};
  const Evaluator drawn(scene.drawn());
  std::vector<double> points(3 * first_samples), values(first_samples);
  size_t n = first_samples;
  for (int round = 0; round <= rounds; ++round, n = samples) {
    const auto place = [&](size_t i) {
      return left.from + (left.to - left.from) * double(i) / double(n - 1);
    };
    for (size_t i = 0; i < n; ++i) {
      const Vec3 point = origin + place(i) * way;
      std::copy(point.begin(), point.end(), &points[3 * i]);
    }
    drawn.values(points.data(), n, values.data());
    const auto inside = [](double value) { return value >= 0; };
    const auto first = std::find_if(values.begin(), values.begin() + long(n), inside);
    const size_t i = size_t(first - values.begin());
    if (i == n) return {};
    if (i == 0) return origin + left.from * way;
    left = {place(i - 1), place(i)};
  }
  return origin + left.to * way;
}

}  // namespace sardf

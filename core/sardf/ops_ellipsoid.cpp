#include "sardf/ops_ellipsoid.hpp"

#include <string>

namespace sardf {

namespace {

constexpr int most_steps = 64;
// Distances from a coordinate plane, in radii, at which the steps are counted.
constexpr double grades[] = {1e-18, 1e-12, 1e-8, 1e-5, 1e-3, 0.01, 0.03, 0.1,
                             0.2,   0.4,   0.6,  0.8,  0.95, 1,    1.5,  4};

// The root's variable after each step, for one point; how many steps until it no longer moves by
// more than rounding. The iteration rises monotonically, so standing still is being there.
template <int N>
int steps_needed(const std::array<double, N>& radii, const std::array<double, N>& excess,
                 const std::array<double, N>& y) {
  double s = -infinity;
  for (int i = 0; i < N; ++i) s = max(s, radii[i] * y[i] - excess[i]);
  for (int step = 0; step < most_steps; ++step) {
    double g = 0, slope = 0;
    for (int i = 0; i < N; ++i) {
      const double c = radii[i] * y[i] / (s + excess[i]);
      g += c * c;
      slope += c * c / (s + excess[i]);
    }
    const double rise = (std::sqrt(g) - 1) * g / slope;
    // The distance is stationary in the root: half of the digits give all of its digits.
    if (!(rise > 1e-9 * (s + excess[0] + excess[N - 1]) && rise > 1e-9 * s)) return step;
    s += rise;
  }
  return most_steps;
}

}  // namespace

// The count depends on the point's direction and depth only through smooth quantities; the slowest
// points lie near the medial set, where the shortest axis' coordinate vanishes. A fan of points,
// graded geometrically towards every coordinate plane, finds the most that these radii need.
template <int N>
void EllipsoidDistance<N>::set(const std::array<double, N>& radii) {
  radii_ = radii;
  double least = infinity, most = 0;
  for (int i = 0; i < N; ++i) {
    if (radii[i] < least) shortest_ = i;
    least = min(least, radii[i]);
    most = max(most, radii[i]);
  }
  if (most > 100 * least) {
    throw Error("radii have the ratio " + std::to_string(most / least) +
                "; the distance is proven up to 100");
  }
  for (int i = 0; i < N; ++i) excess_[i] = (radii[i] - least) * (radii[i] + least);
  std::array<double, N> y;
  const auto visit = [&](auto&& self, int axis) -> void {
    if (axis == N) {
      y[shortest_] = max(y[shortest_], radii[shortest_] * 1e-18);
      steps_ = std::max(steps_, steps_needed<N>(radii, excess_, y));
      return;
    }
    for (double grade : grades) {
      y[axis] = grade * radii[axis];
      self(self, axis + 1);
    }
  };
  visit(visit, 0);
  steps_ += 1;
}

template class EllipsoidDistance<2>;
template class EllipsoidDistance<3>;

}  // namespace sardf

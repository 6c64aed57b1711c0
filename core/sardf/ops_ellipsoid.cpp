#include "sardf/ops_ellipsoid.hpp"

#include <span>
#include <string>

namespace sardf {

namespace {

constexpr int most_steps = 64;
// Distances from the plane of the medial disc, and from the other coordinate planes, in radii.
constexpr double thin_grades[] = {1e-18, 1e-12, 1e-8, 1e-5, 1e-3, 0.01, 0.03, 0.1,
                                  0.2,   0.4,   0.6,  0.8,  0.95, 1,    1.5,  4};
constexpr double grades[] = {1e-12, 1e-5, 0.01, 0.1, 0.4, 0.8, 1, 4};
// Relative distances from the rim of the medial disc, and directions towards it.
constexpr double rim_grades[] = {-0.1, -0.01, -1e-3, -1e-4, -1e-6, -1e-9, -1e-12, -1e-15, 0,
                                 0.1,  0.01,  1e-3,  1e-4,  1e-6,  1e-9,  1e-12,  1e-15};
constexpr double rim_directions[] = {0, 0.3, 1};
// How far from a computed root its proven bounds are tried, relative to it.
constexpr double slacks[] = {1e-14, 1e-11, 1e-7, 1e-3};

}  // namespace

template <int N>
int EllipsoidDistance<N>::steps_needed(std::array<double, N> y) const {
  std::array<double, N> z;
  y[shortest_] = max(y[shortest_], radii_[shortest_] * 1e-18);
  for (int i = 0; i < N; ++i) z[i] = radii_[i] * y[i];
  // steps_ is 0 here: only the halvings.
  double s = root(z);
  for (int step = 0; step < most_steps; ++step) {
    double g = 0, slope = 0;
    for (int i = 0; i < N; ++i) {
      const double c = z[i] / (s + excess_[i]);
      g += c * c;
      slope += c * c / (s + excess_[i]);
    }
    const double rise = (std::sqrt(g) - 1) * g / slope;
    // The distance is stationary in the root: half of the digits give all of its digits.
    if (!(rise > 1e-9 * s)) return step;
    s += rise;
  }
  return most_steps;
}

// The count depends on the point's direction and depth only through smooth quantities; the slowest
// points lie near the medial disc, where the shortest axis' coordinate vanishes, and there near its
// rim Σ (e_i y_i / excess_i)² = 1. Points graded geometrically towards the coordinate planes and
// towards the rim find the most that these radii need.
template <int N>
void EllipsoidDistance<N>::set(const std::array<double, N>& radii) {
  radii_ = radii;
  double least = infinity, most = 0;
  for (int i = 0; i < N; ++i) {
    if (radii[i] < least) shortest_ = i;
    least = min(least, radii[i]);
    most = max(most, radii[i]);
  }
  if (most > most_ratio * least) {
    throw Error("radii have the ratio " + std::to_string(most / least) +
                "; the distance is proven up to " + std::to_string(int(most_ratio)));
  }
  for (int i = 0; i < N; ++i) excess_[i] = (radii[i] - least) * (radii[i] + least);
  steps_ = 0;
  int steps = 0;
  std::array<double, N> y;
  const auto visit = [&](auto&& self, int axis, std::span<const double> thin,
                         std::span<const double> wide, const auto& use) -> void {
    if (axis == N) return use();
    for (double grade : axis == shortest_ ? thin : wide) {
      y[axis] = grade * radii[axis];
      self(self, axis + 1, thin, wide, use);
    }
  };
  visit(visit, 0, thin_grades, grades, [&] { steps = std::max(steps, steps_needed(y)); });
  visit(visit, 0, {thin_grades, 8}, rim_directions,
        [&] { steps = std::max(steps, steps_needed_near_rim(y)); });
  steps_ = steps + 1;
}

template <int N>
int EllipsoidDistance<N>::steps_needed_near_rim(const std::array<double, N>& direction) const {
  double squares = 0;
  for (int i = 0; i < N; ++i) {
    if (excess_[i] > 0) squares += square(radii_[i] * direction[i] / excess_[i]);
  }
  if (squares == 0) return 0;
  int steps = 0;
  for (double rim : rim_grades) {
    std::array<double, N> y = direction;
    for (int i = 0; i < N; ++i) {
      if (excess_[i] > 0) y[i] *= (1 + rim) / std::sqrt(squares);
    }
    steps = std::max(steps, steps_needed(y));
  }
  return steps;
}

template <int N>
Interval EllipsoidDistance<N>::excess(int i) const {
  const double least = radii_[shortest_];
  return (Interval(radii_[i]) - least) * (Interval(radii_[i]) + least);
}

template <int N>
Interval EllipsoidDistance<N>::sum_of_squares(const std::array<double, N>& y, double s) const {
  Interval sum(0.0);
  for (int i = 0; i < N; ++i) {
    sum = sum + square(Interval(radii_[i]) * y[i] / (Interval(s) + excess(i)));
  }
  return sum;
}

// G falls with s and rises with each y_i, so the root rises with them. That a number lies below it
// or above is proven by G there. Without a proof, 0 is below, and |z| above: G(|z|) <= 1.
template <int N>
Interval EllipsoidDistance<N>::root_between(const std::array<Interval, N>& y) const {
  std::array<double, N> near, far, near_z, far_z;
  Interval squares(0.0);
  for (int i = 0; i < N; ++i) {
    near[i] = y[i].lo;
    far[i] = y[i].hi;
    const double trace = i == shortest_ ? radii_[i] * 1e-18 : 0;
    near_z[i] = radii_[i] * max(near[i], trace);
    far_z[i] = radii_[i] * max(far[i], trace);
    squares = squares + square(Interval(radii_[i]) * far[i]);
  }
  Interval s{0, sqrt(squares).hi};
  const double low = root(near_z), high = root(far_z);
  for (double slack : slacks) {
    if (!(sum_of_squares(near, low * (1 - slack)).lo >= 1)) continue;
    s.lo = low * (1 - slack);
    break;
  }
  for (double slack : slacks) {
    if (!(sum_of_squares(far, high * (1 + slack)).hi <= 1)) continue;
    s.hi = high * (1 + slack);
    break;
  }
  return s;
}

// It is monotone in s.
template <int N>
Interval EllipsoidDistance<N>::quotient(int i, int k, const Interval& s) const {
  if (radii_[i] == radii_[k]) return 1;
  const auto at = [&](double end) -> Interval {
    if (!(end < infinity)) return 1;
    const Interval below = Interval(end) + excess(k);
    // Then k is the shortest axis.
    if (!(below.lo > 0)) return {1, infinity};
    return (Interval(end) + excess(i)) / below;
  };
  return hull(at(s.lo), at(s.hi));
}

// The outer normal is along y_k / (s + excess_k), which times s + excess_i is y_k quotient(i, k).
template <int N>
std::array<Interval, N> EllipsoidDistance<N>::partials(const std::array<Interval, N>& at) const {
  std::array<Interval, N> y, out;
  for (int i = 0; i < N; ++i) y[i] = abs(at[i]);
  const Interval s = root_between(y);
  for (int i = 0; i < N; ++i) {
    // The squares of all components but i.
    Interval others(0.0);
    for (int k = 0; k < N; ++k) {
      if (k != i) others = others + square(y[k] * quotient(i, k, s));
    }
    const auto share = [](double own, double other) {
      const Interval squared = square(Interval(own));
      return sqrt(squared / (squared + other));
    };
    // Where all may be 0 or infinite, nothing is known.
    Interval size{0, 1};
    if (y[i].hi < infinity && others.lo < infinity && !(y[i].hi == 0 && others.lo == 0)) {
      size.hi = min(1.0, share(y[i].hi, others.lo).hi);
    }
    if (y[i].lo > 0 && y[i].lo < infinity && others.hi < infinity) {
      size.lo = max(0.0, share(y[i].lo, others.hi).lo);
    }
    out[i] = at[i].lo >= 0 ? -size : at[i].hi <= 0 ? size : Interval{-size.hi, size.hi};
  }
  return out;
}

template class EllipsoidDistance<2>;
template class EllipsoidDistance<3>;

}  // namespace sardf

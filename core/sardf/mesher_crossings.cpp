// Where the surface crosses the grid edges, and its normals there.
#include <algorithm>
#include <cmath>

#include "sardf/mesher_stages.hpp"

namespace sardf::mesher {

namespace {

// The part of a grid edge that holds the crossing, in [0, 1] from its start.
struct Bracket {
  double lo = 0, hi = 1;
  double at_lo, at_hi;  // values there, scaled by the Illinois rule
  double rise;          // between the ends
  double tangent = -1;  // where the tangent at the last point tried vanishes
  int kept = 0;         // which end stayed last: -1 or 1
};

constexpr int most_steps = 60;

// Relative to the rise along the edge: a value that Newton's method takes to 0 in one step, as the
// field hardly bends within so little of a cell; and one that is 0.
constexpr double near_zero = 1e-4, zero = 1e-6;
constexpr double narrowest = 1e-7;

Bracket start_of(const Edge& edge) {
  constexpr double largest = 1e30;  // an end may be infinite
  Bracket b;
  b.at_lo = std::clamp(double(edge.start), -largest, largest);
  b.at_hi = std::clamp(double(edge.end), -largest, largest);
  if (std::isnan(b.at_lo)) b.at_lo = -std::abs(b.at_hi);
  if (std::isnan(b.at_hi)) b.at_hi = -std::abs(b.at_lo);
  b.rise = std::abs(b.at_hi - b.at_lo);
  // An end on the surface is the crossing.
  if (std::abs(b.at_lo) <= zero * b.rise) b.hi = 0;
  if (std::abs(b.at_hi) <= zero * b.rise) b.lo = b.hi;
  return b;
}

// The next point: where the last one's tangent or the chord vanishes, every third step the middle
// so that no bracket stays wide.
double next_point(const Bracket& b, int step) {
  const double middle = 0.5 * (b.lo + b.hi);
  const double slope = b.at_hi - b.at_lo;
  if (step % 3 == 2 || slope == 0 || b.lo == b.hi) return middle;
  if (b.lo < b.tangent && b.tangent < b.hi) return b.tangent;
  const double t = b.lo - b.at_lo * (b.hi - b.lo) / slope;
  return t > b.lo && t < b.hi ? t : middle;
}

// Takes the value at t into account. `leaves`: the start of the edge is inside.
void narrow(Bracket& b, double t, double value, bool leaves) {
  if ((value >= 0) == leaves) {
    if (b.kept == 1) b.at_hi *= 0.5;
    b.lo = t;
    b.at_lo = std::isnan(value) ? b.at_lo : value;
    b.kept = 1;
  } else {
    if (b.kept == -1) b.at_lo *= 0.5;
    b.hi = t;
    b.at_hi = std::isnan(value) ? b.at_hi : value;
    b.kept = -1;
  }
}

// Takes value and gradient at t into account; whether the crossing is found.
bool take(Bracket& b, double t, double value, double derivative, Crossing& crossing) {
  crossing.at = float(t);
  if (b.lo == b.hi) return true;
  const double step = -value / derivative;
  if (std::abs(value) <= near_zero * b.rise && std::abs(step) <= 2 * near_zero) {
    crossing.at = float(std::clamp(t + step, 0.0, 1.0));
    return true;
  }
  narrow(b, t, value, crossing.leaves);
  b.tangent = t + step;
  return std::abs(value) <= zero * b.rise || b.hi - b.lo <= narrowest;
}

template <class T>
void locate_some(const Field& field, const Grid& grid, const Evaluator& program, const Edge* edges,
                 size_t n, Crossing* crossings) {
  Points<T> points;
  std::array<Bracket, Points<T>::capacity> brackets;
  std::array<double, Points<T>::capacity> tried;
  std::array<uint16_t, Points<T>::capacity> open;
  for (size_t i = 0; i < n; ++i) {
    brackets[i] = start_of(edges[i]);
    open[i] = uint16_t(i);
  }
  size_t count = n;
  for (int step = 0; step < most_steps && count > 0; ++step) {
    for (size_t k = 0; k < count; ++k) {
      const size_t i = open[k];
      tried[k] = next_point(brackets[i], step);
      Vec3 p = grid.point(edges[i].at);
      p[crossings[i].axis] += tried[k] * grid.cell;
      points.set(k, p);
    }
    field.differentiate(program, points, count);
    size_t left = 0;
    for (size_t k = 0; k < count; ++k) {
      const size_t i = open[k];
      const Vec3 gradient = points.gradient_at(k), normal = outward_normal(gradient);
      crossings[i].normal = {float(normal[0]), float(normal[1]), float(normal[2])};
      const double derivative = gradient[crossings[i].axis] * grid.cell;
      if (!take(brackets[i], tried[k], double(points.value[k]), derivative, crossings[i])) {
        open[left++] = uint16_t(i);
      }
    }
    count = left;
  }
}

}  // namespace

void locate(const Field& field, const Grid& grid, const Evaluator& program, const Edge* edges,
            size_t n, Crossing* crossings) {
  const auto method = grid.single ? &locate_some<float> : &locate_some<double>;
  for (size_t first = 0; first < n; first += Evaluator::block_size) {
    const size_t count = std::min(Evaluator::block_size, n - first);
    method(field, grid, program, edges + first, count, crossings + first);
  }
}

}  // namespace sardf::mesher

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
  double best = 0, best_value;
  double tolerance;
  int kept = 0;  // which end stayed last: -1 or 1
};

constexpr int most_steps = 60;

Bracket start_of(const Crossing& crossing) {
  constexpr double largest = 1e30;  // an end may be infinite
  Bracket b;
  b.at_lo = std::clamp(double(crossing.start), -largest, largest);
  b.at_hi = std::clamp(double(crossing.end), -largest, largest);
  if (std::isnan(b.at_lo)) b.at_lo = -std::abs(b.at_hi);
  if (std::isnan(b.at_hi)) b.at_hi = -std::abs(b.at_lo);
  const bool start_is_nearer = std::abs(b.at_lo) <= std::abs(b.at_hi);
  b.best = start_is_nearer ? 0 : 1;
  b.best_value = start_is_nearer ? b.at_lo : b.at_hi;
  b.tolerance = 1e-6 * std::abs(b.at_hi - b.at_lo);
  return b;
}

bool finished(const Bracket& b) {
  return std::abs(b.best_value) <= b.tolerance || b.hi - b.lo <= 1e-7;
}

// The next point: regula falsi, every third step the middle so that no bracket stays wide.
double next_point(const Bracket& b, int step) {
  const double middle = 0.5 * (b.lo + b.hi);
  const double slope = b.at_hi - b.at_lo;
  if (step % 3 == 2 || slope == 0) return middle;
  const double t = b.lo - b.at_lo * (b.hi - b.lo) / slope;
  return t > b.lo && t < b.hi ? t : middle;
}

// Takes the value at t into account. `leaves`: the start of the edge is inside.
void narrow(Bracket& b, double t, double value, bool leaves) {
  if (std::abs(value) < std::abs(b.best_value)) {
    b.best = t;
    b.best_value = value;
  }
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

Vec3 point_on(const Grid& grid, const Crossing& crossing, double t) {
  Vec3 p = grid.point(crossing.at);
  p[crossing.axis] += t * grid.cell;
  return p;
}

template <class T>
void solve(const Field& field, const Grid& grid, const Crossing* crossings, size_t n, Vec3* at,
           Vec3* normals) {
  Points<T> points;
  std::array<Bracket, Points<T>::capacity> brackets;
  std::array<double, Points<T>::capacity> tried;
  std::vector<size_t> open;
  for (size_t i = 0; i < n; ++i) {
    brackets[i] = start_of(crossings[i]);
    if (!finished(brackets[i])) open.push_back(i);
  }
  for (int step = 0; step < most_steps && !open.empty(); ++step) {
    for (size_t k = 0; k < open.size(); ++k) {
      tried[k] = next_point(brackets[open[k]], step);
      points.set(k, point_on(grid, crossings[open[k]], tried[k]));
    }
    field.evaluate(points, open.size());
    for (size_t k = 0; k < open.size(); ++k) {
      const size_t i = open[k];
      narrow(brackets[i], tried[k], double(points.value[k]), crossings[i].leaves);
    }
    std::erase_if(open, [&](size_t i) { return finished(brackets[i]); });
  }
  for (size_t i = 0; i < n; ++i) {
    at[i] = point_on(grid, crossings[i], brackets[i].best);
    points.set(i, at[i]);
  }
  field.differentiate(points, n);
  for (size_t i = 0; i < n; ++i) normals[i] = outward_normal(points.gradient_at(i));
}

}  // namespace

CrossingPoints find_crossings(const Field& field, const Grid& grid,
                              const std::vector<Crossing>& crossings, Work& work) {
  CrossingPoints result;
  result.at.resize(crossings.size());
  result.normal.resize(crossings.size());
  work.run(crossings.size(), Evaluator::block_size, [&](size_t first, size_t last) {
    const auto method = grid.single ? &solve<float> : &solve<double>;
    method(field, grid, &crossings[first], last - first, &result.at[first], &result.normal[first]);
  });
  return result;
}

}  // namespace sardf::mesher

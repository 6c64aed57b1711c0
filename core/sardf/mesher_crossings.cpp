// Where the surface crosses the grid edges, and its normals there.
#include <algorithm>
#include <cmath>

#include "sardf/mesher_stages.hpp"

namespace sardf::mesher {

namespace {

// The part of a grid edge that holds the crossing, in [0, 1] from its start. Without initial
// values: only the few that are needed of an array of them are set.
struct Bracket {
  double lo, hi;
  double at_lo, at_hi;  // values there, scaled by the Illinois rule
  double rise;          // between the ends
  double tangent;       // where the tangent at the last point tried vanishes
  int kept;             // which end stayed last: -1 or 1; 0 at first
};

constexpr int most_steps = 60;

// Relative to the rise along the edge: a value that Newton's method takes to 0 in one step, as the
// field hardly bends within so little of a cell; and one that is 0.
constexpr double near_zero = 1e-4, zero = 1e-6;
constexpr double narrowest = 1e-7;

void start(Bracket& b, const Edge& edge) {
  constexpr double largest = 1e30;  // an end may be infinite
  b.lo = 0;
  b.hi = 1;
  b.tangent = -1;
  b.kept = 0;
  b.at_lo = std::clamp(double(edge.start), -largest, largest);
  b.at_hi = std::clamp(double(edge.end), -largest, largest);
  if (std::isnan(b.at_lo)) b.at_lo = -std::abs(b.at_hi);
  if (std::isnan(b.at_hi)) b.at_hi = -std::abs(b.at_lo);
  b.rise = std::abs(b.at_hi - b.at_lo);
  // An end on the surface is the crossing.
  if (std::abs(b.at_lo) <= zero * b.rise) b.hi = 0;
  if (std::abs(b.at_hi) <= zero * b.rise) b.lo = b.hi;
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

// A point that was tried on an edge.
struct Try {
  double at, value, step;  // the step is Newton's
};

// Whether the tangent tells where the crossing is.
bool is_near(const Try& tried, double rise) {
  return std::abs(tried.value) <= near_zero * rise && std::abs(tried.step) <= 2 * near_zero;
}

// Takes a point into account; whether the crossing is found.
bool take(Bracket& b, const Try& tried, Crossing& crossing) {
  crossing.at = float(tried.at);
  if (b.lo == b.hi) return true;
  if (is_near(tried, b.rise)) {
    crossing.at = float(std::clamp(tried.at + tried.step, 0.0, 1.0));
    return true;
  }
  narrow(b, tried.at, tried.value, crossing.leaves);
  b.tangent = tried.at + tried.step;
  return std::abs(tried.value) <= zero * b.rise || b.hi - b.lo <= narrowest;
}

// Some edges, at points that are tried on them.
template <class T>
class Edges {
 public:
  static constexpr size_t capacity = Points<T>::capacity;

  Edges(const Field& field, const Grid& grid, const Evaluator& program, const Edge* edges,
        Crossing* crossings)
      : field_(field), grid_(grid), program_(program), edges_(edges), crossings_(crossings) {}

  void locate(size_t n) {
    std::array<uint16_t, capacity> open;
    std::array<Bracket, capacity> brackets;
    std::array<double, capacity> at;
    for (size_t i = 0; i < n; ++i) {
      open[i] = uint16_t(i);
      // Where the chord vanishes; an end may be infinite.
      const double start = edges_[i].start, t = start / (start - double(edges_[i].end));
      at[i] = t >= 0 && t <= 1 ? t : 0.5;
    }
    evaluate(open.data(), at.data(), n);
    size_t count = 0;
    for (size_t i = 0; i < n; ++i) {
      const Try tried = tried_at(i, i, at[i]);
      const double rise = std::abs(double(edges_[i].start) - double(edges_[i].end));
      crossings_[i].at = float(std::clamp(tried.at + tried.step, 0.0, 1.0));
      if (rise < infinity && is_near(tried, rise)) continue;
      start(brackets[i], edges_[i]);
      if (brackets[i].lo < brackets[i].hi && take(brackets[i], tried, crossings_[i])) continue;
      open[count++] = uint16_t(i);
    }
    narrow_down(open, brackets, count);
  }

 private:
  void narrow_down(std::array<uint16_t, capacity>& open, std::array<Bracket, capacity>& brackets,
                   size_t count) {
    std::array<double, capacity> at;
    for (int step = 1; step < most_steps && count > 0; ++step) {
      for (size_t k = 0; k < count; ++k) at[k] = next_point(brackets[open[k]], step);
      evaluate(open.data(), at.data(), count);
      size_t left = 0;
      for (size_t k = 0; k < count; ++k) {
        const uint16_t i = open[k];
        if (!take(brackets[i], tried_at(i, k, at[k]), crossings_[i])) open[left++] = i;
      }
      count = left;
    }
  }

  // Values and gradients at points of n edges; the normals there.
  void evaluate(const uint16_t* which, const double* at, size_t n) {
    for (size_t k = 0; k < n; ++k) {
      Vec3 p = grid_.point(edges_[which[k]].at);
      p[crossings_[which[k]].axis] += at[k] * grid_.cell;
      points_.set(k, p);
    }
    field_.differentiate(program_, points_, n);
    inverse_lengths(points_, n, inverse_.data());
    for (size_t k = 0; k < n; ++k) {
      const T inverse = inverse_[k];
      for (size_t axis = 0; axis < 3; ++axis) {
        // Where there is no normal the gradient may be no number.
        const T normal = -inverse * points_.gradient[axis][k];
        crossings_[which[k]].normal[axis] = inverse == 0 ? 0 : float(normal);
      }
    }
  }

  Try tried_at(size_t edge, size_t k, double at) const {
    const double value = double(points_.value[k]);
    const double slope = double(points_.gradient[crossings_[edge].axis][k]) * grid_.cell;
    return {at, value, -value / slope};
  }

  const Field& field_;
  const Grid& grid_;
  const Evaluator& program_;
  const Edge* edges_;
  Crossing* crossings_;
  Points<T> points_;
  std::array<T, capacity> inverse_;  // lengths of gradients
};

template <class T>
void locate_some(const Field& field, const Grid& grid, const Evaluator& program, const Edge* edges,
                 size_t n, Crossing* crossings) {
  Edges<T>(field, grid, program, edges, crossings).locate(n);
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

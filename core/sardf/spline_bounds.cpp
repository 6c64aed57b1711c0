#include "sardf/spline_bounds.hpp"

#include <cmath>

namespace sardf {

namespace {

constexpr int block_side = 8;
constexpr size_t most_scanned = 4096, most_cells = 27;
// Twice what the weights' recursion, their products and the sums can lose, in ulps of the largest
// coefficient: 5 steps of 5 roundings along each of 3 axes, 3 products, 18 additions.
constexpr double rounding_ulps = 128;

const Interval nothing{infinity, -infinity};

template <class Visit>
void for_indices(const std::array<int, 3>& first, const std::array<int, 3>& last, Visit visit) {
  for (int x = first[0]; x <= last[0]; ++x) {
    for (int y = first[1]; y <= last[1]; ++y) {
      for (int z = first[2]; z <= last[2]; ++z) visit(std::array<int, 3>{x, y, z});
    }
  }
}

size_t number_of(const std::array<int, 3>& first, const std::array<int, 3>& last) {
  size_t n = 1;
  for (size_t k = 0; k < 3; ++k) n *= size_t(last[k] - first[k] + 1);
  return n;
}

// to[a][m][b] = Σ_j rows[m][j] from[a][j][b], for n of both m and j.
void transform(const double rows[][most_spline_weights], int n, const double* from, double* to,
               int before, int after) {
  for (int a = 0; a < before; ++a) {
    for (int m = 0; m < n; ++m) {
      for (int b = 0; b < after; ++b) {
        double sum = 0;
        for (int j = 0; j < n; ++j) sum += rows[m][j] * from[(a * n + j) * after + b];
        to[(a * n + m) * after + b] = sum;
      }
    }
  }
}

// Row m: the weights of Bernstein control point m of the part [t.lo, t.hi] of a span: the polar
// form at m times t.hi and otherwise t.lo. They are convex, as both lie in the span.
void bernstein_rows(int degree, Interval t, double rows[][most_spline_weights]) {
  for (int m = 0; m <= degree; ++m) {
    double at[most_spline_degree];
    for (int r = 0; r < degree; ++r) at[r] = r < m ? t.hi : t.lo;
    spline_weights(degree, at, 1, rows[m]);
  }
}

}  // namespace

SplineBounds::SplineBounds(const SplineGrid& grid, const std::vector<double>& coefficients)
    : grid_(grid), coefficients_(coefficients) {
  if (coefficients_.size() <= most_scanned) return;
  Index end = blocks();
  for (int& n : end) --n;
  for (int derived = 0; derived <= none; ++derived) {
    std::vector<Interval>& ranges = ranges_[size_t(derived)];
    for_indices({0, 0, 0}, end, [&](const Index& block) {
      Index first, last;
      for (size_t k = 0; k < 3; ++k) {
        first[k] = block[k] * block_side;
        const int past = grid_.counts[k] - (int(k) == derived ? 1 : 0);
        last[k] = std::min(first[k] + block_side, past) - 1;
      }
      ranges.push_back(scanned(first, last, derived));
    });
  }
}

SplineBounds::Index SplineBounds::blocks() const {
  Index n;
  for (size_t k = 0; k < 3; ++k) n[k] = (grid_.counts[k] + block_side - 1) / block_side;
  return n;
}

Interval SplineBounds::scanned(const Index& first, const Index& last, int derived) const {
  Interval range = nothing;
  Index step{};
  if (derived != none) step[size_t(derived)] = 1;
  for_indices(first, last, [&](const Index& i) {
    double value = coefficients_[grid_.index(i[0], i[1], i[2])];
    if (derived != none) {
      value = coefficients_[grid_.index(i[0] + step[0], i[1] + step[1], i[2] + step[2])] - value;
    }
    range = hull(range, value);
  });
  return range;
}

Interval SplineBounds::of_coefficients(const Index& first, const Index& last, int derived) const {
  if (number_of(first, last) <= most_scanned) return scanned(first, last, derived);
  Index from, to;
  for (size_t k = 0; k < 3; ++k) {
    from[k] = first[k] / block_side;
    to[k] = last[k] / block_side;
  }
  Interval range = nothing;
  const Index n = blocks();
  for_indices(from, to, [&](const Index& b) {
    const size_t place = (size_t(b[0]) * size_t(n[1]) + size_t(b[1])) * size_t(n[2]) + size_t(b[2]);
    range = hull(range, ranges_[size_t(derived)][place]);
  });
  return range;
}

Interval SplineBounds::in_cell(const Index& span, const std::array<Interval, 3>& t,
                               int derived) const {
  double control[2][most_spline_weights * most_spline_weights * most_spline_weights];
  Index degrees = grid_.degrees, last, step{};
  if (derived != none) {
    --degrees[size_t(derived)];
    step[size_t(derived)] = 1;
  }
  for (size_t k = 0; k < 3; ++k) last[k] = span[k] + degrees[k];
  size_t n = 0;
  double magnitude = 0;
  for_indices(span, last, [&](const Index& i) {
    const double a = coefficients_[grid_.index(i[0], i[1], i[2])];
    const double b = coefficients_[grid_.index(i[0] + step[0], i[1] + step[1], i[2] + step[2])];
    control[0][n++] = derived == none ? a : b - a;
    magnitude = max(magnitude, max(std::abs(a), std::abs(b)));
  });
  int before = 1, after = int(n), now = 0;
  for (size_t k = 0; k < 3; ++k) {
    double rows[most_spline_weights][most_spline_weights];
    const int weights = degrees[k] + 1;
    after /= weights;
    bernstein_rows(degrees[k], t[k], rows);
    transform(rows, weights, control[now], control[1 - now], before, after);
    before *= weights;
    now = 1 - now;
  }
  Interval range = nothing;
  for (size_t i = 0; i < n; ++i) range = hull(range, control[now][i]);
  return widened(range, magnitude, derived);
}

Interval SplineBounds::widened(Interval found, double magnitude, int derived) const {
  double error = rounding_ulps * 0x1p-52 * magnitude;
  if (derived != none) {
    const double scale = grid_.per_length(derived);
    found = {rounded_down(found.lo * scale, 2), rounded_up(found.hi * scale, 2)};
    error *= 2 * scale;
  }
  return {rounded_down(found.lo - error), rounded_up(found.hi + error)};
}

Interval SplineBounds::over(const std::array<Interval, 3>& box, int derived) const {
  std::array<SplinePlace, 3> from, to;
  Index first, last, end;
  for (int k = 0; k < 3; ++k) {
    from[k] = grid_.place(k, box[k].lo);
    to[k] = grid_.place(k, box[k].hi);
    first[k] = from[k].span;
    last[k] = to[k].span;
    end[k] = last[k] + grid_.degrees[k] - (k == derived ? 1 : 0);
  }
  if (number_of(first, last) > most_cells) {
    const Interval range = of_coefficients(first, end, derived);
    // Differences are rounded, too; their size does not bound that of what they come from.
    const double magnitude = of_coefficients(first, end, none).magnitude();
    return widened(range, derived == none ? magnitude : magnitude + range.magnitude(), derived);
  }
  Interval range = nothing;
  for_indices(first, last, [&](const Index& span) {
    std::array<Interval, 3> t;
    for (size_t k = 0; k < 3; ++k) {
      t[k] = {span[k] == first[k] ? from[k].t : 0, span[k] == last[k] ? to[k].t : 1};
    }
    range = hull(range, in_cell(span, t, derived));
  });
  return range;
}

}  // namespace sardf

#include "sardf/fit_band.hpp"

#include <algorithm>
#include <cmath>

namespace sardf {

namespace {

// Enough for the sum of a singular matrix and this to be safely positive.
constexpr double ridge = 1e-10;
constexpr double most_operations = 3e9, most_entries = 3e7;

size_t width_of(const SplineGrid& grid) {
  return grid.index(grid.degrees[0], grid.degrees[1], grid.degrees[2]);
}

}  // namespace

bool BandFactors::are_cheap(const SplineGrid& grid) {
  const double n = double(grid.size()), width = double(width_of(grid));
  return n * width * width <= most_operations && n * width <= most_entries;
}

BandFactors::BandFactors(const FitSystem& system, const SplineGrid& grid,
                         const std::vector<double>& scale, const Progress& pulse)
    : n_(grid.size()), width_(width_of(grid)), entries_(n_ * (width_ + 1)) {
  system.for_entries(pulse, [&](size_t i, size_t j, double value) {
    row(i)[width_ - (i - j)] += value * scale[i] * scale[j];
  });
  for (size_t i = 0; i < n_; ++i) row(i)[width_] = scale[i] > 0 ? row(i)[width_] + ridge : 1;
  factor(pulse);
}

void BandFactors::factor(const Progress& pulse) {
  for (size_t i = 0; i < n_; ++i) {
    double* const at = row(i);
    const size_t first = i > width_ ? i - width_ : 0;
    for (size_t j = first; j <= i; ++j) {
      const double* const other = row(j);
      const size_t from = std::max(first, j > width_ ? j - width_ : 0);
      const double *a = at + (from + width_ - i), *b = other + (from + width_ - j);
      // Four sums at a time, which the compiler may keep in one register.
      double sums[4] = {};
      const size_t count = j - from;
      size_t k = 0;
      for (; k + 4 <= count; k += 4) {
        for (size_t lane = 0; lane < 4; ++lane) sums[lane] += a[k + lane] * b[k + lane];
      }
      for (; k < count; ++k) sums[0] += a[k] * b[k];
      const double left = at[j + width_ - i] - (sums[0] + sums[1] + sums[2] + sums[3]);
      at[j + width_ - i] = j < i ? left / other[width_] : std::sqrt(std::max(left, 0.1 * ridge));
    }
    if (pulse && i % 16 == 0 && !pulse(0)) throw Cancelled();
  }
}

void BandFactors::solve(std::vector<double>& x) const {
  for (size_t i = 0; i < n_; ++i) {
    const size_t first = i > width_ ? i - width_ : 0;
    const double* const at = row(i);
    double sum = x[i];
    for (size_t j = first; j < i; ++j) sum -= at[j + width_ - i] * x[j];
    x[i] = sum / at[width_];
  }
  for (size_t i = n_; i-- > 0;) {
    const size_t first = i > width_ ? i - width_ : 0;
    const double* const at = row(i);
    x[i] /= at[width_];
    for (size_t j = first; j < i; ++j) x[j] -= at[j + width_ - i] * x[i];
  }
}

}  // namespace sardf

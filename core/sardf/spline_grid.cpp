#include "sardf/spline_grid.hpp"

#include <cmath>
#include <cstdio>

#include "sardf/error.hpp"
#include "sardf/short_number.hpp"

namespace sardf {

namespace {

constexpr double most_bytes = 0x1p31;

int whole_degree(double degree) {
  if (degree >= 1 && degree <= most_spline_degree && degree == std::floor(degree)) {
    return int(degree);
  }
  throw Error("the degree is " + short_number(degree, 6) + "; a whole number from 1 to " +
              std::to_string(most_spline_degree) + " is accepted");
}

void check_count(double count, int degree) {
  if (count > degree && count == std::floor(count)) return;
  throw Error("a number of splines is " + short_number(count, 6) + "; whole numbers from " +
              std::to_string(degree + 1) + " (the degree and one) are accepted");
}

void check_size(const std::vector<double>& counts) {
  double size = 1;
  std::string text;
  for (const double count : counts) {
    size *= count;
    text += (text.empty() ? "" : " x ") + short_number(count, 6);
  }
  if (8 * size <= most_bytes) return;
  throw Error(text + " splines need " + memory_text(8 * size) +
              " for their coefficients alone; up to " + memory_text(most_bytes) + " are accepted");
}

}  // namespace

std::string memory_text(double bytes) {
  char text[40];
  if (bytes >= 0x1p30) {
    std::snprintf(text, sizeof text, "%.3g GiB", bytes / 0x1p30);
  } else {
    std::snprintf(text, sizeof text, "%.3g MiB", bytes / 0x1p20);
  }
  return text;
}

std::array<int, 3> SplineGrid::cell(size_t number) const {
  const size_t z = size_t(spans(2)), y = size_t(spans(1));
  return {int(number / z / y), int(number / z % y), int(number % z)};
}

size_t SplineGrid::cell_number(const std::array<int, 3>& at) const {
  return (size_t(at[0]) * size_t(spans(1)) + size_t(at[1])) * size_t(spans(2)) + size_t(at[2]);
}

SplineGrid spline_grid(const Vec3& lower, const Vec3& upper, const std::vector<double>& counts,
                       double degree) {
  SplineGrid grid;
  const int whole = whole_degree(degree);
  if (counts.size() != 2 && counts.size() != 3) {
    throw Error("there are " + std::to_string(counts.size()) +
                " numbers of splines; 2 (for functions of x and y) or 3 are accepted");
  }
  for (const double count : counts) check_count(count, whole);
  check_size(counts);
  grid.dimensions = int(counts.size());
  for (size_t axis = 0; axis < counts.size(); ++axis) {
    if (!(lower[axis] < upper[axis]) || !std::isfinite(upper[axis] - lower[axis])) {
      throw Error("along " + std::string(1, char('x' + axis)) + " lower is " +
                  short_number(lower[axis], 6) + " and upper " + short_number(upper[axis], 6) +
                  "; finite numbers, lower below upper, are accepted");
    }
    grid.lower[axis] = lower[axis];
    grid.upper[axis] = upper[axis];
    grid.counts[axis] = int(counts[axis]);
    grid.degrees[axis] = whole;
    if (!std::isfinite(grid.per_length(int(axis)))) {
      throw Error("along " + std::string(1, char('x' + axis)) + " upper - lower is only " +
                  short_number(upper[axis] - lower[axis], 6));
    }
  }
  return grid;
}

}  // namespace sardf

#include "sardf/operation_of.hpp"

namespace sardf {

// An operation without a formula evaluates in double and rounds the result.
Enclosure Operation::range(const Enclosure* in) const {
  std::array<Interval, max_arity> values;
  bool is_known = is_distance();
  for (int k = 0; k < info().arity; ++k) {
    values[k] = in[k].value;
    is_known = is_known && !in[k].may_be_nan && in[k].value.magnitude() < infinity;
  }
  const Choice result = Choice::rounded(interval(values.data()), !is_known);
  return {result.range, result.may_be_nan};
}

Fate Operation::fate(const Enclosure*, const Demand&) const { return {}; }

namespace {

Interval product_of_lengths(const Slope& a, const Slope& b) {
  const Interval most = Interval(a.length) * Interval(b.length);
  return {-most.hi, most.hi};
}

// From the scalar products of the partials' columns.
double bound_by_columns(std::span<const Slope> rows) {
  double most = 0;
  for (int i = 0; i < 3; ++i) {
    double row_sum = 0;
    for (int j = 0; j < 3; ++j) {
      Interval product = 0;
      for (const Slope& row : rows) {
        product = product + (i == j ? square(row.partial[i]) : row.partial[i] * row.partial[j]);
      }
      row_sum = rounded_up(row_sum + product.magnitude());
    }
    most = max(most, row_sum);
  }
  return most;
}

// From the scalar products of the gradients, whose lengths may be known better than their
// directions: of the inputs of an extrusion, which are perpendicular, the longer one counts.
double bound_by_rows(std::span<const Slope> rows) {
  double most = 0;
  for (const Slope& row : rows) {
    double row_sum = 0;
    for (const Slope& other : rows) {
      const double product =
          &row == &other ? product_of_lengths(row, row).hi : scalar_product(row, other).magnitude();
      row_sum = rounded_up(row_sum + product);
    }
    most = max(most, row_sum);
  }
  return most;
}

}  // namespace

Interval scalar_product(const Slope& a, const Slope& b) {
  Interval product = 0;
  for (int axis = 0; axis < 3; ++axis) product = product + a.partial[axis] * b.partial[axis];
  return intersect(product, product_of_lengths(a, b));
}

double weighted_length(std::span<const Interval> by, std::span<const Slope> in) {
  double squared = 0;
  for (size_t k = 0; k < in.size(); ++k) {
    if (in[k].length == 0) continue;  // however large the partial
    const Interval own = Interval(by[k].magnitude()) * Interval(in[k].length);
    squared = rounded_up(squared + square(own).hi);
    for (size_t j = 0; j < k; ++j) {
      if (in[j].length == 0) continue;
      const Interval both = by[j] * by[k] * scalar_product(in[j], in[k]);
      squared = rounded_up(squared + max(0.0, 2 * both.hi));
    }
  }
  return rounded_up(std::sqrt(squared));
}

double spectral_bound(std::span<const Slope> rows) {
  return rounded_up(std::sqrt(min(bound_by_columns(rows), bound_by_rows(rows))));
}

}  // namespace sardf

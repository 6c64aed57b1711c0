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

double spectral_bound(std::span<const Slope> rows) {
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
  return rounded_up(std::sqrt(most));
}

}  // namespace sardf

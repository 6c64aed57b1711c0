#include "sardf/operation_of.hpp"

namespace sardf {

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

// What a system knows beside its matrix: right-hand side, diagonal, mean, springs.
#include <algorithm>

#include "sardf/fit_system.hpp"

namespace sardf {

void FitSystem::collect(const Progress& pulse) {
  right_.assign(grid_.size(), 0.0);
  diagonal_.assign(grid_.size(), 0.0);
  mean_row_.assign(grid_.size(), 0.0);
  const size_t m = kernel_.weights();
  double volume = 0;
  mean_of_start_ = 0;
  for (size_t i = 0; i < points(); ++i) {
    volume += weight_[i];
    mean_of_start_ += weight_[i] * start_[i];
  }
  mean_of_start_ /= volume;
  for_cells(pulse, [&](size_t cell) {
    std::vector<double> local(3 * m);
    double *const right = local.data(), *const diagonal = right + m, *const mean = diagonal + m;
    if (is_full(cell)) {
      collect_full(place_[cell], right, diagonal, mean);
    } else {
      collect_cut(cell, right, diagonal, mean);
    }
    scatter(cell, right, right_);
    scatter(cell, diagonal, diagonal_);
    scatter(cell, mean, mean_row_);
  });
  for (double& a : mean_row_) a /= volume;
}

void FitSystem::collect_full(size_t number, double* right, double* diagonal, double* mean) const {
  const size_t n = kernel_.points(), begin = number * n;
  const double* const m = &rule_[number * stored * n];
  std::vector<double> by(n);
  kernel_.backward(m + 10 * n, right);
  size_t entry = 0;
  for (int a = 0; a < 4; ++a) {
    for (int b = a; b < 4; ++b, ++entry) {
      // No function changes along z in two dimensions.
      if (b > grid_.dimensions) continue;
      for (size_t q = 0; q < n; ++q) by[q] = (a == b ? 1 : 2) * m[entry * n + q];
      kernel_.add_squares(a, b, by.data(), diagonal);
    }
  }
  for (size_t q = 0; q < n; ++q) by[q] = weight_[begin + q] * factor_[begin + q];
  kernel_.values_backward(by.data(), mean);
  if (springs_.empty()) return;
  kernel_.add_squares(0, 0, &springs_[begin], diagonal);
  kernel_.values_backward(&pulls_[begin], right);
}

void FitSystem::collect_cut(size_t cell, double* right, double* diagonal, double* mean) const {
  const size_t m = kernel_.weights(), i = cut_number(cell), begin = first_point(cell);
  const std::vector<double>& matrices = spring_matrix_.empty() ? matrix_ : spring_matrix_;
  std::copy_n(&linear_[i * m], m, right);
  for (size_t j = 0; j < m; ++j) diagonal[j] = matrices[i * m * m + j * m + j];
  std::vector<double> weights(m);
  for (size_t p = 0; p < points_of(cell); ++p) {
    weights_at(quadrature_.at[quadrature_.first[i] + p], weights.data(), nullptr);
    const double by = weight_[begin + p] * factor_[begin + p];
    const double pull = pulls_.empty() ? 0 : pulls_[begin + p];
    for (size_t j = 0; j < m; ++j) {
      mean[j] += by * weights[j];
      right[j] += pull * weights[j];
    }
  }
}

void FitSystem::add_springs_to_cut(size_t cell) {
  const size_t m = kernel_.weights(), i = cut_number(cell), begin = first_point(cell);
  double* const matrix = &spring_matrix_[i * m * m];
  std::vector<double> weights(m);
  for (size_t p = 0; p < points_of(cell); ++p) {
    const double spring = springs_[begin + p];
    if (spring == 0) continue;
    weights_at(quadrature_.at[quadrature_.first[i] + p], weights.data(), nullptr);
    for (size_t a = 0; a < m; ++a) {
      for (size_t b = 0; b < m; ++b) matrix[a * m + b] += spring * weights[a] * weights[b];
    }
  }
}

void FitSystem::set_springs(const std::vector<double>& stiffness, const std::vector<double>& target,
                            const Progress& pulse) {
  springs_.resize(points());
  pulls_.resize(points());
  for (size_t i = 0; i < points(); ++i) {
    springs_[i] = stiffness[i] * factor_[i] * factor_[i];
    pulls_[i] = stiffness[i] * factor_[i] * (target[i] - start_[i]);
  }
  spring_matrix_ = matrix_;
  for_cells(pulse, [&](size_t cell) {
    if (!is_full(cell)) add_springs_to_cut(cell);
  });
  collect(pulse);
}

}  // namespace sardf

#include "sardf/fit_system.hpp"

#include <algorithm>
#include <numeric>

#include "sardf/work.hpp"

namespace sardf {

namespace {

constexpr size_t block = Evaluator::block_size;

// Room for the local coefficients of a cell, and for fields at its points.
double* room(size_t n) {
  thread_local Scratch<double> storage;
  return storage.get(n);
}

Vec3 cell_corner(const SplineGrid& grid, size_t cell, Vec3& side) {
  const std::array<int, 3> at = grid.cell(cell);
  Vec3 corner{};
  for (size_t k = 0; k < size_t(grid.dimensions); ++k) {
    side[k] = (grid.upper[k] - grid.lower[k]) / grid.spans(int(k));
    corner[k] = grid.lower[k] + at[k] * side[k];
  }
  return corner;
}

}  // namespace

FitSystem::FitSystem(const FitProblem& problem, const Quadrature& quadrature,
                     const Progress& progress)
    : grid_(problem.grid),
      quadrature_(quadrature),
      kernel_(grid_, quadrature.points),
      place_(grid_.cells(), no_place) {
  const size_t full = quadrature.full.size(), cut = quadrature.cut.size();
  for (size_t i = 0; i < full; ++i) place_[quadrature.full[i]] = i;
  for (size_t i = 0; i < cut; ++i) place_[quadrature.cut[i]] = full + i;
  const size_t m = kernel_.weights(), points = quadrature.size(grid_);
  rule_.resize(full * stored * kernel_.points());
  matrix_.resize(cut * m * m);
  linear_.resize(cut * m);
  start_.resize(points);
  factor_.resize(points);
  weight_.resize(points);
  const FitFields fields(problem);
  std::vector<double> constants(full + cut);
  Work work(progress);
  work.stage(1);
  work.run(full + cut, 4, [&](size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) {
      if (i < full) {
        evaluate_full(fields, i, constants[i]);
      } else {
        evaluate_cut(fields, i - full, constants[i]);
      }
    }
  });
  constant_ = std::accumulate(constants.begin(), constants.end(), 0.0);
  collect(progress);
}

size_t FitSystem::first_point(size_t cell) const {
  if (is_full(cell)) return place_[cell] * kernel_.points();
  return quadrature_.full.size() * kernel_.points() + quadrature_.first[cut_number(cell)];
}

size_t FitSystem::points_of(size_t cell) const {
  if (is_full(cell)) return kernel_.points();
  const size_t i = cut_number(cell);
  return quadrature_.first[i + 1] - quadrature_.first[i];
}

Vec3 FitSystem::point(size_t i) const {
  const size_t in_rule = quadrature_.full.size() * kernel_.points();
  if (i >= in_rule) return quadrature_.at[i - in_rule];
  const GaussRule rule = gauss_rule(quadrature_.points);
  const size_t n = rule.at.size(), q = i % kernel_.points(), deep = grid_.dimensions == 3 ? n : 1;
  Vec3 side{}, at = cell_corner(grid_, quadrature_.full[i / kernel_.points()], side);
  const size_t places[3] = {q / deep / n, q / deep % n, q % deep};
  for (size_t k = 0; k < size_t(grid_.dimensions); ++k) at[k] += rule.at[places[k]] * side[k];
  return at;
}

void FitSystem::evaluate_full(const FitFields& fields, size_t number, double& constant) {
  const size_t n = kernel_.points(), begin = number * n;
  const GaussRule rule = gauss_rule(quadrature_.points);
  const size_t along = rule.at.size(), deep = grid_.dimensions == 3 ? along : 1;
  Vec3 side{};
  const Vec3 corner = cell_corner(grid_, quadrature_.full[number], side);
  double volume = 1;
  for (size_t k = 0; k < size_t(grid_.dimensions); ++k) volume *= side[k];
  double* const to = &rule_[number * stored * n];
  Vec3 at[block];
  FitFields::Density density[block];
  for (size_t from = 0; from < n; from += block) {
    const size_t count = std::min(block, n - from);
    for (size_t i = 0; i < count; ++i) {
      const size_t q = from + i, places[3] = {q / deep / along, q / deep % along, q % deep};
      at[i] = corner;
      weight_[begin + q] = volume;
      for (size_t k = 0; k < size_t(grid_.dimensions); ++k) {
        at[i][k] += rule.at[places[k]] * side[k];
        weight_[begin + q] *= rule.weight[places[k]];
      }
    }
    fields.at(at, count, density);
    for (size_t i = 0; i < count; ++i) {
      const size_t q = from + i;
      const double w = weight_[begin + q];
      for (size_t e = 0; e < 10; ++e) to[e * n + q] = w * density[i].quadratic[e];
      for (size_t e = 0; e < 4; ++e) to[(10 + e) * n + q] = w * density[i].linear[e];
      constant += w * density[i].constant;
      start_[begin + q] = density[i].start;
      factor_[begin + q] = density[i].factor;
    }
  }
}

void FitSystem::weights_at(const Vec3& point, double* weights, double* slopes) const {
  double value[3][most_spline_weights], slope[3][most_spline_weights];
  for (int k = 0; k < 3; ++k) {
    const SplinePlace place = grid_.place(k, point[size_t(k)]);
    spline_weights_and_slopes(grid_.degrees[size_t(k)], place.t, value[k], slope[k]);
    for (double& s : slope[k]) s *= grid_.per_length(k);
  }
  const size_t m = kernel_.weights();
  size_t i = 0;
  for (int a = 0; a <= grid_.degrees[0]; ++a) {
    for (int b = 0; b <= grid_.degrees[1]; ++b) {
      for (int c = 0; c <= grid_.degrees[2]; ++c, ++i) {
        weights[i] = value[0][a] * value[1][b] * value[2][c];
        if (!slopes) continue;
        slopes[i] = slope[0][a] * value[1][b] * value[2][c];
        slopes[m + i] = value[0][a] * slope[1][b] * value[2][c];
        slopes[2 * m + i] = value[0][a] * value[1][b] * slope[2][c];
      }
    }
  }
}

// The lower triangle only; evaluate_cut mirrors it.
void FitSystem::add_point(const Vec3& at, const FitFields::Density& density, double weight,
                          size_t cut) {
  static constexpr size_t entry[4][4] = {{0, 1, 2, 3}, {1, 4, 5, 6}, {2, 5, 7, 8}, {3, 6, 8, 9}};
  const size_t m = kernel_.weights();
  double* const rows = room(8 * m);
  double* const times = rows + 4 * m;
  weights_at(at, rows, rows + m);
  std::fill_n(times, 4 * m, 0.0);
  const int fields = grid_.dimensions + 1;
  for (int a = 0; a < fields; ++a) {
    for (int b = 0; b < fields; ++b) {
      const double by = weight * density.quadratic[entry[a][b]];
      if (by == 0) continue;
      for (size_t j = 0; j < m; ++j) times[size_t(a) * m + j] += by * rows[size_t(b) * m + j];
    }
  }
  double* const matrix = &matrix_[cut * m * m];
  double* const linear = &linear_[cut * m];
  for (int a = 0; a < fields; ++a) {
    const double* const row = rows + size_t(a) * m;
    const double* const by = times + size_t(a) * m;
    for (size_t i = 0; i < m; ++i) {
      if (row[i] == 0) continue;
      linear[i] += weight * density.linear[a] * row[i];
      for (size_t j = 0; j <= i; ++j) matrix[i * m + j] += row[i] * by[j];
    }
  }
}

void FitSystem::evaluate_cut(const FitFields& fields, size_t number, double& constant) {
  const size_t cell = quadrature_.cut[number], begin = first_point(cell), n = points_of(cell);
  const size_t first = quadrature_.first[number], m = kernel_.weights();
  FitFields::Density density[block];
  for (size_t from = 0; from < n; from += block) {
    const size_t count = std::min(block, n - from);
    fields.at(&quadrature_.at[first + from], count, density);
    for (size_t i = 0; i < count; ++i) {
      const double w = quadrature_.weight[first + from + i];
      add_point(quadrature_.at[first + from + i], density[i], w, number);
      constant += w * density[i].constant;
      weight_[begin + from + i] = w;
      start_[begin + from + i] = density[i].start;
      factor_[begin + from + i] = density[i].factor;
    }
  }
  double* const matrix = &matrix_[number * m * m];
  for (size_t i = 0; i < m; ++i) {
    for (size_t j = 0; j < i; ++j) matrix[j * m + i] = matrix[i * m + j];
  }
}

// Lines of cells along the last axis whose functions have no index in common on the other axes are
// done together: for each of (degree + 1)² (or degree + 1) colours one after the other.
void FitSystem::for_cells(const Progress& pulse, const std::function<void(size_t)>& visit) const {
  const bool deep = grid_.dimensions == 3;
  const int step_x = grid_.degrees[0] + 1, step_y = deep ? grid_.degrees[1] + 1 : 1;
  const size_t lines_y = deep ? size_t(grid_.spans(1)) : 1;
  const size_t length = grid_.cells() / size_t(grid_.spans(0)) / lines_y;
  Work work(pulse);
  for (int colour = 0; colour < step_x * step_y; ++colour) {
    std::vector<size_t> lines;
    for (size_t x = size_t(colour / step_y); x < size_t(grid_.spans(0)); x += size_t(step_x)) {
      for (size_t y = size_t(colour % step_y); y < lines_y; y += size_t(step_y)) {
        lines.push_back(x * lines_y + y);
      }
    }
    if (lines.empty()) continue;
    work.run(lines.size(), 1, [&](size_t i, size_t) {
      for (size_t cell = lines[i] * length; cell < (lines[i] + 1) * length; ++cell) {
        if (place_[cell] != no_place) visit(cell);
      }
    });
  }
}

std::vector<size_t> FitSystem::functions(size_t cell) const {
  const std::array<int, 3> at = grid_.cell(cell);
  std::vector<size_t> all;
  all.reserve(kernel_.weights());
  for (int a = 0; a <= grid_.degrees[0]; ++a) {
    for (int b = 0; b <= grid_.degrees[1]; ++b) {
      for (int c = 0; c <= grid_.degrees[2]; ++c) {
        all.push_back(grid_.index(at[0] + a, at[1] + b, at[2] + c));
      }
    }
  }
  return all;
}

void FitSystem::gather(size_t cell, const std::vector<double>& c, double* local) const {
  const std::array<int, 3> at = grid_.cell(cell);
  const int along = grid_.degrees[2] + 1;
  for (int a = 0; a <= grid_.degrees[0]; ++a) {
    for (int b = 0; b <= grid_.degrees[1]; ++b, local += along) {
      std::copy_n(&c[grid_.index(at[0] + a, at[1] + b, at[2])], along, local);
    }
  }
}

void FitSystem::scatter(size_t cell, const double* local, std::vector<double>& c) const {
  const std::array<int, 3> at = grid_.cell(cell);
  for (int a = 0; a <= grid_.degrees[0]; ++a) {
    for (int b = 0; b <= grid_.degrees[1]; ++b) {
      double* const to = &c[grid_.index(at[0] + a, at[1] + b, at[2])];
      for (int k = 0; k <= grid_.degrees[2]; ++k) to[k] += *local++;
    }
  }
}

void FitSystem::apply_full(size_t number, const double* local, double* out) const {
  const size_t n = kernel_.points();
  thread_local std::vector<double> fields, results;
  fields.resize(4 * n);
  results.resize(4 * n);
  kernel_.forward(local, fields.data());
  const double* const m = &rule_[number * stored * n];
  const double* const spring = springs_.empty() ? nullptr : &springs_[number * n];
  const double *a = fields.data(), *b = a + n, *c = b + n, *d = c + n;
  double *ra = results.data(), *rb = ra + n, *rc = rb + n, *rd = rc + n;
  for (size_t q = 0; q < n; ++q) {
    ra[q] = m[q] * a[q] + m[n + q] * b[q] + m[2 * n + q] * c[q] + m[3 * n + q] * d[q];
    rb[q] = m[n + q] * a[q] + m[4 * n + q] * b[q] + m[5 * n + q] * c[q] + m[6 * n + q] * d[q];
    rc[q] = m[2 * n + q] * a[q] + m[5 * n + q] * b[q] + m[7 * n + q] * c[q] + m[8 * n + q] * d[q];
    rd[q] = m[3 * n + q] * a[q] + m[6 * n + q] * b[q] + m[8 * n + q] * c[q] + m[9 * n + q] * d[q];
  }
  for (size_t q = 0; spring && q < n; ++q) ra[q] += spring[q] * a[q];
  kernel_.backward(results.data(), out);
}

void FitSystem::apply(const std::vector<double>& c, std::vector<double>& out,
                      const Progress& pulse) const {
  out.assign(size(), 0.0);
  const size_t m = kernel_.weights();
  const std::vector<double>& matrices = spring_matrix_.empty() ? matrix_ : spring_matrix_;
  for_cells(pulse, [&](size_t cell) {
    double* const local = room(2 * m);
    double* const result = local + m;
    gather(cell, c, local);
    std::fill_n(result, m, 0.0);
    if (is_full(cell)) {
      apply_full(place_[cell], local, result);
    } else {
      const double* const matrix = &matrices[cut_number(cell) * m * m];
      // By columns, which are rows: the matrix is symmetric.
      for (size_t j = 0; j < m; ++j) {
        for (size_t i = 0; i < m; ++i) result[i] += matrix[j * m + i] * local[j];
      }
    }
    scatter(cell, result, out);
  });
}

void FitSystem::values_of_cell(size_t cell, const double* local, double* out) const {
  if (is_full(cell)) return kernel_.values(local, out);
  const size_t first = quadrature_.first[cut_number(cell)], m = kernel_.weights();
  thread_local std::vector<double> weights;
  weights.resize(m);
  for (size_t i = 0; i < points_of(cell); ++i) {
    weights_at(quadrature_.at[first + i], weights.data(), nullptr);
    out[i] = std::inner_product(weights.begin(), weights.end(), local, 0.0);
  }
}

std::vector<double> FitSystem::values(const std::vector<double>& c, const Progress& pulse) const {
  std::vector<double> all(points());
  for_cells(pulse, [&](size_t cell) {
    double* const local = room(kernel_.weights());
    gather(cell, c, local);
    const size_t first = first_point(cell);
    values_of_cell(cell, local, &all[first]);
    for (size_t i = first; i < first + points_of(cell); ++i) {
      all[i] = start_[i] + factor_[i] * all[i];
    }
  });
  return all;
}

const double* FitSystem::local_matrix(size_t cell, std::vector<double>& buffer) const {
  const size_t m = kernel_.weights();
  if (!is_full(cell)) {
    return &(spring_matrix_.empty() ? matrix_ : spring_matrix_)[cut_number(cell) * m * m];
  }
  // Column by column.
  buffer.assign(m * m, 0.0);
  std::vector<double> unit(m);
  for (size_t j = 0; j < m; ++j) {
    unit[j] = 1;
    apply_full(place_[cell], unit.data(), &buffer[j * m]);
    unit[j] = 0;
  }
  return buffer.data();
}

double FitSystem::memory(const SplineGrid& grid, const Quadrature& quadrature) {
  double weights = 1;
  for (const int degree : grid.degrees) weights *= degree + 1;
  const double full = double(quadrature.full.size()) * double(quadrature.points_of_rule(grid));
  const double cut = double(quadrature.cut.size()) * (weights * weights + weights);
  return 8 * (full * (stored + 3) + cut + 7 * double(quadrature.at.size()) +
              14 * double(grid.size()) + double(grid.cells()));
}

double FitSystem::least_memory(const SplineGrid& grid, int points) {
  double rule = 1, cells = 1;
  for (int k = 0; k < grid.dimensions; ++k) {
    rule *= points;
    cells *= grid.spans(k);
  }
  return 8 * (cells * (rule * (stored + 3) + 1) + 14 * double(grid.size()));
}

}  // namespace sardf

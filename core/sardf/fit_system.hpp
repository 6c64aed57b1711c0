// The linear equations of a fit, without a matrix: A c = b, where the energy at coefficients c is
// cᵀA c - 2 bᵀc + its value at 0.
#pragma once

#include <functional>

#include "sardf/fit.hpp"
#include "sardf/fit_kernel.hpp"

namespace sardf {

/// Every expression of a problem at points.
class FitFields {
 public:
  explicit FitFields(const FitProblem& problem);

  /// At a point, with v = (Phi, its derivatives by x, y, z), the energy's density is
  /// vᵀ quadratic v - 2 linear . v + constant: entries 00 01 02 03 11 12 13 22 23 33 of quadratic.
  struct Density {
    double quadratic[10], linear[4], constant, start, factor;
  };
  /// n at most Evaluator::block_size. Throws Error where a field is not finite, with the point.
  void at(const Vec3* points, size_t n, Density* out) const;

 private:
  struct Values;
  Values values_at(const Vec3* points, size_t n) const;
  Density density(const Values& values, size_t i) const;

  double values_weight_, slope_weight_, smoothness_;
  bool needs_slopes_;
  Evaluator start_, factor_, values_, slope_, along_;
  bool has_values_, has_slope_;
};

class FitSystem {
 public:
  /// Keeps references to both. Throws Error, Cancelled.
  FitSystem(const FitProblem& problem, const Quadrature& quadrature, const Progress& progress);

  const SplineGrid& grid() const { return grid_; }
  size_t size() const { return right_.size(); }
  size_t points() const { return start_.size(); }

  void apply(const std::vector<double>& c, std::vector<double>& out, const Progress& pulse) const;
  const std::vector<double>& right() const { return right_; }
  /// Of A. Entries are 0 where no point sees a function.
  const std::vector<double>& diagonal() const { return diagonal_; }
  /// The energy at 0.
  double constant() const { return constant_; }
  /// The mean of F is mean_row . c + mean_of_start.
  const std::vector<double>& mean_row() const { return mean_row_; }
  double mean_of_start() const { return mean_of_start_; }

  /// F at every point of the quadrature.
  std::vector<double> values(const std::vector<double>& c, const Progress& pulse) const;
  /// The points: those of the rule first, in the order of cells.
  Vec3 point(size_t i) const;
  double weight(size_t i) const { return weight_[i]; }
  double factor(size_t i) const { return factor_[i]; }
  double start(size_t i) const { return start_[i]; }

  /// Adds to the energy the sum over points of stiffness * (F - target)², in place of what an
  /// earlier call added.
  void set_springs(const std::vector<double>& stiffness, const std::vector<double>& target,
                   const Progress& pulse);

  /// Adds the lower triangle to a band: to(row, column, value) in the order of cells.
  template <class To>
  void for_entries(const Progress& pulse, To to) const {
    std::vector<double> local;
    for (size_t cell = 0; cell < place_.size(); ++cell) {
      if (pulse && !pulse(0)) throw Cancelled();
      if (place_[cell] == no_place) continue;
      const double* matrix = local_matrix(cell, local);
      const std::vector<size_t> at = functions(cell);
      for (size_t i = 0; i < at.size(); ++i) {
        for (size_t j = 0; j <= i; ++j) to(at[i], at[j], matrix[i * at.size() + j]);
      }
    }
  }

  /// Bytes that a system needs, about.
  static double memory(const SplineGrid& grid, const Quadrature& quadrature);
  /// The same before a quadrature is known.
  static double least_memory(const SplineGrid& grid, int points);

 private:
  static constexpr size_t no_place = size_t(-1);
  // What is stored for a point of the rule: the density's entries, weighted.
  static constexpr size_t stored = 14;

  void evaluate_full(const FitFields& fields, size_t number, double& constant);
  void evaluate_cut(const FitFields& fields, size_t number, double& constant);
  void add_point(const Vec3& at, const FitFields::Density& density, double weight, size_t cut);
  void collect(const Progress& pulse);
  void collect_full(size_t number, double* right, double* diagonal, double* mean) const;
  void collect_cut(size_t cell, double* right, double* diagonal, double* mean) const;
  void add_springs_to_cut(size_t cell);
  const double* local_matrix(size_t cell, std::vector<double>& buffer) const;
  std::vector<size_t> functions(size_t cell) const;
  void gather(size_t cell, const std::vector<double>& c, double* local) const;
  void scatter(size_t cell, const double* local, std::vector<double>& c) const;
  void apply_full(size_t number, const double* local, double* out) const;
  void values_of_cell(size_t cell, const double* local, double* out) const;
  void weights_at(const Vec3& point, double* weights, double* slopes) const;
  bool is_full(size_t cell) const { return place_[cell] < quadrature_.full.size(); }
  size_t cut_number(size_t cell) const { return place_[cell] - quadrature_.full.size(); }
  size_t first_point(size_t cell) const;
  size_t points_of(size_t cell) const;

  /// visit(cell) for every cell with points, in parallel where cells share no coefficient.
  void for_cells(const Progress& pulse, const std::function<void(size_t)>& visit) const;

  const SplineGrid& grid_;
  const Quadrature& quadrature_;
  FitKernel kernel_;
  std::vector<size_t> place_;            // of each cell: among the full ones, then the cut ones
  std::vector<double> rule_;             // stored arrays of each full cell, one after the other
  std::vector<double> matrix_, linear_;  // of each cut cell
  std::vector<double> spring_matrix_;    // the same with springs; empty without
  std::vector<double> start_, factor_, weight_;  // of every point
  // Of every point, or empty: what springs add to entry 00 of the density and to the linear part.
  std::vector<double> springs_, pulls_;
  std::vector<double> right_, diagonal_, mean_row_;
  double constant_ = 0, mean_of_start_ = 0;
};

}  // namespace sardf

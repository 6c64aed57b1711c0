// Splines at the Gauss points of one cell, by one axis after the other.
#pragma once

#include <vector>

#include "sardf/fit_quadrature.hpp"

namespace sardf {

/// Values and derivatives of a cell's functions at the points of a tensor-product rule. The cells
/// of a grid are alike, so one serves all. Fields of the points: value, then the derivatives by x,
/// y, z.
class FitKernel {
 public:
  FitKernel(const SplineGrid& grid, int points);

  size_t weights() const { return weights_; }  // functions of a cell
  size_t points() const { return points_; }

  /// fields[f * points() + q] from the cell's coefficients.
  void forward(const double* coefficients, double* fields) const;
  /// The transpose: adds to the coefficients.
  void backward(const double* fields, double* coefficients) const;
  /// The first field alone.
  void values(const double* coefficients, double* values) const;
  void values_backward(const double* values, double* coefficients) const;
  /// Adds the sums over the points of by * (field a of a function) * (field b of it), for each
  /// function.
  void add_squares(int a, int b, const double* by, double* coefficients) const;

 private:
  /// entries[i * outputs + o].
  struct Table {
    int inputs, outputs;
    std::vector<double> entries;
    Table transposed() const;
  };
  struct Axis {
    Table value, slope, value_back, slope_back;
    std::vector<Table> products;  // value², value * slope, slope², towards coefficients
  };
  struct Buffers;

  static void apply(const Table& table, const double* from, double* to, int before, int after,
                    bool add = false);
  static void contract(const Table& table, const double* from, double* to, int before, int after);

  Axis axes_[3];
  size_t weights_, points_;
};

}  // namespace sardf

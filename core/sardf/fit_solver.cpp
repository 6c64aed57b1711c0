#include "sardf/fit_solver.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "sardf/error.hpp"
#include "sardf/fit_band.hpp"

namespace sardf {

namespace {

constexpr double accepted = 1e-10;
// By the diagonal alone more digits take too long, and are not needed.
constexpr double wanted_by_factors = 1e-14, wanted_by_diagonal = 1e-11;
constexpr int most_iterations = 10000, most_with_factors = 200;
// Steps without progress after which rounding is the reason.
constexpr int most_idle = 20;

using Vector = std::vector<double>;

double dot(const Vector& a, const Vector& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

// to += by * from
void add(double by, const Vector& from, Vector& to) {
  for (size_t i = 0; i < to.size(); ++i) to[i] += by * from[i];
}

class Solver {
 public:
  Solver(const FitSystem& system, const SplineGrid& grid, std::optional<double> mean,
         const Progress& progress)
      : system_(system), progress_(progress), row_(system.mean_row()), constrained_(mean) {
    if (progress_) pulse_ = [this](double) { return progress_(share_); };
    for (const double d : system.diagonal()) scale_.push_back(d > 0 ? 1 / std::sqrt(d) : 0);
    if (mean) prepare_mean(*mean);
    if (BandFactors::are_cheap(grid)) factors_.emplace(system, grid, scale_, pulse_);
    if (mean) preconditioned_row_ = preconditioned(row_);
  }

  SolvedEquations run(Vector c) {
    for (size_t i = 0; i < c.size(); ++i) c[i] *= scale_[i] > 0;
    to_mean(c);
    SolvedEquations made{{}, 0, 0};
    // Rounding lets the residual that is updated drift from the true one: start afresh from there.
    const double reference = reference_size();
    for (int round = 0; round < 4; ++round) {
      Vector r = residual_of(c);
      made.residual = size_of(r, reference);
      if (made.residual <= wanted() || made.iterations >= most()) break;
      const double before = made.residual;
      descend(c, std::move(r), reference, made);
      to_mean(c);
      made.residual = size_of(residual_of(c), reference);
      if (made.residual > 0.5 * before) break;
    }
    if (made.residual > accepted && factors_) {
      // They are worth little where the matrix is nearly singular.
      factors_.reset();
      if (constrained_) preconditioned_row_ = preconditioned(row_);
      const int iterations = made.iterations;
      made = run(std::move(c));
      made.iterations += iterations;
      return made;
    }
    check(made);
    made.coefficients = std::move(c);
    return made;
  }

 private:
  int most() const { return factors_ ? most_with_factors : most_iterations; }
  double wanted() const { return factors_ ? wanted_by_factors : wanted_by_diagonal; }

  void prepare_mean(double mean) {
    for (size_t i = 0; i < row_.size(); ++i) row_[i] *= scale_[i] > 0;
    value_ = mean - system_.mean_of_start();
    Vector scaled = row_;
    for (size_t i = 0; i < row_.size(); ++i) scaled[i] *= scale_[i];
    row_size_ = dot(scaled, scaled);
    if (!(row_size_ > 0)) {
      throw Error("the mean cannot be prescribed: factor is 0 on all of the solid");
    }
    for (size_t i = 0; i < row_.size(); ++i) scaled[i] *= scale_[i];
    towards_mean_ = std::move(scaled);
  }

  // The nearest coefficients, after scaling, with the prescribed mean; twice, for rounding.
  void to_mean(Vector& c) const {
    if (!constrained_) return;
    for (int time = 0; time < 2; ++time) add((value_ - dot(row_, c)) / row_size_, towards_mean_, c);
  }

  Vector preconditioned(const Vector& r) const {
    Vector z(r.size());
    for (size_t i = 0; i < r.size(); ++i) z[i] = r[i] * scale_[i];
    if (factors_) factors_->solve(z);
    for (size_t i = 0; i < r.size(); ++i) z[i] *= scale_[i];
    return z;
  }

  // Without the multiple of the constraint's row that makes it cross no direction of the subspace
  // after preconditioning (Gould, Hribar, Nocedal 2001).
  void take_off_row(Vector& r) const {
    if (!constrained_) return;
    add(-dot(preconditioned_row_, r) / dot(preconditioned_row_, row_), row_, r);
  }

  Vector residual_of(const Vector& c) const {
    Vector r;
    system_.apply(c, r, pulse_);
    for (size_t i = 0; i < r.size(); ++i) r[i] = (system_.right()[i] - r[i]) * (scale_[i] > 0);
    take_off_row(r);
    return r;
  }

  double scaled_norm(const Vector& r) const {
    double sum = 0;
    for (size_t i = 0; i < r.size(); ++i) sum += r[i] * scale_[i] * (r[i] * scale_[i]);
    return std::sqrt(sum);
  }

  // Of the right-hand side, and of what the prescribed mean adds to it.
  double reference_size() const {
    double size = scaled_norm(system_.right());
    if (!constrained_) return size;
    Vector c(row_.size()), by_mean;
    to_mean(c);
    system_.apply(c, by_mean, pulse_);
    return size + scaled_norm(by_mean);
  }
  double size_of(const Vector& r, double reference) const {
    const double size = scaled_norm(r);
    return size == 0 ? 0 : size / reference;
  }

  void descend(Vector& c, Vector r, double reference, SolvedEquations& made) {
    Vector z = preconditioned(r), p = z, along;
    double rz = dot(r, z), best = size_of(r, reference);
    int since_best = 0;
    while (made.iterations < most() && rz > 0) {
      system_.apply(p, along, pulse_);
      const double curvature = dot(p, along);
      if (!(curvature > 0)) break;
      add(rz / curvature, p, c);
      add(-rz / curvature, along, r);
      take_off_row(r);
      ++made.iterations;
      const double size = size_of(r, reference);
      report(size);
      since_best = size < best ? 0 : since_best + 1;
      best = std::min(best, size);
      const int patience = best <= accepted ? most_idle : most() / 10;
      if (size <= 0.5 * wanted() || since_best > patience) break;
      z = preconditioned(r);
      const double next = dot(r, z);
      for (size_t i = 0; i < p.size(); ++i) p[i] = z[i] + next / rz * p[i];
      rz = next;
    }
  }

  void report(double residual) {
    const double decades = -std::log10(std::clamp(residual, wanted(), 1.0));
    share_ = std::max(share_, decades / -std::log10(wanted()));
    if (progress_ && !progress_(share_)) throw Cancelled();
  }

  void check(const SolvedEquations& made) const {
    if (made.residual <= accepted) return;
    char text[200];
    std::snprintf(text, sizeof text,
                  "the equations cannot be solved: their residual is %.2g after %d iterations, "
                  "1e-10 is needed; fewer splines or more points may determine the function",
                  made.residual, made.iterations);
    throw Error(text);
  }

  const FitSystem& system_;
  const Progress& progress_;
  Progress pulse_;  // asks during a step whether to go on
  double share_ = 0;
  Vector scale_;
  Vector row_, preconditioned_row_, towards_mean_;  // of the mean
  double value_ = 0, row_size_ = 0;
  bool constrained_;
  std::optional<BandFactors> factors_;
};

}  // namespace

SolvedEquations solve(const FitSystem& system, std::optional<double> mean,
                      std::vector<double> guess, const Progress& progress) {
  return Solver(system, system.grid(), mean, progress).run(std::move(guess));
}

}  // namespace sardf

#include "sardf/fit.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <mutex>

#include "sardf/arithmetic.hpp"
#include "sardf/error.hpp"
#include "sardf/fit_bounds.hpp"
#include "sardf/pulse.hpp"
#include "sardf/spline_operation.hpp"

namespace sardf {

namespace {

constexpr double most_bytes = 0x1p31;
// A quadrature that finds a third of the energy too little does not see the function it minimises.
constexpr double finer_energy_allowed = 1.5;

/// Never reports less than before: 0 is said while a part of the work goes on.
Progress rising(const Progress& progress) {
  if (!progress) return {};
  return [&progress, shown = 0.0](double share) mutable {
    shown = std::max(shown, share);
    return progress(shown);
  };
}

void check_memory(double bytes, const SplineGrid& grid) {
  if (bytes <= most_bytes) return;
  std::string counts;
  for (int k = 0; k < grid.dimensions; ++k) {
    counts += (k ? " x " : "") + std::to_string(grid.counts[size_t(k)]);
  }
  throw Error("to solve for " + counts + " splines needs about " + memory_text(bytes) + "; up to " +
              memory_text(most_bytes) + " are accepted");
}

void check_plane(const FitProblem& p) {
  if (p.grid.dimensions == 3) return;
  const std::pair<const char*, Expression> all[] = {{"start", p.start}, {"factor", p.factor},
                                                    {"solid", p.solid}, {"values", p.values},
                                                    {"slope", p.slope}, {"along", p.along}};
  for (const auto& [name, field] : all) {
    if (field && field->coordinates & 4) {
      throw Error(std::string(name) +
                  " depends on z; with two numbers of splines, fields of x and y are accepted");
    }
  }
}

void check_terms(const FitProblem& p) {
  if ((p.slope == nullptr) != (p.along == nullptr)) {
    throw Error(std::string(p.slope ? "slope" : "along") + " is given without " +
                (p.slope ? "along: the function whose gradient gives the direction" : "slope"));
  }
  const bool any =
      (p.values && p.values_weight > 0) || (p.slope && p.slope_weight > 0) || p.smoothness > 0;
  if (!any) {
    throw Error(
        "nothing is to be minimised; values, slope with along, or a smoothness above 0 are "
        "needed");
  }
  if (p.points < 1 || p.points > 16) {
    throw Error("points is " + std::to_string(p.points) + "; 1 to 16 are accepted");
  }
}

double energy_of(const FitSystem& system, const std::vector<double>& c, const Progress& progress) {
  std::vector<double> product;
  system.apply(c, product, progress);
  double sum = system.constant();
  for (size_t i = 0; i < c.size(); ++i) sum += c[i] * (product[i] - 2 * system.right()[i]);
  return sum;
}

/// Energies of some full cells by rules of several numbers of points.
class CellEnergy {
 public:
  CellEnergy(const FitProblem& problem, const std::vector<double>& coefficients)
      : grid_(problem.grid), coefficients_(coefficients), fields_(problem) {}

  // At the coefficients, and in `at_start` that without them.
  double of(size_t cell, int points, double& at_start) const {
    const FitKernel kernel(grid_, points);
    const std::vector<Vec3> at = points_of(cell, points);
    const GaussRule rule = gauss_rule(points);
    const size_t n = kernel.points(), deep = grid_.dimensions == 3 ? rule.at.size() : 1;
    std::vector<double> v(4 * n);
    kernel.forward(local(cell).data(), v.data());
    double sum = 0;
    FitFields::Density density[Evaluator::block_size];
    for (size_t from = 0; from < n; from += Evaluator::block_size) {
      const size_t count = std::min(Evaluator::block_size, n - from);
      fields_.at(&at[from], count, density);
      for (size_t i = 0; i < count; ++i) {
        const size_t q = from + i, m = rule.at.size();
        const double weight = rule.weight[q / deep / m] * rule.weight[q / deep % m] *
                              (deep > 1 ? rule.weight[q % deep] : 1);
        const double at_q[4] = {v[q], v[n + q], v[2 * n + q], v[3 * n + q]};
        sum += weight * energy(density[i], at_q);
        at_start += weight * density[i].constant;
      }
    }
    return sum;
  }

 private:
  static double energy(const FitFields::Density& d, const double* v) {
    double sum = d.constant;
    size_t entry = 0;
    for (int a = 0; a < 4; ++a) {
      sum -= 2 * d.linear[a] * v[a];
      for (int b = a; b < 4; ++b) sum += (a == b ? 1 : 2) * d.quadratic[entry++] * v[a] * v[b];
    }
    return sum;
  }

  std::vector<double> local(size_t cell) const {
    const std::array<int, 3> at = grid_.cell(cell);
    std::vector<double> all;
    for (int a = 0; a <= grid_.degrees[0]; ++a) {
      for (int b = 0; b <= grid_.degrees[1]; ++b) {
        for (int c = 0; c <= grid_.degrees[2]; ++c) {
          all.push_back(coefficients_[grid_.index(at[0] + a, at[1] + b, at[2] + c)]);
        }
      }
    }
    return all;
  }

  std::vector<Vec3> points_of(size_t cell, int points) const {
    const GaussRule rule = gauss_rule(points);
    const std::array<int, 3> spans = grid_.cell(cell);
    const size_t m = rule.at.size(), deep = grid_.dimensions == 3 ? m : 1;
    std::vector<Vec3> all(m * m * deep);
    for (size_t q = 0; q < all.size(); ++q) {
      const size_t place[3] = {q / deep / m, q / deep % m, q % deep};
      for (size_t k = 0; k < size_t(grid_.dimensions); ++k) {
        all[q][k] = grid_.lower[k] + (spans[k] + rule.at[place[k]]) / grid_.per_length(int(k));
      }
    }
    return all;
  }

  const SplineGrid& grid_;
  const std::vector<double>& coefficients_;
  FitFields fields_;
};

// Of at most 200 cells, evenly chosen; 1 where none is full.
double finer_energy(const FitProblem& problem, const Quadrature& quadrature,
                    const std::vector<double>& coefficients, const Progress& progress) {
  constexpr size_t most = 200;
  const CellEnergy energy(problem, coefficients);
  double used = 0, finer = 0, start = 0, unused = 0;
  const size_t n = quadrature.full.size(), step = (n + most - 1) / most;
  for (size_t i = step / 2; i < n; i += step) {
    used += energy.of(quadrature.full[i], quadrature.points, start);
    finer += energy.of(quadrature.full[i], quadrature.points + 1, unused);
    if (progress && !progress(double(i) / double(n))) throw Cancelled();
  }
  // Nothing is left of the energy: rounding alone.
  if (used <= 1e-10 * start && finer <= 1e-6 * start) return 1;
  if (finer > finer_energy_allowed * used) {
    char text[200];
    std::snprintf(text, sizeof text,
                  "the quadrature is too coarse: the energy is %.4g with %d points, but %.4g with "
                  "%d points for each cell and axis (of cells inside the solid)",
                  used, quadrature.points, finer, quadrature.points + 1);
    throw Error(text);
  }
  return finer / used;
}

Expression uncut(const FitProblem& problem, std::vector<double> coefficients) {
  const OperationPointer spline = spline_operation(problem.grid, std::move(coefficients));
  const std::array<Expression, 3> xyz{coordinate(0), coordinate(1), coordinate(2)};
  const Expression phi = call(spline, std::span(xyz.data(), size_t(problem.grid.dimensions)));
  return problem.start + problem.factor * phi;
}

FitResult solved(const FitProblem& problem, const Quadrature& quadrature,
                 const Progress& progress) {
  FitResult result;
  FitReport& report = result.report;
  report.memory = FitSystem::memory(problem.grid, quadrature);
  check_memory(report.memory, problem.grid);
  FitSystem system(problem, quadrature, part_of(progress, 0, 0.2));
  const bool bounded = problem.at_least || problem.at_most;
  check_bounds(problem, system, part_of(progress, 0.2, 0.25));
  const Progress later = part_of(progress, bounded ? 0.25 : 0.2, bounded ? 0.5 : 0.9);
  SolvedEquations found = solve(system, problem.mean, std::vector<double>(system.size()), later);
  Cut cut;
  if (bounded) {
    const Progress within = part_of(progress, 0.5, 0.9);
    found = solve_within_bounds(problem, system, std::move(found), within);
    const std::vector<double> zeros(system.points());
    system.set_springs(zeros, zeros, within);
    cut = measured_cut(problem, uncut(problem, found.coefficients), within);
  }
  const Progress last = part_of(progress, 0.9, 1);
  for (const double d : system.diagonal()) report.unknowns += d > 0;
  report.quadrature_points = system.points();
  report.iterations = found.iterations;
  report.residual = found.residual;
  report.volume = quadrature.volume;
  report.volume_error = quadrature.volume_error;
  report.energy_before = system.constant();
  report.energy_after = energy_of(system, found.coefficients, last);
  report.rms_before = std::sqrt(report.energy_before / report.volume);
  report.rms_after = std::sqrt(std::max(0.0, report.energy_after) / report.volume);
  report.finer_energy = finer_energy(problem, quadrature, found.coefficients, last);
  report.cut = cut.most;
  report.mean = mean_within(Limits(problem), system.values(found.coefficients, last), system);
  check_cut(problem, cut);
  result.coefficients = std::move(found.coefficients);
  return result;
}

class Timer {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

FitResult fit(const FitProblem& problem, const Quadrature& quadrature, const Progress& progress) {
  const Timer timer;
  check_terms(problem);
  check_plane(problem);
  FitResult result = solved(problem, quadrature, rising(progress));
  result.report.seconds = timer.seconds();
  return result;
}

FitResult fit(const FitProblem& problem, const Progress& progress) {
  const Timer timer;
  check_terms(problem);
  check_plane(problem);
  check_memory(FitSystem::least_memory(problem.grid, problem.points), problem.grid);
  const Progress shown = rising(progress);
  const Quadrature quadrature =
      quadrature_over(problem.grid, problem.solid, problem.points, part_of(shown, 0, 0.1));
  FitResult result = solved(problem, quadrature, part_of(shown, 0.1, 1));
  result.report.seconds = timer.seconds();
  return result;
}

std::shared_ptr<const FitResult> recent_fit(const FitProblem& problem, const Progress& progress) {
  // The problems hold their expressions, so that equal pointers are equal expressions.
  struct Recent {
    FitProblem problem;
    std::shared_ptr<const FitResult> result;
  };
  constexpr size_t most = 32;
  static std::mutex mutex;
  static std::deque<Recent> recent;
  {
    const std::scoped_lock lock(mutex);
    for (const Recent& each : recent) {
      if (each.problem == problem) return each.result;
    }
  }
  auto made = std::make_shared<const FitResult>(fit(problem, progress));
  const std::scoped_lock lock(mutex);
  if (recent.size() == most) recent.pop_front();
  recent.push_back({problem, made});
  return made;
}

Expression fitted_expression(const FitProblem& problem, std::vector<double> coefficients) {
  Expression f = uncut(problem, std::move(coefficients));
  if (problem.at_least) f = max(f, constant(*problem.at_least));
  if (problem.at_most) f = min(f, constant(*problem.at_most));
  return f;
}

}  // namespace sardf

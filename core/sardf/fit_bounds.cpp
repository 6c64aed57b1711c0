#include "sardf/fit_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <random>

#include "sardf/error.hpp"

namespace sardf {

namespace {

// Of the magnitudes that F and the bounds have.
constexpr double violation_allowed = 1e-6, start_allowed = 1e-6;
constexpr int most_rounds = 60, most_steps = 50;
// How much smaller a round must make the violation, or else the springs become stiffer by as much.
constexpr double wanted_reduction = 5;
constexpr double stiffest = 1e4;

double lower(const FitProblem& problem) { return problem.at_least.value_or(-infinity); }
double upper(const FitProblem& problem) { return problem.at_most.value_or(infinity); }

double violation(const FitProblem& problem, double value) {
  return std::max({lower(problem) - value, value - upper(problem), 0.0});
}

// "at_least is 0" or "at_most is 1", whichever the value breaks.
std::string broken_bound(const FitProblem& problem, double value) {
  char text[60];
  const bool below = value < lower(problem);
  std::snprintf(text, sizeof text, "%s is %.6g", below ? "at_least" : "at_most",
                below ? lower(problem) : upper(problem));
  return text;
}

std::string value_at(double value, const Vec3& at) {
  char text[120];
  std::snprintf(text, sizeof text, "%.6g at (%.6g, %.6g, %.6g)", value, at[0], at[1], at[2]);
  return text;
}

double magnitude_of(const FitProblem& problem, const std::vector<double>& values) {
  double most =
      std::max(std::abs(problem.at_least.value_or(0)), std::abs(problem.at_most.value_or(0)));
  for (const double v : values) most = std::max(most, std::abs(v));
  return most;
}

// Points near where factor may be 0: of each cell the one with the smallest factor.
std::vector<Vec3> near_feature(const FitProblem& problem, const FitSystem& system) {
  const Evaluator factor(problem.factor);
  const SplineGrid& grid = problem.grid;
  std::vector<size_t> best(grid.cells(), size_t(-1));
  for (size_t i = 0; i < system.points(); ++i) {
    std::array<int, 3> spans;
    const Vec3 at = system.point(i);
    for (int k = 0; k < 3; ++k) spans[size_t(k)] = grid.place(k, at[size_t(k)]).span;
    size_t& now = best[grid.cell_number(spans)];
    if (now == size_t(-1) || std::abs(system.factor(i)) < std::abs(system.factor(now))) now = i;
  }
  std::vector<Vec3> points;
  for (size_t cell = 0; cell < best.size(); ++cell) {
    if (best[cell] == size_t(-1)) continue;
    const std::array<int, 3> at = grid.cell(cell);
    BoundingBox box{grid.lower, grid.lower};
    for (size_t k = 0; k < size_t(grid.dimensions); ++k) {
      const double side = 1 / grid.per_length(int(k));
      box.lo[k] += at[k] * side;
      box.hi[k] = box.lo[k] + side;
    }
    if (factor.interval(box).contains(0)) points.push_back(system.point(best[cell]));
  }
  return points;
}

// Newton's steps to where factor is 0.
void descend_to_feature(const Evaluator& factor, std::vector<Vec3>& points) {
  std::vector<double> value(points.size());
  std::vector<Vec3> slope(points.size());
  for (int step = 0; step < 60 && !points.empty(); ++step) {
    factor.gradients(points[0].data(), points.size(), value.data(), slope[0].data());
    for (size_t i = 0; i < points.size(); ++i) {
      const double squared = dot(slope[i], slope[i]);
      const double by = value[i] / squared;
      if (std::isfinite(by)) points[i] = points[i] - by * slope[i];
    }
  }
}

bool is_inside(const FitProblem& problem, const Vec3& at) {
  const SplineGrid& grid = problem.grid;
  double size = 0;
  for (size_t k = 0; k < size_t(grid.dimensions); ++k) {
    if (!(grid.lower[k] <= at[k] && at[k] <= grid.upper[k])) return false;
    size += grid.upper[k] - grid.lower[k];
  }
  return !problem.solid || Evaluator(problem.solid).value(at) >= -1e-6 * size;
}

void check_start(const FitProblem& problem, const FitSystem& system) {
  const Evaluator factor(problem.factor), start(problem.start);
  double largest = 0;
  std::vector<double> starts;
  for (size_t i = 0; i < system.points(); ++i) {
    largest = std::max(largest, std::abs(system.factor(i)));
    starts.push_back(system.start(i));
  }
  const double allowed = start_allowed * magnitude_of(problem, starts);
  std::vector<Vec3> points = near_feature(problem, system);
  descend_to_feature(factor, points);
  for (const Vec3& at : points) {
    if (!(std::abs(factor.value(at)) <= 1e-9 * largest) || !is_inside(problem, at)) continue;
    const double value = start.value(at);
    if (!(violation(problem, value) > allowed)) continue;
    throw Error("start is " + value_at(value, at) + ", where factor is 0 and nothing changes it; " +
                broken_bound(problem, value));
  }
}

/// Augmented Lagrangian at the points of the quadrature: springs towards the bounds, whose rest
/// positions move until the bounds hold.
class Bounded {
 public:
  Bounded(const FitProblem& problem, FitSystem& system, SolvedEquations free,
          const Progress& progress)
      : problem_(problem), system_(system), now_(std::move(free)), progress_(progress) {
    values_ = system_.values(now_.coefficients, progress_);
    allowed_ = violation_allowed * magnitude_of(problem, values_);
    double stiff = 0, mass = 0;
    for (const double d : system.diagonal()) stiff += d;
    for (size_t i = 0; i < system.points(); ++i) {
      mass += system.weight(i) * system.factor(i) * system.factor(i);
    }
    // Much stiffer than the energy itself.
    softest_ = mass > 0 ? 100 * stiff / mass : 0;
    spring_ = softest_;
    force_.assign(system.points(), 0.0);
  }

  SolvedEquations run() {
    double now = largest_violation();
    for (int round = 0; now > allowed_; ++round) {
      if (round == most_rounds) fail();
      relax();
      for (size_t i = 0; i < force_.size(); ++i) force_[i] = force_at(i);
      const double before = now;
      now = largest_violation();
      const bool slow = wanted_reduction * now > before;
      if (slow && spring_ < stiffest * softest_) spring_ *= wanted_reduction;
    }
    return std::move(now_);
  }

 private:
  // What pushes F at a point: up to the lower bound, or (negative) down to the upper one.
  double force_at(size_t i) const {
    const double up = force_[i] + spring_ * (lower(problem_) - values_[i]);
    const double down = force_[i] + spring_ * (upper(problem_) - values_[i]);
    return up > 0 ? up : down < 0 ? down : 0;
  }

  double lower_target(size_t i) const { return lower(problem_) + force_[i] / spring_; }
  double upper_target(size_t i) const { return upper(problem_) + force_[i] / spring_; }

  // Newton's method for the energy with springs where they push, until these points remain the
  // same. A convex function and a search along each step: it cannot circle.
  void relax() {
    std::vector<signed char> active(force_.size()), before;
    std::vector<double> stiffness(force_.size()), target(force_.size());
    bool whole_step = false;
    for (int step = 0; step < most_steps; ++step) {
      for (size_t i = 0; i < force_.size(); ++i) {
        const double force = force_at(i);
        active[i] = force > 0 ? 1 : force < 0 ? -1 : 0;
        stiffness[i] = active[i] ? spring_ * system_.weight(i) : 0;
        target[i] = force > 0 ? lower_target(i) : force < 0 ? upper_target(i) : 0;
      }
      if (whole_step && active == before) return;
      before = active;
      system_.set_springs(stiffness, target, progress_);
      const SolvedEquations next = solve(system_, problem_.mean, now_.coefficients, progress_);
      whole_step = move_towards(next, active, target);
    }
  }

  // By the share of the step with the least energy; whether that is all of it.
  bool move_towards(const SolvedEquations& next, const std::vector<signed char>& active,
                    const std::vector<double>& target) {
    std::vector<double> step(now_.coefficients.size()), product, change = values_;
    const std::vector<double> values = system_.values(next.coefficients, progress_);
    for (size_t i = 0; i < step.size(); ++i) step[i] = next.coefficients[i] - now_.coefficients[i];
    for (size_t i = 0; i < change.size(); ++i) change[i] = values[i] - values_[i];
    system_.apply(step, product, progress_);
    const double curvature = std::inner_product(step.begin(), step.end(), product.begin(), 0.0);
    // With the springs at hand the energy is that of `next` and (1 - share)² * curvature; others
    // push, and these may not, at the place of the share.
    const auto slope_at = [&](double share) {
      double slope = -(1 - share) * curvature;
      for (size_t i = 0; i < change.size(); ++i) {
        const double f = values_[i] + share * change[i];
        const double push = std::min(f - lower_target(i), 0.0) + std::max(f - upper_target(i), 0.0);
        const double counted = active[i] ? f - target[i] : 0;
        slope += spring_ * system_.weight(i) * change[i] * (push - counted);
      }
      return slope;
    };
    double share = 1;
    if (slope_at(1) > 0) {
      double low = 0;
      for (int halving = 0; halving < 30; ++halving) {
        const double middle = 0.5 * (low + share);
        (slope_at(middle) > 0 ? share : low) = middle;
      }
    }
    for (size_t i = 0; i < step.size(); ++i) now_.coefficients[i] += share * step[i];
    if (share == 1) now_.coefficients = next.coefficients;
    now_.iterations += next.iterations;
    now_.residual = next.residual;
    values_ = system_.values(now_.coefficients, progress_);
    return share == 1;
  }

  double largest_violation() const {
    double most = 0;
    for (const double v : values_) most = std::max(most, violation(problem_, v));
    return most;
  }

  [[noreturn]] void fail() const {
    size_t worst = 0;
    for (size_t i = 0; i < values_.size(); ++i) {
      if (violation(problem_, values_[i]) > violation(problem_, values_[worst])) worst = i;
    }
    throw Error("the bounds cannot hold together with the rest: F remains " +
                value_at(values_[worst], system_.point(worst)) + "; " +
                broken_bound(problem_, values_[worst]));
  }

  const FitProblem& problem_;
  FitSystem& system_;
  SolvedEquations now_;
  const Progress& progress_;
  std::vector<double> values_, force_;
  double spring_, softest_, allowed_;
};

}  // namespace

void check_bounds(const FitProblem& problem, const FitSystem& system) {
  char text[120];
  if (lower(problem) > upper(problem)) {
    std::snprintf(text, sizeof text, "at_least is %.6g and at_most only %.6g", lower(problem),
                  upper(problem));
    throw Error(text);
  }
  if (problem.mean && violation(problem, *problem.mean) > 0) {
    std::snprintf(text, sizeof text, "the mean is %.6g; ", *problem.mean);
    throw Error(text + broken_bound(problem, *problem.mean));
  }
  if (problem.at_least || problem.at_most) check_start(problem, system);
}

SolvedEquations solve_within_bounds(const FitProblem& problem, FitSystem& system,
                                    SolvedEquations free, const Progress& progress) {
  return Bounded(problem, system, std::move(free), progress).run();
}

double measured_cut(const FitProblem& problem, const Expression& uncut, const Progress& progress) {
  constexpr size_t count = 200000;
  std::mt19937_64 random(1);
  std::vector<double> points(3 * count), out(2 * count);
  for (size_t i = 0; i < 3 * count; ++i) {
    const size_t k = i % 3;
    const double t = double(random() >> 11) * 0x1p-53;
    const bool used = int(k) < problem.grid.dimensions;
    points[i] =
        used ? problem.grid.lower[k] + t * (problem.grid.upper[k] - problem.grid.lower[k]) : 0;
  }
  const std::vector<Expression> both{uncut, problem.solid ? problem.solid : constant(1)};
  Evaluator(both).values(points.data(), count, out.data(), progress);
  double most = 0;
  for (size_t i = 0; i < count; ++i) {
    if (out[2 * i + 1] >= 0) most = std::max(most, violation(problem, out[2 * i]));
  }
  return most;
}

}  // namespace sardf

#include "sardf/fit_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sardf/error.hpp"
#include "sardf/short_number.hpp"

namespace sardf {

namespace {

// Of the magnitudes that F and the bounds have.
constexpr double violation_allowed = 1e-6, rounding = 1e-14;
// Of the range of F.
constexpr double mean_tolerance = 1e-7;
constexpr int most_rounds = 60, most_steps = 50, most_shifts = 20;
// How much smaller a round must make the violation, or else the springs become stiffer by as much.
constexpr double wanted_reduction = 5;
constexpr double stiffest = 1e4;

/// Augmented Lagrangian at the points of the quadrature: springs towards the bounds, whose rest
/// positions move until the bounds hold.
class Bounded {
 public:
  Bounded(const FitProblem& problem, FitSystem& system, SolvedEquations free,
          const Progress& progress)
      : wanted_mean_(problem.mean),
        mean_(problem.mean),
        limits_(problem),
        system_(system),
        now_(std::move(free)),
        progress_(progress) {
    values_ = system_.values(now_.coefficients, progress_);
    allowed_ = violation_allowed * magnitude_of(limits_, values_);
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
    reach_bounds();
    if (wanted_mean_) reach_mean();
    return std::move(now_);
  }

 private:
  void reach_bounds() {
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
  }

  // What F leaves the bounds by is cut off, which changes the mean: that of the equations is moved,
  // by the secant method, until the mean of the cut function is the wanted one.
  void reach_mean() {
    double before = *mean_, mean_before = mean_within(limits_, values_, system_);
    double slope = 1;
    for (int round = 0;; ++round) {
      const double now = mean_within(limits_, values_, system_);
      const double step = *mean_ - before;
      if (round > 0 && step != 0) slope = std::clamp((now - mean_before) / step, 0.1, 10.0);
      if (std::abs(now - *wanted_mean_) <= mean_allowed()) return;
      if (round == most_shifts) fail_to_reach_mean(now);
      before = *mean_;
      mean_before = now;
      *mean_ += (*wanted_mean_ - now) / slope;
      // Only from a point with the new mean does a search along Newton's step go downhill.
      place_springs();
      move_to(solve(system_, mean_, now_.coefficients, progress_));
      relax();
      reach_bounds();
    }
  }

  double mean_allowed() const {
    const auto [least, most] = std::minmax_element(values_.begin(), values_.end());
    const double range = limits_.within(*most) - limits_.within(*least);
    return mean_tolerance * range + rounding * magnitude_of(limits_, values_);
  }

  // What pushes F at a point: up to the lower bound, or (negative) down to the upper one.
  double force_at(size_t i) const {
    const double up = force_[i] + spring_ * (limits_.lower - values_[i]);
    const double down = force_[i] + spring_ * (limits_.upper - values_[i]);
    return up > 0 ? up : down < 0 ? down : 0;
  }

  double lower_target(size_t i) const { return limits_.lower + force_[i] / spring_; }
  double upper_target(size_t i) const { return limits_.upper + force_[i] / spring_; }

  struct Pushed {
    std::vector<signed char> active;
    std::vector<double> target;
  };

  Pushed place_springs() {
    Pushed now{std::vector<signed char>(force_.size()), std::vector<double>(force_.size())};
    std::vector<double> stiffness(force_.size());
    for (size_t i = 0; i < force_.size(); ++i) {
      const double force = force_at(i);
      now.active[i] = force > 0 ? 1 : force < 0 ? -1 : 0;
      stiffness[i] = now.active[i] ? spring_ * system_.weight(i) : 0;
      now.target[i] = force > 0 ? lower_target(i) : force < 0 ? upper_target(i) : 0;
    }
    system_.set_springs(stiffness, now.target, progress_);
    return now;
  }

  // Newton's method for the energy with springs where they push, until these points remain the
  // same. A convex function and a search along each step: it cannot circle.
  void relax() {
    std::vector<signed char> before;
    bool whole_step = false;
    for (int step = 0; step < most_steps; ++step) {
      const Pushed pushed = place_springs();
      if (whole_step && pushed.active == before) return;
      before = pushed.active;
      const SolvedEquations next = solve(system_, mean_, now_.coefficients, progress_);
      whole_step = move_towards(next, pushed);
    }
  }

  void move_to(SolvedEquations next) {
    next.iterations += now_.iterations;
    now_ = std::move(next);
    values_ = system_.values(now_.coefficients, progress_);
  }

  // By the share of the step with the least energy; whether that is all of it.
  bool move_towards(const SolvedEquations& next, const Pushed& pushed) {
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
        const double counted = pushed.active[i] ? f - pushed.target[i] : 0;
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
    for (const double v : values_) most = std::max(most, limits_.violation(v));
    return most;
  }

  [[noreturn]] void fail_to_reach_mean(double reached) const {
    throw Error("the bounds cannot hold together with the mean " + short_number(*wanted_mean_, 6) +
                ": cut at the bounds, F has the mean " + short_number(reached, 6));
  }

  [[noreturn]] void fail() const {
    size_t worst = 0;
    for (size_t i = 0; i < values_.size(); ++i) {
      if (limits_.violation(values_[i]) > limits_.violation(values_[worst])) worst = i;
    }
    throw Error("the bounds cannot hold together with the rest: F remains " +
                value_at(values_[worst], system_.point(worst)) + "; " +
                limits_.broken_by(values_[worst]));
  }

  const std::optional<double> wanted_mean_;
  std::optional<double> mean_;  // that of the equations
  const Limits limits_;
  FitSystem& system_;
  SolvedEquations now_;
  const Progress& progress_;
  std::vector<double> values_, force_;
  double spring_, softest_, allowed_;
};

}  // namespace

SolvedEquations solve_within_bounds(const FitProblem& problem, FitSystem& system,
                                    SolvedEquations free, const Progress& progress) {
  return Bounded(problem, system, std::move(free), progress).run();
}

}  // namespace sardf

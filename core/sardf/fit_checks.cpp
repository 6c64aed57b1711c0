// What bounds of a fit contradict, and how much they cut off.
#include <cmath>
#include <random>

#include "sardf/box_search.hpp"
#include "sardf/error.hpp"
#include "sardf/fit_bounds.hpp"
#include "sardf/short_number.hpp"

namespace sardf {

namespace {

// Of the magnitudes that the start and the bounds have.
constexpr double start_allowed = 1e-6;
// Of the box's diagonal: shorter steps are none, and a point this far outside the solid is in it.
constexpr double shortest_step = 1e-12, on_solid = 1e-6, least_coordinate = 1e-8;
// Of the largest factor: less is 0.
constexpr double zero_factor = 1e-9;
constexpr int most_boxes = 40000, most_steps = 60;
constexpr size_t points_at_once = 4096;

/// Searches for a point where factor is 0 and start breaks a bound.
class StartSearch {
 public:
  StartSearch(const FitProblem& problem, const FitSystem& system)
      : limits_(problem), factor_(problem.factor) {
    box_ = {problem.grid.lower, problem.grid.upper};
    if (problem.grid.dimensions == 2) box_.lo[2] = box_.hi[2] = 0;
    const std::vector<Expression> all{problem.factor, problem.start,
                                      problem.solid ? problem.solid : constant(1)};
    all_ = Evaluator(all);
    double largest = 0;
    std::vector<double> starts;
    for (size_t i = 0; i < system.points(); ++i) {
      largest = std::max(largest, std::abs(system.factor(i)));
      starts.push_back(system.start(i));
    }
    zero_ = zero_factor * largest;
    allowed_ = start_allowed * magnitude_of(limits_, starts);
  }

  void run(const Progress& progress) {
    const std::vector<BoundingBox> left =
        search_boxes(box_, most_boxes, progress, [&](const BoundingBox& box, bool descends) {
          if (!may_break(box)) return false;
          if (descends) add(box.center(), progress);
          return true;
        });
    for (const BoundingBox& box : left) add(box.center(), progress);
    descend(progress);
  }

 private:
  bool may_break(const BoundingBox& box) const {
    Interval out[3];
    all_.intervals(box, out);
    const Interval &factor = out[0], &start = out[1], &solid = out[2];
    if (factor.lo > zero_ || factor.hi < -zero_ || solid.hi < -tolerance()) return false;
    return !(start.lo >= limits_.lower - allowed_ && start.hi <= limits_.upper + allowed_);
  }

  double tolerance() const { return on_solid * box_.diagonal(); }

  void add(const Vec3& point, const Progress& progress) {
    points_.push_back(point);
    if (points_.size() == points_at_once) descend(progress);
  }

  // Newton's steps to where factor is 0, and a look at the start there.
  void descend(const Progress& progress) {
    std::vector<double> value(points_.size());
    std::vector<Vec3> slope(points_.size());
    for (int step = 0; step < most_steps && !points_.empty(); ++step) {
      if (progress && !progress(0)) throw Cancelled();
      factor_.gradients(points_[0].data(), points_.size(), value.data(), slope[0].data());
      size_t kept = 0;
      for (size_t i = 0; i < points_.size(); ++i) {
        const Vec3 by = newton_step({value[i], slope[i]});
        const double length = norm(by), diagonal = box_.diagonal();
        if (value[i] == 0 || length <= shortest_step * diagonal) {
          check(points_[i]);
        } else if (length < infinity) {
          points_[kept++] = points_[i] + std::min(1.0, 0.25 * diagonal / length) * by;
        }
      }
      points_.resize(kept);
    }
    for (const Vec3& point : points_) check(point);
    points_.clear();
  }

  void check(Vec3 at) const {
    for (size_t k = 0; k < 3; ++k) {
      if (!(box_.lo[k] <= at[k] && at[k] <= box_.hi[k])) {
        // Rounding leads out of the box that has the feature on its face.
        const double inside = std::clamp(at[k], box_.lo[k], box_.hi[k]);
        if (!(std::abs(at[k] - inside) <= 1e-9 * box_.diagonal())) return;
        at[k] = inside;
      }
      // What is left of a descent to 0.
      if (std::abs(at[k]) < least_coordinate * box_.diagonal()) at[k] = 0;
    }
    double out[3];
    all_.values(at, out);
    if (!(std::abs(out[0]) <= zero_) || !(out[2] >= -tolerance())) return;
    if (!(limits_.violation(out[1]) > allowed_)) return;
    throw Error("start is " + value_at(out[1], at) +
                ", where factor is 0 and nothing changes it; " + limits_.broken_by(out[1]));
  }

  const Limits limits_;
  const Evaluator factor_;
  Evaluator all_;
  BoundingBox box_;
  double zero_ = 0, allowed_ = 0;
  std::vector<Vec3> points_;
};

}  // namespace

Limits::Limits(const FitProblem& problem)
    : lower(problem.at_least.value_or(-infinity)), upper(problem.at_most.value_or(infinity)) {}

std::string Limits::broken_by(double value) const {
  return value < lower ? "at_least is " + short_number(lower, 6)
                       : "at_most is " + short_number(upper, 6);
}

std::string value_at(double value, const Vec3& at) {
  return short_number(value, 6) + " at (" + short_number(at[0], 6) + ", " + short_number(at[1], 6) +
         ", " + short_number(at[2], 6) + ")";
}

double magnitude_of(const Limits& limits, const std::vector<double>& values) {
  double most = 0;
  for (const double bound : {limits.lower, limits.upper}) {
    if (std::abs(bound) < infinity) most = std::max(most, std::abs(bound));
  }
  for (const double v : values) most = std::max(most, std::abs(v));
  return most;
}

double mean_within(const Limits& limits, const std::vector<double>& values,
                   const FitSystem& system) {
  double sum = 0, weights = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    sum += system.weight(i) * limits.within(values[i]);
    weights += system.weight(i);
  }
  return sum / weights;
}

void check_bounds(const FitProblem& problem, const FitSystem& system, const Progress& progress) {
  const Limits limits(problem);
  if (limits.lower > limits.upper) {
    throw Error("at_least is " + short_number(limits.lower, 6) + " and at_most only " +
                short_number(limits.upper, 6));
  }
  if (problem.mean && limits.violation(*problem.mean) > 0) {
    throw Error("the mean is " + short_number(*problem.mean, 6) + "; " +
                limits.broken_by(*problem.mean));
  }
  if (problem.at_least || problem.at_most) StartSearch(problem, system).run(progress);
}

Cut measured_cut(const FitProblem& problem, const Expression& uncut, const Progress& progress) {
  constexpr size_t count = 200000;
  std::mt19937_64 random(1);
  std::vector<Vec3> points(count);
  for (Vec3& at : points) {
    for (size_t k = 0; k < 3; ++k) {
      const double t = double(random() >> 11) * 0x1p-53;
      if (int(k) >= problem.grid.dimensions) continue;
      at[k] = problem.grid.lower[k] + t * (problem.grid.upper[k] - problem.grid.lower[k]);
    }
  }
  std::vector<double> out(2 * count);
  const std::vector<Expression> both{uncut, problem.solid ? problem.solid : constant(1)};
  Evaluator(both).values(points[0].data(), count, out.data(), progress);
  const Limits limits(problem);
  Cut cut;
  double least = infinity, most = -infinity;
  for (size_t i = 0; i < count; ++i) {
    if (!(out[2 * i + 1] >= 0)) continue;
    const double value = out[2 * i], by = limits.violation(value);
    if (by > cut.most) cut = {by, points[i], value, 0};
    least = std::min(least, limits.within(value));
    most = std::max(most, limits.within(value));
  }
  cut.range = std::max(0.0, most - least);
  return cut;
}

void check_cut(const FitProblem& problem, const Cut& cut) {
  const Limits limits(problem);
  const double rounding = start_allowed * magnitude_of(limits, {cut.value});
  if (cut.most <= largest_cut * cut.range + rounding) return;
  throw Error("without its bounds the function is " + value_at(cut.value, cut.at) + ", but " +
              limits.broken_by(cut.value) + ": " + short_number(cut.most) +
              " would be cut off, of a function whose range is " + short_number(cut.range) +
              "; up to " + short_number(100 * largest_cut) +
              " % are accepted. More splines or points, or wider bounds, are needed");
}

}  // namespace sardf

#include "povray_gen/field_error.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <queue>
#include <random>

#include "povray_gen/error_tape.hpp"
#include "povray_gen/names.hpp"

namespace sardf::povray {

namespace {

constexpr size_t random_points = 8192;
constexpr int most_bounds = 8192;  // of one field
// Of operations over intervals, for all fields together: a few seconds.
constexpr double most_steps = 1e6;
// A bound over parts is never less than that at a point.
constexpr double close_enough = 1.02;

using Domain = ErrorTape::Domain;

struct Part {
  Domain domain;
  double error;
  bool by_windows = false;
  int depth = 0;
  bool operator<(const Part& other) const { return error < other.error; }
};
using Parts = std::array<Part, 2>;

std::array<Domain, 2> halves_in_space(const Domain& domain) {
  const Vec3 size = domain.box.size();
  const size_t axis = size_t(std::max_element(size.begin(), size.end()) - size.begin());
  std::array<Domain, 2> parts{domain, domain};
  parts[0].box.hi[axis] = parts[1].box.lo[axis] = domain.box.center()[axis];
  return parts;
}

std::array<Domain, 2> halves_by_value(const Domain& domain, const Interval& values) {
  const double middle = values.lo + 0.5 * (values.hi - values.lo);
  std::array<Domain, 2> parts{domain, domain};
  parts[0].exact = {values.lo, middle};
  parts[1].exact = {middle, values.hi};
  return parts;
}

/// Cuts the bounds where the bound is largest, as long as that helps.
class Proof {
 public:
  Proof(const Expression& sampled, double steps)
      : tape_(sampled), most_(std::clamp(steps / tape_.steps(), 1.0, double(most_bounds))) {}

  double bound(const BoundingBox& bounds, const Progress& progress) {
    const Domain all{bounds};
    const auto whole = over(all);
    if (!whole) return infinity;
    std::priority_queue<Part> pending;
    pending.push({all, *whole});
    double least = 0;
    while (used_ < most_ && pending.top().error > close_enough * least) {
      if (progress && !progress(0)) throw Cancelled();
      Part worst = pending.top();
      pending.pop();
      if (!worst.by_windows && windows_help(worst.domain)) {
        worst.error = min(worst.error, over_windows(worst.domain));
        worst.by_windows = true;
        pending.push(worst);
        continue;
      }
      if (worst.depth % 4 == 0) least = max(least, at_center(worst.domain));
      for (const Part& half : halves(worst)) pending.push(half);
    }
    return pending.top().error;
  }

 private:
  std::optional<double> over(const Domain& domain) {
    ++used_;
    const auto bound = tape_.over(domain);
    if (!bound) return std::nullopt;
    return bound->error;
  }
  // Over much wider values than the errors, all windows hold what the whole way does.
  bool windows_help(const Domain& domain) {
    return tape_.has_windows() && over(domain) &&
           width(tape_.exact_values()) <= 2 * tape_.source_error();
  }
  double over_windows(const Domain& domain) {
    used_ += 2 * error_windows;
    return tape_.over_windows(domain);
  }

  double at_center(const Domain& domain) {
    const Vec3 center = domain.box.center();
    const Domain point{{center, center}};
    const auto bound = over(point);
    if (!bound) return 0;
    return tape_.has_windows() ? min(*bound, over_windows(point)) : *bound;
  }

  // In space or by the value of the sampled function: what bounds better. Where both are as good,
  // by the value, down to a part of its error, if the field's slope by it differs.
  Parts halves(const Part& worst) {
    const Parts in_space = bounded(worst, halves_in_space(worst.domain));
    if (!tape_.has_windows() || !over(worst.domain)) return in_space;
    const Interval values = tape_.exact_values();
    if (!(values.lo < values.hi && width(values) < infinity)) return in_space;
    const bool wide = width(values) > tape_.source_error() / 4;
    const Parts by_value = bounded(worst, halves_by_value(worst.domain, values));
    const double a = max(in_space[0].error, in_space[1].error);
    const double b = max(by_value[0].error, by_value[1].error);
    if (a != b) return a < b ? in_space : by_value;
    for (double value : {values.lo, by_value[0].domain.exact.hi, values.hi}) {
      ++used_;
      const auto near = tape_.near({worst.domain.box, value});
      if (wide && near && near->error < 0.98 * worst.error) return by_value;
    }
    return in_space;
  }

  Parts bounded(const Part& worst, const std::array<Domain, 2>& domains) {
    Parts out;
    for (size_t i = 0; i < 2; ++i) {
      const auto bound = over(domains[i]);
      // A part is never worse than the whole.
      out[i] = {domains[i], bound ? min(worst.error, *bound) : 0, false, worst.depth + 1};
    }
    return out;
  }

  ErrorTape tape_;
  double most_, used_ = 0;
};

// Where the inputs of all sampled functions lie in the samples' boxes.
class Claimed {
 public:
  explicit Claimed(const Expression& sampled) {
    std::vector<Expression> inputs;
    for (const Node* node : topological_order({&sampled, 1})) {
      const auto* function = dynamic_cast<const SampledFunction*>(node->operation.get());
      for (int k = 0; function && k < node->arity; ++k) {
        if (goes_on(*function, k)) continue;
        inputs.push_back(node->inputs[size_t(k)]);
        boxes_.push_back(function->samples().grid().box[size_t(k)]);
      }
    }
    inputs_ = Evaluator(inputs);
  }
  bool contains(const Vec3& point) const {
    std::vector<double> values(boxes_.size());
    inputs_.values(point, values.data());
    for (size_t k = 0; k < values.size(); ++k) {
      if (!boxes_[k].contains(values[k])) return false;
    }
    return true;
  }

 private:
  Evaluator inputs_;
  std::vector<Interval> boxes_;
};

void measure(FieldError& error, const Expression& exact, const Expression& sampled,
             const BoundingBox& bounds, const Progress& progress) {
  std::mt19937_64 random(1);
  const Claimed claimed(sampled);
  std::vector<Vec3> points;
  for (size_t i = 0; i < random_points; ++i) {
    Vec3 p;
    for (int k = 0; k < 3; ++k) {
      p[k] = bounds.lo[k] + double(random() >> 11) * 0x1p-53 * (bounds.hi[k] - bounds.lo[k]);
    }
    if (claimed.contains(p)) points.push_back(p);
  }
  error.points = points.size();
  if (points.empty()) return;
  const std::array<Expression, 2> both{exact, sampled};
  std::vector<double> values(2 * points.size());
  Evaluator(both).values(points[0].data(), points.size(), values.data(), progress);
  Interval all{infinity, -infinity};
  for (size_t i = 0; i < points.size(); ++i) {
    if (!std::isfinite(values[2 * i])) continue;  // no exact value to differ from
    all = hull(all, values[2 * i]);
    const double here = std::abs(values[2 * i] - values[2 * i + 1]);
    error.measured = max(error.measured, here < infinity ? here : infinity);
  }
  if (all.lo <= all.hi) error.spread = all.hi - all.lo;
}

}  // namespace

std::vector<FieldError> errors_of_fields(std::span<const Expression> exact,
                                         std::span<const Expression> sampled,
                                         const BoundingBox& bounds, const Progress& progress) {
  std::vector<FieldError> out(exact.size());
  const double fields = double(std::max(size_t(1), exact.size()));
  for (size_t i = 0; i < exact.size(); ++i) {
    Progress here;
    if (progress) here = [&](double) { return progress(double(i) / fields); };
    if (here && !here(0)) throw Cancelled();
    if (exact[i] == sampled[i]) {
      out[i].proven = 0;
      continue;
    }
    out[i].proven = Proof(sampled[i], most_steps / fields).bound(bounds, here);
    measure(out[i], exact[i], sampled[i], bounds, here);
  }
  if (progress && !progress(1)) throw Cancelled();
  return out;
}

std::string StatedError::sentence() const {
  const std::string measured =
      bound_text(error.measured) + " (measured at " + std::to_string(error.points) + " points)";
  if (error.says_something()) {
    return name + ": differs from the exact one by at most " + bound_text(error.proven) +
           " (proven), " + measured;
  }
  return name + ": differs from the exact one by " + measured + "; not bounded: what is proven, " +
         bound_text(error.proven) + ", is no less than its values differ, " +
         bound_text(error.spread);
}

}  // namespace sardf::povray

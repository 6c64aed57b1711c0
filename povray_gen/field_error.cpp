#include "povray_gen/field_error.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <queue>
#include <random>

#include "povray_gen/names.hpp"
#include "povray_gen/sampled_function.hpp"
#include "sardf/operation_of.hpp"
#include "sardf/ops_domain.hpp"
#include "sardf/spline_operation.hpp"

namespace sardf::povray {

namespace {

constexpr size_t random_points = 8192;
constexpr int most_bounds = 8192;
// The way from exact to sampled values is cut into so many windows, to either side.
constexpr int windows = 8;
// Of operations over intervals, for all fields together: a few seconds.
constexpr double most_steps = 1e6;
// A bound over parts is never less than that at a point.
constexpr double close_enough = 1.02;

/// A value on its way from exact (t = 0) to sampled (t = 1): all values in between, and its
/// derivative by t, cut into the shares of up to three sampled functions, each from -share to
/// +share.
struct Change {
  Slope slope;
  bool moves = false;  // whether it depends on t at all
};

const SampledFunction* sampled_in(const Instruction& instruction) {
  return dynamic_cast<const SampledFunction*>(instruction.operation);
}

// Their slopes are those between jumps that others hide, as long as this input stays where it is.
bool jumps_along_its_first_input(const Operation& operation) {
  return dynamic_cast<const OperationOf<Below>*>(&operation) ||
         dynamic_cast<const OperationOf<CopyCoordinate>*>(&operation);
}

// Whether beyond the samples' box in this input the exact function goes on as they do: that of a
// spline ends where the spline's ends, or where inputs do.
bool goes_on(const SampledFunction& sampled, int input) {
  const std::optional<SplineReach> reach = spline_reach(sampled.exact());
  return reach && !reach->jumps[size_t(input)];
}

// NaN bounds come of inf - inf.
Interval known(const Interval& a) { return a.lo <= a.hi ? a : Interval::all(); }

double width(const Interval& a) {
  const double w = rounded_up(a.hi - a.lo);
  return w >= 0 ? w : infinity;
}

/// One field as a tape, whose sampled functions are the sources of its error.
class ErrorTape {
 public:
  explicit ErrorTape(const Expression& sampled) : tape_(sampled) {
    for (const Instruction& i : tape_.instructions()) sources_ += sampled_in(i) != nullptr;
    registers_.resize(tape_.registers());
  }

  /// Of one bound over a box, in operations.
  double steps() const { return double(tape_.instructions().size()) * double(passes()); }

  struct Bound {
    double error = 0;
    Interval values;  // exact and sampled ones
  };
  /// Where points are, and where there is one sampled function only, its exact values.
  struct Domain {
    BoundingBox box;
    Interval exact = Interval::all();
  };
  /// Nothing where no point of the domain has its inputs in the samples' boxes.
  std::optional<Bound> over(const Domain& domain) { return over(domain, {-1, 1}, 1); }

  bool has_windows() const { return sources_ == 1; }
  /// The mean over the windows of the way, to the worse side: a kink somewhere on the way does not
  /// count for all of it. After over() for the same domain.
  double over_windows(const Domain& domain) {
    double worst = 0;
    for (int side : {-1, 1}) {
      double sum = 0;
      for (int i = 0; i < windows; ++i) {
        const double near = side * double(i) / windows, far = side * double(i + 1) / windows;
        const auto bound = over(domain, {min(near, far), max(near, far)}, 1.0 / windows);
        if (bound) sum = rounded_up(sum + bound->error);
      }
      worst = max(worst, sum);
    }
    return worst;
  }
  /// The exact values of the one sampled function in the last domain.
  const Interval& exact_values() const { return exact_values_; }
  /// Its error there.
  double source_error() const { return source_error_; }

 private:
  int passes() const { return (sources_ + 2) / 3; }

  // `window`: of the way from exact to sampled values, in errors; `share` of it that is gone there.
  std::optional<Bound> over(const Domain& domain, const Interval& window, double share) {
    window_ = window;
    exact_part_ = domain.exact;
    Bound out;
    for (int pass = 0; pass < passes(); ++pass) {
      if (!run(domain.box, 3 * pass)) return std::nullopt;
      const Slope& slope = registers_[tape_.outputs()[0]].slope;
      const double shares = std::sqrt(double(std::min(3, sources_ - 3 * pass)));
      double sum = 0;
      for (const Interval& partial : slope.partial) sum = rounded_up(sum + partial.magnitude());
      if (std::isnan(sum)) sum = infinity;
      const double by_length = rounded_up(shares * slope.length, 4);
      out.error = rounded_up(out.error + (by_length < sum ? by_length : sum));
      out.values = slope.value;
    }
    out.error = min(rounded_up(out.error * share), width(out.values));
    return out;
  }

  // The derivatives by the sources first, first + 1 and first + 2. False: no point counts.
  bool run(const BoundingBox& box, int first) {
    for (int axis = 0; axis < 3; ++axis) {
      registers_[axis] = {{Interval(box.lo[axis], box.hi[axis]), {}, 0}, false};
    }
    for (const Tape::Constant& c : tape_.constants()) registers_[c.reg] = {{c.value, {}, 0}, false};
    int source = -first;
    for (const Instruction& i : tape_.instructions()) {
      const OperationInfo& info = i.operation->info();
      std::array<Slope, max_arity> in;
      bool moves = false;
      for (int k = 0; k < info.arity; ++k) {
        in[k] = registers_[i.in[k]].slope;
        moves = moves || registers_[i.in[k]].moves;
      }
      Change& out = registers_[i.out];
      if (const SampledFunction* sampled = sampled_in(i)) {
        const std::optional<Slope> slope = of_samples(*sampled, in, moves, source++);
        if (!slope) return false;
        out = {*slope, true};
        continue;
      }
      out = {moves ? i.operation->slope(in.data()) : fixed(i, in), moves};
      if (registers_[i.in[0]].moves && jumps_along_its_first_input(*i.operation)) {
        out.slope = anything(out.slope.value);
      }
    }
    return true;
  }

  static Slope fixed(const Instruction& instruction, const std::array<Slope, max_arity>& in) {
    std::array<Interval, max_arity> values;
    for (int k = 0; k < max_arity; ++k) values[size_t(k)] = in[size_t(k)].value;
    return {instruction.operation->interval(values.data()), {}, 0};
  }

  static Slope anything(const Interval& value) {
    return {value, {Interval::all(), Interval::all(), Interval::all()}, infinity};
  }

  // s(inputs at t) - (1 - t) (s - f)(exact inputs), for the samples s of f: it goes from f to s.
  std::optional<Slope> of_samples(const SampledFunction& sampled,
                                  const std::array<Slope, max_arity>& in, bool moves, int axis) {
    std::array<Interval, max_arity> inside;
    for (int k = 0; k < sampled.info().arity; ++k) {
      const Interval& box = sampled.samples().grid().box[size_t(k)];
      inside[k] = intersect(known(in[k].value), box);
      if (inside[k].lo <= inside[k].hi) continue;
      if (!goes_on(sampled, k)) return std::nullopt;
      inside[k] = in[k].value.hi < box.lo ? box.lo : box.hi;
    }
    Interval exact = sampled.exact().interval(inside.data());
    Interval all = hull(exact, sampled.interval(inside.data()));
    const double error = min(sampled.error().proven, width(all));
    if (has_windows()) {
      exact = intersect(exact, exact_part_);
      if (!(exact.lo <= exact.hi)) return std::nullopt;
      exact_values_ = exact;
      source_error_ = error;
      const Interval here = intersect(all, exact + Interval(error) * window_);
      if (here.lo <= here.hi) all = here;
    }
    Slope out = sampled.slope(in.data());
    out.value = moves ? out.value + Interval{-error, error} : all;
    if (!moves) out = {out.value, {}, 0};
    if (axis < 0 || axis > 2) return out;
    if (!(error < infinity)) return anything(out.value);
    out.partial[size_t(axis)] = out.partial[size_t(axis)] + Interval(error);
    out.length = rounded_up(out.length + error);
    return out;
  }

  Tape tape_;
  int sources_ = 0;
  Interval window_, exact_part_, exact_values_;
  double source_error_ = 0;
  std::vector<Change> registers_;
};

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
      if (tape_.has_windows() && !worst.by_windows) {
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
  double over_windows(const Domain& domain) {
    used_ += 2 * windows;
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
  // by the value, of which alone most fields depend, down to a part of its error.
  Parts halves(const Part& worst) {
    const Parts in_space = bounded(worst, halves_in_space(worst.domain));
    if (!tape_.has_windows() || !over(worst.domain)) return in_space;
    const Interval values = tape_.exact_values();
    if (!(values.lo < values.hi && width(values) < infinity)) return in_space;
    const Parts by_value = bounded(worst, halves_by_value(worst.domain, values));
    const double a = max(in_space[0].error, in_space[1].error);
    const double b = max(by_value[0].error, by_value[1].error);
    const bool wide = width(values) > tape_.source_error() / 4;
    return b < a || (!(a < b) && wide) ? by_value : in_space;
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

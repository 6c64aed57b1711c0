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
constexpr int most_parts = 512;
// Of operations over intervals, for all fields together: a few seconds.
constexpr double most_steps = 5e5;
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
  /// Nothing where no point of the box has its inputs in the samples' boxes.
  std::optional<Bound> over(const BoundingBox& box) {
    Bound out;
    for (int pass = 0; pass < passes(); ++pass) {
      if (!run(box, 3 * pass)) return std::nullopt;
      const Slope& slope = registers_[tape_.outputs()[0]].slope;
      const double shares = std::sqrt(double(std::min(3, sources_ - 3 * pass)));
      double sum = 0;
      for (const Interval& partial : slope.partial) sum = rounded_up(sum + partial.magnitude());
      if (std::isnan(sum)) sum = infinity;
      const double by_length = rounded_up(shares * slope.length, 4);
      out.error = rounded_up(out.error + (by_length < sum ? by_length : sum));
      out.values = slope.value;
    }
    out.error = min(out.error, width(out.values));
    return out;
  }

 private:
  int passes() const { return (sources_ + 2) / 3; }

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
  static std::optional<Slope> of_samples(const SampledFunction& sampled,
                                         const std::array<Slope, max_arity>& in, bool moves,
                                         int axis) {
    std::array<Interval, max_arity> inside;
    for (int k = 0; k < sampled.info().arity; ++k) {
      const Interval& box = sampled.samples().grid().box[size_t(k)];
      inside[k] = intersect(known(in[k].value), box);
      if (inside[k].lo <= inside[k].hi) continue;
      if (!goes_on(sampled, k)) return std::nullopt;
      inside[k] = in[k].value.hi < box.lo ? box.lo : box.hi;
    }
    const Interval all =
        hull(sampled.exact().interval(inside.data()), sampled.interval(inside.data()));
    const double error = min(sampled.error().proven, width(all));
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
  std::vector<Change> registers_;
};

struct Part {
  BoundingBox box;
  double error;
  bool operator<(const Part& other) const { return error < other.error; }
};

std::array<BoundingBox, 2> halves(const BoundingBox& box) {
  const Vec3 size = box.size();
  const size_t axis = size_t(std::max_element(size.begin(), size.end()) - size.begin());
  std::array<BoundingBox, 2> parts{box, box};
  parts[0].hi[axis] = parts[1].lo[axis] = box.center()[axis];
  return parts;
}

void prove(FieldError& error, const Expression& sampled, const BoundingBox& bounds, double steps,
           const Progress& progress) {
  ErrorTape tape(sampled);
  // The whole, and three boxes for each further part: its halves and a point.
  const int parts = int(std::clamp(steps / (3 * tape.steps()), 1.0, double(most_parts)));
  const std::optional<ErrorTape::Bound> whole = tape.over(bounds);
  if (!whole) return;
  std::priority_queue<Part> pending;
  pending.push({bounds, whole->error});
  double least = 0;
  for (int used = 1; used < parts; ++used) {
    const Part worst = pending.top();
    if (worst.error <= close_enough * least) break;
    pending.pop();
    if (progress && !progress(0)) throw Cancelled();
    const Vec3 center = worst.box.center();
    if (const auto at = tape.over({center, center})) least = max(least, at->error);
    for (const BoundingBox& half : halves(worst.box)) {
      const std::optional<ErrorTape::Bound> bound = tape.over(half);
      // A part is never worse than the whole.
      pending.push({half, bound ? min(worst.error, bound->error) : 0});
    }
  }
  error.proven = pending.top().error;
}

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
    prove(out[i], sampled[i], bounds, most_steps / fields, here);
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

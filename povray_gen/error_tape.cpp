#include "povray_gen/error_tape.hpp"

#include <algorithm>
#include <cmath>

#include "sardf/operation_of.hpp"
#include "sardf/ops_domain.hpp"
#include "sardf/spline_operation.hpp"

namespace sardf::povray {

namespace {

const SampledFunction* sampled_in(const Instruction& instruction) {
  return dynamic_cast<const SampledFunction*>(instruction.operation);
}

// Their slopes are those between jumps that others hide, as long as this input stays where it is.
bool jumps_along_its_first_input(const Operation& operation) {
  return dynamic_cast<const OperationOf<Below>*>(&operation) ||
         dynamic_cast<const OperationOf<CopyCoordinate>*>(&operation);
}

// NaN bounds come of inf - inf.
Interval known(const Interval& a) { return a.lo <= a.hi ? a : Interval::all(); }

Slope fixed(const Instruction& instruction, const std::array<Slope, max_arity>& in) {
  std::array<Interval, max_arity> values;
  for (int k = 0; k < max_arity; ++k) values[size_t(k)] = in[size_t(k)].value;
  return {instruction.operation->interval(values.data()), {}, 0};
}

Slope anything(const Interval& value) {
  return {value, {Interval::all(), Interval::all(), Interval::all()}, infinity};
}

}  // namespace

bool goes_on(const SampledFunction& sampled, int input) {
  const std::optional<SplineReach> reach = spline_reach(sampled.exact());
  return reach && !reach->jumps[size_t(input)];
}

double width(const Interval& a) {
  const double w = rounded_up(a.hi - a.lo);
  return w >= 0 ? w : infinity;
}

ErrorTape::ErrorTape(const Expression& sampled) : tape_(sampled) {
  for (const Instruction& i : tape_.instructions()) sources_ += sampled_in(i) != nullptr;
  registers_.resize(tape_.registers());
}

double ErrorTape::over_windows(const Domain& domain) {
  double worst = 0;
  for (int side : {-1, 1}) {
    double sum = 0;
    for (int i = 0; i < error_windows; ++i) {
      const double near = side * double(i) / error_windows,
                   far = side * double(i + 1) / error_windows;
      const auto bound = over(domain, {min(near, far), max(near, far)}, 1.0 / error_windows);
      if (bound) sum = rounded_up(sum + bound->error);
    }
    worst = max(worst, sum);
  }
  return worst;
}

std::optional<ErrorTape::Bound> ErrorTape::over(const Domain& domain, const Interval& window,
                                                double share) {
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

bool ErrorTape::run(const BoundingBox& box, int first) {
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

std::optional<Slope> ErrorTape::of_samples(const SampledFunction& sampled,
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

}  // namespace sardf::povray

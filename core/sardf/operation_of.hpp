// Everything about an operation, derived from one struct.
//
// The struct has:
//   static constexpr const char* name, *doc;
//   static constexpr Kind kind;
//   static constexpr int arity;
//   template <class T> T eval(T, ...) const;       the formula, in `arity` arguments
//   template <class V> static void parameters(V& v);
//                                      v(Parameter{...}, &Op::member) for each member
// and may have:
//   void prepare();                    derived members, after the parameters are set; throws Error
//   static constexpr bool distance = true;         exact Euclidean distance in its inputs
//   static constexpr std::array<int, arity> monotone;
//                                      sign of each partial derivative everywhere
//   std::array<Interval, arity> partials(const std::array<Interval, arity>&) const;
//                                      encloses its partial derivatives better than the formula
//   std::array<double, arity> top() const;
//                                      of a distance that falls with the distance from here along
//                                      each axis: it is enclosed by its values at two corners
//   double gain(Interval, ...) const;  bound of the sum of |partials|
//   double steepness(Interval x, Interval y, double longer, Interval product) const;
//                                      of a blend: bound of the gradient's length where those of
//                                      x and y are at most `longer` and have this scalar product
//   std::optional<Op> near(Choice, Choice) const;  the same over these ranges for less work
//   void append_edges(std::vector<double>&) const; what tells such an operation from the whole one
//   double blend_error() const;        bound of |this - its min/max counterpart|
//   static constexpr Join join;        which boolean of a blend it is
//   static constexpr bool mean_value = true;       its slopes bound it better than its formula
//   static constexpr bool hides_jumps = true;      it jumps, and its slope is that in between
//   static constexpr double rounding = 16;
//                                      rounding error, in ulps of the largest magnitude of
//                                      parameters and result and, for a distance, of arguments
//   static constexpr bool cancels = true;          for a monotone one: of arguments, too
//   using Family = ...;                with whom it is evaluated together (TogetherOf, kernels.hpp)
//   static constexpr int place;        its place there, if all are parts of one formula
#pragma once

#include <algorithm>
#include <cstring>
#include <utility>

#include "sardf/error.hpp"
#include "sardf/kernels.hpp"
#include "sardf/numbers/choice.hpp"
#include "sardf/numbers/gradient.hpp"
#include "sardf/operation.hpp"
#include "sardf/operation_fate.hpp"
#include "sardf/parameter.hpp"

namespace sardf {

template <class Op, class T, size_t... I>
T apply(const Op& op, const T* in, std::index_sequence<I...>) {
  return op.template eval<T>(in[I]...);
}
template <class Op, class T>
T apply(const Op& op, const T* in) {
  return apply(op, in, std::make_index_sequence<Op::arity>());
}

template <class Op>
constexpr bool is_monotone = requires { Op::monotone; };
template <class Op>
constexpr bool is_exact_distance = requires { Op::distance; };
template <class Op>
constexpr bool is_smooth_function = requires { Op::smooth; };

/// Encloses the scalar product of the gradients of two fields.
Interval scalar_product(const Slope& a, const Slope& b);

/// Bound of |Σ by_k grad in_k|. Gradients that are perpendicular add up as the sides of a right
/// angle, those of which nothing is known as on a line.
double weighted_length(std::span<const Interval> by, std::span<const Slope> in);

/// The largest singular value of the 3-row matrix of intervals, from above: the square root of the
/// greatest row sum of |JᵀJ|, which is tight for rotations and scalings.
double spectral_bound(std::span<const Slope> rows);

template <class Op>
class OperationOf final : public Operation {
 public:
  static constexpr int arity = Op::arity;
  using DualInterval = Gradient<Interval, arity>;

  explicit OperationOf(Op op) : op_(std::move(op)) {
    if constexpr (requires { op_.prepare(); }) op_.prepare();
    std::vector<double> measured;
    auto append = [&](const Parameter& parameter, auto member) {
      append_numbers(numbers_, op_.*member);
      if (is_measured(parameter)) append_numbers(measured, op_.*member);
    };
    if constexpr (requires { Op::parameters(append); }) Op::parameters(append);
    for (double a : numbers_) magnitude_ = std::max(magnitude_, std::abs(a));
    for (double a : measured) scale_ = std::max(scale_, std::abs(a));
    if constexpr (requires { op_.append_edges(numbers_); }) op_.append_edges(numbers_);
    std::array<Enclosure, arity> anything;
    anything.fill({Interval::all(), true});
    // A blend may add 0 to one of its arguments: the formula alone does not show that.
    may_be_copy_ = join() != Join::none || choose(anything.data()).origin != Choice::computed;
  }

  static const OperationInfo& static_info() {
    static const OperationInfo info{Op::name, Op::kind, Op::arity, Op::doc};
    return info;
  }
  const OperationInfo& info() const override { return static_info(); }
  const std::vector<double>& numbers() const override { return numbers_; }
  double scale() const override { return scale_; }
  const void* object() const override { return &op_; }
  const Kernels& kernels() const override { return best_kernels<Op>(); }

  double evaluate(const double* in) const override { return apply(op_, in); }

  void evaluate(const double* const* in, double* out, size_t n) const override {
    using L = Lanes<TwoDoubles>;
    const typename KernelsOf<Op, TwoDoubles>::Own op = op_;
    std::array<const double*, arity> from;
    std::copy_n(in, arity, from.begin());
    size_t i = 0;
    for (; i + L::width <= n; i += L::width) {
      std::array<L, arity> at;
      for (int k = 0; k < arity; ++k) at[k] = L::load(from[k] + i);
      apply(op, at.data()).store(out + i);
    }
    for (; i < n; ++i) {
      std::array<double, arity> at;
      for (int k = 0; k < arity; ++k) at[k] = from[k][i];
      out[i] = apply(op, at.data());
    }
  }

  void partials(const double* const* in, double* out, double* const* partial,
                size_t n) const override {
    using L = Lanes<TwoDoubles>;
    const typename KernelsOf<Op, TwoDoubles>::Own op = op_;
    size_t i = 0;
    for (; i + L::width <= n; i += L::width) partials_from<L>(op, i, in, out, partial);
    for (; i < n; ++i) partials_from<double>(op, i, in, out, partial);
  }

  Interval interval(const Interval* in) const override {
    if constexpr (is_monotone<Op>) {
      if (rounding() <= 1 || !may_overflow(in)) return at_end_points(in);
    }
    if constexpr (has_top) {
      if (!may_overflow(in)) return at_corners(in);
    }
    const Interval natural = apply(op_, in);
    if constexpr (is_exact_distance<Op>) {
      return may_overflow(in) ? natural : intersect(natural, around_centre(in));
    }
    if constexpr (requires { Op::mean_value; }) return intersect(natural, by_mean_value(in));
    return natural;
  }

  Slope slope(const Slope* in) const override {
    std::array<Interval, arity> values;
    for (int k = 0; k < arity; ++k) values[k] = in[k].value;
    std::array<Interval, arity> by = local_partials(values.data());
    const double gain = gain_with(by, values.data());
    for (Interval& partial : by) partial = intersect(partial, {-gain, gain});
    Slope out;
    out.value = interval(values.data());
    double steepest = 0;
    for (int k = 0; k < arity; ++k) {
      for (int axis = 0; axis < 3; ++axis) {
        out.partial[axis] = out.partial[axis] + by[k] * in[k].partial[axis];
      }
      if (by[k].magnitude() > 0) steepest = max(steepest, in[k].length);
    }
    const Interval norm = sardf::length(out.partial[0], out.partial[1], out.partial[2]);
    out.length = min(norm.hi, weighted_length(by, {in, size_t(arity)}));
    out.length = min(out.length, rounded_up(times(gain, steepest)));
    if constexpr (is_exact_distance<Op>) {
      out.length = min(out.length, spectral_bound({in, size_t(arity)}));
    }
    if constexpr (requires { op_.steepness(in[0].value, in[1].value, steepest, in[0].value); }) {
      const Interval product = scalar_product(in[0], in[1]);
      out.length = min(out.length, op_.steepness(values[0], values[1], steepest, product));
    }
    const Interval within{-out.length, out.length};
    for (Interval& partial : out.partial) partial = intersect(partial, within);
    return out;
  }

  Enclosure range(const Enclosure* in) const override {
    // Squares of more than this overflow floats.
    constexpr double most = 0x1p60;
    bool is_plain = magnitude_ < most;
    for (int k = 0; k < arity; ++k) {
      is_plain = is_plain && !in[k].may_be_nan && in[k].value.magnitude() < most;
    }
    // Of NaN and infinity the formula itself knows best what it makes.
    if (!is_plain) return natural_range(in);
    std::array<Interval, arity> values;
    for (int k = 0; k < arity; ++k) values[k] = in[k].value;
    if constexpr (is_monotone<Op>) {
      return widened(at_end_points(values.data()), values.data());
    }
    if constexpr (has_top) return {widened(at_corners(values.data()), values.data()).value, false};
    if constexpr (is_exact_distance<Op>) {
      const Interval near = widened(around_centre(values.data()), values.data()).value;
      return {intersect(near, natural_range(in).value), false};
    }
    return natural_range(in);
  }

  Fate fate(const Enclosure* in, const Demand& demand) const override {
    if (!may_be_copy_) return {};
    const auto chosen = [this](const Enclosure* ranges) { return choose(ranges); };
    if constexpr (is_monotone<Op> && arity == 2) {
      std::array<Interval, arity> values{in[0].value, in[1].value};
      const double error = float_error(Interval(largest(values.data())), values.data());
      const auto evaluated = [this](const double* at) { return evaluate(at); };
      return fate_between(in, demand, Op::monotone, magnitude_, error, chosen, evaluated);
    }
    return fate_of(chosen(in));
  }

  OperationPointer narrowed(const Enclosure* in) const override {
    if constexpr (requires(Choice c) { op_.near(c, c); }) {
      auto near = op_.near(Choice::of(in[0].value, in[0].may_be_nan),
                           Choice::of(in[1].value, in[1].may_be_nan));
      if (near) return std::make_shared<OperationOf>(std::move(*near));
    }
    return nullptr;
  }

  double gain(const Interval* in) const override { return gain_with(local_partials(in), in); }

  double blend_error() const override {
    if constexpr (requires { op_.blend_error(); }) return op_.blend_error();
    return 0;
  }
  bool is_distance() const override { return is_exact_distance<Op>; }
  bool is_smooth() const override { return is_smooth_function<Op>; }
  Join join() const override {
    if constexpr (requires { Op::join; }) return Op::join;
    return Join::none;
  }

  void record(Trace& trace) const override {
    std::array<Text, arity> in;
    for (int k = 0; k < arity; ++k) in[k] = Text::at(k);
    trace.result = apply(op_, in.data()).step;
  }

 private:
  /// Value and partials of the points i, i + 1, ... that T holds.
  template <class T>
  static void partials_from(const Op& op, size_t i, const double* const* in, double* out,
                            double* const* partial) {
    using Dual = Gradient<T, arity>;
    std::array<Dual, arity> at;
    for (int k = 0; k < arity; ++k) {
      T value;
      std::memcpy(&value, in[k] + i, sizeof value);
      at[k] = Dual::variable(value, k);
    }
    const Dual result = apply(op, at.data());
    std::memcpy(out + i, &result.v, sizeof result.v);
    for (int k = 0; k < arity; ++k) std::memcpy(partial[k] + i, &result.d[k], sizeof result.d[k]);
  }

  static double times(double a, double b) { return a == 0 || b == 0 ? 0 : a * b; }

  static constexpr bool has_top = requires(const Op& op) { op.top(); };

  static constexpr double rounding() {
    if constexpr (requires { Op::rounding; }) return Op::rounding;
    return 16;
  }

  // Whether an end is so far away that its square overflows: the formula's double is infinite where
  // the real value is not. An infinite end stands for all that is nearer.
  static bool may_overflow(const Interval* in) {
    constexpr double most = 0x1p500;
    const auto is_far = [](double end) { return std::abs(end) >= most && std::isfinite(end); };
    return std::any_of(in, in + arity, [&](Interval i) { return is_far(i.lo) || is_far(i.hi); });
  }

  // Bound of the rounding error of `result`, a value for arguments up to `magnitude`.
  double rounding_error(double magnitude, double result) const {
    const double ulps = rounding();
    if (ulps == 0) return 0;
    // The square of a number below 2^-511 is rounded to a multiple of 2^-1074, and the root of a
    // sum of squares is then wrong by up to 2^-536. One sum or difference has no such error.
    const double underflow = ulps > 1 ? 0x1p-530 : 0;
    return max(max(magnitude_, std::abs(result)), magnitude) * ulps * 0x1p-52 + underflow;
  }

  static double largest(const Interval* in) {
    double magnitude = 0;
    for (int k = 0; k < arity; ++k) magnitude = max(magnitude, in[k].magnitude());
    return magnitude;
  }

  Choice choose(const Enclosure* in) const {
    std::array<Choice, arity> at;
    for (int k = 0; k < arity; ++k) at[k] = Choice::argument(k, in[k].value, in[k].may_be_nan);
    return apply(op_, at.data());
  }
  Enclosure natural_range(const Enclosure* in) const {
    const Choice result = choose(in);
    return {result.range, result.may_be_nan};
  }

  // Bound of the error of a float result for equal inputs: what the law of the kernels allows.
  double float_error(const Interval& result, const Interval* in) const {
    if constexpr (requires { Op::rounding; }) {
      if (Op::rounding == 0) return 0;
      if (Op::rounding == 1) return result.magnitude() * 0x1p-23;
    }
    constexpr double tolerance = 2.2e-6, vanishing = 4e-19;
    return max(max(magnitude_, result.magnitude()), largest(in)) * tolerance + vanishing;
  }
  Enclosure widened(const Interval& result, const Interval* in) const {
    const double error = float_error(result, in);
    const Choice known = Choice::of({result.lo - error, result.hi + error}, false);
    return {known.range, known.may_be_nan};
  }

  Interval at_end_points(const Interval* in) const {
    if constexpr (is_monotone<Op>) {
      std::array<double, arity> low, high;
      for (int k = 0; k < arity; ++k) {
        low[k] = Op::monotone[k] > 0 ? in[k].lo : in[k].hi;
        high[k] = Op::monotone[k] > 0 ? in[k].hi : in[k].lo;
      }
      const double lo = apply(op_, low.data()), hi = apply(op_, high.data());
      // An infinite end can make the formula inf - inf: nothing is known there.
      double magnitude = 0;
      if constexpr (requires { Op::cancels; }) magnitude = largest(in);
      const double below = rounding_error(magnitude, lo), above = rounding_error(magnitude, hi);
      return {std::isnan(lo) || below == infinity ? -infinity : rounded_down(lo - below),
              std::isnan(hi) || above == infinity ? infinity : rounded_up(hi + above)};
    }
    return Interval::all();
  }

  // The least value is that at the corner farthest from the top, the largest that at the nearest.
  Interval at_corners(const Interval* in) const {
    if constexpr (has_top) {
      const std::array<double, arity> top = op_.top();
      std::array<double, arity> far, near;
      for (int k = 0; k < arity; ++k) {
        far[k] = top[k] - in[k].lo > in[k].hi - top[k] ? in[k].lo : in[k].hi;
        near[k] = min(max(top[k], in[k].lo), in[k].hi);
      }
      const double lo = apply(op_, far.data()), hi = apply(op_, near.data());
      // The rounding of the value here and of that at the corner.
      const double below = 2 * rounding_error(largest(in), lo);
      const double above = 2 * rounding_error(largest(in), hi);
      return {std::isnan(lo) || below == infinity ? -infinity : rounded_down(lo - below),
              std::isnan(hi) || above == infinity ? infinity : rounded_up(hi + above)};
    }
    return Interval::all();
  }

  // f(centre) + Σ partial · (input - centre), which holds all values of a smooth function.
  Interval by_mean_value(const Interval* in) const {
    std::array<Interval, arity> centre;
    for (int k = 0; k < arity; ++k) centre[k] = in[k].lo + 0.5 * (in[k].hi - in[k].lo);
    const std::array<Interval, arity> by = local_partials(in);
    Interval all = apply(op_, centre.data());
    for (int k = 0; k < arity; ++k) all = all + by[k] * (in[k] - centre[k]);
    return std::isfinite(all.lo) && std::isfinite(all.hi) ? all : Interval::all();
  }

  Interval around_centre(const Interval* in) const {
    std::array<double, arity> centre;
    double squared = 0;
    for (int k = 0; k < arity; ++k) {
      centre[k] = in[k].lo + 0.5 * (in[k].hi - in[k].lo);
      const double half = max(in[k].hi - centre[k], centre[k] - in[k].lo);
      squared += half * half;
    }
    const double f = apply(op_, centre.data());
    const double radius = std::sqrt(squared) * (1 + 8 * 0x1p-52) + rounding_error(largest(in), f);
    if (!(radius < infinity) || std::isnan(f)) return Interval::all();
    return {rounded_down(f - radius), rounded_up(f + radius)};
  }

  std::array<Interval, arity> local_partials(const Interval* in) const {
    std::array<Interval, arity> by = natural_partials(in);
    for (int k = 0; k < arity; ++k) {
      // A NaN bound comes of inf - inf: nothing is known.
      if (!(by[k].lo <= by[k].hi)) by[k] = Interval::all();
      if constexpr (is_exact_distance<Op>) by[k] = intersect(by[k], {-1, 1});
      if constexpr (is_monotone<Op>) {
        by[k] =
            intersect(by[k], Op::monotone[k] > 0 ? Interval{0, infinity} : Interval{-infinity, 0});
      }
    }
    return by;
  }

  std::array<Interval, arity> natural_partials(const Interval* in) const {
    if constexpr (requires(std::array<Interval, arity> values) { op_.partials(values); }) {
      std::array<Interval, arity> values;
      std::copy_n(in, arity, values.begin());
      return op_.partials(values);
    } else {
      std::array<DualInterval, arity> at;
      for (int k = 0; k < arity; ++k) at[k] = DualInterval::variable(in[k], k);
      return apply(op_, at.data()).d;
    }
  }

  double gain_with(const std::array<Interval, arity>& partials, const Interval* in) const {
    if constexpr (requires { gain_of(op_, in, std::make_index_sequence<arity>()); }) {
      return gain_of(op_, in, std::make_index_sequence<arity>());
    }
    double sum = 0;
    for (const Interval& by : partials) sum = rounded_up(sum + by.magnitude());
    return sum;
  }

  template <class O, size_t... I>
  static auto gain_of(const O& op, const Interval* in, std::index_sequence<I...>)
      -> decltype(op.gain(in[I]...)) {
    return op.gain(in[I]...);
  }

  Op op_;
  std::vector<double> numbers_;
  double magnitude_ = 0;
  double scale_ = 0;
  bool may_be_copy_ = false;
};

/// Makes the operation from a struct whose parameters are set.
template <class Op>
OperationPointer make_operation(Op op) {
  return std::make_shared<OperationOf<Op>>(std::move(op));
}

}  // namespace sardf

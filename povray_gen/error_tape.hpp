// A field as a tape, over which the errors of its sampled functions are passed on.
#pragma once

#include <optional>
#include <vector>

#include "povray_gen/sampled_function.hpp"
#include "sardf/evaluate.hpp"

namespace sardf::povray {

/// The way from exact to sampled values is cut into so many windows, to either side.
inline constexpr int error_windows = 8;

/// Whether beyond the samples' box in this input the exact function goes on as they do: that of a
/// spline ends where the spline's ends, or where inputs do.
bool goes_on(const SampledFunction& sampled, int input);

/// At least the width; infinite where that is not known.
double width(const Interval& a);

/// One field as a tape, whose sampled functions are the sources of its error.
class ErrorTape {
 public:
  explicit ErrorTape(const Expression& sampled);

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

  /// As if all of the way were as steep as its first window: for choosing where to cut.
  std::optional<Bound> near(const Domain& domain) {
    return over(domain, {0, 1.0 / error_windows}, 1);
  }

  bool has_windows() const { return sources_ == 1; }
  /// The mean over the windows of the way, to the worse side: a kink somewhere on the way does not
  /// count for all of it. After over() for the same domain.
  double over_windows(const Domain& domain);
  /// The exact values of the one sampled function in the last domain.
  const Interval& exact_values() const { return exact_values_; }
  /// Its error there.
  double source_error() const { return source_error_; }

 private:
  // A value on its way from exact (t = 0) to sampled (t = 1): all values in between, and its
  // derivative by t, cut into the shares of up to three sampled functions, each from -share to
  // +share.
  struct Change {
    Slope slope;
    bool moves = false;  // whether it depends on t at all
  };

  int passes() const { return (sources_ + 2) / 3; }

  // `window`: of the way from exact to sampled values, in errors; `share` of it that is gone there.
  std::optional<Bound> over(const Domain& domain, const Interval& window, double share);
  // The derivatives by the sources first, first + 1 and first + 2. False: no point counts.
  bool run(const BoundingBox& box, int first);
  // s(inputs at t) - (1 - t) (s - f)(exact inputs), for the samples s of f: it goes from f to s.
  std::optional<Slope> of_samples(const SampledFunction& sampled,
                                  const std::array<Slope, max_arity>& in, bool moves, int axis);

  Tape tape_;
  int sources_ = 0;
  Interval window_, exact_part_, exact_values_;
  double source_error_ = 0;
  std::vector<Change> registers_;
};

}  // namespace sardf::povray

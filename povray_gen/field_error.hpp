// What the errors of samples make of the fields that are computed from them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sardf/evaluate.hpp"
#include "sardf/progress.hpp"

namespace sardf::povray {

/// How far a field with sampled functions in it is from the exact one, in the field's unit, at the
/// points of the scene's bounds where the inputs of all samples lie in the samples' boxes.
struct FieldError {
  /// A bound, but for the rounding of doubles; infinite where none is proven.
  double proven = infinity;
  double measured = 0;  ///< the largest at `points` random points; infinite: a value is NaN
  size_t points = 0;
  double spread = 0;  ///< between the largest and the smallest exact value at these points
  /// Only a bound says something that is less than what the values differ anyway.
  bool says_something() const { return proven < spread; }
};

/// The errors of the sampled counterparts of exact expressions (sampling.hpp); 0 at 0 points for
/// those without samples. Proven: on the straight way from exact to sampled values, by the mean
/// value theorem, the field changes by no more than the sum over all sampled functions of their
/// errors times a bound of the field's derivative by that function's value. That is bounded over
/// parts of the bounds, which are cut where it is largest. Throws Cancelled.
std::vector<FieldError> errors_of_fields(std::span<const Expression> exact,
                                         std::span<const Expression> sampled,
                                         const BoundingBox& bounds, const Progress& progress = {});

struct StatedError {
  std::string name;
  FieldError error;
  /// "NAME: differs from the exact one by at most 0.01 (proven), 0.003 (measured at 8192 points)",
  /// or that and why no bound is stated.
  std::string sentence() const;
};

}  // namespace sardf::povray

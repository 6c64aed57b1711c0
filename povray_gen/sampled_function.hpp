// An operation without a formula as POV-Ray evaluates it: sampled, with its error.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "povray_gen/samples.hpp"
#include "sardf/data_operation.hpp"

namespace sardf::povray {

/// How far the interpolated samples are from the exact function inside the grid's box.
struct SampleError {
  double proven = infinity;  ///< a bound; infinite where the function has no bounded slope
  double measured = 0;       ///< the largest at `points` points between the samples
  size_t points = 0;
  double aimed = 0;  ///< what the number of samples was chosen for
};

/// In place of the exact operation in an expression it makes of it the very function that POV-Ray
/// evaluates, so that bounds of that one's slope can be proven as for any other.
class SampledFunction final : public DataOperation {
 public:
  /// `file`: the name of the density file, no folder.
  SampledFunction(OperationPointer exact, std::shared_ptr<const Samples> samples,
                  const SampleError& error, std::string file);

  const Samples& samples() const { return *samples_; }
  const SampleError& error() const { return error_; }
  const Operation& exact() const { return *exact_; }
  const std::string& file() const { return file_; }
  /// A sentence for users: how many samples, in which file, and the error.
  std::string description() const;

  using DataOperation::evaluate;
  void evaluate(const double* const* in, double* out, size_t n) const override;
  void partials(const double* const* in, double* out, double* const* partial,
                size_t n) const override;
  Interval interval(const Interval* in) const override;
  Slope slope(const Slope* in) const override;

 private:
  Slope sampled_over(const Interval* in) const;
  Vec3 point(const double* const* in, size_t i) const;

  OperationPointer exact_;
  std::shared_ptr<const Samples> samples_;
  SampleError error_;
  std::string file_;
};

using SampledPointer = std::shared_ptr<const SampledFunction>;

}  // namespace sardf::povray

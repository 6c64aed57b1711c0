// One operation sampled until its error is small enough.
#pragma once

#include <functional>

#include "povray_gen/sampling.hpp"

namespace sardf::povray {

class Sampler {
 public:
  /// Over the box of inputs. Throws Error for an operation of more than three inputs.
  Sampler(OperationPointer operation, const std::array<Interval, 3>& box);

  struct Result {
    std::shared_ptr<const Samples> samples;
    SampleError error;
  };
  /// `aimed`: the error; of operations that are no distances, as a share of the range of values.
  /// Reports up to `progress_end`.
  Result sample(double aimed, double most_samples, Work& work, double progress_end);

 private:
  /// `step`: of a distance, whose inputs are lengths, as a share of the longest side, else of each
  /// side.
  SampleGrid grid_of(double step) const;
  /// The smallest step whose grid needs no more stored samples.
  double finest_step(double most_samples) const;
  std::unique_ptr<double[]> values(size_t n, const std::function<Vec3(size_t)>& point,
                                   Work& work) const;
  [[noreturn]] void complain_of(const Vec3& point) const;
  double proven_error(const SampleGrid& grid) const;
  SampleError error_of(const Samples& samples, Work& work) const;

  OperationPointer operation_;
  std::array<Interval, 3> box_;
  Evaluator evaluator_;
  double lipschitz_;
  std::array<double, 3> curvature_;  // bounds of the second derivatives by each input
};

}  // namespace sardf::povray

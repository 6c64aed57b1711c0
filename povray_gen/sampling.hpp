// Operations without a formula become sampled functions: where, how finely, and how exactly.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "povray_gen/sampled_function.hpp"
#include "sardf/evaluate.hpp"

namespace sardf::povray {

struct SamplingOptions {
  /// The error aimed at: this share of the scene's diagonal for a distance, in scene units on
  /// its way through the inputs; of the range of values for other functions. Half a pixel of a
  /// picture 640 wide that the scene fills is 1/1280 of its diagonal.
  double error_share = 1.0 / 2000;
  /// For each function; 256³ samples are 64 MiB. The error aimed at may not be reached.
  double most_samples = 256.0 * 256 * 256;
  /// Else fields are left out that need samples which the picture does not (scene_samples.hpp).
  bool all_fields = true;
  Progress progress = {};
};

/// Whether the node has no formula.
bool is_sampled(const Node& node);

struct Sampling {
  std::vector<Expression> expressions;  ///< as given, with sampled functions in them
  std::vector<SampledPointer> functions;
};

/// Samples every operation without a formula that the expressions need, equal ones once, over all
/// that its inputs can be within the bounds and 1/1000 of the diagonal around them; of a spline on
/// a box, no farther than the box. The density files are named STEM_sampled_1.df3, _2, ... Throws
/// Error naming the operation where an input has no finite bounds or a value is not finite;
/// Cancelled.
Sampling sample_operations(std::span<const Expression> expressions, const BoundingBox& bounds,
                           const std::string& stem, const SamplingOptions& options);

}  // namespace sardf::povray

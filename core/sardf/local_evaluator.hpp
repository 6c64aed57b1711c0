// Evaluation of blocks of points that lie close together, by programs shortened for where they lie
// (shorten.hpp).
//
// Programs are made when so many points have been evaluated around a place that finding out does
// not count. Values are the same to the bit, whichever program makes them; gradients that a whole
// program lacks do not depend on what was evaluated before either, or on the order in which threads
// come by.
#pragma once

#include <memory>

#include "sardf/evaluate.hpp"

namespace sardf {

namespace local {
class Cube;
struct Experience;
}  // namespace local

class LocalEvaluator {
 public:
  LocalEvaluator();
  /// Points within the box have programs of their own; evaluation is right everywhere.
  LocalEvaluator(Evaluator whole, const BoundingBox& box);
  ~LocalEvaluator();
  LocalEvaluator(LocalEvaluator&&) noexcept;
  LocalEvaluator& operator=(LocalEvaluator&&) noexcept;

  const Evaluator& whole() const { return whole_; }
  size_t outputs() const { return whole_.outputs(); }

  /// As Evaluator::block. Any number of threads at once.
  void block(const float* x, const float* y, const float* z, size_t n, float* const* out) const;
  void block(const double* x, const double* y, const double* z, size_t n, double* const* out) const;
  /// As Evaluator::gradient_block, but that 0 has no sign, and that gradients may be numbers where
  /// those of the whole program are NaN: what is found not to vary has the derivative 0. `out` is
  /// not null.
  void gradient_block(const float* x, const float* y, const float* z, size_t n, float* out,
                      float* const* gradient) const;

 private:
  Evaluator whole_;
  std::unique_ptr<local::Experience> experience_;
  std::unique_ptr<local::Cube> root_;  // none: the whole program is what evaluates
  double long_work_ = 0;               // instructions times points that are worth sorting
  int gradient_levels_ = 0;            // of the octree
};

}  // namespace sardf

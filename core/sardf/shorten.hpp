// Shorter programs for boxes: what cannot matter there is left out.
//
// One pass over the program encloses every value over the box, by intervals and, of exact
// distances, by the value at the centre and the radius; a second one, backwards, finds which
// operations are copies of an input there, and which inputs cannot matter (Operation::fate). In a
// union of many solids that leaves those that can be the nearest one somewhere in the box. It
// applies to minima, maxima, blends out of their bands, selects and whatever else a formula decides
// by comparing. After Barbier et al. 2025, "Lipschitz pruning", and Keeter 2020, "Massively
// parallel rendering of complex closed-form implicit surfaces".
#pragma once

#include <vector>

#include "sardf/evaluate.hpp"

namespace sardf {

/// What of the outputs is needed: all of it, or whether they are negative.
enum class Wanted { values, signs };

/// An evaluator's values over a box, and its program for that box.
class Shortening {
 public:
  /// The evaluator must outlive this object.
  Shortening(const Evaluator& evaluator, const BoundingBox& box);

  /// Encloses output k at all points of the box, in double and in float.
  Interval range(size_t k = 0) const { return ranges_[outputs_[k]].value; }
  /// Whether output k may be no number somewhere in the box.
  bool may_be_nan(size_t k = 0) const { return ranges_[outputs_[k]].may_be_nan; }

  /// The evaluator for points in the box: the same bits in double and in float; of signs, the
  /// outputs are negative at the same points. Gradients are equal, too, but where that of the full
  /// program is NaN: what is found not to vary has the derivative 0 here.
  Evaluator shortened(Wanted wanted = Wanted::values) const;
  /// The same bits where an output lies between the demand's floor and ceiling; where it does not,
  /// that of the shorter program lies beyond the same end.
  Evaluator shortened(const Demand& demand) const;

 private:
  const Tape& tape_;
  uint32_t first_ = 0;                               // number of the first instruction's value
  std::vector<std::array<uint32_t, max_arity>> in_;  // of each instruction: values
  std::vector<uint32_t> outputs_;                    // values
  std::vector<Enclosure> ranges_;                    // of each value
};

}  // namespace sardf

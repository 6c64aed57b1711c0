// Searches of space: boxes in which something may be are halved, and points descend from them.
#pragma once

#include <functional>
#include <vector>

#include "sardf/evaluate.hpp"

namespace sardf {

/// The value of a field at a point, and its gradient; zero where it has none.
struct ValueAndGradient {
  double value = 0;
  Vec3 gradient{};
};
ValueAndGradient value_and_gradient(const Evaluator& field, const Vec3& point);

/// The shortest step on which the value vanishes to first order.
Vec3 newton_step(const ValueAndGradient& at);
/// The shortest step on which both values vanish to first order; the mean of both steps where the
/// gradients are parallel.
Vec3 common_newton_step(const ValueAndGradient& a, const ValueAndGradient& b);

/// Called with a box: whether what is searched for may lie in it, so that it is to be halved.
/// `descends` is true at every sixth halving and for boxes that are not halved any more: points
/// may then be looked for from there.
using LookIntoBox = std::function<bool(const BoundingBox& box, bool descends)>;

/// Halves boxes along their longest sides, larger ones first, down to sides of 1/256 of the
/// diagonal of `whole`, and looks into `most` of them at most. The boxes that were left because of
/// that: where there are none, nothing that intervals see was overlooked down to that size.
/// Throws Cancelled.
std::vector<BoundingBox> search_boxes(const BoundingBox& whole, int most, const Progress& progress,
                                      const LookIntoBox& look);

}  // namespace sardf

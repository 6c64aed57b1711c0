// Certified numbers of a field: how far blending moves it, and how steep it is.
#pragma once

#include <optional>
#include <string>

#include "sardf/evaluate.hpp"

namespace sardf {

/// A proven upper bound. When it is infinite, `infinite_at` is the name of the operation that made
/// it so; otherwise that is empty.
struct CertifiedBound {
  double value = 0;
  std::string infinite_at;
};

/// Bound of |expression - the same tree with min and max in place of its blends| over all of
/// space; 0 for a tree without blends.
CertifiedBound certified_error(const Expression& expression);
double error_bound(const Expression& expression);

/// How much work certified_lipschitz may do.
inline constexpr int default_lipschitz_boxes = 512;

/// Bound L of the first output over the box: |f(p) - f(q)| <= L |p - q| for p and q in it. The box
/// is split where the bound is largest, into at most `boxes` parts, until the bound lies within
/// 0.1 % of a gradient that the field attains. A box with infinite sides is not split.
CertifiedBound certified_lipschitz(const Evaluator& evaluator, const BoundingBox& box,
                                   int boxes = default_lipschitz_boxes);
double lipschitz_bound(const Evaluator& evaluator, const BoundingBox& box,
                       int boxes = default_lipschitz_boxes);

/// How long to look for a bound.
struct BoundEffort {
  int boxes = default_lipschitz_boxes;
  /// A bound that is small enough. A gradient that is longer ends the search, too.
  double enough = 0;
  Progress progress = {};  ///< called with 0, to be able to stop
};

/// The same of min(band, max(-band, f)), that is, of f where |f| <= band; within 3 % of a gradient
/// that is attained there, if so many boxes suffice. Parts below 1/400 of the box's diagonal are
/// not split, since the bound stays as it is at an edge of the solid. Infinity if there is no
/// bound; nothing where it is proven that no value lies in the band. Cancelled.
std::optional<double> band_lipschitz_bound(const Evaluator& evaluator, const BoundingBox& box,
                                           double band, const BoundEffort& effort);

}  // namespace sardf

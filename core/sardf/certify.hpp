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

/// The same of min(band, max(-band, f)): of f where |f| <= band. Parts below 1 % of the box's
/// diagonal are not split, since the bound stays as it is at an edge of the solid. Infinity if
/// there is no bound; nothing where it is proven that no value lies in the band.
std::optional<double> band_lipschitz_bound(const Evaluator& evaluator, const BoundingBox& box,
                                           double band, int boxes);

}  // namespace sardf

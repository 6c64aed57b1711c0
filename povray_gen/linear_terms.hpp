// Linear parts of a formula in as few steps as possible.
#pragma once

#include <utility>

#include "povray_gen/terms.hpp"

namespace sardf::povray {

/// The terms that `root` needs, with those that are linear in the inputs 0, 1 and 2 as
/// a x + b y + c z + d, where that takes fewer operators; and the root. The three inputs are the
/// first terms, needed or not. Values differ by rounding only, that of a sum of the same numbers in
/// another order.
std::pair<Terms, int> with_short_linear_terms(const Terms& terms, int root);

}  // namespace sardf::povray

// Taylor coefficients of a formula of one variable.
#pragma once

#include <string>
#include <vector>

namespace sardf {

/// The coefficients c_0, ..., c_(count-1) of the formula, a function of u, at u = 0: c_k is its
/// k-th derivative over k!. Where it has a kink at 0 they are those of the branch that gives its
/// value there. Error where it depends on more than u, or where a coefficient is not finite (the
/// square root of u from its second term on); the text says which.
std::vector<double> taylor_coefficients(const std::string& formula, int count);

}  // namespace sardf

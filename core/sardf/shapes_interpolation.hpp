// Transfinite interpolation as a field: a rule for values used wherever a field may stand.
#pragma once

#include "sardf/constructor_of.hpp"
#include "sardf/op_list.hpp"

namespace sardf {

/// Σ P_i W_i of any rule for values. With a formula over named fields it gives the general form
/// P + Φ Π u_i^m_i.
/// Source: Biswas, Shapiro, Tsukanov 2004, section 3, eqs. (7) to (10).
struct ValueOf {
  static constexpr const char *name = "value_of", *group = "function",
                              *doc =
                                  "The number that a rule gives, as a field: values on features, "
                                  "interpolated between them. It is no distance.";
  RulePointer rule;
  double scale = 1;
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"rule", "a rule with values, as an attribute has it", Unit::none, Range::any, true},
      &ValueOf::rule);
    v(Parameter{"scale",
                "the size of what is modelled: a point counts as on a feature within 1e-12 of it",
                Unit::length, Range::positive},
      &ValueOf::scale);
  }
  /// Throws Error for a rule that gives fractions, and for one that depends on a scene's fractions.
  Expression expression() const;
  Quality quality() const { return {}; }
};

using InterpolationShapes = OpList<ValueOf>;

}  // namespace sardf

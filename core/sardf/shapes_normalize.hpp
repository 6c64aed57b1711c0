// Normalised fields: they behave as the distance does near where they are 0.
//
// A field w is normalised to order m when at its zeros its normal derivative is 1 and those of
// order 2 to m vanish, so that |w - distance| is of order distance^(m+1). Source: Biswas, Shapiro,
// Tsukanov, "Heterogeneous material modeling with distance fields", section 1.3, eq. (1), after
// Rvachev; joins and trims after Biswas, Shapiro, "Approximate distance fields with non-vanishing
// gradients".
#pragma once

#include "sardf/shapes_combine.hpp"

namespace sardf {

struct Normalized {
  static constexpr const char *name = "normalized", *group = "value",
                              *doc =
                                  "A field with the same zeros, normalised: near them it is the "
                                  "distance, with an error of order distance^(order+1). The first "
                                  "order is f / sqrt(f^2 + |grad f|^2).";
  Field field;
  double order = 1;
  template <class V>
  static void parameters(V& v) {
    v(field_parameter("the field f, smooth at its zeros"), &Normalized::field);
    v(count_of("order", "how well, from 1 to 12"), &Normalized::order);
  }
  Expression expression() const;
  Quality quality() const { return {}; }
};

struct REquivalence {
  static constexpr const char *name = "r_equivalence", *group = "feature",
                              *doc =
                                  "The union of features, smooth away from them: "
                                  "(sum of u_i^-order)^(-1/order), normalised to that order where "
                                  "the distances u_i are. It is never larger than the smallest.";
  std::vector<Field> of;
  double order = 1;
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"of", "the distances", Unit::none, Range::any, true, 1}, &REquivalence::of);
    v(Parameter{"order", "the higher, the nearer to the smallest of them", Unit::none,
                Range::positive},
      &REquivalence::order);
  }
  Expression expression() const;
  Quality quality() const;
};

struct Trimmed {
  static constexpr const char *name = "trimmed", *group = "feature",
                              *doc =
                                  "The part of where a field is 0 that lies in a solid, as a "
                                  "feature normalised to the first order if both fields are: "
                                  "sqrt(f^2 + (sqrt(t^2 + f^4) - t)^2 / 4) for a solid t.";
  Field field, by;
  template <class V>
  static void parameters(V& v) {
    v(field_parameter("the field f"), &Trimmed::field);
    v(field_parameter("the solid t that it is kept in", "by"), &Trimmed::by);
  }
  Expression expression() const;
  Quality quality() const { return {}; }
};

struct TrimmedSegment {
  static constexpr const char *name = "trimmed_segment", *group = "feature",
                              *doc =
                                  "A straight segment as a line that is trimmed by the ball around "
                                  "it: smooth away from it, normalised to the first order.";
  Vec3 a{}, b{0, 0, 1};
  template <class V>
  static void parameters(V& v) {
    v(required_length("a", "one end"), &TrimmedSegment::a);
    v(required_length("b", "the other end"), &TrimmedSegment::b);
  }
  Expression expression() const;
  Quality quality() const { return {}; }
};

using NormalizeShapes = OpList<Normalized, REquivalence, Trimmed, TrimmedSegment>;

}  // namespace sardf

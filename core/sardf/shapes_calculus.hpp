// Substitution, derivatives, and material functions of a distance that are made with them.
//
// Source: Biswas, Shapiro, Tsukanov, "Heterogeneous material modeling with distance fields",
// sections 2.1 and 2.2.
#pragma once

#include "sardf/shapes_combine.hpp"

namespace sardf {

struct At {
  static constexpr const char *name = "at", *group = "transform",
                              *doc =
                                  "A field's values at another point, which three fields give: "
                                  "with [\"=x\", \"=y\", 0] a plane section of it.";
  Field field;
  FieldValues point;
  template <class V>
  static void parameters(V& v) {
    v(field_parameter("the field"), &At::field);
    v(Parameter{"point", "the coordinates x, y, z of the point that it is taken at", Unit::none,
                Range::any, true, 3},
      &At::point);
  }
  Expression expression() const;
  Quality quality() const { return {}; }
};

struct Derivative {
  static constexpr const char *name = "derivative", *group = "function",
                              *doc =
                                  "The derivative of a field along a direction, per scene unit. "
                                  "At a kink it is that of the branch that gives the value; where "
                                  "a length vanishes there is none: NaN.";
  Field field;
  Axis axis;
  template <class V>
  static void parameters(V& v) {
    v(field_parameter("the field"), &Derivative::field);
    v(Parameter{"axis", "the direction", Unit::direction, Range::any, true}, &Derivative::axis);
  }
  Expression expression() const;
  Quality quality() const { return {}; }
};

struct GradientLength {
  static constexpr const char *name = "gradient_length", *group = "function",
                              *doc = "How steep a field is: the length of its gradient.";
  Field field;
  template <class V>
  static void parameters(V& v) {
    v(field_parameter("the field"), &GradientLength::field);
  }
  Expression expression() const;
  Quality quality() const { return {}; }
};

struct NormalDerivative {
  static constexpr const char *name = "normal_derivative", *group = "function",
                              *doc =
                                  "The product of two fields' gradients: for a distance the "
                                  "derivative of the field away from its feature.";
  Field field, distance;
  template <class V>
  static void parameters(V& v) {
    v(field_parameter("the field"), &NormalDerivative::field);
    v(field_parameter("the distance to the feature", "distance"), &NormalDerivative::distance);
  }
  Expression expression() const;
  Quality quality() const { return {}; }
};

/// Source: section 2.2, after eq. (4).
struct Conditioned {
  static constexpr const char *name = "conditioned", *group = "function",
                              *doc =
                                  "A field F made constant along the normals of a feature: F(p - u "
                                  "grad u), for an exact distance u the value at the feature's "
                                  "nearest point. On the feature it is F.";
  Field field, distance;
  template <class V>
  static void parameters(V& v) {
    v(field_parameter("the field"), &Conditioned::field);
    v(field_parameter("the distance u to the feature", "distance"), &Conditioned::distance);
  }
  Expression expression() const;
  Quality quality() const { return {}; }
};

/// Source: section 2.1, eq. (2).
struct CanonicalForm {
  static constexpr const char
      *name = "canonical_form",
      *group = "function",
      *doc =
          "The distance canonical form: the sum of F_k u^k / k! over the "
          "coefficients F_0, F_1, ..., F_m, plus u^(m+1) times a remainder. "
          "F_k is the k-th normal derivative on the feature where the "
          "coefficients are numbers or conditioned.";
  Field distance;
  FieldValues coefficients;
  std::optional<Field> remainder;
  template <class V>
  static void parameters(V& v) {
    v(field_parameter("the distance u to the feature", "distance"), &CanonicalForm::distance);
    v(Parameter{"coefficients",
                "F_0, F_1, ...: the value on the feature and its normal derivatives", Unit::none,
                Range::any, true, 1},
      &CanonicalForm::coefficients);
    v(Parameter{"remainder", "the function that u^(m+1) is multiplied by"},
      &CanonicalForm::remainder);
  }
  Expression expression() const;
  Quality quality() const { return {}; }
};

/// Source: section 2.2, Figs 4 to 6.
struct Taylor {
  static constexpr const char
      *name = "taylor",
      *group = "function",
      *doc =
          "The first terms of the Taylor series, at u = 0, of a function of "
          "the distance u; or some of them, counted from 1.";
  std::string formula;
  Field distance;
  double terms = 1, first_term = 1;
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"formula", "the function of u, such as 'exp(-1.5*u)'", Unit::none, Range::any,
                true},
      &Taylor::formula);
    v(field_parameter("the distance u", "distance"), &Taylor::distance);
    v(count_of("terms", "how many terms, at most 32", true), &Taylor::terms);
    v(count_of("first_term", "the first of them; term k is that of u^(k-1)"), &Taylor::first_term);
  }
  Expression expression() const;
  Quality quality() const { return {}; }
};

using CalculusShapes =
    OpList<At, Derivative, GradientLength, NormalDerivative, Conditioned, CanonicalForm, Taylor>;

}  // namespace sardf

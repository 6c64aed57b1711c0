// The rules: one struct each. The last line is their list.
#pragma once

#include "sardf/fraction_rule_of.hpp"
#include "sardf/op_list.hpp"

namespace sardf {

constexpr Parameter part_parameter(const char* doc) {
  return {"fractions", doc, Unit::none, Range::any, true};
}

struct ConstantFractions {
  static constexpr const char *name = "constant", *doc = "The same mixture everywhere.";
  static constexpr RuleUse use = RuleUse::fractions;
  Shares shares;
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"shares", "the share of each material; their sum is 1", Unit::none, Range::any,
                true, 1},
      &ConstantFractions::shares);
  }
  void check() const;
  std::vector<Expression> values(const Lowering& lowering) const;
};

struct Formulas {
  static constexpr const char *name = "formulas",
                              *doc =
                                  "A function for each material, divided by their sum. Negative "
                                  "values count as 0; where the sum is not positive it is an "
                                  "error that names the place.";
  static constexpr RuleUse use = RuleUse::fractions;
  MaterialFunctions functions;
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"functions", "a field for each material", Unit::none, Range::any, true, 1},
      &Formulas::functions);
  }
  std::vector<Expression> values(const Lowering& lowering) const;
};

/// Source: Biswas, Shapiro, Tsukanov 2004, section 4.2: P^{i,j}, whose sum over the materials j is
/// 1 on every feature i; by Theorem 1 so is then the sum of what is interpolated.
struct FractionFunctions {
  static constexpr const char *name = "functions",
                              *doc =
                                  "A function for each material, not divided by anything: that "
                                  "they sum to 1 is proven, or it is an error. One may be the "
                                  "word \"rest\": 1 minus the others. In the solid they must lie "
                                  "in [0, 1]; outside of it what is less than 0 counts as 0 and "
                                  "the others are scaled to the sum 1.";
  static constexpr RuleUse use = RuleUse::fractions;
  FunctionsOrRest functions;
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"functions", "a field for each material, or \"rest\" for one", Unit::none,
                Range::any, true, 1},
      &FractionFunctions::functions);
  }
  void check() const;
  std::vector<Expression> values(const Lowering& lowering) const;
};

struct AttributeValue {
  static constexpr const char *name = "value", *doc = "A field for each component.";
  static constexpr RuleUse use = RuleUse::values;
  std::vector<Field> components;
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"components", "the components", Unit::none, Range::any, true, 1},
      &AttributeValue::components);
  }
  std::vector<Expression> values(const Lowering& lowering) const;
};

struct NamedComponents {
  static constexpr const char *name = "components",
                              *doc =
                                  "A field for each named component, as of a tensor; wherever the "
                                  "value is written its columns carry the names.";
  static constexpr RuleUse use = RuleUse::values;
  NamedValues components;
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"components", "a field for each name", Unit::none, Range::any, true, 1},
      &NamedComponents::components);
  }
  std::vector<Expression> values(const Lowering& lowering) const;
};

struct OfMaterials {
  static constexpr const char *name = "of_materials",
                              *doc =
                                  "A scalar for each material, averaged by the fractions at the "
                                  "point; a material that is not named counts as 0.";
  static constexpr RuleUse use = RuleUse::values;
  MaterialFunctions functions;
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"functions", "a field for each material", Unit::none, Range::any, true, 1},
      &OfMaterials::functions);
  }
  std::vector<Expression> values(const Lowering& lowering) const;
};

/// Weights (λ_i u_i)^-k_i / Σ_j (λ_j u_j)^-k_j, computed through logarithms.
/// Source: Biswas, Shapiro, Tsukanov 2004, section 3.2 and eqs. (8) and (9).
struct InverseDistance {
  static constexpr const char *name = "inverse_distance",
                              *doc =
                                  "Each feature counts the more the nearer it is: by its "
                                  "distance times its influence, to the power -exponent. On a "
                                  "feature it alone counts; where several meet, they share "
                                  "evenly.";
  static constexpr RuleUse use = RuleUse::both;
  struct Feature {
    FeatureField at;
    Fractions fractions;
    double exponent = 1;
    Influence influence;
    template <class V>
    static void parameters(V& v) {
      v(Parameter{"at", "a feature, or a solid, which counts by the distance outside of it",
                  Unit::none, Range::any, true},
        &Feature::at);
      v(part_parameter("what is there"), &Feature::fractions);
      v(Parameter{"exponent",
                  "how fast its weight falls; with different exponents the result depends on the "
                  "unit of length",
                  Unit::none, Range::positive},
        &Feature::exponent);
      v(Parameter{"influence",
                  "a positive factor of its distance, so that a larger one makes it reach less "
                  "far: a field, or a formula that may use u, the distance to the feature; 1 where "
                  "it is not given; less than 1e-30 counts as 1e-30"},
        &Feature::influence);
    }
  };
  std::vector<Feature> features;
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"features", "the features", Unit::none, Range::any, true, 1},
      &InverseDistance::features);
  }
  std::vector<WeightedPart> parts(double diagonal) const;
};

/// Source: Fayolle, Pasko, Schmitt, Mirenkov 2004, eqs. (6) and (7).
struct BlendBetween {
  static constexpr const char *name = "blend_between",
                              *doc =
                                  "From one solid to another: each counts by the distance "
                                  "outside the other, evenly where both distances are 0.";
  static constexpr RuleUse use = RuleUse::both;
  struct Side {
    FeatureField at;
    Fractions fractions;
    template <class V>
    static void parameters(V& v) {
      v(Parameter{"at", "a solid, or a feature", Unit::none, Range::any, true}, &Side::at);
      v(part_parameter("what is there"), &Side::fractions);
    }
  };
  std::vector<Side> of;
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"of", "the two sides", Unit::none, Range::any, true, 2}, &BlendBetween::of);
  }
  void check() const;
  std::vector<WeightedPart> parts(double diagonal) const;
};

struct Ramp {
  static constexpr const char *name = "ramp",
                              *doc =
                                  "Stops along the values of a field, linear in between; two "
                                  "stops at one value make a step.";
  static constexpr RuleUse use = RuleUse::both;
  struct Stop {
    double at = 0;
    Fractions fractions;
    template <class V>
    static void parameters(V& v) {
      v(Parameter{"at", "value of the field", Unit::none, Range::any, true}, &Stop::at);
      v(part_parameter("what is there"), &Stop::fractions);
    }
  };
  Field field;
  std::vector<Stop> stops;
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"field", "any field", Unit::none, Range::any, true}, &Ramp::field);
    v(Parameter{"stops", "in rising order", Unit::none, Range::any, true, 1}, &Ramp::stops);
  }
  void check() const;
  std::vector<WeightedPart> parts(double diagonal) const;
};

struct Bands {
  static constexpr const char *name = "bands",
                              *doc = "Stripes along the values of a field, repeated without end.";
  static constexpr RuleUse use = RuleUse::both;
  struct Band {
    double width = 1;
    Fractions fractions;
    template <class V>
    static void parameters(V& v) {
      v(Parameter{"width", "how far the field rises across it", Unit::none, Range::positive, true},
        &Band::width);
      v(part_parameter("what is there"), &Band::fractions);
    }
  };
  Field field;
  std::vector<Band> bands;
  double start = 0, blend_width = 0;
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"field", "any field", Unit::none, Range::any, true}, &Bands::field);
    v(Parameter{"bands", "the stripes of one period", Unit::none, Range::any, true, 1},
      &Bands::bands);
    v(Parameter{"start", "value of the field where the first stripe starts"}, &Bands::start);
    v(Parameter{"blend_width",
                "how far the field rises from one stripe to the next, at most the narrowest "
                "stripe; 0: a sharp border",
                Unit::none, Range::non_negative},
      &Bands::blend_width);
  }
  void check() const;
  std::vector<WeightedPart> parts(double diagonal) const;
};

struct Partition {
  static constexpr const char *name = "partition",
                              *doc =
                                  "Parts of space. Where several contain a point, the conflict "
                                  "rule decides; where none does, the one with the largest field "
                                  "counts.";
  static constexpr RuleUse use = RuleUse::both;
  struct Part {
    Field solid;
    Fractions fractions;
    template <class V>
    static void parameters(V& v) {
      v(Parameter{"solid", "the part", Unit::none, Range::any, true}, &Part::solid);
      v(part_parameter("what it is made of"), &Part::fractions);
    }
  };
  std::vector<Part> of;
  std::string conflict = "first";
  double blend_width = 0;
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"of", "the parts", Unit::none, Range::any, true, 1}, &Partition::of);
    v(Parameter{"blend_width",
                "the distance outside a part over which it fades into the others; with 'max' the "
                "difference of depths; 0: a sharp border",
                Unit::length, Range::non_negative},
      &Partition::blend_width);
    v(Parameter{"conflict",
                "which part counts where several contain the point: the 'first' or the 'last', the "
                "'mean' of all of them, or with 'max' the one in which it lies deepest"},
      &Partition::conflict);
  }
  void check() const;
  std::vector<WeightedPart> parts(double diagonal) const;
};

using FractionRules =
    OpList<ConstantFractions, InverseDistance, BlendBetween, Ramp, Bands, Formulas,
           FractionFunctions, Partition, AttributeValue, NamedComponents, OfMaterials>;

}  // namespace sardf

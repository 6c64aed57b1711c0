// What the rules of a scene promise, checked in the solid: functions that are fractions, and
// features that do not contradict each other.
#pragma once

#include <string>
#include <vector>

#include "sardf/evaluate.hpp"
#include "sardf/fractions.hpp"
#include "sardf/scene_source.hpp"

namespace sardf {

/// What is accepted but may not be what is meant, in one sentence.
struct Warning {
  std::string message;
};

/// A rule's fractions or values, and the part of space in which they are asked for.
struct CheckedRule {
  std::string owner;  // "the fractions", "the attribute 'grain'", "the field 'f'"
  Fractions rule;
  Lowering lowering;
};

/// Where the rules are checked.
struct CheckedPlace {
  Expression solid;
  BoundingBox box;
  double tolerance = 0;  // a point is in the solid where its field is at least minus this
  BlendPointer blend;    // joins every boolean of the scene; null: as each says
};

/// A rule inside a rule with the share that it has: 0 where it does not count.
struct PlacedRule {
  Fractions rule;
  Expression share;
};
/// The rule itself and all inside it. What stands at features has the share of the rule that has
/// the features, since none of their weights is 0 anywhere but on other features.
std::vector<PlacedRule> placed_rules(const Fractions& rule, double diagonal);

/// Checks each rule `functions`: their sum is proven to be 1, or it is an Error that says where it
/// is not. A function that is found outside of [0, 1] in the solid is an Error, too; one that
/// cannot be proven to lie in it, to 1e-6, is a warning with the range that is proven. Errors name
/// the place that `source` knows of the rule, or of the one function that is to blame.
std::vector<Warning> check_functions(const CheckedRule& checked, const CheckedPlace& place,
                                     const SceneSource& source, const Progress& progress = {});

/// Two features of a rule that touch, within 1e-9 of the scene's diagonal, at a point of the solid
/// at which they prescribe different values: there the mean of both counts.
struct Contradiction {
  std::string owner;
  Vec3 point{};
  size_t first = 0, second = 0;  // places of the features in the rule, from 0
  std::vector<double> first_values, second_values;
};

/// Searches all rules with features for contradictions, one for each pair. The search halves boxes
/// in which both distances may be 0, to 1/256 of the diagonal, at most 4000 of them for each rule,
/// and descends from them: what it reports is so, but it may overlook a touch.
std::vector<Contradiction> find_contradictions(const CheckedRule& checked,
                                               const CheckedPlace& place,
                                               const Progress& progress = {});

/// "the fractions: features 1 and 2 touch at (0, 0, 0), ..."
Warning warning_of(const Contradiction& found, const std::vector<std::string>& names);

}  // namespace sardf

// What a solid is made of: rules that give the fraction of each material at every point of space.
//
// A rule is described by data like a constructor: name, documentation, parameters. The list of
// rules, fraction_rules(), is what scene files, the schema and the documentation loop over. The
// same rules with values in place of materials describe attributes.
//
// All rules are defined in all of space. Fractions are >= 0 and their sum is 1; only where formulas
// have no positive sum is it 0.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "sardf/field.hpp"
#include "sardf/parameter.hpp"

namespace sardf {

struct RuleType;

/// A rule with its arguments; empty by default. Cheap to copy.
class Fractions {
 public:
  Fractions() = default;
  explicit Fractions(RulePointer rule) : rule_(std::move(rule)) {}
  /// One material alone: short for the rule `constant`.
  static Fractions material(const std::string& name);
  /// The value of an attribute: one field for each component.
  static Fractions value(std::vector<Field> components);

  explicit operator bool() const { return rule_ != nullptr; }
  const Rule& rule() const { return *rule_; }
  const RulePointer& pointer() const { return rule_; }

 private:
  RulePointer rule_;
};

/// A number, or a field, for each of some materials, in the order given. The field of a material
/// that takes what the others leave is empty.
using Shares = std::vector<std::pair<std::string, double>>;
using MaterialFunctions = std::vector<std::pair<std::string, Field>>;

struct Record;
using RuleValue =
    std::variant<std::monostate, double, std::string, Field, Shares, MaterialFunctions,
                 std::vector<Field>, Fractions, std::vector<Record>>;
/// One element of a list of records; values in the order of the record's parameters.
struct Record {
  std::vector<RuleValue> values;
};

enum class RuleParameterType {
  number,
  text,
  field,
  feature,            // a field whose distance counts: see feature_distance
  influence,          // a field; its formula may use u, the distance to the record's feature
  fractions,          // a material, or a rule; of an attribute a value, or a rule
  shares,             // {material: number}: the rule's whole value
  functions,          // {material: field}: the rule's whole value
  functions_or_rest,  // the same, where one may take what the others leave
  values,             // the components of a value
  named_values,       // {component: field}: the rule's whole value
  records,
};

struct RuleParameter {
  std::string name, doc;
  Unit unit = Unit::none;
  Range range = Range::any;
  bool required = false;
  int at_least = 0;
  RuleParameterType type = RuleParameterType::number;
  RuleValue default_value;
  std::vector<RuleParameter> record;  // of records: the parameters of each
};

/// Where a rule may stand.
enum class RuleUse { fractions, values, both };

struct RuleType {
  std::string name, doc;
  RuleUse use = RuleUse::both;
  std::vector<RuleParameter> parameters;
  std::function<Fractions(const RuleType&, std::vector<RuleValue>)> make;
};

/// What rules are lowered for: fractions of materials, or the components of a value.
struct Lowering {
  std::vector<std::string> materials;
  double diagonal = 1;                     // of the scene's bounds: the scale of its tolerances
  size_t components = 0;                   // of a value; 0: fractions
  std::vector<Expression> fractions = {};  // of the materials, for values that depend on them
  std::vector<std::string> names = {};     // of the components; empty: they have none
};

/// A part of space that a rule blends in: how much of it there is, and what it is made of.
struct WeightedPart {
  Expression weight;
  Fractions of;
};

struct Rule {
  const RuleType* type = nullptr;
  std::vector<RuleValue> arguments;
  /// A rule has either weighted parts, whose weights sum to 1, or values of its own.
  std::function<std::vector<WeightedPart>(double diagonal)> parts;
  std::function<std::vector<Expression>(const Lowering&)> values;
};

const std::vector<RuleType>& fraction_rules();
/// Whether the rule has one parameter whose value stands for all of them, as {"constant": {...}}.
bool has_whole_value(const RuleType& type);
const RuleType* find_fraction_rule(const std::string& name);

/// Checks the arguments and makes the rule; those left out at the end have their defaults. Throws
/// Error.
Fractions make_fractions(const std::string& rule, std::vector<RuleValue> arguments);

/// The fraction of each material. Throws Error for a material that is not among them.
std::vector<Expression> lower(const Fractions& fractions, const std::vector<std::string>& materials,
                              double diagonal);
/// The same for what `lowering` asks.
std::vector<Expression> lower(const Fractions& fractions, const Lowering& lowering);

/// The distance that rules use: the field itself of a feature or a formula, negative values counted
/// as 0; the distance outside, max(0, -f), of a solid.
Expression feature_distance(const Field& field);

/// The materials that a rule names, each once, in order.
std::vector<std::string> materials_of(const Fractions& fractions);
/// Whether the rule, or one inside it, is of that name.
bool uses_rule(const Fractions& fractions, const std::string& name);

/// u at or below this share of the scene's diagonal counts as on the feature.
inline constexpr double on_feature = 1e-12;
/// A point is in a region where its field is at least minus this share of the diagonal.
inline constexpr double in_region = 1e-6;

}  // namespace sardf

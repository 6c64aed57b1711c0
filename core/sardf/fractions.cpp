#include "sardf/fractions.hpp"

#include <algorithm>

#include "sardf/arithmetic.hpp"
#include "sardf/constructor.hpp"
#include "sardf/error.hpp"
#include "sardf/fraction_rules.hpp"

namespace sardf {

namespace {

void check_parameter(const RuleParameter& p, const RuleValue& value);

void check_number(const RuleParameter& p, double value) {
  ParameterInfo info;
  info.name = p.name;
  info.range = p.range;
  check_argument(info, value);
}

void check_size(const RuleParameter& p, size_t size) {
  if (int(size) >= p.at_least) return;
  throw Error(p.name + " has " + std::to_string(size) + " elements; at least " +
              std::to_string(p.at_least) + " are needed");
}

void check_values(const std::vector<RuleParameter>& parameters,
                  const std::vector<RuleValue>& values) {
  for (size_t i = 0; i < parameters.size(); ++i) check_parameter(parameters[i], values.at(i));
}

void check_parameter(const RuleParameter& p, const RuleValue& value) {
  if (value.index() == 0 && p.required) throw Error(p.name + " is not given");
  if (const auto* number = std::get_if<double>(&value)) check_number(p, *number);
  if (const auto* shares = std::get_if<Shares>(&value)) check_size(p, shares->size());
  if (const auto* all = std::get_if<MaterialFunctions>(&value)) check_size(p, all->size());
  if (const auto* components = std::get_if<std::vector<Field>>(&value)) {
    check_size(p, components->size());
  }
  if (const auto* records = std::get_if<std::vector<Record>>(&value)) {
    check_size(p, records->size());
    for (const Record& record : *records) check_values(p.record, record.values);
  }
}

void collect_materials(const std::vector<RuleParameter>& parameters,
                       const std::vector<RuleValue>& values, std::vector<std::string>& names) {
  const auto add = [&](const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (size_t i = 0; i < parameters.size(); ++i) {
    const RuleValue& value = values.at(i);
    if (parameters[i].type == RuleParameterType::named_values) continue;
    if (const auto* shares = std::get_if<Shares>(&value)) {
      for (const auto& [name, share] : *shares) add(name);
    } else if (const auto* functions = std::get_if<MaterialFunctions>(&value)) {
      for (const auto& [name, field] : *functions) add(name);
    } else if (const auto* nested = std::get_if<Fractions>(&value)) {
      collect_materials(nested->rule().type->parameters, nested->rule().arguments, names);
    } else if (const auto* records = std::get_if<std::vector<Record>>(&value)) {
      for (const Record& record : *records) {
        collect_materials(parameters[i].record, record.values, names);
      }
    }
  }
}

bool any_uses_rule(const std::vector<RuleValue>& values, const std::string& name) {
  for (const RuleValue& value : values) {
    if (const auto* nested = std::get_if<Fractions>(&value)) {
      if (uses_rule(*nested, name)) return true;
    } else if (const auto* records = std::get_if<std::vector<Record>>(&value)) {
      for (const Record& record : *records) {
        if (any_uses_rule(record.values, name)) return true;
      }
    }
  }
  return false;
}

bool equals(const Expression& e, double value) { return is_constant(e) && e->value == value; }

}  // namespace

Fractions Fractions::material(const std::string& name) {
  return make_fractions(ConstantFractions::name, {Shares{{name, 1}}});
}

Fractions Fractions::value(std::vector<Field> components) {
  return make_fractions(AttributeValue::name, {std::move(components)});
}

const std::vector<RuleType>& fraction_rules() {
  static const std::vector<RuleType> all = [] {
    std::vector<RuleType> types;
    FractionRules::for_each(
        [&]<class R>(std::type_identity<R>) { types.push_back(rule_type_of<R>()); });
    return types;
  }();
  return all;
}

bool has_whole_value(const RuleType& type) {
  switch (type.parameters[0].type) {
    case RuleParameterType::shares:
    case RuleParameterType::functions:
    case RuleParameterType::functions_or_rest:
    case RuleParameterType::named_values:
      return true;
    default:
      return false;
  }
}

const RuleType* find_fraction_rule(const std::string& name) {
  for (const RuleType& type : fraction_rules()) {
    if (type.name == name) return &type;
  }
  return nullptr;
}

Fractions make_fractions(const std::string& rule, std::vector<RuleValue> arguments) {
  const RuleType* type = find_fraction_rule(rule);
  if (!type) {
    std::vector<std::string> names;
    for (const RuleType& known : fraction_rules()) names.push_back(known.name);
    throw Error("there is no rule '" + rule + "'" + did_you_mean(rule, names));
  }
  for (size_t i = arguments.size(); i < type->parameters.size(); ++i) {
    arguments.push_back(type->parameters[i].default_value);
  }
  check_values(type->parameters, arguments);
  return type->make(*type, std::move(arguments));
}

std::vector<Expression> lower(const Fractions& fractions, const std::vector<std::string>& materials,
                              double diagonal) {
  Lowering lowering;
  lowering.materials = materials;
  lowering.diagonal = diagonal;
  return lower(fractions, lowering);
}

std::vector<Expression> lower(const Fractions& fractions, const Lowering& lowering) {
  const Rule& rule = fractions.rule();
  const RuleUse use = rule.type->use;
  if (use == (lowering.components ? RuleUse::fractions : RuleUse::values)) {
    throw Error(
        "the rule '" + rule.type->name + "' gives " +
        (lowering.components ? "fractions where values are" : "values where fractions are") +
        " needed");
  }
  if (rule.values) return rule.values(lowering);
  const size_t channels = lowering.components ? lowering.components : lowering.materials.size();
  std::vector<Expression> out(channels, constant(0));
  for (const WeightedPart& part : rule.parts(lowering.diagonal)) {
    const std::vector<Expression> inside = lower(part.of, lowering);
    for (size_t i = 0; i < channels; ++i) {
      if (!equals(inside[i], 0)) out[i] = out[i] + part.weight * inside[i];
    }
  }
  return out;
}

Expression feature_distance(const Field& field) {
  const Construction* made = field.construction();
  // A feature that is moved or normalised, or whose parts are joined otherwise, is a feature.
  const auto keeps_its_kind = [](const Constructor& c) {
    return c.group == "transform" || c.name == "with_blend" || c.name == "normalized";
  };
  while (made && made->constructor && keeps_its_kind(*made->constructor)) {
    made = std::get<Field>(made->arguments[0]).construction();
  }
  if (!made || !made->constructor || made->constructor->group == "function")
    return max(constant(0), field.expression());
  if (made->constructor->group == "feature") return field.expression();
  return max(constant(0), -field.expression());
}

std::vector<std::string> materials_of(const Fractions& fractions) {
  std::vector<std::string> names;
  if (fractions) {
    collect_materials(fractions.rule().type->parameters, fractions.rule().arguments, names);
  }
  return names;
}

bool uses_rule(const Fractions& fractions, const std::string& name) {
  if (!fractions) return false;
  const Rule& rule = fractions.rule();
  return rule.type->name == name || any_uses_rule(rule.arguments, name);
}

}  // namespace sardf

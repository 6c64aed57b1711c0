// A rule's description from a struct, as constructor_of.hpp does it for constructors.
//
// A rule has `name`, `doc`, `use`, `parameters(V&)`, and either
//   std::vector<WeightedPart> parts(double diagonal) const;          or
//   std::vector<Expression> values(const Lowering&) const;
// and may have `void check() const`, which throws Error. A record has `parameters(V&)` alone.
#pragma once

#include <type_traits>

#include "sardf/fractions.hpp"

namespace sardf {

struct FeatureField {
  Field field;
};
struct Influence {
  Field field;
};
struct FunctionsOrRest {
  MaterialFunctions functions;
};
struct NamedValues {
  MaterialFunctions functions;
};

template <class Member>
struct IsRecords : std::false_type {};
template <class Element>
struct IsRecords<std::vector<Element>>
    : std::bool_constant<!std::is_same_v<Element, Field> && std::is_class_v<Element> &&
                         !std::is_same_v<Element, Shares::value_type> &&
                         !std::is_same_v<Element, MaterialFunctions::value_type>> {};

template <class Member>
constexpr RuleParameterType rule_parameter_type() {
  if constexpr (std::is_same_v<Member, double>) return RuleParameterType::number;
  if constexpr (std::is_same_v<Member, std::string>) return RuleParameterType::text;
  if constexpr (std::is_same_v<Member, Field>) return RuleParameterType::field;
  if constexpr (std::is_same_v<Member, FeatureField>) return RuleParameterType::feature;
  if constexpr (std::is_same_v<Member, Influence>) return RuleParameterType::influence;
  if constexpr (std::is_same_v<Member, Fractions>) return RuleParameterType::fractions;
  if constexpr (std::is_same_v<Member, Shares>) return RuleParameterType::shares;
  if constexpr (std::is_same_v<Member, MaterialFunctions>) return RuleParameterType::functions;
  if constexpr (std::is_same_v<Member, FunctionsOrRest>) {
    return RuleParameterType::functions_or_rest;
  }
  if constexpr (std::is_same_v<Member, NamedValues>) return RuleParameterType::named_values;
  if constexpr (std::is_same_v<Member, std::vector<Field>>) return RuleParameterType::values;
  if constexpr (IsRecords<Member>::value) return RuleParameterType::records;
}

template <class Struct>
std::vector<RuleParameter> rule_parameters() {
  std::vector<RuleParameter> all;
  const Struct defaults{};
  auto visit = [&](const Parameter& p, auto member) {
    using Member = std::remove_cvref_t<decltype(defaults.*member)>;
    RuleParameter made{
        p.name, p.doc, p.unit, p.range, p.required, p.at_least, rule_parameter_type<Member>(),
        {},     {}};
    if constexpr (std::is_same_v<Member, double> || std::is_same_v<Member, std::string>) {
      if (!p.required) made.default_value = defaults.*member;
    }
    if constexpr (IsRecords<Member>::value) {
      made.record = rule_parameters<typename Member::value_type>();
    }
    all.push_back(std::move(made));
  };
  Struct::parameters(visit);
  return all;
}

template <class Struct>
Struct from_rule_values(const std::vector<RuleValue>& values) {
  Struct made{};
  size_t next = 0;
  auto visit = [&](const Parameter&, auto member) {
    using Member = std::remove_cvref_t<decltype(made.*member)>;
    const RuleValue& value = values.at(next++);
    if (value.index() == 0) return;  // not given
    if constexpr (IsRecords<Member>::value) {
      for (const Record& record : std::get<std::vector<Record>>(value)) {
        (made.*member).push_back(from_rule_values<typename Member::value_type>(record.values));
      }
    } else if constexpr (requires { (made.*member).field; }) {
      (made.*member).field = std::get<Field>(value);
    } else if constexpr (requires { (made.*member).functions; }) {
      (made.*member).functions = std::get<MaterialFunctions>(value);
    } else {
      made.*member = std::get<Member>(value);
    }
  };
  Struct::parameters(visit);
  return made;
}

template <class R>
RuleType rule_type_of() {
  return {R::name, R::doc, R::use, rule_parameters<R>(),
          [](const RuleType& type, std::vector<RuleValue> arguments) {
            const R rule = from_rule_values<R>(arguments);
            if constexpr (requires { rule.check(); }) rule.check();
            auto made = std::make_shared<Rule>();
            made->type = &type;
            made->arguments = std::move(arguments);
            if constexpr (requires { rule.parts(1.0); }) {
              made->parts = [rule](double diagonal) { return rule.parts(diagonal); };
            } else {
              made->values = [rule](const Lowering& l) { return rule.values(l); };
            }
            return Fractions(std::move(made));
          }};
}

}  // namespace sardf

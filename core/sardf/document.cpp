#include "sardf/document.hpp"

#include <vector>

#include "sardf/constructor.hpp"
#include "sardf/fractions.hpp"
#include "sardf/short_number.hpp"

namespace sardf {

namespace {

struct Group {
  const char *name, *title;
};
constexpr Group groups[] = {{"solid", "Solids"},           {"plane", "Plane fields"},
                            {"feature", "Features"},       {"boolean", "Booleans"},
                            {"value", "Acting on values"}, {"transform", "Transforms"}};

std::string unit_text(Unit unit) {
  if (unit == Unit::length) return ", scene units";
  if (unit == Unit::angle) return ", degrees";
  return "";
}

std::string range_text(Range range) {
  if (range == Range::positive) return ", positive";
  if (range == Range::non_negative) return ", not negative";
  return "";
}

struct DefaultText {
  std::string operator()(std::monostate) const { return "none"; }
  std::string operator()(bool b) const { return b ? "true" : "false"; }
  std::string operator()(double a) const { return short_number(a); }
  std::string operator()(const std::string& s) const { return "\"" + s + "\""; }
  template <size_t N>
  std::string operator()(const std::array<double, N>& v) const {
    std::string text;
    for (double a : v) text += (text.empty() ? "[" : ", ") + short_number(a);
    return text + "]";
  }
  std::string operator()(const BlendPointer& blend) const { return blend->name; }
  template <class T>
  std::string operator()(const T&) const {
    return "none";
  }
};

std::string row(const std::string& name, const std::string& accepts, const std::string& standard,
                const std::string& doc) {
  return "| `" + name + "` | " + accepts + " | " + standard + " | " + doc + " |\n";
}

const char* const table_head = "\n| parameter | accepts | default | |\n|---|---|---|---|\n";

std::string parameter_table(const std::vector<ParameterInfo>& parameters) {
  if (parameters.empty()) return "";
  std::string text = table_head;
  for (const ParameterInfo& p : parameters) {
    text += row(p.name, type_name(p.type) + range_text(p.range) + unit_text(p.unit),
                p.required ? "**required**" : std::visit(DefaultText{}, p.default_value), p.doc);
  }
  return text;
}

std::string rule_type_name(RuleParameterType type) {
  switch (type) {
    case RuleParameterType::number:
      return "a number";
    case RuleParameterType::field:
      return "a field";
    case RuleParameterType::feature:
      return "a feature or a solid";
    case RuleParameterType::influence:
      return "a formula of u";
    case RuleParameterType::fractions:
      return "a material or a rule";
    case RuleParameterType::shares:
      return "{material: number}";
    case RuleParameterType::functions:
      return "{material: field}";
    case RuleParameterType::values:
      return "a field, or a list of them";
    default:
      return "a list of objects";
  }
}

std::string rule_rows(const std::vector<RuleParameter>& parameters, const std::string& before) {
  std::string text;
  for (const RuleParameter& p : parameters) {
    const double* standard = std::get_if<double>(&p.default_value);
    text += row(before + p.name, rule_type_name(p.type) + range_text(p.range) + unit_text(p.unit),
                p.required ? "**required**"
                : standard ? short_number(*standard)
                           : "none",
                p.doc);
    text += rule_rows(p.record, before + p.name + "[].");
  }
  return text;
}

std::string constructors_text() {
  std::string text;
  for (const Group& group : groups) {
    text += "\n## " + std::string(group.title) + "\n";
    for (const Constructor& c : constructors()) {
      if (c.group != group.name) continue;
      text += "\n### " + c.name + "\n" + c.doc + "\n" + parameter_table(c.parameters);
    }
  }
  return text;
}

}  // namespace

std::string operations_document() {
  std::string text =
      "# Operations\n\nMade by `sardf schema --document`. Names are the same in scene files, in "
      "Python and in Blender.\n";
  text += constructors_text();
  text += "\n## Blends\nHow `union`, `intersection` and `difference` join two fields.\n";
  for (const BlendType& b : blend_types()) {
    text += "\n### " + b.name + "\n" + b.doc + "\n" + parameter_table(b.parameters);
  }
  text += "\n## Fractions\nWhat a solid is made of.\n";
  for (const RuleType& rule : fraction_rules()) {
    text += "\n### " + rule.name + "\n" + rule.doc + "\n";
    if (!rule.parameters.empty()) text += table_head + rule_rows(rule.parameters, "");
  }
  text += "\n## Functions of the formula language\n\n| function | |\n|---|---|\n";
  for (const std::string& name : function_names()) {
    text += "| `" + name + "` | " + find_function(name)->info().doc + " |\n";
  }
  return text;
}

}  // namespace sardf

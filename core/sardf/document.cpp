#include "sardf/document.hpp"

#include "sardf/constructor.hpp"
#include "sardf/formula_functions.hpp"
#include "sardf/number_text.hpp"
#include "sardf/scene_file_rules.hpp"

namespace sardf {

namespace {

struct Group {
  const char *name, *heading;
};
constexpr Group groups[] = {
    {"solid", "Solids: signed, positive inside"},
    {"plane", "Plane fields: of x and y, the same for every z"},
    {"feature", "Features: the distance to a set of points"},
    {"boolean", "Joining fields"},
    {"value", "Changing a field's value"},
    {"transform", "Moving a field"},
    {"function", "Functions of points and distances: they count as formulas do"},
};

template <class Numbers>
std::string numbers_text(const Numbers& all) {
  std::string text = "[";
  for (size_t i = 0; i < all.size(); ++i) text.append(i ? ", " : "").append(number_text(all[i]));
  return text + "]";
}

std::string default_text(const Value& value) {
  if (const auto* truth = std::get_if<bool>(&value)) return *truth ? "true" : "false";
  if (const auto* number = std::get_if<double>(&value)) return number_text(*number);
  if (const auto* word = std::get_if<std::string>(&value)) return '"' + *word + '"';
  if (const auto* blend = std::get_if<BlendPointer>(&value)) return '"' + (*blend)->name + '"';
  if (const auto* v = std::get_if<Vec2>(&value)) return numbers_text(*v);
  if (const auto* v = std::get_if<Vec3>(&value)) return numbers_text(*v);
  return "none";
}

std::string accepted_text(const std::string& type, Unit unit, Range range, int at_least) {
  const char* units[] = {"", ", scene units", ", degrees", ""};
  const char* ranges[] = {"", ", > 0", ", ≥ 0", ", whole, ≥ 1"};
  std::string text = type + ranges[size_t(range)] + units[size_t(unit)];
  if (at_least > 0) text += ", at least " + std::to_string(at_least);
  return text;
}

void add_table(std::string& to) {
  to += "\n| parameter | accepted | default | |\n|---|---|---|---|\n";
}

void add_row(std::string& to, const std::string& name, const std::string& accepted,
             const std::string& usual, const std::string& doc) {
  std::string safe;
  for (const char c : doc) safe += c == '|' ? std::string("\\|") : std::string(1, c);
  to += "| `" + name + "` | " + accepted + " | " + usual + " | " + safe + " |\n";
}

void add_parameters(std::string& to, const std::vector<ParameterInfo>& infos) {
  if (infos.empty()) return;
  add_table(to);
  for (const ParameterInfo& p : infos) {
    add_row(to, p.name, accepted_text(type_name(p.type), p.unit, p.range, p.at_least),
            p.required ? "required" : default_text(p.default_value), p.doc);
  }
}

void add_constructors(std::string& to) {
  for (const Group& group : groups) {
    to += std::string("\n## ") + group.heading + "\n";
    for (const Constructor& c : constructors()) {
      if (c.group != group.name) continue;
      to += "\n### " + c.name + "\n\n" + c.doc + "\n";
      add_parameters(to, c.parameters);
    }
  }
}

void add_blends(std::string& to) {
  to +=
      "\n## Blends\n\nHow `union`, `intersection` and `difference` join two fields; of more than "
      "two, the first two are joined first.\n";
  for (const BlendType& type : blend_types()) {
    to += "\n### " + type.name + "\n\n" + type.doc + "\n";
    add_parameters(to, type.parameters);
  }
}

void add_functions(std::string& to) {
  to +=
      "\n## Functions of formulas\n\nBesides `+ - * / ^`, comparisons and `pi`. Angles are in "
      "radians.\n\n| function | |\n|---|---|\n| `length(a, b)`, `length(a, b, c)` | the length of "
      "the vector |\n| `at(f, a, b, c)` | f at the point (a, b, c) |\n| `dx(f)`, `dy(f)`, `dz(f)` "
      "| the "
      "derivative of f by x, y or z |\n";
  for (const std::string& name : all_functions()) {
    const OperationPointer function = find_function(name);
    if (!function) continue;
    const OperationInfo& info = function->info();
    const bool any_number = arguments_message(name, 5).empty();
    const char* arguments[] = {"", "a", "a, b", "a, b, c"};
    to += "| `" + name + "(" + arguments[info.arity] + (any_number ? ", ..." : "") + ")` | " +
          info.doc + " |\n";
  }
}

std::string rule_type_text(RuleParameterType type) {
  switch (type) {
    case RuleParameterType::number:
      return "a number";
    case RuleParameterType::text:
      return "a string";
    case RuleParameterType::field:
    case RuleParameterType::feature:
      return "a field";
    case RuleParameterType::influence:
      return "a field or a number";
    case RuleParameterType::fractions:
      return "a material, or a rule";
    case RuleParameterType::shares:
      return "a number for each material";
    case RuleParameterType::functions:
      return "a field or a number for each material";
    default:
      return "a list of objects";
  }
}

void add_rule_parameters(std::string& to, const std::vector<RuleParameter>& infos,
                         const std::string& prefix) {
  for (const RuleParameter& p : infos) {
    std::string name = prefix;
    for (const std::string& key : keys_of(p, false)) {
      if (name.size() > prefix.size()) name += "` or `" + prefix;
      name += key;
    }
    const auto* number = std::get_if<double>(&p.default_value);
    const auto* word = std::get_if<std::string>(&p.default_value);
    add_row(to, name, accepted_text(rule_type_text(p.type), p.unit, p.range, p.at_least),
            p.required ? "required"
            : number   ? number_text(*number)
            : word     ? '"' + *word + '"'
                       : "none",
            p.doc);
    add_rule_parameters(to, p.record, p.name + "[].");
  }
}

void add_rules(std::string& to) {
  to +=
      "\n## Fraction rules\n\nIn attributes, `value` stands in place of `material` or "
      "`fractions`.\n";
  for (const RuleType& type : fraction_rules()) {
    if (type.name == "value") continue;
    const char* uses[] = {" Of fractions only.", " Of attributes only.", ""};
    to += "\n### " + type.name + "\n\n" + type.doc + uses[size_t(type.use)] + "\n";
    const RuleParameterType first = type.parameters[0].type;
    if (first == RuleParameterType::shares || first == RuleParameterType::functions) {
      to += "\nIts value is " + rule_type_text(first) + ".\n";
      continue;
    }
    add_table(to);
    add_rule_parameters(to, type.parameters, "");
  }
}

}  // namespace

std::string operations_document() {
  std::string text =
      "# Operations\n\nGenerated from the operations themselves by `sardf schema --document`. The "
      "words are the keys of [scene files](scene_format.md) and the names of Python's "
      "functions.\n";
  add_constructors(text);
  add_blends(text);
  add_functions(text);
  add_rules(text);
  return text;
}

}  // namespace sardf

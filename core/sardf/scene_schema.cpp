// The JSON Schema of scene files, from the registries.
#include <cctype>

#include "sardf/constructor.hpp"
#include "sardf/json_document.hpp"
#include "sardf/scene_file.hpp"
#include "sardf/scene_file_rules.hpp"

namespace sardf {

namespace {

JsonValue text(const std::string& a) { return JsonValue::of(a); }

JsonValue object(std::initializer_list<std::pair<const char*, JsonValue>> members) {
  JsonValue made = JsonValue::object();
  for (const auto& [key, value] : members) made.add(key, value);
  return made;
}

JsonValue list(std::initializer_list<JsonValue> elements) {
  JsonValue made = JsonValue::list();
  for (const JsonValue& element : elements) made.add(element);
  return made;
}

JsonValue reference(const std::string& name) {
  return object({{"$ref", text(std::string("#/$defs/").append(name))}});
}

JsonValue any_of(std::initializer_list<JsonValue> choices) {
  return object({{"anyOf", list(choices)}});
}

JsonValue list_of(const JsonValue& element, double fewest = 0) {
  JsonValue made = object({{"type", text("array")}, {"items", element}});
  if (fewest > 0) made.add("minItems", JsonValue::of(fewest));
  return made;
}

JsonValue tuple(const JsonValue& element, double least, double most) {
  return object({{"type", text("array")},
                 {"items", element},
                 {"minItems", JsonValue::of(least)},
                 {"maxItems", JsonValue::of(most)}});
}

JsonValue tuple(const JsonValue& element, double n) { return tuple(element, n, n); }

JsonValue formula() { return object({{"type", text("string")}, {"pattern", text("^=")}}); }

JsonValue number(Range range) {
  JsonValue made = object({{"type", text(range == Range::count ? "integer" : "number")}});
  if (range == Range::positive) made.add("exclusiveMinimum", JsonValue::of(0.0));
  if (range == Range::non_negative) made.add("minimum", JsonValue::of(0.0));
  if (range == Range::count) made.add("minimum", JsonValue::of(1.0));
  return any_of({made, formula()});
}

// An object with any keys.
JsonValue map_of(const JsonValue& value, const std::string& key_pattern = "") {
  JsonValue made = object({{"type", text("object")}, {"additionalProperties", value}});
  if (!key_pattern.empty()) {
    made.add("propertyNames", object({{"pattern", text(key_pattern)}}));
  }
  return made;
}

// An object with some keys and no others.
JsonValue closed(const JsonValue& properties, const std::vector<std::string>& required) {
  JsonValue made = object({{"type", text("object")},
                           {"properties", properties},
                           {"additionalProperties", JsonValue::of(false)}});
  if (required.empty()) return made;
  JsonValue names = JsonValue::list();
  for (const std::string& name : required) names.add(text(name));
  made.add("required", names);
  return made;
}

// An object with exactly one of some keys: a name and its parameters.
JsonValue one_of_named(const JsonValue& properties) {
  JsonValue made = closed(properties, {});
  made.add("minProperties", JsonValue::of(1.0));
  made.add("maxProperties", JsonValue::of(1.0));
  return made;
}

std::string description(const std::string& doc, Unit unit) {
  const char* units[] = {"", " (scene units)", " (degrees)", " (any length but 0)"};
  return std::string(doc).append(units[size_t(unit)]);
}

JsonValue of_type(ParameterType type, Range range, int at_least) {
  switch (type) {
    case ParameterType::boolean:
      return object({{"type", text("boolean")}});
    case ParameterType::number:
      return number(range);
    case ParameterType::optional_number:
      return any_of({number(range), object({{"type", text("null")}})});
    case ParameterType::text:
      return object({{"type", text("string")}});
    case ParameterType::vector2:
      return tuple(number(range), 2);
    case ParameterType::vector3:
    case ParameterType::optional_vector3:
      return tuple(number(range), 3);
    case ParameterType::optional_vector4:
      return tuple(number(range), 4);
    case ParameterType::axis:
      return reference("axis");
    case ParameterType::numbers:
      return list_of(number(range), at_least);
    case ParameterType::point_grid:
      return list_of(list_of(tuple(number(range), 3)), at_least);
    case ParameterType::rule:
      return reference("value");
    case ParameterType::path:
      return object({{"type", text("string")}});
    case ParameterType::points2:
      return list_of(tuple(number(range), 2), at_least);
    case ParameterType::points3:
      return list_of(tuple(number(range), 2, 3), at_least);
    case ParameterType::field:
    case ParameterType::optional_field:
      return reference("field_or_number");
    case ParameterType::fields:
      return list_of(reference("field"), at_least);
    case ParameterType::values:
      return list_of(reference("field_or_number"), at_least);
    case ParameterType::sections:
      return list_of(closed(object({{"field", reference("field")}, {"z", number(Range::any)}}),
                            {"field", "z"}),
                     at_least);
    case ParameterType::blend:
      return reference("blend");
  }
  return JsonValue::of(true);
}

JsonValue default_json(const Value& value) {
  if (const auto* truth = std::get_if<bool>(&value)) return JsonValue::of(*truth);
  if (const auto* a = std::get_if<double>(&value)) return JsonValue::of(*a);
  if (const auto* word = std::get_if<std::string>(&value)) return text(*word);
  if (const auto* blend = std::get_if<BlendPointer>(&value)) return text((*blend)->name);
  JsonValue numbers = JsonValue::list();
  if (const auto* v = std::get_if<Vec3>(&value)) {
    for (const double a : *v) numbers.add(JsonValue::of(a));
  } else if (const auto* w = std::get_if<Vec2>(&value)) {
    for (const double a : *w) numbers.add(JsonValue::of(a));
  } else {
    return {};
  }
  return numbers;
}

JsonValue parameters_schema(const std::vector<ParameterInfo>& infos) {
  JsonValue properties = JsonValue::object();
  std::vector<std::string> required;
  for (const ParameterInfo& info : infos) {
    JsonValue parameter = of_type(info.type, info.range, info.at_least);
    parameter.add("description", text(description(info.doc, info.unit)));
    const JsonValue usual = default_json(info.default_value);
    if (!info.required && !usual.is(JsonValue::Type::null)) parameter.add("default", usual);
    properties.add(info.name, parameter);
    if (info.required) required.push_back(info.name);
  }
  return closed(properties, required);
}

// Where the first parameter is a field, a list of fields or a rule, it may stand alone.
JsonValue with_short_form(const JsonValue& parameters, const ParameterInfo& first) {
  switch (first.type) {
    case ParameterType::field:
      return any_of({parameters, object({{"type", text("string")}})});
    case ParameterType::fields:
    case ParameterType::rule:
      return any_of({parameters, of_type(first.type, Range::any, first.at_least)});
    default:
      return parameters;
  }
}

JsonValue field_schema() {
  JsonValue properties = JsonValue::object();
  for (const Constructor& c : constructors()) {
    JsonValue parameters = parameters_schema(c.parameters);
    parameters.add("description", text(c.doc));
    if (!c.parameters.empty()) parameters = with_short_form(parameters, c.parameters[0]);
    properties.add(c.name, parameters);
  }
  JsonValue name =
      object({{"type", text("string")},
              {"description", text("a field's name, or a formula that starts with =")}});
  return any_of({name, one_of_named(properties)});
}

JsonValue blend_schema() {
  JsonValue properties = JsonValue::object(), names = JsonValue::list();
  for (const BlendType& type : blend_types()) {
    JsonValue parameters = parameters_schema(type.parameters);
    if (type.parameters.size() == 1) {
      parameters =
          any_of({of_type(type.parameters[0].type, type.parameters[0].range, 0), parameters});
    } else if (type.parameters.empty()) {
      names.add(text(type.name));
    }
    parameters.add("description", text(type.doc));
    properties.add(type.name, parameters);
  }
  return any_of({object({{"enum", names}}), one_of_named(properties)});
}

JsonValue rule_parameters_schema(const std::vector<RuleParameter>& infos, bool of_values);

JsonValue rule_parameter_schema(const RuleParameter& info, bool of_values) {
  switch (info.type) {
    case RuleParameterType::number:
      return number(info.range);
    case RuleParameterType::text:
      return object({{"type", text("string")}});
    case RuleParameterType::field:
    case RuleParameterType::feature:
      return reference("field");
    case RuleParameterType::influence:
      return reference("field_or_number");
    case RuleParameterType::fractions:
      return reference(of_values ? "value" : "fractions");
    case RuleParameterType::shares:
      return map_of(number(Range::non_negative));
    case RuleParameterType::functions:
    case RuleParameterType::functions_or_rest:  // the word "rest" is text, as a name is
      return map_of(reference("field_or_number"));
    case RuleParameterType::named_values:
      return map_of(reference("field_or_number"), "^[A-Za-z0-9_]+$");
    case RuleParameterType::records:
      return list_of(rule_parameters_schema(info.record, of_values), info.at_least);
    case RuleParameterType::values:
      break;
  }
  return JsonValue::of(true);
}

JsonValue rule_parameters_schema(const std::vector<RuleParameter>& infos, bool of_values) {
  JsonValue properties = JsonValue::object();
  std::vector<std::string> required;
  JsonValue choices = JsonValue::list();
  for (const RuleParameter& info : infos) {
    const std::vector<std::string> keys = keys_of(info, of_values);
    for (const std::string& key : keys) {
      JsonValue parameter = rule_parameter_schema(info, of_values);
      if (key == "material") parameter = object({{"type", text("string")}});
      parameter.add("description", text(description(info.doc, info.unit)));
      const auto* usual = std::get_if<double>(&info.default_value);
      if (!info.required && usual) parameter.add("default", JsonValue::of(*usual));
      const auto* word = std::get_if<std::string>(&info.default_value);
      if (!info.required && word) parameter.add("default", text(*word));
      properties.add(key, parameter);
      if (keys.size() > 1) choices.add(object({{"required", list({text(key)})}}));
    }
    if (info.required && keys.size() == 1) required.push_back(keys[0]);
  }
  JsonValue made = closed(properties, required);
  if (!choices.elements.empty()) made.add("oneOf", choices);
  return made;
}

JsonValue rules_schema(bool of_values) {
  JsonValue properties = JsonValue::object();
  for (const RuleType& type : fraction_rules()) {
    const RuleUse other = of_values ? RuleUse::fractions : RuleUse::values;
    if (type.use == other || type.name == "value") continue;
    JsonValue parameters = has_whole_value(type)
                               ? rule_parameter_schema(type.parameters[0], of_values)
                               : rule_parameters_schema(type.parameters, of_values);
    parameters.add("description", text(type.doc));
    properties.add(type.name, parameters);
  }
  return one_of_named(properties);
}

JsonValue material_schema() {
  const JsonValue share = any_of({object({{"type", text("number")},
                                          {"minimum", JsonValue::of(0.0)},
                                          {"maximum", JsonValue::of(1.0)}}),
                                  formula()});
  const std::map<std::string, JsonValue> properties{
      {"color", reference("color")},
      {"roughness", share},
      {"metallic", share},
      {"index_of_refraction", number(Range::positive)},
      {"emission", reference("color")},
      {"density", number(Range::positive)},
      {"metadata", object({{"type", text("object")}})}};
  JsonValue ordered = JsonValue::object();
  for (const std::string& key : material_keys()) ordered.add(key, properties.at(key));
  return closed(ordered, {});
}

JsonValue definitions() {
  const JsonValue hex = object({{"type", text("string")}, {"pattern", text("^#[0-9a-fA-F]{6}$")}});
  const JsonValue any_number = number(Range::any), coordinates = tuple(any_number, 3);
  const JsonValue components = list_of(reference("field_or_number"), 1);
  return object(
      {{"axis", any_of({object({{"enum", list({text("x"), text("y"), text("z")})}}), coordinates})},
       {"color", any_of({hex, tuple(number(Range::non_negative), 3)})},
       {"field", field_schema()},
       {"field_or_number", any_of({object({{"type", text("number")}}), reference("field")})},
       {"blend", blend_schema()},
       {"material", material_schema()},
       {"fractions", any_of({object({{"type", text("string")}}), rules_schema(false)})},
       {"value", any_of({reference("field_or_number"), components, rules_schema(true)})}});
}

JsonValue attribute_schema() {
  const JsonValue properties = object({{"value", reference("value")},
                                       {"unit", object({{"type", text("string")}})},
                                       {"unit_vector", object({{"type", text("boolean")}})},
                                       {"fallback", reference("axis")}});
  const JsonValue components = list_of(reference("field_or_number"), 1);
  return any_of({object({{"type", list({text("number"), text("string")})}}), components,
                 closed(properties, {"value"})});
}

JsonValue units_schema() {
  JsonValue names = JsonValue::list();
  for (const std::string& name : unit_names()) names.add(text(name));
  return object({{"enum", names}, {"default", text("mm")}});
}

}  // namespace

std::string scene_schema() {
  const std::string name = "^(?!(x|y|z|pi)$)[A-Za-z_][A-Za-z0-9_]*$";
  const JsonValue word = object({{"type", text("string")}});
  const JsonValue section = closed(
      object({{"remove", reference("field")}, {"keep", list_of(reference("field"))}}), {"remove"});
  JsonValue materials = map_of(reference("material"), "^[A-Za-z0-9_.-][A-Za-z0-9 _.-]*$");
  materials.add("minProperties", JsonValue::of(1.0));
  const std::map<std::string, JsonValue> properties{
      {"sardf", object({{"const", JsonValue::of(1.0)}, {"description", text("format version")}})},
      {"title", word},
      {"comment", any_of({word, list_of(word)})},
      {"units", units_schema()},
      {"parameters", map_of(number(Range::any), name)},
      {"fields", map_of(reference("field_or_number"), name)},
      {"solid", reference("field")},
      {"blend", reference("blend")},
      {"materials", materials},
      {"fractions", reference("fractions")},
      {"attributes", map_of(attribute_schema(), name)},
      {"sections", list_of(section)},
      {"bounds", tuple(tuple(number(Range::any), 3), 2)},
      {"lipschitz", number(Range::positive)},
      {"view", closed(object({{"direction", reference("axis")}}), {})}};
  JsonValue ordered = JsonValue::object();
  for (const std::string& key : scene_keys()) ordered.add(key, properties.at(key));
  JsonValue schema = object({{"$schema", text("https://json-schema.org/draft/2020-12/schema")},
                             {"title", text("sardf scene")}});
  for (JsonMember& member : closed(ordered, {"sardf", "solid"}).members) {
    schema.add(member.key, member.value);
  }
  schema.add("$defs", definitions());
  return pretty_json(schema);
}

}  // namespace sardf

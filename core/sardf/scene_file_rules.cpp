#include "sardf/scene_file_rules.hpp"

#include <algorithm>
#include <utility>

namespace sardf {

namespace {

using Type = JsonValue::Type;

std::string list_of(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

bool is_component_name(const std::string& name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return ('a' <= c && c <= 'z') || ('A' <= c && c <= 'Z') || ('0' <= c && c <= '9') || c == '_';
  });
}

// The word, not a field of that name, which "=rest" means.
bool is_rest(const JsonValue& value) { return value.is(Type::string) && value.text == "rest"; }

}  // namespace

std::vector<std::string> keys_of(const RuleParameter& parameter, bool of_values) {
  if (parameter.type != RuleParameterType::fractions) return {parameter.name};
  if (of_values) return {"value"};
  return {"material", "fractions"};
}

bool RuleReader::check_material(const std::string& name, const JsonPlace* place,
                                const JsonPlace* object, const JsonMember* member) {
  if (std::find(materials.begin(), materials.end(), name) != materials.end()) return true;
  const std::string message = "there is no material '" + name + "'" + did_you_mean(name, materials);
  if (place) {
    error(*place, message);
  } else {
    error_at_key(*object, *member, message);
  }
  return false;
}

Fractions RuleReader::fractions(const JsonPlace& place) {
  if (place.value->is(Type::string)) {
    if (!check_material(place.value->text, &place, nullptr, nullptr)) return {};
    return Fractions::material(place.value->text);
  }
  if (place.value->is(Type::object)) return rule(place, {nullptr});
  wrong_type(place, "a material's name, or an object such as {\"ramp\": {...}}");
  return {};
}

Fractions RuleReader::value(const JsonPlace& place, ValueShape& shape) {
  const JsonValue& json = *place.value;
  const bool is_rule =
      json.is(Type::object) && json.members.size() == 1 && !find_constructor(json.members[0].key);
  return is_rule ? rule(place, {&shape}) : constant_value(place, shape);
}

RulePointer RuleReader::value_rule(const JsonPlace& place) {
  ValueShape one{1, {}};
  const bool before = std::exchange(for_field_, true);
  const Fractions read = value(place, one);
  for_field_ = before;
  return read ? read.pointer() : nullptr;
}

Fractions RuleReader::constant_value(const JsonPlace& place, ValueShape& shape) {
  std::vector<Field> fields;
  if (place.value->is(Type::array)) {
    for (size_t i = 0; i < place.value->elements.size(); ++i) {
      fields.push_back(field_or_number(place.element(i)));
    }
    if (fields.empty()) {
      wrong_type(place, "a list of at least one number or field");
      return {};
    }
  } else {
    fields.push_back(field_or_number(place));
  }
  for (const Field& f : fields) {
    if (!f) return {};
  }
  if (shape.components == 0) shape.components = fields.size();
  if (shape.components != fields.size()) {
    error(place, "found " + std::to_string(fields.size()) + " components where others have " +
                     std::to_string(shape.components));
    return {};
  }
  if (!shape.names.empty()) {
    error(place, "found a component without a name where others have the names " +
                     list_of(shape.names) + ", as in {\"components\": {...}}");
    return {};
  }
  return Fractions::value(std::move(fields));
}

Fractions RuleReader::nested(const JsonPlace& place, Wanted wanted) {
  return wanted.shape ? value(place, *wanted.shape) : fractions(place);
}

Fractions RuleReader::rule(const JsonPlace& place, Wanted wanted) {
  const JsonValue& json = *place.value;
  if (json.members.size() != 1) {
    error(place, "found an object with " + std::to_string(json.members.size()) +
                     " keys; a rule is an object with one, its name");
    return {};
  }
  const JsonMember& member = json.members[0];
  const RuleType* type = known_rule(place, member, wanted);
  if (!type) return {};
  const JsonPlace inside = place.member(member);
  std::optional<std::vector<RuleValue>> values;
  if (has_whole_value(*type)) {
    RuleValue whole = rule_value(inside, type->parameters[0], wanted, {});
    if (whole.index() == 0) return {};
    // Named components have set it.
    if (wanted.shape && wanted.shape->components == 0) wanted.shape->components = 1;
    values = {std::move(whole)};
  } else {
    values = rule_values(inside, type->name, type->parameters, wanted);
  }
  if (!values) return {};
  const auto made = guarded(inside, [&] { return make_fractions(type->name, std::move(*values)); });
  if (!made) return {};
  rule_was_read(made->pointer(), inside);
  return *made;
}

// Null, with an error at its key, where there is none of the name or none that may stand here.
const RuleType* RuleReader::known_rule(const JsonPlace& place, const JsonMember& member,
                                       Wanted wanted) {
  const auto may_stand = [&](const RuleType& type) {
    return type.use != wanted.other() && type.name != "value" &&
           !(for_field_ && (type.name == "of_materials" || type.name == "components"));
  };
  const RuleType* type = find_fraction_rule(member.key);
  if (type && may_stand(*type)) return type;
  std::vector<std::string> names;
  for (const RuleType& known : fraction_rules()) {
    if (may_stand(known)) names.push_back(known.name);
  }
  std::string message =
      "there is no rule '" + member.key + "' here" + did_you_mean(member.key, names);
  if (message.back() != '?') message += "; accepted are " + list_of(names);
  error_at_key(place, member, message);
  return nullptr;
}

std::optional<std::vector<RuleValue>> RuleReader::rule_values(
    const JsonPlace& place, const std::string& owner, const std::vector<RuleParameter>& infos,
    Wanted wanted) {
  if (!object(place, "an object of the parameters of " + owner)) return std::nullopt;
  std::vector<std::string> accepted;
  for (const RuleParameter& p : infos) {
    for (const std::string& key : keys_of(p, wanted.shape)) accepted.push_back(key);
  }
  const size_t before = errors.size();
  check_keys(place, accepted);
  std::vector<RuleValue> values;
  Field feature;
  for (const RuleParameter& p : infos) {
    std::optional<JsonPlace> given;
    std::string named;
    for (const std::string& key : keys_of(p, wanted.shape)) {
      const auto found = place.find(key);
      if (found && given) error(*found, "give either 'material' or 'fractions', not both");
      if (found) given = found;
      named += (named.empty() ? "'" : " or '") + key + "'";
    }
    if (!given) {
      if (p.required) error(place, owner + " needs " + named + ": " + p.doc);
      values.push_back(p.default_value);
      continue;
    }
    values.push_back(rule_value(*given, p, wanted, feature));
    if (p.type == RuleParameterType::feature && values.back().index() != 0) {
      feature = std::get<Field>(values.back());
    }
  }
  // A part that is wrong without an error of its own names something that is wrong elsewhere.
  for (size_t i = 0; i < infos.size(); ++i) {
    if (infos[i].required && values[i].index() == 0) return std::nullopt;
  }
  return errors.size() == before ? std::optional(std::move(values)) : std::nullopt;
}

RuleValue RuleReader::rule_value(const JsonPlace& place, const RuleParameter& parameter,
                                 Wanted wanted, const Field& feature) {
  const auto as_value = [](auto read) { return read ? RuleValue(std::move(read)) : RuleValue(); };
  switch (parameter.type) {
    case RuleParameterType::number: {
      const auto read = number(place, parameter.name, parameter.range);
      return read ? RuleValue(*read) : RuleValue();
    }
    case RuleParameterType::text: {
      const auto read = text(place);
      return read ? RuleValue(*read) : RuleValue();
    }
    case RuleParameterType::field:
    case RuleParameterType::feature:
      return as_value(field(place));
    case RuleParameterType::influence: {
      // Without its feature, which is reported, u has no meaning.
      if (!feature) return {};
      return as_value(field_with(place, "u", formula_field(feature_distance(feature), "u", {})));
    }
    case RuleParameterType::fractions:
      return as_value(nested(place, wanted));
    case RuleParameterType::shares:
    case RuleParameterType::functions:
    case RuleParameterType::functions_or_rest:
      return whole_value(place, parameter.type);
    case RuleParameterType::named_values:
      return named_values(place, *wanted.shape);
    case RuleParameterType::records:
      return records(place, parameter, wanted);
    case RuleParameterType::values:
      break;
  }
  return {};
}

RuleValue RuleReader::records(const JsonPlace& place, const RuleParameter& parameter,
                              Wanted wanted) {
  if (!list(place, "a list of objects")) return {};
  std::vector<Record> all;
  for (size_t i = 0; i < place.value->elements.size(); ++i) {
    auto values = rule_values(place.element(i),
                              "element " + std::to_string(i + 1) + " of '" + parameter.name + "'",
                              parameter.record, wanted);
    if (values) all.push_back({std::move(*values)});
  }
  if (all.size() != place.value->elements.size()) return {};
  return all;
}

RuleValue RuleReader::whole_value(const JsonPlace& place, RuleParameterType type) {
  const bool shares = type == RuleParameterType::shares;
  const char* what = shares ? "a number" : "a field or a number";
  if (!object(place, std::string("an object with ") + what + " for each material")) return {};
  const size_t before = errors.size();
  Shares numbers;
  MaterialFunctions functions;
  bool good = true;
  for (const JsonMember& member : place.value->members) {
    check_material(member.key, nullptr, &place, &member);
    const JsonPlace inside = place.member(member);
    if (shares) {
      const auto read = number(inside, "the share");
      if (read) numbers.push_back({member.key, *read});
    } else if (type == RuleParameterType::functions_or_rest && is_rest(*inside.value)) {
      functions.push_back({member.key, Field()});
    } else {
      functions.push_back({member.key, field_or_number(inside)});
      good = good && functions.back().second;
    }
  }
  if (errors.size() != before || !good) return {};
  if (shares) return numbers;
  return functions;
}

RuleValue RuleReader::named_values(const JsonPlace& place, ValueShape& shape) {
  if (!object(place, "an object with a field or a number for each component")) return {};
  const size_t before = errors.size();
  MaterialFunctions values;
  std::vector<std::string> names;
  bool good = true;
  for (const JsonMember& member : place.value->members) {
    if (!is_component_name(member.key)) {
      error_at_key(
          place, member,
          "'" + member.key + "' cannot name a component; letters, digits and _ are accepted");
    }
    names.push_back(member.key);
    values.push_back({member.key, field_or_number(place.member(member))});
    good = good && values.back().second;
  }
  if (errors.size() != before || !good) return {};
  if (shape.components == 0) shape = {names.size(), names};
  std::vector<std::string> here = names, others = shape.names;
  std::sort(here.begin(), here.end());
  std::sort(others.begin(), others.end());
  if (here != others) {
    error(place, "found the components " + list_of(names) + " where others are " +
                     (others.empty() ? "without names" : list_of(shape.names)));
    return {};
  }
  return values;
}

}  // namespace sardf

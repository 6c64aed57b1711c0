#include "sardf/scene_file_fields.hpp"

#include <algorithm>

#include "sardf/formula.hpp"
#include "sardf/fractions.hpp"
#include "sardf/scene_file_rules.hpp"

namespace sardf {

namespace {

using Type = JsonValue::Type;

bool has_one_member(const JsonValue& value) {
  return value.is(Type::object) && value.members.size() == 1;
}

// Whether an object is a rule rather than an object of parameters, one of whose names may be
// misspelt.
bool is_rule(const Constructor& constructor, const JsonValue& value) {
  std::vector<std::string> names;
  for (const ParameterInfo& info : constructor.parameters) names.push_back(info.name);
  const std::string& key = value.members[0].key;
  if (std::find(names.begin(), names.end(), key) != names.end()) return false;
  return find_fraction_rule(key) || find_constructor(key) || did_you_mean(key, names).empty();
}

bool is_short_form(const Constructor& constructor, const JsonValue& value) {
  switch (constructor.parameters[0].type) {
    case ParameterType::field:
      return value.is(Type::string);
    case ParameterType::fields:
      return value.is(Type::array);
    case ParameterType::rule:
      return value.is(Type::string) || value.is(Type::number) ||
             (has_one_member(value) && is_rule(constructor, value));
    default:
      return false;
  }
}

// {"boundary": "bore"} is short for {"boundary": {"solid": "bore"}}, {"union": ["a", "b"]} for
// {"union": {"of": ["a", "b"]}}, and {"value_of": {"ramp": ...}} for {"value_of": {"rule": {"ramp":
// ...}}}: the parameters that are meant, or an object without members.
JsonValue as_parameters(const Constructor& constructor, const JsonValue& value) {
  JsonValue object = JsonValue::object();
  object.line = value.line;
  if (!constructor.parameters.empty() && is_short_form(constructor, value)) {
    object.add(constructor.parameters[0].name, value);
  }
  return object;
}

void collect_names(const JsonValue& value, std::vector<std::string>& names);
void collect_value_names(const JsonValue& value, std::vector<std::string>& names);

// The names in the value of one parameter of a rule for values.
void collect_rule_names(const JsonValue& value, const RuleParameter& parameter,
                        std::vector<std::string>& names) {
  switch (parameter.type) {
    case RuleParameterType::field:
    case RuleParameterType::feature:
      return collect_names(value, names);
    case RuleParameterType::influence: {
      std::vector<std::string> inside;
      collect_names(value, inside);
      // u is the distance to the feature here, whatever field may have that name.
      std::erase(inside, "u");
      names.insert(names.end(), inside.begin(), inside.end());
      return;
    }
    case RuleParameterType::fractions:
      return collect_value_names(value, names);
    case RuleParameterType::named_values:
      for (const JsonMember& member : value.members) collect_names(member.value, names);
      return;
    case RuleParameterType::records:
      for (const JsonValue& element : value.elements) {
        for (const RuleParameter& inner : parameter.record) {
          for (const std::string& key : keys_of(inner, true)) {
            if (const JsonValue* found = element.find(key))
              collect_rule_names(*found, inner, names);
          }
        }
      }
      return;
    default:
      return;
  }
}

// The names in a value: a field, a list of fields, or a rule.
void collect_value_names(const JsonValue& value, std::vector<std::string>& names) {
  for (const JsonValue& element : value.elements) collect_names(element, names);
  const RuleType* rule = has_one_member(value) && !find_constructor(value.members[0].key)
                             ? find_fraction_rule(value.members[0].key)
                             : nullptr;
  if (!rule) return collect_names(value, names);
  for (const RuleParameter& parameter : rule->parameters) {
    const JsonValue& inside = value.members[0].value;
    const JsonValue* given = has_whole_value(*rule) ? &inside : inside.find(parameter.name);
    if (given) collect_rule_names(*given, parameter, names);
  }
}

// The names in the value of one parameter of a constructor.
void collect_argument_names(const JsonValue& value, ParameterType type,
                            std::vector<std::string>& names) {
  switch (type) {
    case ParameterType::field:
    case ParameterType::optional_field:
      return collect_names(value, names);
    case ParameterType::rule:
      return collect_value_names(value, names);
    case ParameterType::fields:
    case ParameterType::values:
      for (const JsonValue& element : value.elements) collect_names(element, names);
      return;
    case ParameterType::sections:
      for (const JsonValue& element : value.elements) {
        if (const JsonValue* field = element.find("field")) collect_names(*field, names);
      }
      return;
    default:
      return;
  }
}

// Every name that a field's text or object mentions, known or not.
void collect_names(const JsonValue& value, std::vector<std::string>& names) {
  if (value.is(Type::string)) {
    if (!value.text.starts_with("=")) {
      names.push_back(value.text);
      return;
    }
    for (std::string& name : names_in_formula(value.text.substr(1))) {
      names.push_back(std::move(name));
    }
    return;
  }
  if (!has_one_member(value)) return;
  const Constructor* constructor = find_constructor(value.members[0].key);
  if (!constructor) return;
  const JsonValue short_form = as_parameters(*constructor, value.members[0].value);
  const JsonValue& given = short_form.members.empty() ? value.members[0].value : short_form;
  for (const ParameterInfo& info : constructor->parameters) {
    const JsonValue* argument = given.find(info.name);
    if (argument) collect_argument_names(*argument, info.type, names);
  }
}

}  // namespace

std::vector<size_t> FieldReader::references(const JsonValue& value) const {
  std::vector<std::string> names;
  collect_names(value, names);
  std::vector<size_t> places;
  for (const std::string& name : names) {
    const auto found = definition_of_.find(name);
    if (found != definition_of_.end()) places.push_back(found->second);
  }
  return places;
}

void FieldReader::report_circle(const JsonPlace& object, const std::vector<size_t>& circle) {
  std::string chain;
  for (const size_t i : circle) {
    const std::string& name = definitions_[i].member->key;
    failed_.insert(name);
    chain += "'" + name + "' -> ";
  }
  const JsonMember& first = *definitions_[circle[0]].member;
  error_at_key(object, first,
               "fields name each other in a circle: " + chain + "'" + first.key + "'");
}

// A depth-first walk without recursion: chains of names may be long.
std::vector<size_t> FieldReader::in_order_of_use(const JsonPlace& object) {
  enum class State { fresh, open, done };
  struct Step {
    size_t place;
    std::vector<size_t> needed;
    size_t next = 0;
  };
  std::vector<State> states(definitions_.size(), State::fresh);
  std::vector<size_t> order;
  for (size_t root = 0; root < definitions_.size(); ++root) {
    if (states[root] != State::fresh) continue;
    std::vector<Step> path;
    const auto enter = [&](size_t i) {
      states[i] = State::open;
      path.push_back({i, references(*definitions_[i].place.value)});
    };
    enter(root);
    while (!path.empty()) {
      Step& step = path.back();
      if (step.next == step.needed.size()) {
        states[step.place] = State::done;
        order.push_back(step.place);
        path.pop_back();
        continue;
      }
      const size_t needed = step.needed[step.next++];
      if (states[needed] == State::fresh) {
        enter(needed);
      } else if (states[needed] == State::open) {
        std::vector<size_t> circle;
        for (const Step& s : path) {
          if (s.place == needed || !circle.empty()) circle.push_back(s.place);
        }
        report_circle(object, circle);
      }
    }
  }
  return order;
}

void FieldReader::define(const JsonPlace& object) {
  for (const JsonMember& member : object.value->members) {
    if (!is_name(member.key) || parameters.count(member.key)) {
      const std::string reason =
          parameters.count(member.key)
              ? "' is a parameter's name too"
              : "' cannot name a field; letters, digits and _ are accepted, but not x, y, z and pi";
      error_at_key(object, member, "'" + member.key + reason);
      failed_.insert(member.key);
      continue;
    }
    definition_of_[member.key] = definitions_.size();
    definitions_.push_back({&member, object.member(member)});
  }
  for (const size_t i : in_order_of_use(object)) {
    const std::string& name = definitions_[i].member->key;
    if (failed_.count(name)) continue;
    const Field made = field_or_number(definitions_[i].place);
    if (made) {
      known_[name] = made;
      given_.erase(name);
    } else {
      failed_.insert(name);
    }
  }
}

std::vector<NamedField> FieldReader::named() const {
  std::vector<NamedField> all;
  for (const Definition& definition : definitions_) {
    const auto found = known_.find(definition.member->key);
    if (found != known_.end()) all.push_back({found->first, found->second});
  }
  for (const std::string& name : used_given_) all.push_back({name, given_.at(name)});
  return all;
}

Field FieldReader::field(const JsonPlace& place) { return field_like(place, ""); }

Field FieldReader::field_like(const JsonPlace& place, const std::string& otherwise) {
  const JsonValue& value = *place.value;
  if (value.is(Type::string)) return value.text.starts_with("=") ? formula(place) : by_name(place);
  if (value.is(Type::object)) return constructed_field(place);
  wrong_type(
      place,
      otherwise + "a field (a name, a formula \"=...\", or an object such as {\"sphere\": {...}})");
  return {};
}

Field FieldReader::field_or_number(const JsonPlace& place) {
  if (!place.value->is(Type::number)) return field_like(place, "a number or ");
  const auto read = number(place, "the number");
  return read ? Field::number(*read) : Field();
}

Field FieldReader::field_with(const JsonPlace& place, const std::string& name,
                              const Field& meaning) {
  const auto before = known_.find(name);
  const Field hidden = before == known_.end() ? Field() : before->second;
  known_[name] = meaning;
  const Field read = field_or_number(place);
  if (hidden) {
    known_[name] = hidden;
  } else {
    known_.erase(name);
  }
  return read;
}

Field FieldReader::formula(const JsonPlace& place) {
  const std::string text = place.value->text.substr(1);
  std::map<std::string, Field> stand_ins;
  for (const std::string& name : names_in_formula(text)) {
    if (failed_.count(name) && !known_.count(name)) stand_ins[name] = Field::coordinate(0);
    if (given_.count(name)) used_given_.insert(name);
  }
  const auto parse = [&](const std::map<std::string, Field>& names) {
    return guarded(place, [&] { return parse_formula(text, names, parameters); });
  };
  if (stand_ins.empty()) return parse(known_).value_or(Field());
  // Without the fields that are wrong it has no value, but may have errors of its own.
  stand_ins.insert(known_.begin(), known_.end());
  parse(stand_ins);
  return {};
}

Field FieldReader::by_name(const JsonPlace& place) {
  const std::string& name = place.value->text;
  const auto found = known_.find(name);
  if (found != known_.end()) {
    if (given_.count(name)) used_given_.insert(name);
    return found->second;
  }
  if (failed_.count(name)) return {};
  std::vector<std::string> names;
  for (const auto& [known, field] : known_) names.push_back(known);
  std::string hint = did_you_mean(name, names);
  if (parameters.count(name) || name == "x" || name == "y" || name == "z") {
    hint = "; a formula starts with =: \"=" + name + "\"";
  }
  error(place, "there is no field '" + name + "'" + hint);
  return {};
}

Field FieldReader::constructed_field(const JsonPlace& place) {
  const JsonValue& value = *place.value;
  if (value.members.size() != 1) {
    error(place, "found an object with " + std::to_string(value.members.size()) +
                     " keys; a field is an object with one, the constructor's name");
    return {};
  }
  const JsonMember& member = value.members[0];
  const Constructor* constructor = find_constructor(member.key);
  if (!constructor) {
    std::vector<std::string> names;
    for (const Constructor& c : constructors()) names.push_back(c.name);
    error_at_key(place, member,
                 "there is no constructor '" + member.key + "'" + did_you_mean(member.key, names));
    return {};
  }
  const JsonPlace inside = place.member(member);
  const JsonValue object = as_parameters(*constructor, member.value);
  if (object.members.empty()) return construct(inside, *constructor);
  const size_t before = errors.size();
  const Field made = construct({&object, inside.pointer}, *constructor);
  // The file does not say the parameter's name.
  const std::string unsaid = pointer_to(inside.pointer, object.members[0].key);
  for (size_t i = before; i < errors.size(); ++i) {
    if (!(errors[i].pointer + "/").starts_with(unsaid + "/")) continue;
    errors[i] = Error(errors[i].message, errors[i].file, errors[i].line,
                      inside.pointer + errors[i].pointer.substr(unsaid.size()));
  }
  return made;
}

Field FieldReader::construct(const JsonPlace& inside, const Constructor& constructor) {
  auto given = arguments(inside, constructor.name, constructor.parameters);
  if (!given) return {};
  return guarded(inside, [&] { return make_field(constructor, std::move(*given)); })
      .value_or(Field());
}

}  // namespace sardf

#include "sardf/scene_file_fields.hpp"

#include <algorithm>

#include "sardf/formula.hpp"

namespace sardf {

namespace {

using Type = JsonValue::Type;

// {"boundary": "bore"} is short for {"boundary": {"solid": "bore"}}, and {"union": ["a", "b"]} for
// {"union": {"of": ["a", "b"]}}: the parameters that are meant, or an object without members.
JsonValue as_parameters(const Constructor& constructor, const JsonValue& value) {
  JsonValue object = JsonValue::object();
  object.line = value.line;
  if (constructor.parameters.empty()) return object;
  const ParameterInfo& first = constructor.parameters[0];
  const bool short_form = (first.type == ParameterType::field && value.is(Type::string)) ||
                          (first.type == ParameterType::fields && value.is(Type::array));
  if (short_form) object.add(first.name, value);
  return object;
}

void collect_names(const JsonValue& value, std::vector<std::string>& names);

// The names in every text of a rule, whose values are fields at any depth.
void collect_all_names(const JsonValue& value, std::vector<std::string>& names) {
  if (value.is(Type::string)) collect_names(value, names);
  for (const JsonValue& element : value.elements) collect_all_names(element, names);
  for (const JsonMember& member : value.members) collect_all_names(member.value, names);
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
  if (!value.is(Type::object) || value.members.size() != 1) return;
  const Constructor* constructor = find_constructor(value.members[0].key);
  if (!constructor) return;
  const JsonValue short_form = as_parameters(*constructor, value.members[0].value);
  const JsonValue& given = short_form.members.empty() ? value.members[0].value : short_form;
  for (const ParameterInfo& info : constructor->parameters) {
    const JsonValue* argument = given.find(info.name);
    if (!argument) continue;
    if (info.type == ParameterType::field || info.type == ParameterType::optional_field) {
      collect_names(*argument, names);
    }
    if (info.type == ParameterType::rule) collect_all_names(*argument, names);
    if (info.type == ParameterType::fields || info.type == ParameterType::values) {
      for (const JsonValue& element : argument->elements) collect_names(element, names);
    }
    if (info.type == ParameterType::sections) {
      for (const JsonValue& element : argument->elements) {
        const JsonValue* field = element.find("field");
        if (field) collect_names(*field, names);
      }
    }
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

Field FieldReader::field(const JsonPlace& place) {
  const JsonValue& value = *place.value;
  if (value.is(Type::string)) return value.text.starts_with("=") ? formula(place) : by_name(place);
  if (value.is(Type::object)) return constructed_field(place);
  wrong_type(place,
             "a field (a name, a formula \"=...\", or an object such as {\"sphere\": {...}})");
  return {};
}

Field FieldReader::field_or_number(const JsonPlace& place) {
  if (!place.value->is(Type::number)) return field(place);
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
  if (const JsonValue object = as_parameters(*constructor, member.value); !object.members.empty()) {
    return construct({&object, inside.pointer}, *constructor);
  }
  return construct(inside, *constructor);
}

Field FieldReader::construct(const JsonPlace& inside, const Constructor& constructor) {
  auto given = arguments(inside, constructor.name, constructor.parameters);
  if (!given) return {};
  return guarded(inside, [&] { return make_field(constructor, std::move(*given)); })
      .value_or(Field());
}

}  // namespace sardf

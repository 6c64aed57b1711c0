#include "sardf/scene_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iostream>
#include <limits>
#include <sstream>

#include "sardf/formula.hpp"
#include "sardf/scene_file_rules.hpp"

namespace sardf {

namespace {

using Type = JsonValue::Type;

constexpr double format_version = 1;

std::string joined(const std::vector<Error>& all) {
  std::string text = all.at(0).message;
  for (size_t i = 1; i < all.size(); ++i) text += std::string("\n") + all[i].what();
  return text;
}

class ValueRuleReader : private RuleReader {
 public:
  explicit ValueRuleReader(const std::map<std::string, Field>& given) : RuleReader("", given) {}

  Fractions read(const JsonValue& root, std::vector<Error> problems) {
    errors = std::move(problems);
    const RulePointer rule = value_rule({&root, ""});
    if (!errors.empty()) throw SceneErrors(std::move(errors));
    return Fractions(rule);
  }
};

class SceneReader : private RuleReader {
 public:
  SceneReader(const std::string& file, const std::map<std::string, Field>& given)
      : RuleReader(file, given) {
    scene_.source.file = file;
  }

  SceneDescription read(const JsonValue& root, std::vector<Error> problems) {
    errors = std::move(problems);
    const JsonPlace top{&root, ""};
    if (object(top, "an object: a scene")) read_scene(top);
    std::stable_sort(errors.begin(), errors.end(),
                     [](const Error& a, const Error& b) { return a.line < b.line; });
    if (!errors.empty()) throw SceneErrors(std::move(errors));
    return std::move(scene_);
  }

 private:
  void read_scene(const JsonPlace& top) {
    check_keys(top, scene_keys());
    read_version(top);
    if (const auto at = find(top, "title")) scene_.title = text(*at).value_or("");
    if (const auto at = find(top, "comment")) scene_.comment = read_comment(*at);
    if (const auto at = find(top, "units")) read_units(*at);
    if (const auto at = find(top, "parameters")) read_parameters(*at);
    if (const auto at = find(top, "fields"); at && object(*at, "an object of fields by name")) {
      define(*at);
    }
    if (const auto at = find(top, "solid")) {
      scene_.solid = field(*at);
    } else {
      error(top, "the key 'solid' is missing: the field that is the object");
    }
    if (const auto at = find(top, "blend")) scene_.blend = blend(*at).value_or(nullptr);
    if (const auto at = find(top, "materials")) read_materials(*at);
    if (const auto at = find(top, "fractions")) scene_.fractions = fractions(*at);
    if (const auto at = find(top, "attributes")) read_attributes(*at);
    if (const auto at = find(top, "sections")) read_sections(*at);
    if (const auto at = find(top, "bounds")) read_bounds(*at);
    if (const auto at = find(top, "lipschitz")) {
      scene_.stated_lipschitz = number(*at, "lipschitz", Range::positive);
    }
    if (const auto at = find(top, "view")) read_view(*at);
    scene_.fields = named();
  }

  std::optional<JsonPlace> find(const JsonPlace& top, const char* key) {
    const auto place = top.find(key);
    if (place) scene_.source.lines[place->pointer] = place->value->line;
    return place;
  }

  void rule_was_read(const RulePointer& rule, const JsonPlace& place) override {
    SceneSource& source = scene_.source;
    source.rules[rule] = place.pointer;
    source.lines[place.pointer] = place.value->line;
    for (const JsonMember& member : place.value->members) {
      source.lines[place.member(member).pointer] = member.value.line;
    }
  }

  void read_version(const JsonPlace& top) {
    const auto at = top.find("sardf");
    if (!at) {
      error(top, "the key 'sardf' is missing: the version of the format, 1");
    } else if (!at->value->is(Type::number) || at->value->number != format_version) {
      wrong_type(*at, "the format's version 1");
    }
  }

  // A long comment may be a list of lines.
  std::string read_comment(const JsonPlace& place) {
    if (!place.value->is(Type::array)) return text(place).value_or("");
    std::string comment;
    for (size_t i = 0; i < place.value->elements.size(); ++i) {
      if (i) comment += '\n';
      comment += text(place.element(i)).value_or("");
    }
    return comment;
  }

  void read_units(const JsonPlace& place) {
    const auto read = text(place);
    if (!read) return;
    guarded(place, [&] { return metres_per_unit(*read); });
    scene_.units = *read;
  }

  void read_parameters(const JsonPlace& place) {
    if (!object(place, "an object of numbers by name")) return;
    for (const JsonMember& member : place.value->members) {
      if (!is_name(member.key)) {
        error_at_key(place, member,
                     "'" + member.key +
                         "' cannot name a parameter; letters, digits and _ are accepted, but not "
                         "x, y, z and pi");
        continue;
      }
      const auto read = number(place.member(member), "the parameter");
      if (read) scene_.parameters.push_back({member.key, *read});
      // A wrong one has some value all the same, so that its users are not reported too.
      parameters[member.key] = read.value_or(1);
    }
  }

  void read_materials(const JsonPlace& place) {
    if (!object(place, "an object of materials by name")) return;
    for (const JsonMember& member : place.value->members) {
      const JsonPlace inside = place.member(member);
      materials.push_back(member.key);
      if (!is_material_name(member.key)) {
        error_at_key(place, member,
                     "'" + member.key +
                         "' cannot name a material; letters, digits, space, _, - and . are "
                         "accepted");
      }
      if (object(inside, "an object of the material's properties")) {
        scene_.materials.push_back(read_material(inside, member.key));
      }
    }
    if (place.value->members.empty()) error(place, "there is no material; at least 1 is needed");
  }

  static bool is_material_name(const std::string& name) {
    const auto good = [](char c) {
      return ('a' <= c && c <= 'z') || ('A' <= c && c <= 'Z') || ('0' <= c && c <= '9') ||
             c == ' ' || c == '_' || c == '-' || c == '.';
    };
    return !name.empty() && name[0] != ' ' && std::all_of(name.begin(), name.end(), good);
  }

  Material read_material(const JsonPlace& place, const std::string& name) {
    Material m;
    m.name = name;
    check_keys(place, material_keys());
    constexpr double no_limit = std::numeric_limits<double>::max();
    if (const auto at = place.find("color")) m.color = color(*at, 1).value_or(m.color);
    if (const auto at = place.find("emission"))
      m.emission = color(*at, no_limit).value_or(m.emission);
    read_share(place, "roughness", m.roughness);
    read_share(place, "metallic", m.metallic);
    if (const auto at = place.find("index_of_refraction")) {
      m.index_of_refraction =
          number(*at, "index_of_refraction", Range::positive).value_or(m.index_of_refraction);
    }
    if (const auto at = place.find("density")) m.density = number(*at, "density", Range::positive);
    if (const auto at = place.find("metadata"); at && object(*at, "an object of free values")) {
      for (const JsonMember& member : at->value->members) {
        m.metadata.push_back({member.key, json_text(member.value)});
      }
    }
    return m;
  }

  void read_share(const JsonPlace& place, const char* key, double& to) {
    const auto at = place.find(key);
    if (!at) return;
    const auto read = number(*at, key);
    if (read && !(*read >= 0 && *read <= 1)) {
      wrong_type(*at, "a number from 0 to 1");
    } else if (read) {
      to = *read;
    }
  }

  void read_attributes(const JsonPlace& place) {
    if (!object(place, "an object of attributes by name")) return;
    for (const JsonMember& member : place.value->members) {
      if (!is_name(member.key)) {
        error_at_key(place, member,
                     "'" + member.key +
                         "' cannot name an attribute; letters, digits and _ are "
                         "accepted, but not x, y, z and pi");
        continue;
      }
      read_attribute(place.member(member), member.key);
    }
  }

  void read_attribute(const JsonPlace& place, const std::string& name) {
    Attribute attribute;
    attribute.name = name;
    ValueShape shape;
    Fractions made;
    scene_.source.lines[place.pointer] = place.value->line;
    if (place.value->is(Type::object)) {
      check_keys(place, {"value", "unit", "unit_vector", "fallback"});
      if (const auto at = place.find("unit")) attribute.unit = text(*at).value_or("");
      if (const auto at = place.find("value")) {
        made = value(*at, shape);
      } else {
        error(place, "an attribute needs 'value': a field, a number, a list of these, or a rule");
      }
      read_unit_vector(place, attribute);
    } else {
      made = value(place, shape);
    }
    if (!made) return;
    if (attribute.unit_vector && shape.components != 3) {
      error(place,
            "a unit vector has 3 components; the value has " + std::to_string(shape.components));
    }
    attribute.component_names = shape.names;
    if (made.rule().type->name == "value") {
      attribute.components = std::get<std::vector<Field>>(made.rule().arguments[0]);
    } else {
      attribute.rule = made;
      attribute.rule_components = shape.components;
    }
    scene_.attributes.push_back(std::move(attribute));
  }

  void read_unit_vector(const JsonPlace& place, Attribute& attribute) {
    if (const auto at = place.find("unit_vector")) {
      attribute.unit_vector = boolean(*at).value_or(false);
    }
    if (const auto at = place.find("fallback")) {
      if (!attribute.unit_vector) error(*at, "a fallback needs \"unit_vector\": true");
      attribute.fallback = direction(*at, "fallback").value_or(attribute.fallback);
    }
  }

  void read_sections(const JsonPlace& place) {
    if (!list(place, "a list of sections")) return;
    for (size_t i = 0; i < place.value->elements.size(); ++i) {
      const JsonPlace at = place.element(i);
      if (!object(at, "an object such as {\"remove\": solid}")) continue;
      check_keys(at, {"remove", "keep"});
      Section section;
      if (const auto remove = at.find("remove")) {
        section.remove = field(*remove);
      } else {
        error(at, "a section needs 'remove': the solid that is taken away");
      }
      if (const auto keep = at.find("keep"); keep && list(*keep, "a list of fields")) {
        for (size_t k = 0; k < keep->value->elements.size(); ++k) {
          section.keep.push_back(field(keep->element(k)));
        }
      }
      scene_.sections.push_back(std::move(section));
    }
  }

  void read_bounds(const JsonPlace& place) {
    if (!place.value->is(Type::array) || place.value->elements.size() != 2) {
      wrong_type(place, "[lowest corner, highest corner]");
      return;
    }
    const auto lo = vector3(place.element(0), "the lowest corner");
    const auto hi = vector3(place.element(1), "the highest corner");
    if (!lo || !hi) return;
    for (int axis = 0; axis < 3; ++axis) {
      if ((*lo)[axis] < (*hi)[axis]) continue;
      error(place,
            "the highest corner is not above the lowest along " + std::string(1, char('x' + axis)));
      return;
    }
    scene_.stated_bounds = BoundingBox{*lo, *hi};
  }

  void read_view(const JsonPlace& place) {
    if (!object(place, "an object such as {\"direction\": [1, -1, 1]}")) return;
    check_keys(place, {"direction"});
    if (const auto at = place.find("direction")) {
      scene_.view.direction = direction(*at, "direction").value_or(scene_.view.direction);
    }
  }

  SceneDescription scene_;
};

std::string contents(const std::string& path) {
  std::stringstream text;
  if (path == "-") {
    text << std::cin.rdbuf();
    return text.str();
  }
  std::ifstream file(path, std::ios::binary);
  // A folder opens, but cannot be read.
  if (file) file.peek();
  if (!file.is_open() || file.bad() || (file.fail() && !file.eof())) {
    const std::string reason = errno ? std::strerror(errno) : "unknown reason";
    throw SceneErrors({Error("cannot read the scene file: " + reason, path)});
  }
  file.clear();
  text << file.rdbuf();
  return text.str();
}

}  // namespace

SceneErrors::SceneErrors(std::vector<Error> all)
    : Error(joined(all), all[0].file, all[0].line, all[0].pointer), errors(std::move(all)) {}

SceneDescription parse_scene(const std::string& text, const std::string& file,
                             const std::map<std::string, Field>& fields) {
  std::vector<Error> problems;
  JsonValue root;
  try {
    root = parse_json(text, file, problems);
  } catch (const Error& error) {
    problems.push_back(error);
    throw SceneErrors(std::move(problems));
  }
  return SceneReader(file, fields).read(root, std::move(problems));
}

Fractions parse_value_rule(const std::string& text, const std::map<std::string, Field>& fields) {
  std::vector<Error> problems;
  const JsonValue root = parse_json(text, "", problems);
  return ValueRuleReader(fields).read(root, std::move(problems));
}

SceneDescription read_scene(const std::string& path) {
  errno = 0;
  return parse_scene(contents(path), path == "-" ? "standard input" : path);
}

std::vector<std::string> scene_keys() {
  return {"sardf",      "title",    "comment", "units",     "parameters",
          "fields",     "solid",    "blend",   "materials", "fractions",
          "attributes", "sections", "bounds",  "lipschitz", "view"};
}

std::vector<std::string> material_keys() {
  return {"color",    "roughness", "metallic", "index_of_refraction",
          "emission", "density",   "metadata"};
}

}  // namespace sardf

#include <cmath>
#include <filesystem>
#include <iostream>
#include <optional>
#include <utility>

#include "sardf/constructor.hpp"
#include "sardf/output_file.hpp"
#include "sardf/scene_file.hpp"
#include "sardf/scene_file_names.hpp"
#include "sardf/scene_file_rules.hpp"

namespace sardf {

namespace {

template <class Numbers>
JsonValue numbers(const Numbers& v) {
  JsonValue list = JsonValue::list();
  for (const double a : v) list.add(JsonValue::of(a));
  return list;
}

template <class Points>
JsonValue points(const Points& all) {
  JsonValue list = JsonValue::list();
  for (const auto& point : all) list.add(numbers(point));
  return list;
}

JsonValue color_json(const Vec3& linear) {
  const std::string hex = hex_color(linear);
  return hex.empty() ? numbers(linear) : JsonValue::of(hex);
}

JsonValue axis_json(const Vec3& v) {
  for (size_t axis = 0; axis < 3; ++axis) {
    Vec3 unit{};
    unit[axis] = 1;
    if (v == unit) return JsonValue::of(std::string(1, char('x' + axis)));
  }
  return numbers(v);
}

JsonValue blend_json(const Blend& blend) {
  if (blend.parameters.empty()) return JsonValue::of(blend.name);
  const BlendType& type = *find_blend_type(blend.name);
  JsonValue inside = JsonValue::object();
  for (size_t i = 0; i < blend.parameters.size(); ++i) {
    inside.add(type.parameters[i].name, JsonValue::of(blend.parameters[i]));
  }
  if (blend.parameters.size() == 1) inside = JsonValue::of(blend.parameters[0]);
  JsonValue object = JsonValue::object();
  object.add(blend.name, std::move(inside));
  return object;
}

bool is_default(const ParameterInfo& info, const Value& value) {
  if (value.index() == 0) return true;
  if (info.required || value.index() != info.default_value.index()) return false;
  return std::visit(
      [&](const auto& a) {
        using T = std::decay_t<decltype(a)>;
        if constexpr (std::is_same_v<T, Field> || std::is_same_v<T, std::vector<Field>> ||
                      std::is_same_v<T, std::vector<PlaneSection>> ||
                      std::is_same_v<T, RulePointer>) {
          return false;
        } else if constexpr (std::is_same_v<T, BlendPointer>) {
          return a->name == std::get<T>(info.default_value)->name && a->parameters.empty();
        } else {
          return a == std::get<T>(info.default_value);
        }
      },
      value);
}

// The file's name in a scene of this folder; an absolute name stays.
std::string path_from(const std::string& folder, const FilePath& file) {
  namespace fs = std::filesystem;
  if (fs::path(file.text).is_absolute()) return file.text;
  std::error_code error;
  const auto whole = [&](const std::string& path) {
    return fs::weakly_canonical(fs::absolute(path.empty() ? "." : path, error), error);
  };
  const fs::path from = whole(file.folder), to = whole(folder);
  if (error || from == to) return file.text;
  return whole(file.full()).lexically_proximate(to).generic_string();
}

class SceneWriter {
 public:
  /// `folder`: that the names of files become relative to; none: they stay as they were given.
  SceneWriter(const SceneDescription& scene, const ReplacedArguments& replaced,
              std::optional<std::string> folder)
      : scene_(scene), replaced_(replaced), names_(scene), folder_(std::move(folder)) {}

  JsonValue document() {
    JsonValue top = JsonValue::object();
    top.add("sardf", JsonValue::of(1.0));
    if (!scene_.title.empty()) top.add("title", JsonValue::of(scene_.title));
    if (!scene_.comment.empty()) top.add("comment", JsonValue::of(scene_.comment));
    top.add("units", JsonValue::of(scene_.units));
    add_if_any(top, "parameters", parameters());
    add_if_any(top, "fields", fields());
    if (scene_.solid) top.add("solid", field(scene_.solid));
    if (scene_.blend) top.add("blend", blend_json(*scene_.blend));
    add_if_any(top, "materials", materials());
    if (scene_.fractions) top.add("fractions", fractions(scene_.fractions));
    add_if_any(top, "attributes", attributes());
    add_if_any(top, "sections", sections());
    if (scene_.stated_bounds) {
      JsonValue bounds = JsonValue::list();
      bounds.add(numbers(scene_.stated_bounds->lo));
      bounds.add(numbers(scene_.stated_bounds->hi));
      top.add("bounds", std::move(bounds));
    }
    if (scene_.stated_lipschitz) top.add("lipschitz", JsonValue::of(*scene_.stated_lipschitz));
    if (scene_.view.direction != Framing().direction) {
      JsonValue view = JsonValue::object();
      view.add("direction", numbers(scene_.view.direction));
      top.add("view", std::move(view));
    }
    return top;
  }

 private:
  static void add_if_any(JsonValue& to, const char* key, JsonValue value) {
    if (!value.members.empty() || !value.elements.empty()) to.add(key, std::move(value));
  }

  JsonValue parameters() const {
    JsonValue object = JsonValue::object();
    for (const auto& [name, value] : scene_.parameters) object.add(name, JsonValue::of(value));
    return object;
  }

  JsonValue fields() const {
    JsonValue object = JsonValue::object();
    for (const NamedField& named : names_.defined()) {
      const std::string name = names_.name_of(named.field);
      // Of two names for one field the second names the first.
      object.add(named.name,
                 name == named.name ? definition_or_number(named.field) : JsonValue::of(name));
    }
    return object;
  }

  JsonValue field(const Field& f) const {
    const std::string name = names_.name_of(f);
    return name.empty() ? definition(f) : JsonValue::of(name);
  }

  // Where a number may stand for a field.
  JsonValue field_or_number(const Field& f) const {
    return names_.name_of(f).empty() ? definition_or_number(f) : field(f);
  }

  JsonValue definition_or_number(const Field& f) const {
    const Construction& made = *f.construction();
    const bool is_number = !made.constructor && made.names.empty() && is_constant(f.expression()) &&
                           std::isfinite(f.expression()->value);
    return is_number ? JsonValue::of(f.expression()->value) : definition(f);
  }

  JsonValue definition(const Field& f) const {
    const Construction& made = *f.construction();
    if (!made.constructor) return JsonValue::of(std::string("=").append(names_.formula_text(made)));
    const auto other = replaced_.find(&made);
    const std::vector<Value>& values = other == replaced_.end() ? made.arguments : other->second;
    JsonValue arguments = JsonValue::object();
    for (size_t i = 0; i < values.size(); ++i) {
      const ParameterInfo& info = made.constructor->parameters[i];
      if (is_default(info, values[i])) continue;
      arguments.add(info.name, argument(info, values[i]));
    }
    JsonValue object = JsonValue::object();
    object.add(made.constructor->name, std::move(arguments));
    return object;
  }

  JsonValue argument(const ParameterInfo& info, const Value& value) const {
    return std::visit(
        [&](const auto& a) -> JsonValue {
          using T = std::decay_t<decltype(a)>;
          if constexpr (std::is_same_v<T, bool> || std::is_same_v<T, double> ||
                        std::is_same_v<T, std::string>) {
            return JsonValue::of(a);
          } else if constexpr (std::is_same_v<T, Field>) {
            return field_or_number(a);
          } else if constexpr (std::is_same_v<T, BlendPointer>) {
            return blend_json(*a);
          } else if constexpr (std::is_same_v<T, std::vector<Field>>) {
            return info.type == ParameterType::values ? field_or_number_list(a) : field_list(a);
          } else if constexpr (std::is_same_v<T, std::vector<PlaneSection>>) {
            JsonValue list = JsonValue::list();
            for (const PlaneSection& section : a) list.add(plane_section(section));
            return list;
          } else if constexpr (std::is_same_v<T, std::vector<Vec2>> ||
                               std::is_same_v<T, std::vector<Vec3>>) {
            return points(a);
          } else if constexpr (std::is_same_v<T, std::vector<double>>) {
            return numbers(a);
          } else if constexpr (std::is_same_v<T, PointGrid>) {
            JsonValue list = JsonValue::list();
            for (const auto& row : a) list.add(points(row));
            return list;
          } else if constexpr (std::is_same_v<T, FilePath>) {
            return JsonValue::of(folder_ ? path_from(*folder_, a) : a.text);
          } else if constexpr (std::is_same_v<T, RulePointer>) {
            return value_rule(a);
          } else if constexpr (std::is_same_v<T, std::monostate>) {
            return {};
          } else if constexpr (std::is_same_v<T, Vec3>) {
            return info.type == ParameterType::axis ? axis_json(a) : numbers(a);
          } else {
            return numbers(a);
          }
        },
        value);
  }

  // Inside a rule for values even where the scene's fractions are being written.
  JsonValue value_rule(const RulePointer& rule) const {
    const bool before = std::exchange(writing_values_, true);
    JsonValue made = fractions(Fractions(rule));
    writing_values_ = before;
    return made;
  }

  JsonValue plane_section(const PlaneSection& section) const {
    JsonValue object = JsonValue::object();
    object.add("field", field(section.field));
    object.add("z", JsonValue::of(section.z));
    return object;
  }

  JsonValue field_list(const std::vector<Field>& all) const {
    JsonValue list = JsonValue::list();
    for (const Field& f : all) list.add(field(f));
    return list;
  }

  JsonValue field_or_number_list(const std::vector<Field>& all) const {
    JsonValue list = JsonValue::list();
    for (const Field& f : all) list.add(field_or_number(f));
    return list;
  }

  JsonValue component_values(const std::vector<Field>& components) const {
    if (components.size() == 1) return field_or_number(components[0]);
    return field_or_number_list(components);
  }

  JsonValue materials() const {
    JsonValue object = JsonValue::object();
    for (const Material& m : scene_.materials) object.add(m.name, material(m));
    return object;
  }

  static JsonValue material(const Material& m) {
    const Material usual;
    JsonValue object = JsonValue::object();
    object.add("color", color_json(m.color));
    const auto add = [&](const char* key, double value, double unless) {
      if (value != unless) object.add(key, JsonValue::of(value));
    };
    add("roughness", m.roughness, usual.roughness);
    add("metallic", m.metallic, usual.metallic);
    add("index_of_refraction", m.index_of_refraction, usual.index_of_refraction);
    if (m.emission != usual.emission) object.add("emission", color_json(m.emission));
    if (m.density) object.add("density", JsonValue::of(*m.density));
    JsonValue metadata = JsonValue::object();
    std::vector<Error> problems;
    for (const auto& [name, text] : m.metadata) {
      metadata.add(name, parse_json(text, "", problems));
    }
    add_if_any(object, "metadata", std::move(metadata));
    return object;
  }

  JsonValue fractions(const Fractions& of) const {
    const Rule& rule = of.rule();
    if (rule.type->name == "value") {
      const auto& components = std::get<std::vector<Field>>(rule.arguments[0]);
      return component_values(components);
    }
    const auto* shares = std::get_if<Shares>(&rule.arguments[0]);
    if (shares && shares->size() == 1) return JsonValue::of((*shares)[0].first);
    JsonValue object = JsonValue::object();
    if (has_whole_value(*rule.type)) {
      object.add(rule.type->name, rule_value(rule.arguments[0]));
    } else {
      object.add(rule.type->name, rule_values(rule.type->parameters, rule.arguments));
    }
    return object;
  }

  template <class T>
  static bool is_usual(const RuleParameter& info, const RuleValue& value) {
    const auto *given = std::get_if<T>(&value), *usual = std::get_if<T>(&info.default_value);
    return given && usual && *given == *usual;
  }

  JsonValue rule_values(const std::vector<RuleParameter>& infos,
                        const std::vector<RuleValue>& values) const {
    JsonValue object = JsonValue::object();
    for (size_t i = 0; i < infos.size() && i < values.size(); ++i) {
      if (values[i].index() == 0) continue;
      if (is_usual<double>(infos[i], values[i]) || is_usual<std::string>(infos[i], values[i])) {
        continue;
      }
      if (const auto* part = std::get_if<Fractions>(&values[i])) {
        object.add(key_of(*part), fractions(*part));
      } else if (infos[i].type == RuleParameterType::records) {
        JsonValue list = JsonValue::list();
        for (const Record& record : std::get<std::vector<Record>>(values[i])) {
          list.add(rule_values(infos[i].record, record.values));
        }
        object.add(infos[i].name, std::move(list));
      } else {
        object.add(infos[i].name, rule_value(values[i]));
      }
    }
    return object;
  }

  std::string key_of(const Fractions& part) const {
    if (writing_values_) return "value";
    const auto* shares = std::get_if<Shares>(&part.rule().arguments[0]);
    return shares && shares->size() == 1 ? "material" : "fractions";
  }

  JsonValue rule_value(const RuleValue& value) const {
    if (const auto* number = std::get_if<double>(&value)) return JsonValue::of(*number);
    if (const auto* word = std::get_if<std::string>(&value)) return JsonValue::of(*word);
    if (const auto* one = std::get_if<Field>(&value)) return field(*one);
    JsonValue object = JsonValue::object();
    if (const auto* shares = std::get_if<Shares>(&value)) {
      for (const auto& [name, share] : *shares) object.add(name, JsonValue::of(share));
    }
    if (const auto* functions = std::get_if<MaterialFunctions>(&value)) {
      for (const auto& [name, function] : *functions) object.add(name, function_or_rest(function));
    }
    return object;
  }

  // The word "rest" is no field's name here.
  JsonValue function_or_rest(const Field& function) const {
    if (!function) return JsonValue::of(std::string("rest"));
    JsonValue written = field_or_number(function);
    const bool misread = written.is(JsonValue::Type::string) && written.text == "rest";
    return misread ? JsonValue::of(std::string("=rest")) : written;
  }

  JsonValue attributes() {
    JsonValue object = JsonValue::object();
    writing_values_ = true;
    for (const Attribute& a : scene_.attributes) {
      JsonValue inside = JsonValue::object();
      inside.add("value", a.rule ? fractions(a.rule) : component_values(a.components));
      if (!a.unit.empty()) inside.add("unit", JsonValue::of(a.unit));
      if (a.unit_vector) {
        inside.add("unit_vector", JsonValue::of(true));
        if (a.fallback != Attribute().fallback) inside.add("fallback", axis_json(a.fallback));
      }
      object.add(a.name, std::move(inside));
    }
    writing_values_ = false;
    return object;
  }

  JsonValue sections() const {
    JsonValue list = JsonValue::list();
    for (const Section& s : scene_.sections) {
      JsonValue section = JsonValue::object();
      section.add("remove", field(s.remove));
      add_if_any(section, "keep", field_list(s.keep));
      list.add(std::move(section));
    }
    return list;
  }

  const SceneDescription& scene_;
  const ReplacedArguments& replaced_;
  FieldNames names_;
  std::optional<std::string> folder_;
  mutable bool writing_values_ = false;
};

}  // namespace

std::string scene_text(const SceneDescription& scene, const ReplacedArguments& replaced,
                       const std::optional<std::string>& folder) {
  return pretty_json(SceneWriter(scene, replaced, folder).document());
}

void write_scene(const std::string& path, const SceneDescription& scene,
                 const ReplacedArguments& replaced) {
  const std::string folder =
      path == "-" ? "." : (std::filesystem::path(".") / path).parent_path().string();
  const std::string text = scene_text(scene, replaced, folder);
  if (path == "-") {
    std::cout << text;
    return;
  }
  OutputFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace sardf

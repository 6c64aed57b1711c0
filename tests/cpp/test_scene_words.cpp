// tests/scenes/everything.json, which the tests of reading and writing use, says each word of the
// lists of constructors, blends and rules, and gives each of their parameters another value than
// its default.
#include <gtest/gtest.h>

#include <set>

#include "sardf/constructor.hpp"
#include "sardf/field_parts.hpp"
#include "sardf/scene_file.hpp"
#include "source_folder.hpp"

namespace sardf {
namespace {

// Lists are the same only where both are empty.
bool same(const auto& given, const auto& usual) {
  return std::visit(
      [&]<class T>(const T& a) {
        const T* b = std::get_if<T>(&usual);
        if (!b) return false;
        if constexpr (std::is_scalar_v<T> || std::is_same_v<T, std::string> ||
                      std::is_same_v<T, Vec2> || std::is_same_v<T, Vec3>) {
          return a == *b;
        } else if constexpr (std::is_same_v<T, BlendPointer>) {
          return a->name == (*b)->name;
        } else if constexpr (requires { a.empty(); }) {
          return a.empty() && b->empty();
        }
        return true;
      },
      given);
}

class Words {
 public:
  void add(const Field& field) { open_.push_back(field); }
  void add(const Fractions& rule) {
    if (!rule) return;
    const Rule& made = rule.rule();
    said_.insert(made.type->name);
    add_values(made.type->name, made.type->parameters, made.arguments);
  }
  std::set<std::string> take() {
    while (!open_.empty()) {
      const Field field = open_.back();
      open_.pop_back();
      if (const Construction* made = field.construction()) add(*made);
    }
    return std::move(said_);
  }

 private:
  void add(const Construction& made) {
    if (!seen_.insert(&made).second) return;
    for (const auto& [name, part] : made.names) add(part);
    if (!made.constructor) return;
    said_.insert(made.constructor->name);
    for (size_t i = 0; i < made.arguments.size(); ++i) {
      const ParameterInfo& parameter = made.constructor->parameters[i];
      const Value& value = made.arguments[i];
      append_fields(value, open_);
      if (const auto* rule = std::get_if<RulePointer>(&value)) add(Fractions(*rule));
      if (const auto* blend = std::get_if<BlendPointer>(&value)) said_.insert((*blend)->name);
      if (parameter.required || !same(value, parameter.default_value)) {
        said_.insert(made.constructor->name + "." + parameter.name);
      }
    }
  }

  void add_values(const std::string& owner, const std::vector<RuleParameter>& parameters,
                  const std::vector<RuleValue>& values) {
    for (size_t i = 0; i < values.size(); ++i) {
      const RuleParameter& parameter = parameters[i];
      const std::string name = owner + "." + parameter.name;
      if (parameter.required || !same(values[i], parameter.default_value)) said_.insert(name);
      if (const auto* rule = std::get_if<Fractions>(&values[i])) add(*rule);
      if (const auto* records = std::get_if<std::vector<Record>>(&values[i])) {
        for (const Record& record : *records) add_values(name, parameter.record, record.values);
      }
    }
  }

  std::vector<Field> open_;
  std::set<const Construction*> seen_;
  std::set<std::string> said_;
};

std::set<std::string> words_of(const SceneDescription& scene) {
  Words words;
  for (const NamedField& named : scene.fields) words.add(named.field);
  words.add(scene.solid);
  words.add(scene.fractions);
  std::vector<Field> inside_rules;
  append_fields(scene.fractions, inside_rules);
  for (const Attribute& attribute : scene.attributes) {
    words.add(attribute.rule);
    append_fields(attribute.rule, inside_rules);
    // A value alone is kept without its rule.
    if (!attribute.rule) words.add(Fractions::value(attribute.components));
  }
  for (const Section& section : scene.sections) words.add(section.remove);
  for (const Field& field : inside_rules) words.add(field);
  return words.take();
}

void add_words(std::vector<std::string>& to, const std::string& owner,
               const std::vector<RuleParameter>& parameters) {
  for (const RuleParameter& parameter : parameters) {
    to.push_back(owner + "." + parameter.name);
    add_words(to, owner + "." + parameter.name, parameter.record);
  }
}

std::vector<std::string> all_words() {
  std::vector<std::string> all;
  for (const Constructor& constructor : constructors()) {
    all.push_back(constructor.name);
    for (const ParameterInfo& p : constructor.parameters) {
      all.push_back(constructor.name + "." + p.name);
    }
  }
  for (const BlendType& blend : blend_types()) all.push_back(blend.name);
  for (const RuleType& rule : fraction_rules()) {
    all.push_back(rule.name);
    add_words(all, rule.name, rule.parameters);
  }
  return all;
}

// Taken before any test adds an operation of its own.
const std::vector<std::string> listed = all_words();

TEST(SceneWords, AreAllInTheSceneThatSaysEverything) {
  const std::set<std::string> said =
      words_of(read_scene(source_folder() / "tests/scenes/everything.json"));
  EXPECT_GT(listed.size(), 200u);
  for (const std::string& word : listed) EXPECT_TRUE(said.count(word)) << word << " is missing";
}

// The walk above finds nothing that is not said.
TEST(SceneWords, AreNotFoundWhereTheyAreNotSaid) {
  const auto said = words_of(parse_scene(
      R"({"sardf": 1, "fields": {"a": {"sphere": {"radius": 1}},
            "b": {"translate": {"field": "a", "by": [1, 0, 0]}}},
          "solid": {"union": ["a", "b"]},
          "attributes": {"f": {"value": {"inverse_distance": {"features": [
            {"at": "b", "value": 1, "exponent": 1}]}}}}})",
      ""));
  EXPECT_EQ(said, (std::set<std::string>{
                      "inverse_distance", "inverse_distance.features",
                      "inverse_distance.features.at", "inverse_distance.features.fractions",
                      "min_max", "sphere", "sphere.radius", "translate", "translate.by",
                      "translate.field", "union", "union.of", "value", "value.components"}));
}

}  // namespace
}  // namespace sardf

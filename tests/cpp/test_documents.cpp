// The schema and the documents that are generated from the registries.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "sardf/constructor.hpp"
#include "sardf/document.hpp"
#include "sardf/fractions.hpp"
#include "sardf/scene_file.hpp"
#include "source_folder.hpp"

namespace sardf {
namespace {

using testing::HasSubstr;

TEST(Documents, SchemaKnowsEveryOperation) {
  const auto schema = nlohmann::json::parse(scene_schema());
  const auto& fields = schema.at("$defs").at("field").at("anyOf").at(1).at("properties");
  for (const Constructor& c : constructors()) {
    const auto& found = fields.at(c.name);
    const auto& parameters = found.contains("anyOf") ? found.at("anyOf").at(0) : found;
    for (const ParameterInfo& p : c.parameters) {
      EXPECT_THAT(parameters.at("properties").at(p.name).at("description").get<std::string>(),
                  testing::StartsWith(p.doc));
    }
  }
  const auto& blends = schema.at("$defs").at("blend").at("anyOf").at(1).at("properties");
  for (const BlendType& type : blend_types()) EXPECT_TRUE(blends.contains(type.name)) << type.name;
  const auto& rules = schema.at("$defs").at("fractions").at("anyOf").at(1).at("properties");
  const auto& values = schema.at("$defs").at("value").at("anyOf").at(2).at("properties");
  for (const RuleType& type : fraction_rules()) {
    const bool spoken = type.name != "value";
    EXPECT_EQ(rules.contains(type.name), spoken && type.use != RuleUse::values) << type.name;
    EXPECT_EQ(values.contains(type.name), spoken && type.use != RuleUse::fractions) << type.name;
  }
  EXPECT_EQ(schema.at("properties").size(), scene_keys().size());
}

TEST(Documents, ReferenceNamesEveryOperation) {
  const std::string text = operations_document();
  for (const Constructor& c : constructors()) {
    EXPECT_THAT(text, HasSubstr("\n### " + c.name + "\n\n" + c.doc)) << c.group;
  }
  for (const BlendType& type : blend_types()) EXPECT_THAT(text, HasSubstr("### " + type.name));
  for (const RuleType& type : fraction_rules()) {
    if (type.name == "value") continue;
    EXPECT_THAT(text, HasSubstr("### " + type.name + "\n"));
  }
  for (const char* function : {"| `sin(a)` |", "| `min(a, b, ...)` |", "| `clamp(a, b, c)` |"}) {
    EXPECT_THAT(text, HasSubstr(function));
  }
}

TEST(Documents, ReferenceInTheRepositoryIsCurrent) {
  std::stringstream kept;
  kept << std::ifstream(source_folder() / "docs/operations.md").rdbuf();
  EXPECT_EQ(kept.str(), operations_document()) << "sardf schema --document > docs/operations.md";
}

}  // namespace
}  // namespace sardf

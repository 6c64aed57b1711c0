#include "sardf/scene_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "sardf/arithmetic.hpp"
#include "sardf/constructor.hpp"
#include "sardf/formula.hpp"
#include "sardf/json_document.hpp"
#include "source_folder.hpp"

namespace sardf {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

SceneDescription parse(const std::string& text) { return parse_scene(text, "test.json"); }

std::string problem(const std::string& text) {
  try {
    parse(text);
  } catch (const SceneErrors& error) {
    return error.what();
  }
  return "";
}

// A scene that says everything a scene can say; test_scene_words.cpp sees to that.
const std::string everything_path = source_folder() / "tests/scenes/everything.json";

const std::string& everything() {
  static const std::string text = [] {
    std::stringstream read;
    read << std::ifstream(everything_path).rdbuf();
    return read.str();
  }();
  return text;
}

// As from that folder, in which a mesh lies.
SceneDescription parse_everything(const std::string& text) {
  return parse_scene(text, everything_path);
}

TEST(SceneFile, IsRead) {
  const SceneDescription s = parse_everything(everything());
  EXPECT_EQ(s.title, "all \"words\"");
  EXPECT_EQ(s.comment, "two\nlines");
  EXPECT_EQ(s.units, "cm");
  EXPECT_THAT(s.parameters, ElementsAre(std::pair{"R", 0.5}, std::pair{"twice", 1.0}));
  ASSERT_EQ(s.fields.size(), 43u);
  EXPECT_EQ(s.fields[0].name, "part");
  EXPECT_EQ(s.fields[7].field.construction(), s.fields[0].field.construction());
  const Field block = make_field("rounded_box", {Vec3{0, 0, 1}, Vec3{20, 12, 8}, 1.0});
  const Field bore = make_field("cylinder", {Vec3{}, Vec3{1, 0, 0}, 3.0, Value()});
  const Field part =
      make_field("difference", {std::vector<Field>{block, bore}, make_blend("sardf", {0.5})});
  EXPECT_EQ(s.fields[0].field.expression(), part.expression());
  EXPECT_EQ(s.materials[0].name, "hard steel");
  // 0x8a = 138: ((138/255 + 0.055) / 1.055)^2.4.
  EXPECT_NEAR(s.materials[0].color[0], 0.25415209, 1e-8);
  EXPECT_EQ(s.materials[0].density, 7.8);
  EXPECT_EQ(s.materials[0].metadata[1].second, "[1, 2.5, {\"a\": null}]");
  EXPECT_EQ(s.materials[1].emission[2], 12);
  EXPECT_EQ(s.attributes[1].components.size(), 3u);
  EXPECT_EQ(s.attributes[2].rule_components, 2u);
  EXPECT_EQ(s.sections[0].keep.size(), 2u);
  EXPECT_EQ(s.stated_bounds->hi, (Vec3{50, 50, 50}));
  EXPECT_EQ(s.stated_lipschitz, 3);
  EXPECT_EQ(s.view.direction, (Vec3{1, 1, 1}));
  EXPECT_EQ(s.source.lines.at("/solid"), 71);
}

// Equal expressions are one node, so equal pointers mean equal scenes.
void expect_same(const SceneDescription& a, const SceneDescription& b) {
  EXPECT_EQ(a.title, b.title);
  EXPECT_EQ(a.comment, b.comment);
  EXPECT_EQ(a.units, b.units);
  EXPECT_EQ(a.parameters, b.parameters);
  EXPECT_EQ(a.solid.expression(), b.solid.expression());
  for (const NamedField& named : a.fields) {
    const auto same = std::find_if(b.fields.begin(), b.fields.end(),
                                   [&](const NamedField& n) { return n.name == named.name; });
    ASSERT_NE(same, b.fields.end()) << named.name;
    EXPECT_EQ(named.field.expression(), same->field.expression()) << named.name;
  }
  ASSERT_EQ(a.materials.size(), b.materials.size());
  std::vector<std::string> names;
  for (size_t i = 0; i < a.materials.size(); ++i) {
    const Material &m = a.materials[i], &n = b.materials[i];
    names.push_back(m.name);
    EXPECT_EQ(std::tie(m.name, m.color, m.roughness, m.metallic, m.index_of_refraction, m.emission,
                       m.density, m.metadata),
              std::tie(n.name, n.color, n.roughness, n.metallic, n.index_of_refraction, n.emission,
                       n.density, n.metadata));
  }
  ASSERT_EQ(bool(a.fractions), bool(b.fractions));
  if (a.fractions) {
    EXPECT_EQ(lower(a.fractions, names, 2), lower(b.fractions, names, 2));
  }
  ASSERT_EQ(a.attributes.size(), b.attributes.size());
  for (size_t i = 0; i < a.attributes.size(); ++i) {
    const Attribute &m = a.attributes[i], &n = b.attributes[i];
    EXPECT_EQ(
        std::tie(m.name, m.unit, m.rule_components, m.component_names, m.unit_vector, m.fallback),
        std::tie(n.name, n.unit, n.rule_components, n.component_names, n.unit_vector, n.fallback));
    ASSERT_EQ(bool(m.rule), bool(n.rule));
    if (m.rule) {
      const std::vector<Expression> thirds(names.size(), constant(0.5));
      const Lowering lowering{names, 2, m.rule_components, thirds, m.component_names};
      EXPECT_EQ(lower(m.rule, lowering), lower(n.rule, lowering));
      continue;
    }
    ASSERT_EQ(m.components.size(), n.components.size());
    for (size_t k = 0; k < m.components.size(); ++k) {
      EXPECT_EQ(m.components[k].expression(), n.components[k].expression());
    }
  }
  ASSERT_EQ(a.sections.size(), b.sections.size());
  for (size_t i = 0; i < a.sections.size(); ++i) {
    EXPECT_EQ(a.sections[i].remove.expression(), b.sections[i].remove.expression());
    ASSERT_EQ(a.sections[i].keep.size(), b.sections[i].keep.size());
  }
  EXPECT_EQ(a.stated_bounds.has_value(), b.stated_bounds.has_value());
  EXPECT_EQ(a.stated_lipschitz, b.stated_lipschitz);
  EXPECT_EQ(a.view.direction, b.view.direction);
}

TEST(SceneFile, IsWrittenAndReadBack) {
  const SceneDescription first = parse_everything(everything());
  const std::string text = scene_text(first);
  const SceneDescription second = parse_everything(text);
  expect_same(first, second);
  EXPECT_EQ(scene_text(second), text);
  EXPECT_THAT(text, HasSubstr("\"color\": \"#8a8f98\""));
  EXPECT_THAT(text, HasSubstr("\"blend\": {\"sardf\": 0.5}"));
  EXPECT_THAT(text, HasSubstr("\"axis\": \"x\""));
  EXPECT_THAT(text, HasSubstr("sin(x/R) * part"));
}

TEST(SceneFile, NamesWhatIsSharedOrNamedByFormulas) {
  SceneDescription scene;
  const Field ball = make_field("sphere", {Vec3{}, 2.0});
  const Field cube = make_field("box", {Vec3{}, Vec3{3, 3, 3}});
  const Field moved = combine(ball, '+', Field::number(0.25));
  const Field other = combine(cube, '*', Field::number(-2));  // its operand is field_1 too
  const Field both = make_field("union", {std::vector<Field>{moved, other, ball}, min_max_blend()});
  scene.solid = make_field(
      "intersection",
      {std::vector<Field>{both, parse_formula("R*both - R", {{"both", both}}, {{"R", 4.0}})},
       min_max_blend()});
  const SceneDescription read = parse(scene_text(scene));
  EXPECT_EQ(read.solid.expression(), scene.solid.expression());
  EXPECT_THAT(scene_text(scene), HasSubstr("(4)*both - (4)"));
}

TEST(SceneFile, TakesNamesOfItsReader) {
  const Field ball = make_field("sphere", {Vec3{}, 2.0});
  const char* text = R"({"sardf": 1, "solid": "=ball - wall"})";
  const SceneDescription scene =
      parse_scene(text, "", {{"ball", ball}, {"wall", Field::number(1)}, {"unused", ball}});
  EXPECT_EQ(scene.solid.expression(), ball.expression() - constant(1));
  EXPECT_EQ(parse(scene_text(scene)).solid.expression(), scene.solid.expression());
  EXPECT_EQ(scene.fields.size(), 2u);
}

TEST(SceneFile, MayBeLargeAndDeep) {
  std::stringstream text;
  text << "{\"sardf\": 1, \"solid\": \"u9999\", \"fields\": {\n";
  // Every field names the one after it in the file: a chain of forward references.
  for (int i = 9999; i > 0; --i) {
    text << "\"u" << i << "\": {\"union\": {\"of\": [\"u" << i - 1 << "\", {\"sphere\": {"
         << "\"center\": [" << i % 100 << ", " << i / 100 << ", 0], \"radius\": 0.7}}], "
         << "\"blend\": {\"sardf\": 0.1}}},\n";
  }
  text << "\"u0\": {\"sphere\": {\"radius\": 1}}}}";
  const auto start = std::chrono::steady_clock::now();
  const SceneDescription scene = parse(text.str());
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
  EXPECT_LT(time.count(), 4) << "seconds, on a machine that may be busy";
  EXPECT_EQ(scene.fields.size(), 10000u);

  Field chain = make_field("sphere", {Vec3{}, 1.0});
  for (int i = 0; i < 20000; ++i) chain = make_field("offset", {chain, 0.001});
  SceneDescription deep;
  deep.solid = chain;
  EXPECT_EQ(parse(scene_text(deep)).solid.expression(), chain.expression());
}

TEST(SceneFile, IsNestedOnlySoDeep) {
  std::string open, close;
  for (int i = 0; i < 100000; ++i) {
    open += "{\"complement\": {\"field\": ";
    close += "}}";
  }
  EXPECT_THAT(problem("{\"sardf\": 1, \"solid\": " + open + "\"x\"" + close + "}"),
              HasSubstr("nested more than 256 deep"));
  EXPECT_THAT(problem(std::string(1000000, '[')), HasSubstr("nested more than 256 deep"));
}

TEST(SceneFile, CutAnywhereGivesAnErrorAndNothingElse) {
  const std::string text = everything();
  for (size_t n = 0; n + 1 < text.size(); n += 7) {
    EXPECT_THROW(parse(text.substr(0, n)), SceneErrors) << n;
  }
  // Beyond the comment of the first line, a control character is wrong everywhere.
  for (size_t i = text.find('\n') + 1; i < text.size(); i += 3) {
    std::string changed = text;
    changed[i] = '\x01';
    EXPECT_THROW(parse(changed), SceneErrors) << i;
  }
}

TEST(SceneFile, OfEveryExampleIsReadAndWritten) {
  size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(source_folder() / "scenes")) {
    if (entry.path().extension() != ".json") continue;
    SCOPED_TRACE(entry.path().string());
    const SceneDescription scene = read_scene(entry.path());
    expect_same(scene, parse_scene(scene_text(scene), entry.path()));
    ++count;
  }
  EXPECT_GT(count, 0u);
}

class SceneFolder : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("sardf_scene_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_;
};

TEST_F(SceneFolder, HoldsWrittenScenes) {
  const std::string path = folder_ / "part.json";
  const SceneDescription scene = parse_everything(everything());
  write_scene(path, scene);
  expect_same(scene, read_scene(path));
  EXPECT_EQ(read_scene(path).source.file, path);
  EXPECT_THROW(write_scene(folder_ / "none" / "part.json", scene), Error);
}

TEST_F(SceneFolder, SaysWhyAFileCannotBeRead) {
  const auto reason = [](const std::string& path) {
    try {
      read_scene(path);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(
      reason(folder_ / "none.json"),
      (folder_ / "none.json").string() + ": cannot read the scene file: No such file or directory");
  EXPECT_THAT(reason(folder_), HasSubstr("cannot read the scene file: Is a directory"));
  std::ofstream(folder_ / "bytes.json") << std::string("\xff\xfe\x00\x80", 4);
  EXPECT_THAT(reason(folder_ / "bytes.json"), HasSubstr("this is not JSON"));
}

TEST(SceneFile, ListsAllErrorsInOneText) {
  EXPECT_EQ(problem("{\"sardf\": 2,\n\"solid\": 5}"),
            "test.json:1: /sardf: found the number 2; the format's version 1 is accepted\n"
            "test.json:2: /solid: found the number 5; a field (a name, a formula \"=...\", or an "
            "object such as {\"sphere\": {...}}) is accepted");
}

}  // namespace
}  // namespace sardf

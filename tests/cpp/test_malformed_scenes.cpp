// Every file of tests/malformed says in comments what is wrong with it, on the line of the error:
//   // error <JSON pointer> part of the message
// Exactly these errors must be reported.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "sardf/scene_file.hpp"
#include "source_folder.hpp"

namespace sardf {
namespace {

namespace fs = std::filesystem;

struct Expected {
  int line;
  std::string pointer, message;
};

std::string contents(const fs::path& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

std::vector<Expected> expectations(const std::string& text) {
  std::vector<Expected> all;
  std::stringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::string mark = " error <";
    const size_t at = line.find(mark);
    if (at == std::string::npos) continue;
    const size_t begin = at + mark.size(), end = line.find("> ", begin);
    all.push_back({number, line.substr(begin, end - begin), line.substr(end + 2)});
  }
  return all;
}

std::vector<Error> problems(const std::string& text, const std::string& file) {
  try {
    const Scene scene(parse_scene(text, file));
  } catch (const SceneErrors& all) {
    return all.errors;
  } catch (const Error& one) {
    return {one};
  }
  return {};
}

class MalformedScene : public testing::TestWithParam<std::string> {};

TEST_P(MalformedScene, IsReportedWhereItIsWrong) {
  const std::string file = GetParam() + ".json";
  const std::string text = contents(source_folder() / "tests/malformed" / file);
  const std::vector<Expected> expected = expectations(text);
  const std::vector<Error> found = problems(text, file);
  ASSERT_FALSE(expected.empty());
  std::string listed;
  for (const Error& error : found) listed += std::string(error.what()) + "\n";
  ASSERT_EQ(found.size(), expected.size()) << listed;
  for (size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].file, file);
    EXPECT_EQ(found[i].line, expected[i].line) << listed;
    EXPECT_EQ(found[i].pointer, expected[i].pointer) << listed;
    EXPECT_THAT(found[i].message, testing::HasSubstr(expected[i].message));
  }
}

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const auto& entry : fs::directory_iterator(source_folder() / "tests/malformed")) {
    all.push_back(entry.path().stem().string());
  }
  std::sort(all.begin(), all.end());
  return all;
}

INSTANTIATE_TEST_SUITE_P(Files, MalformedScene, testing::ValuesIn(names()),
                         [](const auto& file) { return file.param; });

TEST(MalformedScenes, AreMany) { EXPECT_GE(names().size(), 60u); }

}  // namespace
}  // namespace sardf

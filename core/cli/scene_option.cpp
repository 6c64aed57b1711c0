#include "cli/scene_option.hpp"

#include <CLI/CLI.hpp>
#include <charconv>

#include "sardf/constructor.hpp"
#include "sardf/error.hpp"
#include "sardf/scene_file.hpp"

namespace sardf {

namespace {

// NAME or NAME=NUMBER.
BlendPointer blend_from(const std::string& text) {
  const size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  const BlendType* type = find_blend_type(name);
  if (!type) return make_blend(name, {});  // says what there is
  std::vector<Value> arguments;
  if (equals != std::string::npos) {
    double value = 0;
    const char *begin = text.data() + equals + 1, *end = text.data() + text.size();
    const auto [rest, problem] = std::from_chars(begin, end, value);
    if (problem != std::errc() || rest != end) {
      throw Error("the blend is '" + text + "'; NAME or NAME=NUMBER is accepted, as sardf=0.5");
    }
    arguments.push_back(value);
  }
  if (arguments.size() != type->parameters.size()) {
    const std::string wanted = type->parameters.empty() ? name : name + "=NUMBER";
    throw Error("the blend is '" + text + "'; '" + wanted + "' is accepted");
  }
  return make_blend(name, arguments);
}

}  // namespace

void SceneOption::add_to(CLI::App& command) {
  command.add_option("scene", path, "Scene file; - for standard input")->required();
  command.add_option(
      "--blend", blend,
      "Join every boolean by this blend instead: min_max, r_function, sardf=0.5, ...");
}

Scene SceneOption::read(const Progress& progress) const {
  const ProgressScope scope(progress);
  SceneDescription description = read_scene(path);
  if (!blend.empty()) description.blend = blend_from(blend);
  return Scene(std::move(description), progress);
}

}  // namespace sardf

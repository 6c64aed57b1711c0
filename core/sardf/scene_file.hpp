// Scene files: JSON with comments, read with every error located, and written back.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sardf/error.hpp"
#include "sardf/scene.hpp"

namespace sardf {

/// All that is wrong with a scene file, in the file's order; what() joins them, one a line.
struct SceneErrors : Error {
  explicit SceneErrors(std::vector<Error> all);
  std::vector<Error> errors;
};

/// Reads a scene; "-" reads standard input. Throws SceneErrors.
SceneDescription read_scene(const std::string& path);
/// The same from text; `file` is the name that errors carry, `fields` are names it may use besides
/// its own.
SceneDescription parse_scene(const std::string& text, const std::string& file,
                             const std::map<std::string, Field>& fields = {});

/// A rule that gives one number, as {"inverse_distance": {...}}, from text.
Fractions parse_value_rule(const std::string& text, const std::map<std::string, Field>& fields);

/// Arguments to write in place of those that a field was made with.
using ReplacedArguments = std::map<const Construction*, std::vector<Value>>;

/// The scene as text that parse_scene reads back to equal expressions. Shared fields are named;
/// relative names of files become relative to `folder`, or stay as they were given without one.
std::string scene_text(const SceneDescription& scene, const ReplacedArguments& replaced = {},
                       const std::optional<std::string>& folder = {});
/// Writes a temporary file and renames it; "-" writes standard output. Relative names of files
/// become relative to the folder of `path` (to the current one for "-"), so that they are found.
void write_scene(const std::string& path, const SceneDescription& scene,
                 const ReplacedArguments& replaced = {});

/// The JSON Schema (draft 2020-12) of scene files, generated from the registries.
std::string scene_schema();

/// The keys of a scene, and of a material, in the order in which they are written.
std::vector<std::string> scene_keys();
std::vector<std::string> material_keys();

}  // namespace sardf

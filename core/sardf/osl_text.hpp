// A scene's channels as an OSL shader: the same expressions, evaluated where a ray hits.
#pragma once

#include <string>
#include <vector>

#include "sardf/scene.hpp"

namespace sardf {

/// One output of the shader.
struct OslOutput {
  /// An identifier of OSL, unlike all others of the shader.
  std::string name;
  /// What it is: a channel's name, a material's for its fraction, or a component's of an attribute.
  std::string meaning;
  /// Whether it is of the type color; else it is a float.
  bool is_color = false;
};

struct OslShader {
  std::string text;
  std::vector<OslOutput> outputs;
};

/// The channels (bake_channels.hpp) as functions of the point in the object's space, which has to
/// be the scene's frame. Each operation's text comes from its record (numbers/trace.hpp), as
/// POV-Ray's does. OSL (Open Shading Language Specification 1.12) computes in single precision, and
/// defines x / 0 = 0, sqrt of a negative number as 0 and log of 0 as a large negative number.
///
/// fractions are a float for each material. Throws Error: an unknown channel, "normal" (the
/// renderer's own), or an operation without a formula, by its name.
OslShader osl_shader(const Scene& scene, const std::vector<std::string>& channels,
                     const std::string& name = "sardf_part");

/// The body of an OSL function of the operation's inputs a0, a1, ...: "float NAME(...) {...}".
/// Throws Error for an operation without a formula.
std::string osl_function(const std::string& name, const Operation& operation);

}  // namespace sardf

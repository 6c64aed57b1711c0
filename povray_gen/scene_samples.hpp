// A scene for POV-Ray with sampled functions in it, and what is stated of their errors.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "povray_gen/field_error.hpp"
#include "povray_gen/scene_text.hpp"

namespace sardf::povray {

struct SceneSamples {
  /// Samples in place of what has no formula; fields whose functions are written have a comment.
  PovrayScene scene;
  std::vector<SampledPointer> functions;
  /// Of what has samples in it: fields, the solid, red, green and blue, fractions.
  std::vector<StatedError> errors;
  std::string solid_comment;
  std::array<std::string, 3> color_comments;
  std::string fractions_comment;
  /// Fields that are not in the scene because they need samples that the picture does not.
  std::vector<std::string> left_out;

  /// For users: each sampled function and each error, and what was left out.
  std::vector<std::string> sentences() const;
  /// "" if nothing is left out.
  std::string left_out_sentence() const;
};

/// Samples what the picture needs, and with SamplingOptions::all_fields what any field needs. The
/// density files are named STEM_sampled_1.df3 and so on. Throws as sample_operations does.
SceneSamples sample_scene(const PovrayScene& exact, const std::string& stem,
                          const SamplingOptions& options);

}  // namespace sardf::povray

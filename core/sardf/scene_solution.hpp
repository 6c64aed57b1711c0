// The fitted functions of a scene, solved, and the scene with their solutions.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sardf/fit.hpp"
#include "sardf/scene_file.hpp"

namespace sardf {

struct SolvedField {
  std::string name;  // "fitted" where the field has none
  std::shared_ptr<const FitResult> result;
};

/// Of every `fitted` field, used or named, parts before what is made of them. Those that carry
/// coefficients are solved again; parts of their problems have the coefficients that they carry,
/// unless the scene was read under IgnoredCoefficients (shapes_fit.hpp). Throws Error that names
/// the field, Cancelled.
std::vector<SolvedField> solve_fields(const SceneDescription& scene, const Progress& progress = {});

/// The arguments of every `fitted` field with its coefficients and fingerprint, from solve_fields,
/// for scene_text and write_scene. Reading what they write solves nothing and gives equal
/// expressions.
ReplacedArguments solved_arguments(const SceneDescription& scene, const Progress& progress = {});

}  // namespace sardf

// The fitted functions of a scene, solved, and the scene with their solutions.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sardf/fit.hpp"
#include "sardf/scene.hpp"

namespace sardf {

struct SolvedField {
  std::string name;  // "fitted" where the field has none
  std::shared_ptr<const FitResult> result;
};

/// Of every `fitted` field, used or named, parts before what is made of them. Those that carry
/// coefficients are solved again. Throws Error that names the field, Cancelled.
std::vector<SolvedField> solve_fields(const SceneDescription& scene, const Progress& progress = {});

/// scene_text with the coefficients of every `fitted` field, from solve_fields. Reading it solves
/// nothing and gives equal expressions.
std::string solved_scene_text(const SceneDescription& scene, const Progress& progress = {});

}  // namespace sardf

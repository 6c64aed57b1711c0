// A solid as a scene for POV-Ray 3.7: an include file with the object, for anybody's scenes, and a
// scene that shows it.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "povray_gen/field_error.hpp"
#include "povray_gen/function_text.hpp"
#include "povray_gen/sampling.hpp"
#include "sardf/camera.hpp"

namespace sardf::povray {

enum class Look {
  shaded,   // lit, with shadows, for people
  flat,     // the colour itself, unlit and linear: for comparisons
  normals,  // 0.5 + 0.5 × the outward unit normal, unlit
};

struct PovrayScene {
  std::string title;                    ///< all identifiers begin with it
  Expression solid;                     ///< what is drawn, sections cut away; positive inside
  BoundingBox bounds;                   ///< the solid is empty outside; the isosurface's container
  std::vector<NamedExpression> fields;  ///< each becomes a function of its own
  std::array<Expression, 3> color{};    ///< linear Rec.709; null: a light grey
  /// Not written: of those with sampled functions in them, the errors are stated.
  std::vector<NamedExpression> fractions;
  /// Linear colours of the fractions' materials, where the color is their average; may be empty.
  std::vector<Vec3> material_colors;
  Camera camera;
  int width = 320;  ///< pixels; the camera's picture depends on their ratio
  int height = 240;
  Look look = Look::shaded;
  Vec3 background{0.9, 0.92, 0.95};  ///< linear; shaded only, other looks have none and alpha 0
  /// A bound of |grad solid| within the bounds that the user states where none can be proven. That
  /// of a solid with sampled functions in it, which are steeper, can always be.
  std::optional<double> stated_lipschitz;
};

struct SceneText {
  std::string include;      ///< the .inc file
  std::string scene;        ///< the .pov file
  std::string prefix;       ///< of all identifiers
  double max_gradient = 0;  ///< 1.02 × the bound
  bool proven = true;       ///< false: the bound is the stated one
  /// Each must be written as its file() beside the others.
  std::vector<SampledPointer> sampled;
  std::vector<StatedError> errors;     ///< of what has sampled functions in it
  std::vector<std::string> sentences;  ///< for users: of samples, errors, and what is left out
};

/// The two files' texts; the scene includes `include_name`, a file of its own folder. Throws Error
/// for a solid without finite Lipschitz bound, naming the operation at fault, where none is
/// stated; for empty or unbounded bounds; and for what POV-Ray cannot evaluate. Cancelled.
SceneText scene_text(const PovrayScene& scene, const std::string& include_name,
                     const SamplingOptions& sampling = {});

/// The camera as POV-Ray reads it: vectors only, so that nothing is rounded or mirrored on the way.
std::string camera_text(const Camera& camera, int width, int height);

}  // namespace sardf::povray

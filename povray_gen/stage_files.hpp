// A stage as POV-Ray files, and rendered from them. What the command line and Blender call.
#pragma once

#include <string>
#include <vector>

#include "sardf/progress.hpp"
#include "sardf/stage.hpp"

namespace sardf::povray {

struct StageFiles {
  std::string path;  ///< of the .pov file; of each part an .inc lies beside it: NAME_1.inc, ...
  std::string look = "lit";  ///< lit: matte surfaces under the stage's lights; flat, normals
  int width = 640, height = 480;
  int samples = 256;         ///< as SceneFiles has it
  int light_samples = 4;     ///< along each side of a light: 1 to 16
  std::string program = {};  ///< path of POV-Ray; empty: what find_povray finds
};

/// Writes the files, which appear when all are complete. The scene has no background: a picture's
/// alpha tells where solids are. Colours are linear radiances. "lit" shows matte surfaces of the
/// parts' base colours, with the world as ambient light that nothing shadows; roughness, metal and
/// emission do not count. Returns sentences for users, as write_files does. Throws Error for a path
/// that does not end in .pov, an unknown look, numbers out of range, and as scene_text does;
/// Failure when a file cannot be written; Cancelled.
std::vector<std::string> write_stage(const Stage& stage, const StageFiles& files,
                                     const Progress& progress = {});

/// Renders written files to `image`, .exr (linear, half precision, alpha), one ray for each pixel
/// through its centre. Throws Error for another ending, Failure when POV-Ray is missing or
/// complains; Cancelled.
void render_stage(const StageFiles& files, const std::string& image, const Progress& progress);

}  // namespace sardf::povray

// A scene as POV-Ray text, and rendered by POV-Ray.
#pragma once

#include <string>

#include "sardf/camera.hpp"
#include "sardf/progress.hpp"
#include "sardf/scene.hpp"

namespace sardf {

struct PovrayJob {
  std::string path;             // of the .pov file; the .inc and pictures lie beside it
  std::string look = "shaded";  // shaded, flat, normals
  Camera camera;
  int width = 640, height = 480;
};

/// Writes path and the .inc beside it.
void write_povray(const Scene& scene, const PovrayJob& job);

/// Renders a written job to `image`, .exr (linear) or .png. Throws Error when POV-Ray is missing,
/// complains, or draws nothing of the object; Cancelled.
void render_povray(const PovrayJob& job, const std::string& image, const Progress& progress);

}  // namespace sardf

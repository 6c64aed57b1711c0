// A whole scene as POV-Ray files, and rendered from them. What the command line and Python call.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sardf/camera.hpp"
#include "sardf/progress.hpp"
#include "sardf/scene.hpp"

namespace sardf::povray {

struct SceneFiles {
  std::string path;             // of the .pov file; the .inc lies beside it
  std::string look = "shaded";  // shaded, flat, normals
  Camera camera;
  int width = 640, height = 480;
  /// What has no formula is sampled at no more points than a cube with so many along each edge has:
  /// 8 to 512. 256 are 64 MiB for each operation.
  int samples = 256;
  /// Also writes the fields that need samples which the picture does not.
  bool all_fields = false;
};

/// Writes path, the .inc beside it and, for operations without a formula, density files; they
/// appear when all of them are complete. Density files that the replaced .inc reads and the new one
/// does not are removed. Returns sentences for users: of each density file, which function, how
/// many samples, how exact; of all fields, colours and fractions with samples in them, their
/// errors; which fields were left out. Throws Error for a path that does not end in .pov, an
/// unknown look, a number of samples that is not accepted, a bound that is not finite, and as
/// scene_text does; Failure when a file cannot be written; Cancelled.
std::vector<std::string> write_files(const Scene& scene, const SceneFiles& files,
                                     const Progress& progress = {});

/// Renders written files to `image`, .exr (linear) or .png. `check` receives the path of the
/// picture before it is renamed and returns a complaint or "". Throws Error for another ending,
/// Failure when POV-Ray is missing or complains; Cancelled.
void render_files(const SceneFiles& files, const std::string& image, const Progress& progress,
                  const std::function<std::string(const std::string&)>& check = {});

}  // namespace sardf::povray

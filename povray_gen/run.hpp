// POV-Ray as a child process.
#pragma once

#include <functional>
#include <string>

#include "sardf/progress.hpp"

namespace sardf::povray {

/// What POV-Ray writes. `exr` holds linear colours in half precision and is what comparisons read;
/// PNG is encoded as sRGB. Alpha is 0 where a ray hits nothing but a transparent background.
enum class Format { exr, png8, png16 };

struct RunOptions {
  int width = 320;
  int height = 240;
  Format format = Format::exr;
  bool alpha = true;
  bool antialias = false;
  /// More than one is faster, but then POV-Ray's isosurfaces differ from run to run in some pixels.
  int threads = 1;
  /// Seconds after which the render is given up; 0: never.
  double timeout = 0;
  /// Asked every 0.05 s whether to go on, with the share of pixels that POV-Ray says are done.
  Progress progress = {};
  std::string program = {};  ///< path of POV-Ray; empty: what find_povray finds
};

/// Renders `scene`, a .pov file that may include files of its folder, to `image`, whose folder must
/// exist. The picture appears under its name only when it is complete and sound.
///
/// Throws Error: POV-Ray missing (it says how to install it), its parse errors and warnings, a
/// max_gradient that is too small ("may contain holes"), the timeout, an unwritable picture, and
/// what `check` finds. `check` gets the path of the finished picture before it is renamed and
/// returns a complaint, a sentence, or "" if all is well: POV-Ray itself calls an empty picture a
/// success. Throws Cancelled when the progress says so; POV-Ray is then stopped.
void render(const std::string& scene, const std::string& image, const RunOptions& options,
            const std::function<std::string(const std::string&)>& check = {});

/// The first complaint in POV-Ray's messages that makes a picture wrong: a parse error or warning,
/// a fatal error, holes. Empty if there is none.
std::string complaint_in(const std::string& messages);

/// The share of pixels in POV-Ray's last message that tells one, "Rendered 5 of 20 pixels (25%)";
/// 0 before.
double share_in(const std::string& messages);

/// The path of the POV-Ray program: the one that is named, else $POVRAY, or `povray` in PATH.
/// Throws Failure if there is none.
std::string find_povray(const std::string& named = {});

}  // namespace sardf::povray

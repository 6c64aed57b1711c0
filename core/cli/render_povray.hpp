// POV-Ray's pictures for the command line: an empty one is an error.
#pragma once

#include <string>

#include "povray_gen/scene_files.hpp"

namespace sardf {

/// povray::render_files, and Failure when a picture with an alpha channel shows nothing.
void render_povray(const povray::SceneFiles& files, const std::string& image,
                   const Progress& progress);

}  // namespace sardf

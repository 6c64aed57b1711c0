// The options of commands that write a picture's scene for POV-Ray.
#pragma once

#include <CLI/CLI.hpp>

namespace sardf {

/// Adds --width, --height (pixels, from `least` on) and --samples; `files` is a povray::SceneFiles
/// or a povray::StageFiles.
template <class Files>
void add_picture_options(CLI::App& command, Files& files, int least) {
  for (const auto& [name, pixels] :
       {std::pair{"--width", &files.width}, std::pair{"--height", &files.height}}) {
    command.add_option(name, *pixels, "Pixels")
        ->check(CLI::Range(least, 16384))
        ->capture_default_str();
  }
  command
      .add_option("--samples", files.samples,
                  "What has no formula is sampled at up to this number of points, cubed")
      ->check(CLI::Range(8, 512))
      ->capture_default_str();
}

}  // namespace sardf

#include <CLI/CLI.hpp>
#include <iostream>

#include "cli/commands.hpp"
#include "cli/render_povray.hpp"
#include "sardf/camera_file.hpp"
#include "sardf/error.hpp"
#include "sardf/scene_file.hpp"

namespace sardf {

namespace {

struct Options {
  std::string scene, camera, image;
  PovrayJob job;
};

void povray(Options& options) {
  if (!options.job.path.ends_with(".pov")) {
    throw Error("the output must end in .pov; the functions go into an .inc file beside it",
                options.job.path);
  }
  const Scene scene(read_scene(options.scene), terminal_progress("finding bounds"));
  options.job.camera = options.camera.empty()
                           ? scene_camera(scene, options.job.width, options.job.height)
                           : read_camera(options.camera);
  write_povray(scene, options.job);
  std::cout << options.job.path << "\n";
  if (options.image.empty()) return;
  render_povray(options.job, options.image, terminal_progress("rendering"));
  std::cout << options.image << "\n";
}

}  // namespace

void add_povray(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("povray", "Write the scene as POV-Ray functions; render it");
  const auto options = std::make_shared<Options>();
  command->add_option("scene", options->scene, "Scene file; - for standard input")->required();
  command->add_option("-o,--output", options->job.path, "part.pov; part.inc is written beside it")
      ->required();
  command->add_option("--render", options->image, "Also render to this .exr (linear) or .png");
  command->add_option("--look", options->job.look, "shaded, flat or normals")
      ->check(CLI::IsMember({"shaded", "flat", "normals"}))
      ->capture_default_str();
  command->add_option("--camera", options->camera, "A camera.json; else the scene is framed");
  command->add_option("--width", options->job.width, "Pixels")
      ->check(CLI::Range(8, 16384))
      ->capture_default_str();
  command->add_option("--height", options->job.height, "Pixels")
      ->check(CLI::Range(8, 16384))
      ->capture_default_str();
  command->callback([options] { povray(*options); });
}

}  // namespace sardf

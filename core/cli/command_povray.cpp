#include <CLI/CLI.hpp>
#include <iostream>

#include "cli/commands.hpp"
#include "cli/picture_options.hpp"
#include "cli/render_povray.hpp"
#include "cli/scene_option.hpp"
#include "povray_gen/run.hpp"
#include "sardf/camera_file.hpp"
#include "sardf/error.hpp"

namespace sardf {

namespace {

struct Options {
  SceneOption scene;
  std::string camera, image;
  povray::SceneFiles files;
};

void write_and_render(Options& options) {
  if (!options.image.empty()) povray::find_povray();
  const Scene scene = options.scene.read(terminal_progress("finding bounds"));
  options.files.camera = options.camera.empty()
                             ? scene_camera(scene, options.files.width, options.files.height)
                             : read_camera(options.camera);
  const std::vector<std::string> sentences =
      povray::write_files(scene, options.files, terminal_progress("sampling"));
  for (const std::string& sentence : sentences) std::cout << sentence << "\n";
  std::cout << options.files.path << "\n";
  if (options.image.empty()) return;
  render_povray(options.files, options.image, terminal_progress("rendering"));
  std::cout << options.image << "\n";
}

}  // namespace

void add_povray(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("povray", "Write the scene as POV-Ray functions; render it");
  const auto options = std::make_shared<Options>();
  options->scene.add_to(*command);
  command
      ->add_option("-o,--output", options->files.path,
                   "part.pov; part.inc is written beside it, and samples of what has no formula")
      ->required();
  command->add_option("--render", options->image, "Also render to this .exr (linear) or .png");
  command->add_option("--look", options->files.look, "shaded, flat or normals")
      ->check(CLI::IsMember({"shaded", "flat", "normals"}))
      ->capture_default_str();
  command->add_option("--camera", options->camera, "A camera.json; else the scene is framed");
  add_picture_options(*command, options->files, 8);
  command->add_flag("--all-fields", options->files.all_fields,
                    "Also write fields that need samples which the picture does not");
  command->callback([options] { write_and_render(*options); });
}

}  // namespace sardf

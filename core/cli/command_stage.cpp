#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "cli/commands.hpp"
#include "cli/picture_options.hpp"
#include "povray_gen/run.hpp"
#include "povray_gen/stage_files.hpp"
#include "sardf/stage.hpp"

namespace sardf {

namespace {

struct Options {
  std::string stage, image;
  povray::StageFiles files;
};

void write_and_render(const Options& options) {
  if (!options.image.empty()) povray::find_povray();
  const Stage stage = read_stage(options.stage, terminal_progress("reading"));
  for (const std::string& sentence :
       povray::write_stage(stage, options.files, terminal_progress("sampling"))) {
    std::cout << sentence << "\n";
  }
  std::cout << options.files.path << "\n";
  if (options.image.empty()) return;
  povray::render_stage(options.files, options.image, terminal_progress("rendering"));
  std::cout << options.image << "\n";
}

}  // namespace

void add_stage(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("stage", "Write parts under Blender's lights for POV-Ray; render them");
  const auto options = std::make_shared<Options>();
  command->add_option("stage", options->stage, "stage.json: camera, lights, world, parts")
      ->required();
  command
      ->add_option("-o,--output", options->files.path,
                   "stage.pov; stage_1.inc and so on are written beside it")
      ->required();
  command->add_option("--render", options->image, "Also render to this .exr (linear)");
  command->add_option("--look", options->files.look, "lit (matte), flat or normals")
      ->check(CLI::IsMember({"lit", "flat", "normals"}))
      ->capture_default_str();
  add_picture_options(*command, options->files, 1);
  command
      ->add_option("--light-samples", options->files.light_samples,
                   "Along each side of an area light, and of soft shadows")
      ->check(CLI::Range(1, 16))
      ->capture_default_str();
  command->callback([options] { write_and_render(*options); });
}

}  // namespace sardf

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <iostream>

#include "cli/commands.hpp"
#include "cli/picture_size.hpp"
#include "cli/scene_option.hpp"
#include "sardf/camera_file.hpp"
#include "sardf/error.hpp"
#include "sardf/render.hpp"

namespace sardf {

namespace {

struct Options {
  SceneOption scene;
  std::string output, camera, size = "640x480", look = "shaded";
  int bits = 16;
  double tolerance = 0;
  bool transparent = false, time = false;
  RenderOptions render;
};

Depth depth_of(const Options& options) {
  const std::string ending = std::filesystem::path(options.output).extension();
  if (ending == ".exr" && options.bits == 8) {
    throw Error("--bits 8 needs a picture that ends in .png");
  }
  if (ending == ".exr") return options.bits == 32 ? Depth::float32 : Depth::half16;
  if (ending != ".png") {
    throw Error("the picture ends in '" + ending + "'; .png and .exr are accepted", options.output);
  }
  if (options.bits == 32) throw Error("--bits 32 needs a picture that ends in .exr");
  if (options.render.depth || options.render.normals) {
    throw Error("--depth and --normals need a picture that ends in .exr");
  }
  return options.bits == 8 ? Depth::byte8 : Depth::byte16;
}

void render_to_file(Options& options) {
  const PictureSize size = parse_size(options.size);
  const Depth depth = depth_of(options);
  RenderOptions& render_options = options.render;
  render_options.width = size.width;
  render_options.height = size.height;
  render_options.look = render_look(options.look);
  if (options.tolerance != 0) render_options.tolerance = options.tolerance;
  if (render_options.look == RenderLook::shaded && !options.transparent) {
    render_options.background = shaded_background;
  }
  const Scene scene = options.scene.read(terminal_progress("finding bounds"));
  render_options.camera = options.camera.empty() ? scene_camera(scene, size.width, size.height)
                                                 : read_camera(options.camera);
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t start_of_work = std::clock();
  const RenderedPicture picture = render(scene, render_options, terminal_progress("rendering"));
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  const double work = double(std::clock() - start_of_work) / CLOCKS_PER_SEC;
  // Normals are colours of a kind that no colour space may change.
  const bool is_color = render_options.look != RenderLook::normals;
  write_image(options.output, picture.image, is_color ? Meaning::color : Meaning::data, depth,
              picture.channels);
  std::cout << options.output << "\n";
  if (!options.time) return;
  std::printf("%.4f s, %.4f s of all threads together\n", taken.count(), work);
}

}  // namespace

void add_render(CLI::App& app) {
  CLI::App* command = app.add_subcommand("render", "Render the scene by sardf's own ray caster");
  const auto options = std::make_shared<Options>();
  options->scene.add_to(*command);
  command->add_option("-o,--output", options->output, "picture.png (sRGB), or picture.exr (linear)")
      ->required();
  command->add_option("--size", options->size, "WIDTHxHEIGHT")->capture_default_str();
  command->add_option("--look", options->look, "shaded, flat (the colours alone) or normals")
      ->check(CLI::IsMember({"shaded", "flat", "normals"}))
      ->capture_default_str();
  command->add_option("--camera", options->camera, "A camera.json; else the scene is framed");
  command->add_option("--bits", options->bits, "Of each channel: 8 or 16; of .exr 16 or 32")
      ->check(CLI::IsMember({8, 16, 32}))
      ->capture_default_str();
  command
      ->add_option("--tolerance", options->tolerance,
                   "No stretch of the solid that is longer along a ray is missed; scene units; "
                   "else 1e-4 of the diagonal")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--samples", options->render.samples,
                   "Rays along each side of a pixel; more smooth edges")
      ->check(CLI::Range(1, 8))
      ->capture_default_str();
  command->add_flag("--depth", options->render.depth, "Also the channel Z: depth along the view");
  command->add_flag("--normals", options->render.normals,
                    "Also the channels NX, NY, NZ: the outward normal");
  command->add_flag("--transparent", options->transparent,
                    "No background behind the lit picture; the other looks have none");
  command
      ->add_option("--threads", options->render.threads,
                   "At most so many; 0: all. The picture does not depend on it")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command->add_flag("--time", options->time, "Print how long the rays took");
  command->callback([options] { render_to_file(*options); });
}

}  // namespace sardf

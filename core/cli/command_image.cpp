#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>

#include "cli/commands.hpp"
#include "cli/scene_option.hpp"
#include "sardf/error.hpp"
#include "sardf/image_file.hpp"
#include "sardf/plane_image.hpp"
#include "sardf/vm_file.hpp"

namespace sardf {

namespace {

struct Options {
  SceneOption scene;
  std::string output;
  int size = 1024;
  double z = 0;
  std::vector<double> window;
};

// The field and what to draw of it.
std::pair<Expression, PlaneView> read(const Options& options) {
  PlaneView view;
  view.z = options.z;
  Expression field;
  if (std::filesystem::path(options.scene.path).extension() == ".vm") {
    if (!options.scene.blend.empty()) {
      throw Error("--blend joins the booleans of a scene; a .vm file has none", options.scene.path);
    }
    field = read_vm(options.scene.path);
  } else {
    const Scene scene = options.scene.read(terminal_progress("finding bounds"));
    field = scene.solid();
    const BoundingBox& box = scene.bounds();
    view.lo = {box.lo[0], box.lo[1]};
    view.hi = {box.hi[0], box.hi[1]};
  }
  if (!options.window.empty()) {
    view.lo = {options.window[0], options.window[1]};
    view.hi = {options.window[2], options.window[3]};
  }
  const double width = view.hi[0] - view.lo[0], height = view.hi[1] - view.lo[1];
  const double longest = std::max(width, height);
  const auto pixels = [&](double length) {
    return std::max(1, int(std::lround(std::min(1.0, length / longest) * options.size)));
  };
  view.width = pixels(width);
  view.height = pixels(height);
  return {field, view};
}

void draw(const Options& options) {
  const auto [field, view] = read(options);
  const std::vector<uint8_t> signs =
      sign_image(Evaluator(field), view, terminal_progress("drawing"));
  Image image{view.width, view.height, 1, {}};
  image.samples.assign(signs.begin(), signs.end());
  write_image(options.output, image, Meaning::data, Depth::byte8);
  std::cout << options.output << ": " << view.width << " x " << view.height << " pixels\n";
}

}  // namespace

void add_image(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "image", "Draw where a solid is on a plane z = constant: white inside, black outside");
  const auto options = std::make_shared<Options>();
  options->scene.add_to(*command);
  command->get_option("scene")->description(
      "Scene file, - for standard input, or a field as a .vm list of steps");
  command->add_option("-o,--output", options->output, "PNG to write")->required();
  command->add_option("--size", options->size, "Pixels along the longer side, 1 to 65536")
      ->check(CLI::Range(1, 65536))
      ->capture_default_str();
  command->add_option("--z", options->z, "Height of the plane, in scene units")
      ->capture_default_str();
  command
      ->add_option("--window", options->window,
                   "x0 y0 x1 y1, the part of the plane; else the scene's bounds, or -1 -1 1 1 of "
                   "a .vm file")
      ->expected(4);
  command->callback([options] { draw(*options); });
}

}  // namespace sardf

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>

#include "cli/commands.hpp"
#include "sardf/bake_channels.hpp"
#include "sardf/error.hpp"
#include "sardf/image_file.hpp"
#include "sardf/mesh_file.hpp"
#include "sardf/scene_file.hpp"
#include "sardf/surface.hpp"

namespace sardf {

namespace {

struct Options {
  std::string scene, output, format = "exr";
  std::vector<std::string> channels{"base_color", "roughness", "metallic", "fractions"};
  SurfaceOptions surface;
};

void make_folder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) throw Failure("the folder cannot be made: " + error.message(), path);
}

// Names inside the file: materials for fractions, else the image library's own (R, G, B or Y).
std::vector<std::string> names_of(const Scene& scene, const BakeChannel& channel) {
  std::vector<std::string> names = materials_of_channel(scene, channel.name);
  for (size_t i = names.size(); !names.empty() && i < channel.components.size(); ++i) {
    names.push_back("unused_" + std::to_string(i));
  }
  return names;
}

void bake_to_files(const Options& options) {
  const Scene scene(read_scene(options.scene), terminal_progress("finding bounds"));
  const std::vector<BakeChannel> channels = scene_channels(scene, options.channels);
  make_folder(options.output);
  const Mesh mesh = make_surface(scene, options.surface, terminal_progress("meshing"));
  const TexelMap texels(mesh, options.surface.texture_size, options.surface.gutter,
                        terminal_progress("unwrapping"));
  const std::filesystem::path folder(options.output);
  const auto write = [&](size_t k, Image&& image, const std::vector<unsigned char>& covered) {
    fill_uncovered(image, covered);
    const bool color = is_color_channel(channels[k].name);
    const bool exr = options.format == "exr";
    const Depth depth = exr                         ? Depth::float32
                        : options.format == "png16" ? Depth::byte16
                                                    : Depth::byte8;
    const std::string path = folder / (channels[k].name + (exr ? ".exr" : ".png"));
    write_image(path, image, color ? Meaning::color : Meaning::data, depth,
                names_of(scene, channels[k]));
    std::cout << path << "\n";
  };
  bake(texels, options.surface.sections ? scene.drawn() : scene.solid(), channels, write,
       terminal_progress("baking"));
  const std::string mesh_path = folder / "part.glb";
  write_mesh(mesh_path, mesh, {}, scene.metres_per_unit());
  std::cout << mesh_path << "\n";
}

}  // namespace

void add_bake(CLI::App& app) {
  CLI::App* command = app.add_subcommand("bake", "Bake materials into textures, beside the mesh");
  const auto options = std::make_shared<Options>();
  command->add_option("scene", options->scene, "Scene file; - for standard input")->required();
  command->add_option("-o,--output", options->output, "Folder to write to")->required();
  command->add_option("--size", options->surface.texture_size, "Texels along each side")
      ->check(CLI::Range(16, 16384))
      ->capture_default_str();
  command->add_option("--gutter", options->surface.gutter, "Texels between charts")
      ->capture_default_str();
  command->add_option("--resolution", options->surface.resolution, "Cells along the longest side")
      ->capture_default_str();
  command
      ->add_option("--channels", options->channels,
                   "base_color, roughness, metallic, emission, fractions, field, or attributes")
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--format", options->format, "exr (32-bit, linear), png16 or png8")
      ->check(CLI::IsMember({"exr", "png16", "png8"}))
      ->capture_default_str();
  command->add_flag("!--no-section", options->surface.sections, "Do not cut the part open");
  command->callback([options] { bake_to_files(*options); });
}

}  // namespace sardf

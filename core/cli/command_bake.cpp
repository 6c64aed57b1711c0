#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <map>

#include "cli/commands.hpp"
#include "cli/scene_option.hpp"
#include "sardf/bake_channels.hpp"
#include "sardf/error.hpp"
#include "sardf/image_file.hpp"
#include "sardf/mesh_file.hpp"
#include "sardf/surface.hpp"

namespace sardf {

namespace {

struct Options {
  SceneOption scene;
  std::string output, format = "exr";
  std::vector<std::string> channels{"base_color", "roughness", "metallic", "fractions"};
  SurfaceOptions surface;
};

struct Format {
  const char* extension;
  Depth depth;
};
const std::map<std::string, Format> formats{{"exr", {".exr", Depth::float32}},
                                            {"png16", {".png", Depth::byte16}},
                                            {"png8", {".png", Depth::byte8}},
                                            {"tx", {".tx", Depth::float32}}};

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
  const Scene scene = options.scene.read(terminal_progress("finding bounds"));
  const std::vector<BakeChannel> channels = scene_channels(scene, options.channels);
  make_folder(options.output);
  const Mesh mesh = make_surface(scene, options.surface, terminal_progress("meshing"));
  const TexelMap texels(mesh, options.surface.texture_size, options.surface.gutter,
                        terminal_progress("unwrapping"));
  const std::filesystem::path folder(options.output);
  const auto write = [&](size_t k, Image&& image, const std::vector<unsigned char>& covered) {
    fill_uncovered(image, covered);
    const bool color = is_color_channel(channels[k].name);
    const Meaning meaning = color ? Meaning::color : Meaning::data;
    const std::vector<std::string> names = names_of(scene, channels[k]);
    const Format& format = formats.at(options.format);
    const std::string path = folder / (channels[k].name + format.extension);
    if (options.format == "tx") {
      write_texture(path, image, meaning, names);
    } else {
      write_image(path, image, meaning, format.depth, names);
    }
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
  options->scene.add_to(*command);
  command->add_option("-o,--output", options->output, "Folder to write to")->required();
  command->add_option("--size", options->surface.texture_size, "Texels along each side")
      ->check(CLI::Range(16, 16384))
      ->capture_default_str();
  command->add_option("--gutter", options->surface.gutter, "Texels between charts")
      ->capture_default_str();
  command->add_option("--resolution", options->surface.resolution, "Cells along the longest side")
      ->capture_default_str();
  command
      ->add_option(
          "--channels", options->channels,
          "base_color, roughness, metallic, emission, fractions, field, normal, density, or "
          "attributes")
      ->delimiter(',')
      ->capture_default_str();
  command
      ->add_option("--format", options->format,
                   "exr (32-bit, linear), png16, png8, or tx (mip-mapped tiles)")
      ->check(CLI::IsMember(formats))
      ->capture_default_str();
  command->add_flag("!--no-section", options->surface.sections, "Do not cut the part open");
  command->callback([options] { bake_to_files(*options); });
}

}  // namespace sardf

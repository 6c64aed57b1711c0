#include <CLI/CLI.hpp>
#include <iostream>

#include "cli/commands.hpp"
#include "cli/scene_option.hpp"
#include "sardf/mesh_file.hpp"
#include "sardf/surface.hpp"

namespace sardf {

namespace {

struct Options {
  SceneOption scene;
  std::string output;
  SurfaceOptions surface;
};

// Fractions and base colour at the vertices, for the formats that carry them.
MeshAttributes vertex_attributes(const Scene& scene, const Mesh& mesh) {
  const size_t n = mesh.vertices.size(), materials = scene.fractions().size();
  MeshAttributes attributes;
  attributes.fraction_names = scene.material_names();
  std::vector<double> fractions(n * materials);
  scene.fractions_at(mesh.vertices[0].data(), n, fractions.data());
  attributes.fractions.assign(fractions.begin(), fractions.end());
  attributes.colors.resize(3 * n);
  for (size_t v = 0; v < n; ++v) {
    for (size_t m = 0; m < materials; ++m) {
      const Vec3& color = scene.description().materials[m].color;
      for (int c = 0; c < 3; ++c) {
        attributes.colors[3 * v + c] += float(fractions[v * materials + m] * color[c]);
      }
    }
  }
  return attributes;
}

void mesh(const Options& options) {
  check_mesh_path(options.output);
  const Scene scene = options.scene.read(terminal_progress("finding bounds"));
  const Mesh made = make_surface(scene, options.surface, terminal_progress("meshing"));
  write_mesh(options.output, made, vertex_attributes(scene, made), scene.metres_per_unit());
  std::cout << options.output << ": " << made.vertices.size() << " vertices, " << made.faces.size()
            << " faces\n";
}

}  // namespace

void add_mesh(CLI::App& app) {
  CLI::App* command = app.add_subcommand("mesh", "Write the surface as glb, ply or obj");
  const auto options = std::make_shared<Options>();
  options->scene.add_to(*command);
  command->add_option("-o,--output", options->output, "part.glb, part.ply or part.obj")->required();
  command->add_option("--resolution", options->surface.resolution, "Cells along the longest side")
      ->capture_default_str();
  command->add_option("--cell-size", options->surface.cell_size,
                      "Edge of a cell in scene units, instead of a resolution");
  command
      ->add_option("--size", options->surface.texture_size,
                   "Texture size that the UV atlas is made for; 0: no atlas")
      ->capture_default_str();
  command->add_flag("!--no-section", options->surface.sections, "Do not cut the part open");
  command->callback([options] { mesh(*options); });
}

}  // namespace sardf

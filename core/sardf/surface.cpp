#include "sardf/surface.hpp"

#include "sardf/mesher.hpp"
#include "sardf/pulse.hpp"

namespace sardf {

Mesh make_surface(const Scene& scene, const SurfaceOptions& options, const Progress& progress,
                  Atlas* atlas) {
  const bool textured = options.texture_size > 0;
  MeshOptions meshing;
  meshing.resolution = options.resolution;
  meshing.cell_size = options.cell_size;
  meshing.progress = part_of(progress, 0, textured ? 0.6 : 1);
  Mesh mesh = make_mesh(Evaluator(options.sections ? scene.drawn() : scene.solid()), scene.bounds(),
                        meshing);
  if (!textured) return mesh;
  Atlas made = make_atlas(mesh, options.texture_size, options.gutter, part_of(progress, 0.6, 1));
  if (atlas) *atlas = std::move(made);
  return mesh;
}

}  // namespace sardf

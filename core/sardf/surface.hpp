// From a scene to its textured surface: mesh, then atlas. What every front end calls.
#pragma once

#include "sardf/atlas.hpp"
#include "sardf/mesh.hpp"
#include "sardf/progress.hpp"
#include "sardf/scene.hpp"

namespace sardf {

struct SurfaceOptions {
  int resolution = 128;     // cells along the longest side of the bounds
  double cell_size = 0;     // scene units; replaces the resolution when > 0
  bool sections = true;     // cut the solid open
  int texture_size = 2048;  // 0: no atlas
  int gutter = 8;           // texels
};

/// The drawn solid's surface with texture coordinates. Throws Error (a resolution beyond memory, an
/// atlas that cannot fit) and Cancelled. `atlas` receives the charts when it is given.
Mesh make_surface(const Scene& scene, const SurfaceOptions& options, const Progress& progress = {},
                  Atlas* atlas = nullptr);

}  // namespace sardf

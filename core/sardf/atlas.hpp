// The UV atlas: cuts a mesh into charts along creases, flattens them and packs them in one image.
#pragma once

#include <cstdint>
#include <vector>

#include "sardf/mesh.hpp"
#include "sardf/progress.hpp"

namespace sardf {

/// One smooth piece of surface and its flat image. Stretch is measured at each triangle by the
/// singular values s1 >= s2 of the map from the surface to the atlas, divided by the atlas's
/// texels_per_unit: max(s1, 1 / s2), 1 where the map keeps all lengths. Densities are the square
/// root of texels per unit area.
struct Chart {
  /// Indices into Mesh::faces, ascending.
  std::vector<uint32_t> faces;
  /// In square scene units.
  double area = 0;
  /// Largest stretch, leaving out the worst triangles that make up 0.1 % of the chart's area
  /// (slivers of a mesh have no meaningful stretch).
  double stretch_max = 1;
  /// Mean stretch over the area, at least 1.
  double stretch_mean = 1;
  /// Texels per scene unit; min and max leave out 0.1 % of the area each, as stretch_max does.
  double density_min = 0;
  double density_max = 0;
  double density_mean = 0;
};

/// How a mesh lies in its texture.
struct Atlas {
  std::vector<Chart> charts;
  /// For each face the index of its chart.
  std::vector<uint32_t> chart_of_face;
  /// Texels along each side of the image for which the atlas was packed.
  int size = 0;
  /// Least number of texels between triangles of two charts; half of it (rounded up) is kept from
  /// the border of the image.
  int gutter = 0;
  /// The one scale of all charts.
  double texels_per_unit = 0;
  /// Share of the image covered by the charts themselves, without gutters, in [0, 1].
  double texels_used = 0;
};

/// Cuts, flattens and packs `mesh` and writes mesh.corner_uv (4 * faces, in [0, 1]², v upwards).
///
/// A face (a, b, c, d) is flattened, and must be drawn, as the triangles (a, b, c) and (a, c, d);
/// no two triangles of the atlas overlap and all keep their winding. No chart spans a crease: the
/// two sides of a crease, and of every other seam, have texture coordinates of their own. A chart
/// is a plane region without handles; it may have holes (a plate with bores is one chart). Where
/// two seams of the *same* chart face each other they also keep `gutter` texels apart, except close
/// to the inner end of a seam, where both sides meet, and except that charts of surfaces too
/// intricate for 60 charts may come as close as 3 texels to themselves.
///
/// Every chart has the same scale: the area of its image is its own area times texels_per_unit².
/// At most 60 charts, unless creases alone cut the surface into more pieces, or it has very many
/// handles, as walls of a lattice with many periods do. Compact charts are halved when that packs
/// better. The result does not depend on the number of threads.
///
/// Throws Error when the mesh has no faces or no area, an index beyond its vertices, a vertex that
/// is not finite or a wrong number of normals, when `size` is outside [16, 16384] or `gutter`
/// outside [1, size / 8], or when the charts cannot fit with that gutter. Throws Cancelled when
/// `progress` says so. The mesh is then unchanged.
Atlas make_atlas(Mesh& mesh, int size = 2048, int gutter = 8, const Progress& progress = {});

}  // namespace sardf

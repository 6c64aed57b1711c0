// How much of each material a scene holds.
#pragma once

#include <vector>

#include "sardf/progress.hpp"
#include "sardf/scene.hpp"

namespace sardf {

struct MaterialVolumes {
  double total = 0;               // cubic scene units, sections not cut
  std::vector<double> materials;  // one for each material, their sum is the total
};

/// Sums fractions over cells, `resolution` along the longest side of the bounds. A cell that the
/// surface crosses counts by the share that its linearised field leaves inside, so the error falls
/// with the square of the cell size; cells proven empty are skipped in blocks.
MaterialVolumes measure_volumes(const Scene& scene, int resolution = 160,
                                const Progress& progress = {});

}  // namespace sardf

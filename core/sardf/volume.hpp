// How much of each material a scene holds.
#pragma once

#include <vector>

#include "sardf/progress.hpp"
#include "sardf/scene.hpp"

namespace sardf {

struct MaterialVolumes {
  double total = 0;               // cubic scene units, sections not cut
  std::vector<double> materials;  // one for each material, their sum is the total
  double error = 0;               // of the total, estimated: not proven
};

/// Sums fractions over cells, `resolution` along each side of the bounds. A cell that the surface
/// crosses counts by the share that its linearised field leaves inside. Where halved cells give
/// another sum, as in walls thinner than a cell, they are halved again, five times at most; the
/// last changes make up the error.
MaterialVolumes measure_volumes(const Scene& scene, int resolution = 72,
                                const Progress& progress = {});

}  // namespace sardf

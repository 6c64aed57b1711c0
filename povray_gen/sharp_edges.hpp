// A simpler field with the same surface.
#pragma once

#include "sardf/graph.hpp"

namespace sardf::povray {

/// A field with the sign of the solid everywhere, so with its surface, and equal to it in every bit
/// inside, near faces, and near the surface away from edges. SARDF rounds level lines, but none of
/// the edges of its solids: minima and maxima have their surface (ops_sardf.hpp). Outside of boxes,
/// of extrusions and of caps the distance to the nearest face's plane stands for that to an edge.
/// Where values and not only their sign count, as under an offset or in a loft, all stays as it is.
Expression with_sharp_edges(const Expression& solid);

}  // namespace sardf::povray

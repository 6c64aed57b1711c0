// The colours of what rays meet; private to core/sardf/render*.cpp.
#pragma once

#include <span>

#include "sardf/render.hpp"
#include "sardf/render_stages.hpp"

namespace sardf::rendering {

/// A pixel that shows the solid.
struct Hit {
  Vec3 at;
  Vec3 toward;    // unit, against the ray
  Vec3 normal{};  // outward, unit; 0: the field has no direction there
  Vec3 color{};   // linear
};

/// The outward normals of the hits.
void find_normals(const Subject& subject, std::span<Hit> hits, Watch& watch);

/// Whether single precision serves for colours.
bool single_does(const Subject& subject, const Evaluator& color);
/// The colours themselves, as POV-Ray's flat picture has them: limited to [0, 1]. In single
/// precision where `single_does` and that is seen to do.
void find_colors(const Subject& subject, const Evaluator& color, std::span<Hit> hits, Watch& watch);
/// How far from the surface along the rays, in scene units, colours in single precision are taken
/// of hits that are known in single precision only.
double beside_rough_hits(const Subject& subject);
/// The colours of such hits; the numbers of those whose colour is not told come into `open`.
void find_rough_colors(const Subject& subject, const Evaluator& color, std::span<Hit> hits,
                       std::vector<size_t>& open, Watch& watch);

/// Lights the colours: a key light with a soft shadow and two without, placed as in povray_gen's
/// lit picture, and a share of the sky by distances along the normal.
void light(const Subject& subject, std::span<Hit> hits, Watch& watch);

}  // namespace sardf::rendering

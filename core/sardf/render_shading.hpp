// The colours of what rays meet; private to core/sardf/render*.cpp.
#pragma once

#include <functional>
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

/// Whether single precision serves for colours within the box.
bool single_does(const BoundingBox& box, const Evaluator& color);
/// Whether it serves for rays in single precision: else their surface has to be found in double
/// first, and some of the colours may be in double in any case.
bool single_pays(const BoundingBox& box, const Evaluator& color);
/// The colours themselves, as POV-Ray's flat picture has them: limited to [0, 1]. In single
/// precision where `single_does` and that is seen to do.
void find_colors(const Subject& subject, const LocalEvaluator& color, std::span<Hit> hits,
                 Watch& watch);
/// The colours of the table's rays, all of which have met the solid: use(first, n, block) for the
/// rays [first, first + n), whose colours are the first n of block.channels where both sides of the
/// surface have the same; the trial of the others has become NaN.
void mix_colors(const Subject& subject, const LocalEvaluator& color, RayTable& table, Watch& watch,
                const std::function<void(size_t first, size_t n, const RayBlock&)>& use);

/// Lights the colours: a key light with a soft shadow and two without, placed as in povray_gen's
/// lit picture, and a share of the sky by distances along the normal.
void light(const Subject& subject, std::span<Hit> hits, Watch& watch);

}  // namespace sardf::rendering

// Lights as Blender describes them, as POV-Ray's.
#pragma once

#include <string>

#include "sardf/evaluate.hpp"
#include "sardf/stage.hpp"

namespace sardf::povray {

/// light_source statements that give matte surfaces the radiance that Light states: POV-Ray shows
/// pigment × light × cosine, for a finish of `diffuse 1` and nothing else.
///
/// Point, spot and sun are one light_source, whose `area_light` of samples × samples blurs shadows
/// only; a surface is lit from its middle. With `fade_power 2` POV-Ray fades by 2 / (1 + (d / f)²),
/// so f = radius is the fading of a ball by Blender. An area light becomes samples² spotlights
/// whose `tightness 1` is the cosine at the emitter: Gauss points of a rectangle, rings of an
/// ellipse. `lit` bounds what is lit; a sun stands far away from it. samples: 1 to 16.
std::string light_text(const Light& light, const BoundingBox& lit, int samples);

}  // namespace sardf::povray

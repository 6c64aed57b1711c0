// Pictures of a scene by the core's own ray caster: certified steps over the field itself.
//
// The flat look is the picture that povray_gen writes for POV-Ray, pixel by pixel: the same rays
// through the pixels' centres, the same colours.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sardf/camera.hpp"
#include "sardf/image_file.hpp"
#include "sardf/scene.hpp"

namespace sardf {

enum class RenderLook {
  flat,     // the colour itself, unlit and linear
  shaded,   // lit by a key light with a soft shadow, darker where little of the sky is seen
  normals,  // 0.5 + 0.5 × the outward unit normal, unlit
};

/// "flat", "shaded" or "normals". Throws Error for another word.
RenderLook render_look(const std::string& name);

struct RenderOptions {
  /// Clipping distances do not count: the whole solid in front of the camera is seen.
  Camera camera;
  int width = 640;  ///< pixels, 1 to 16384
  int height = 480;
  /// Rays along each side of a pixel, 1 to 8: more smooth the picture's edges. Each holds memory.
  int samples = 1;
  RenderLook look = RenderLook::flat;
  /// Scene units, positive: no ray steps over a stretch of the solid that is longer along the ray.
  /// None: 1e-4 of the diagonal of the scene's bounds. Less than 1e-14 of a depth counts as that.
  std::optional<double> tolerance;
  /// Linear; alpha is 1 everywhere then. None: nothing is seen behind the solid, alpha 0.
  std::optional<Vec3> background;
  bool depth = false;    ///< one channel more: depth along the view, scene units; infinite: nothing
  bool normals = false;  ///< three channels more: the outward unit normal; 0: nothing, or none
  int threads = 0;       ///< at most; 0: all. The picture does not depend on it
};

/// The background that a lit picture has unless another is chosen.
inline constexpr Vec3 shaded_background{0.9, 0.92, 0.95};

struct RenderedPicture {
  /// Linear colour times alpha, alpha, then what was asked for.
  Image image;
  /// R, G, B, A, Z, NX, NY, NZ, as many as there are.
  std::vector<std::string> channels;
};

/// Renders what the scene shows, its sections cut away. A pixel shows the first point of the solid
/// on the ray through its centre, so that alpha is 0 or 1 without a background; with more samples
/// the mean of its parts, the least of their depths and the mean direction of their normals. Throws
/// Error for options out of their ranges and for a camera whose axes vanish; Cancelled.
RenderedPicture render(const Scene& scene, const RenderOptions& options,
                       const Progress& progress = {});

/// Where the rays of a picture meet a solid that the box is proven to hold (certified_bounds): the
/// depth along the view of each pixel, row 0 at the top, in the units of the field's coordinates;
/// infinite where there is nothing. Of `options` camera, width, height, tolerance and threads
/// count. Throws as render does, and Error for a box that is empty or infinite.
std::vector<double> render_depths(const Evaluator& solid, const BoundingBox& bounds,
                                  const RenderOptions& options, const Progress& progress = {});

}  // namespace sardf

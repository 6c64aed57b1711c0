// Cameras as JSON, the form in which renderers hand them to each other; and a scene's own camera.
#pragma once

#include <string>

#include "sardf/camera.hpp"
#include "sardf/scene.hpp"

namespace sardf {

/// The camera that frames a scene, seen from where the scene's framing says.
Camera scene_camera(const Scene& scene, int width, int height);

/// {"matrix_world": [[4 numbers] × 4], "type": "PERSP" | "ORTHO", "lens", "sensor_width",
/// "sensor_height", "sensor_fit": "AUTO" | "HORIZONTAL" | "VERTICAL", "ortho_scale", "shift_x",
/// "shift_y", "clip_start", "clip_end"}.
std::string camera_text(const Camera& camera);

/// What camera_text made; fields left out keep their defaults, others are ignored. Throws Error.
Camera camera_from_text(const std::string& text);

/// The same from a file; errors name it.
Camera read_camera(const std::string& path);

}  // namespace sardf

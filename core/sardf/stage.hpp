// Solids in their places under lights, as Blender describes them: what another renderer must be
// told to draw the same picture.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "sardf/camera.hpp"
#include "sardf/scene.hpp"

namespace sardf {

/// Row-major; the columns are the images of the three axes, and the place.
using Matrix4 = std::array<std::array<double, 4>, 4>;

inline constexpr Matrix4 identity_matrix{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};

/// A light. It shines along the third column of its matrix, backwards; what is said of white
/// surfaces holds for matte ones of albedo 1 that face the light at the distance d.
struct Light {
  enum class Type {
    point,  ///< a ball; a white surface has the radiance power / (4 pi^2 (d^2 + radius^2))
    sun,    ///< from everywhere along one direction; a white surface has power / pi
    spot,   ///< a point's, within a cone
    area,   ///< one side of a flat shape, equally bright: its radiance is power / (pi area)
  };
  enum class Shape { rectangle, ellipse };

  std::string name;  ///< for errors and comments
  Type type = Type::point;
  Matrix4 matrix_world = identity_matrix;
  Vec3 color{1, 1, 1};             ///< linear Rec.709
  double power = 10;               ///< W; of a sun W per square unit
  double radius = 0;               ///< of point and spot, in units; 0: hard shadows
  bool soft_falloff = true;        ///< false: without the radius² in the denominator
  double angle = 0;                ///< of a sun: its disk's diameter as seen from here, radians
  double spot_size = 0.785398163;  ///< whole angle of the cone, radians, in (0, pi]
  /// Share of the cone that is blurred, in [0, 1]: where the cosine is by up to blend (1 - c) above
  /// c, that of half the cone, brightness rises from 0 to 1 by the cubic 3 t^2 - 2 t^3.
  double spot_blend = 0;
  bool spot_cosine = false;        ///< a spot is weaker by the cosine of the angle from its axis
  Shape shape = Shape::rectangle;  ///< of an area light
  double size_x = 1, size_y = 1;   ///< its edges or diameters along the first two columns
  bool shadow = true;
};

/// A solid with its sections, and where it stands.
struct StagePart {
  std::shared_ptr<const Scene> scene;
  Matrix4 matrix_world = identity_matrix;
};

struct Stage {
  Camera camera;
  Vec3 world{};  ///< the same radiance from all sides, linear; a white surface has it, too
  std::vector<Light> lights;
  std::vector<StagePart> parts;
};

/// A stage from JSON text:
///
///     {"camera": as camera_from_text reads it, "world": {"color": [r, g, b], "strength"},
///      "lights": [{"type": "point" | "sun" | "spot" | "area", "matrix_world", "color", "tint",
///                  "power", "exposure", "radius", "soft_falloff", "angle", "spot_size",
///                  "spot_blend", "shape": "rectangle" | "ellipse", "size_x", "size_y", "shadow",
///                  "name"}],
///      "parts": [{"scene": a scene or the path of its file, "matrix_world"}],
///      "blender": [major, minor, patch]}
///
/// Only camera and parts are needed. The colour of a light is color × tint, its power is power ×
/// 2^exposure. Paths are relative to the folder of `file`, which errors name. "blender" says whose
/// lights these are: in 3.4, measured, an area light is weaker by pi/4 and a spot by the cosine of
/// the angle from its axis; in 5.0 neither. The change is taken to be in 4.0. Progress: scenes that
/// are solved for. Throws Error, with the pointer to what is wrong: a type, a number that is not
/// finite or out of range, an unknown key, no part; as parse_scene does. Cancelled.
Stage stage_from_text(const std::string& text, const std::string& file = "",
                      const Progress& progress = {});

/// The same from a file.
Stage read_stage(const std::string& path, const Progress& progress = {});

}  // namespace sardf

// Tangent-space normals: the solid's normal at a texel, seen from the mesh's frame there.

#include <cmath>

#include "sardf/bake_stages.hpp"

namespace sardf::baking {
namespace {

/// Smallest squared cosine between the solid's normal and the mesh's: 45 degrees, as for moving
/// points onto the surface. Beyond, the gradient is another face's.
constexpr double aligned = 0.5;
constexpr std::array<float, 3> unbent{0.5f, 0.5f, 1.0f};

struct Frame {
  Vec3 tangent{}, normal{};
  double sign = 0;
};

std::array<float, 3> color_of(const Frame& frame, const Vec3& gradient) {
  // The field grows inwards.
  const Vec3 outwards = -1.0 * gradient;
  const double cosine = dot(outwards, frame.normal);
  const double squares = dot(outwards, outwards) * dot(frame.normal, frame.normal);
  if (!(squares > 0) || !(cosine > 0) || !(cosine * cosine >= aligned * squares)) return unbent;
  // Coordinates in the frame (t, b, n), which is neither orthogonal nor of unit length: renderers
  // interpolate its vectors and take them as they are.
  const Vec3& t = frame.tangent;
  const Vec3& n = frame.normal;
  const Vec3 b = (frame.sign < 0 ? -1.0 : 1.0) * cross(n, t);
  const double determinant = dot(t, cross(b, n));
  Vec3 at{dot(cross(b, n), outwards), dot(cross(n, t), outwards), dot(cross(t, b), outwards)};
  if (determinant < 0) at = -1.0 * at;
  const double length = norm(at);
  if (!(length > 0) || !(at[2] > 0)) return unbent;
  return {float(0.5 + 0.5 * at[0] / length), float(0.5 + 0.5 * at[1] / length),
          float(0.5 + 0.5 * at[2] / length)};
}

}  // namespace

void tangent_normals(const Mesh& mesh, std::span<const std::array<float, 4>> tangents,
                     const TexelCorners& corners, size_t first, size_t n, float* const* rows) {
  for (size_t i = 0; i < n; ++i) {
    Frame frame;
    const size_t corner = 4 * size_t(corners.face[first + i]);
    for (size_t k = 0; k < 4; ++k) {
      const double weight = corners.weight[first + i][k];
      const auto& t = tangents[corner + k];
      frame.tangent = frame.tangent + weight * Vec3{t[0], t[1], t[2]};
      frame.normal = frame.normal + weight * mesh.corner_normals[corner + k];
      frame.sign += weight * t[3];
    }
    const std::array<float, 3> color = color_of(frame, {rows[0][i], rows[1][i], rows[2][i]});
    for (size_t axis = 0; axis < 3; ++axis) rows[axis][i] = color[axis];
  }
}

}  // namespace sardf::baking

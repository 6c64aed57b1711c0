// Which corner a quad begins with: programs split a quad from its first corner to its third.
#include <algorithm>
#include <cmath>

#include "sardf/mesher_stages.hpp"

namespace sardf::mesher {

namespace {

// Differences of rounding decide nothing: on flat faces both diagonals are as good.
constexpr double clearly_better = 1e-9;

}  // namespace

void choose_diagonal(Mesh& mesh, size_t face) {
  auto& v = mesh.faces[face];
  Vec3* normals = &mesh.corner_normals[4 * face];
  // Corners go round almost twice, so that those of a triangle are neighbours.
  double at[3][7], normal[3][7];
  for (size_t k = 0; k < 7; ++k) {
    for (size_t axis = 0; axis < 3; ++axis) {
      at[axis][k] = mesh.vertices[v[k & 3]][axis];
      normal[axis][k] = normals[k & 3][axis];
    }
  }
  // How well the triangle without corner k agrees with its corners' normals: the least cosine; -2
  // without area.
  const auto agreement = [&](size_t k) {
    const auto side = [&](int axis, size_t j) { return at[axis][k + j] - at[axis][k + 1]; };
    const double x = side(1, 2) * side(2, 3) - side(2, 2) * side(1, 3);
    const double y = side(2, 2) * side(0, 3) - side(0, 2) * side(2, 3);
    const double z = side(0, 2) * side(1, 3) - side(1, 2) * side(0, 3);
    const auto along = [&](size_t j) {
      return x * normal[0][k + j] + y * normal[1][k + j] + z * normal[2][k + j];
    };
    const double length = std::sqrt(x * x + y * y + z * z);
    const double a = along(1), b = along(2), c = along(3);
    const double ab = a < b ? a : b, least = ab < c ? ab : c;
    return length > 0 ? least / length : -2.0;
  };
  const double kept = std::min(agreement(3), agreement(1));
  if (kept >= 1 - clearly_better) return;
  const double turned = std::min(agreement(0), agreement(2));
  if (!(turned > kept + clearly_better)) return;
  std::rotate(v.begin(), v.begin() + 1, v.end());
  std::rotate(normals, normals + 1, normals + 4);
}

}  // namespace sardf::mesher

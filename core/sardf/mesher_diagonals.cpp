// Which corner a quad begins with: programs split a quad from its first corner to its third.
#include <algorithm>

#include "sardf/mesher_stages.hpp"

namespace sardf::mesher {

namespace {

// Differences of rounding decide nothing: on flat faces both diagonals are as good.
constexpr double clearly_better = 1e-9;

}  // namespace

void choose_diagonal(Mesh& mesh, size_t face) {
  auto& v = mesh.faces[face];
  Vec3* normals = &mesh.corner_normals[4 * face];
  std::array<Vec3, 4> at;
  for (size_t k = 0; k < 4; ++k) at[k] = mesh.vertices[v[k]];
  // How well the triangle without corner k agrees with its corners' normals: the least cosine; -2
  // without area.
  const auto agreement = [&](size_t k) {
    const size_t a = (k + 1) & 3, b = (k + 2) & 3, c = (k + 3) & 3;
    const Vec3 normal = cross(at[b] - at[a], at[c] - at[a]);
    const double length = norm(normal);
    if (!(length > 0)) return -2.0;
    const double least =
        std::min({dot(normal, normals[a]), dot(normal, normals[b]), dot(normal, normals[c])});
    return std::min(1.0, least / length);
  };
  const double kept = std::min(agreement(3), agreement(1));
  const double turned = std::min(agreement(0), agreement(2));
  if (!(turned > kept + clearly_better)) return;
  std::rotate(v.begin(), v.begin() + 1, v.end());
  std::rotate(normals, normals + 1, normals + 4);
}

}  // namespace sardf::mesher

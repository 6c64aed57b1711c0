// Which corner a quad begins with: programs split a quad from its first corner to its third.
#include <algorithm>

#include "sardf/mesher_stages.hpp"

namespace sardf::mesher {

namespace {

// How well a triangle of corners agrees with their normals: the least cosine; -2 without area.
double agreement(const Mesh& mesh, size_t face, const std::array<size_t, 3>& k) {
  const auto& v = mesh.faces[face];
  const Vec3 &a = mesh.vertices[v[k[0]]], &b = mesh.vertices[v[k[1]]], &c = mesh.vertices[v[k[2]]];
  const Vec3 normal = cross(b - a, c - a);
  const double length = norm(normal);
  if (!(length > 0)) return -2;
  double least = length;
  for (const size_t corner : k) {
    least = std::min(least, dot(normal, mesh.corner_normals[4 * face + corner]));
  }
  return least / length;
}

// Differences of rounding decide nothing: on flat faces both diagonals are as good.
constexpr double clearly_better = 1e-9;

}  // namespace

void choose_diagonals(Mesh& mesh, Work& work) {
  work.run(mesh.faces.size(), 4096, [&](size_t first, size_t last) {
    for (size_t f = first; f < last; ++f) {
      const double kept = std::min(agreement(mesh, f, {0, 1, 2}), agreement(mesh, f, {0, 2, 3}));
      const double turned = std::min(agreement(mesh, f, {1, 2, 3}), agreement(mesh, f, {1, 3, 0}));
      if (!(turned > kept + clearly_better)) continue;
      std::rotate(mesh.faces[f].begin(), mesh.faces[f].begin() + 1, mesh.faces[f].end());
      const auto normals = mesh.corner_normals.begin() + 4 * std::ptrdiff_t(f);
      std::rotate(normals, normals + 1, normals + 4);
    }
  });
}

}  // namespace sardf::mesher

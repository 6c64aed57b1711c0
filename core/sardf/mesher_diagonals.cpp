// Which corner a quad begins with: programs split a quad from its first corner to its third.
#include <algorithm>
#include <cmath>

#include "sardf/mesher_stages.hpp"

namespace sardf::mesher {

namespace {

// Differences of rounding decide nothing: on flat faces both diagonals are as good.
constexpr double clearly_better = 1e-9;
constexpr float clearly_better_single = 1e-6f;

// Faces that are looked at together.
constexpr size_t faces_at_once = 64;
using Vectors = float[3][faces_at_once];

// How well triangles with the sides a and b and these normals at their corners agree with them: the
// least cosine; -2 without area. `to` is none of the others, as the compiler must know.
void find_agreement(const Vectors& a, const Vectors& b, const Vectors& n0, const Vectors& n1,
                    const Vectors& n2, size_t n, float* __restrict to) {
  for (size_t i = 0; i < n; ++i) {
    const float x = a[1][i] * b[2][i] - a[2][i] * b[1][i];
    const float y = a[2][i] * b[0][i] - a[0][i] * b[2][i];
    const float z = a[0][i] * b[1][i] - a[1][i] * b[0][i];
    const float c0 = x * n0[0][i] + y * n0[1][i] + z * n0[2][i];
    const float c1 = x * n1[0][i] + y * n1[1][i] + z * n1[2][i];
    const float c2 = x * n2[0][i] + y * n2[1][i] + z * n2[2][i];
    const float c01 = c0 < c1 ? c0 : c1, least = c01 < c2 ? c01 : c2;
    const float square = x * x + y * y + z * z, cosine = least / std::sqrt(square);
    to[i] = square > 0 ? cosine : -2.0f;
  }
}

// Faces of smooth vertices, some at a time as arrays, for vector instructions. Single precision
// tells angles of 0.1 degrees.
class SmoothFaces {
 public:
  static constexpr size_t capacity = faces_at_once;

  SmoothFaces(const Grid& grid, const Vertices& vertices, Mesh& mesh)
      : per_cell_(1 / grid.cell), vertices_(vertices), mesh_(mesh) {}

  /// Sets the corner normals of up to `capacity` faces and turns those of which the other diagonal
  /// is better; of faces with sharp vertices it only sets the normals of the smooth ones.
  void finish(size_t first, size_t n) {
    for (size_t i = 0; i < n; ++i) load(first + i, i);
    compare(n);
    for (size_t i = 0; i < n; ++i) write(first + i, turn_[i] && smooth_[i]);
  }

 private:
  void load(size_t face, size_t i) {
    const auto& v = mesh_.faces[face];
    bool smooth = true;
    for (size_t k = 0; k < 4; ++k) {
      const Vec3 &from = mesh_.vertices[v[k]], &to = mesh_.vertices[v[(k + 1) % 4]];
      const auto& normal = vertices_.normal[v[k]];
      for (size_t axis = 0; axis < 3; ++axis) {
        side_[k][axis][i] = float((to[axis] - from[axis]) * per_cell_);
        normal_[k][axis][i] = normal[axis];
      }
      smooth &= vertices_.is_smooth(v[k]);
    }
    smooth_[i] = smooth;
  }

  void compare(size_t n) {
    for (size_t k = 0; k < 4; ++k) {
      const size_t before = (k + 3) % 4, after = (k + 1) % 4;
      find_agreement(side_[before], side_[k], normal_[before], normal_[k], normal_[after], n,
                     agreement_[k]);
    }
    for (size_t i = 0; i < n; ++i) {
      const float a = agreement_[1][i], b = agreement_[3][i], kept = a < b ? a : b;
      const float c = agreement_[0][i], d = agreement_[2][i], turned = c < d ? c : d;
      turn_[i] = turned > kept + clearly_better_single;
    }
  }

  void write(size_t face, bool turn) {
    auto& v = mesh_.faces[face];
    if (turn) std::rotate(v.begin(), v.begin() + 1, v.end());
    for (size_t k = 0; k < 4; ++k) {
      const auto& n = vertices_.normal[v[k]];
      const double x = double(n[0]), y = double(n[1]), z = double(n[2]);
      // One step of Newton's method towards the length 1, which a float misses by 1e-7.
      const double by = 1.5 - 0.5 * (x * x + y * y + z * z);
      mesh_.corner_normals[4 * face + k] = {by * x, by * y, by * z};
    }
  }

  double per_cell_;
  const Vertices& vertices_;
  Mesh& mesh_;
  Vectors side_[4], normal_[4];
  float agreement_[4][capacity];
  uint8_t turn_[capacity], smooth_[capacity];
};

}  // namespace

void finish_smooth_faces(const Grid& grid, const Vertices& vertices, Mesh& mesh, size_t first,
                         size_t last) {
  SmoothFaces faces(grid, vertices, mesh);
  for (; first < last; first += faces.capacity) {
    faces.finish(first, std::min(faces.capacity, last - first));
  }
}

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

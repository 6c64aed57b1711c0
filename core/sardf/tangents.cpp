#include "sardf/tangents.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sardf/error.hpp"

namespace sardf {
namespace {

constexpr size_t vertices_at_once = size_t(1) << 16;  // between two reports

Vec3 rounded(const Vec3& a) { return {float(a[0]), float(a[1]), float(a[2])}; }
Vec3 in_plane(const Vec3& a, const Vec3& normal) {
  return unit_or_zero(a - dot(normal, a) * normal);
}
Vec3 any_perpendicular(const Vec3& normal) {
  const Vec3 axis = std::abs(normal[0]) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  return in_plane(axis, normal);
}

/// A triangle's corner at a vertex; the triangle's other corners in its order of winding.
struct Wedge {
  uint32_t corner, next, previous;  // numbers of corners, four a face
  Vec3 along_u;                     // unit direction in which u grows on the triangle
  int sign = 0;                     // 1 or, where the texture is mirrored, -1; 0: no area
};

class Tangents {
 public:
  explicit Tangents(const Mesh& mesh) : mesh_(mesh), start_(mesh.vertices.size() + 1, 0) {
    // The corners of each vertex, in their order, so that sums do not depend on threads.
    for (const auto& face : mesh_.faces)
      for (const uint32_t v : face) ++start_[v + 1];
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    corners_.resize(start_.back());
    std::vector<size_t> at(start_.begin(), start_.end() - 1);
    for (size_t c = 0; c < 4 * mesh_.faces.size(); ++c)
      corners_[at[vertex(c)]++] = static_cast<uint32_t>(c);
    made.assign(4 * mesh_.faces.size(), {0, 0, 0, 1});
  }

  void at_vertex(size_t v) {
    std::vector<Wedge> wedges;
    for (size_t i = start_[v]; i < start_[v + 1]; ++i) add_wedges(corners_[i], wedges);
    std::vector<uint32_t> group(wedges.size());
    std::iota(group.begin(), group.end(), 0u);
    for (size_t i = 0; i < wedges.size(); ++i)
      for (size_t j = 0; j < i; ++j)
        if (group[i] != group[j] && hang_together(wedges[i], wedges[j]))
          std::replace(group.begin(), group.end(), std::max(group[i], group[j]),
                       std::min(group[i], group[j]));
    for (size_t i = 0; i < wedges.size(); ++i)
      if (group[i] == i) write_group(wedges, group, i);
    for (size_t i = start_[v]; i < start_[v + 1]; ++i) settle(corners_[i], v);
  }

  std::vector<std::array<float, 4>> made;

 private:
  uint32_t vertex(size_t corner) const { return mesh_.faces[corner / 4][corner % 4]; }
  Vec3 position(size_t corner) const { return rounded(mesh_.vertices[vertex(corner)]); }
  Vec3 normal(size_t corner) const { return rounded(mesh_.corner_normals[corner]); }
  std::array<float, 2> uv(size_t corner) const {
    return {float(mesh_.corner_uv[corner][0]), float(mesh_.corner_uv[corner][1])};
  }
  bool same_point(uint32_t a, uint32_t b) const {
    return vertex(a) == vertex(b) && uv(a) == uv(b) && normal(a) == normal(b);
  }

  /// The triangles of a face that a corner belongs to: (0, 1, 2) and (0, 2, 3).
  void add_wedges(uint32_t corner, std::vector<Wedge>& wedges) const {
    const uint32_t face = corner / 4 * 4, k = corner % 4;
    if (k != 3) add_wedge(face, {0, 1, 2}, k, wedges);
    if (k != 1) add_wedge(face, {0, 2, 3}, k == 0 ? 0 : k - 1, wedges);
  }
  void add_wedge(uint32_t face, const std::array<uint32_t, 3>& triangle, uint32_t at,
                 std::vector<Wedge>& wedges) const {
    Wedge wedge{face + triangle[at], face + triangle[(at + 1) % 3], face + triangle[(at + 2) % 3],
                Vec3{}, 0};
    const std::array<float, 2> t0 = uv(wedge.corner), t1 = uv(wedge.next), t2 = uv(wedge.previous);
    const double u1 = double(t1[0]) - t0[0], v1 = double(t1[1]) - t0[1];
    const double u2 = double(t2[0]) - t0[0], v2 = double(t2[1]) - t0[1];
    const double area = u1 * v2 - v1 * u2;
    const Vec3 p = position(wedge.corner);
    const Vec3 e1 = position(wedge.next) - p, e2 = position(wedge.previous) - p;
    if (!(std::abs(area) > 0) || norm(cross(e1, e2)) == 0) return;
    wedge.sign = area > 0 ? 1 : -1;
    wedge.along_u = unit_or_zero(wedge.sign * (v2 * e1 - v1 * e2));
    wedges.push_back(wedge);
  }

  bool hang_together(const Wedge& a, const Wedge& b) const {
    if (a.sign != b.sign || !same_point(a.corner, b.corner)) return false;
    return same_point(a.next, b.previous) || same_point(a.previous, b.next);
  }

  void write_group(const std::vector<Wedge>& wedges, const std::vector<uint32_t>& group,
                   size_t first) {
    const Vec3 n = normal(wedges[first].corner);
    Vec3 sum{};
    for (size_t i = first; i < wedges.size(); ++i) {
      if (group[i] != first) continue;
      const Wedge& wedge = wedges[i];
      const Vec3 p = position(wedge.corner);
      const Vec3 a = in_plane(position(wedge.next) - p, n);
      const Vec3 b = in_plane(position(wedge.previous) - p, n);
      const double angle = std::acos(std::clamp(dot(a, b), -1.0, 1.0));
      sum = sum + angle * in_plane(wedge.along_u, n);
    }
    const Vec3 tangent = unit_or_zero(sum);
    for (size_t i = first; i < wedges.size(); ++i)
      if (group[i] == first)
        made[wedges[i].corner] = {float(tangent[0]), float(tangent[1]), float(tangent[2]),
                                  float(wedges[first].sign)};
  }

  /// Gives a corner without a tangent that of another one at its point, or any.
  void settle(uint32_t corner, size_t v) {
    if (has_tangent(corner)) return;
    for (size_t i = start_[v]; i < start_[v + 1]; ++i)
      if (has_tangent(corners_[i]) && same_point(corner, corners_[i])) {
        made[corner] = made[corners_[i]];
        return;
      }
    const Vec3 t = any_perpendicular(normal(corner));
    made[corner] = {float(t[0]), float(t[1]), float(t[2]), 1};
  }
  bool has_tangent(uint32_t corner) const {
    const auto& t = made[corner];
    return t[0] != 0 || t[1] != 0 || t[2] != 0;
  }

  const Mesh& mesh_;
  std::vector<size_t> start_;
  std::vector<uint32_t> corners_;  // of vertex v: [start_[v], start_[v + 1])
};

}  // namespace

std::vector<std::array<float, 4>> corner_tangents(const Mesh& mesh, const Progress& progress) {
  const size_t corners = 4 * mesh.faces.size();
  if (mesh.corner_uv.size() != corners || mesh.corner_normals.size() != corners)
    throw Error("tangents need a normal and texture coordinates for each corner of each face");
  Tangents tangents(mesh);
  const size_t all = mesh.vertices.size();
  for (size_t first = 0; first < all; first += vertices_at_once) {
    if (progress && !progress(double(first) / double(all))) throw Cancelled();
    tbb::parallel_for(first, std::min(first + vertices_at_once, all),
                      [&](size_t v) { tangents.at_vertex(v); });
  }
  return std::move(tangents.made);
}

}  // namespace sardf

// Fields to mesh, and checks of meshes by counting: they share no code with the mesher.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include "sardf/evaluate.hpp"
#include "sardf/mesh.hpp"
#include "sardf/operation_of.hpp"
#include "sardf/ops.hpp"

namespace sardf::checks {

template <class Op>
Expression at_point(const Op& op) {
  return call(make_operation(op), {coordinate(0), coordinate(1), coordinate(2)});
}
template <class Op>
Expression of(const Op& op, const Expression& a, const Expression& b) {
  return call(make_operation(op), {a, b});
}
inline Expression box(const Vec3& size, const Vec3& center = {}) {
  Box op;
  op.size = size;
  op.center = center;
  return at_point(op);
}
inline Expression sphere(double radius, const Vec3& center = {}) {
  Sphere op;
  op.radius = radius;
  op.center = center;
  return at_point(op);
}
inline Expression cylinder(double radius, const Vec3& center = {},
                           std::optional<double> height = {}) {
  Cylinder op;
  op.radius = radius;
  op.center = center;
  op.height = height;
  return at_point(op);
}
inline Expression torus(double major, double minor, const Vec3& axis = {0, 0, 1}) {
  Torus op;
  op.major_radius = major;
  op.minor_radius = minor;
  op.axis.direction = axis;
  return at_point(op);
}
inline Expression joined(const Expression& a, const Expression& b) {
  return of(UnionOf<MinMax>(), a, b);
}
inline Expression cut(const Expression& a, const Expression& b) {
  return of(DifferenceOf<MinMax>(), a, b);
}

/// The block with five through-holes and a ring in it, joined with R = 0.5.
inline Expression block_with_holes(const Vec3& ring_axis = {0, 0, 1}) {
  Sardf blend;
  blend.radius = 0.5;
  const DifferenceOf<Sardf> minus(blend);
  Expression f = of(minus, box({20, 12, 8}), cylinder(3));
  for (const double x : {-8, 8}) {
    for (const double y : {-4, 4}) f = of(minus, f, cylinder(1, {x, y, 0}));
  }
  return of(UnionOf<Sardf>(blend), f, torus(5, 1, ring_axis));
}

/// Rows of a rotation.
inline std::array<Vec3, 3> rotation(const Vec3& axis, double angle) {
  const Vec3 k = normalized(axis);
  const double c = std::cos(angle), s = std::sin(angle);
  std::array<Vec3, 3> rows;
  for (int i = 0; i < 3; ++i) {
    Vec3 e{};
    e[i] = 1;
    rows[i] = c * e + s * cross(e, k) + ((1 - c) * k[i]) * k;
  }
  return rows;
}
/// The field at the rotated point: the solid turned backwards.
inline Expression rotated(const Expression& field, const std::array<Vec3, 3>& rows) {
  std::array<Expression, 3> to;
  for (int i = 0; i < 3; ++i) {
    Affine op;
    op.row = rows[i];
    to[i] = at_point(op);
  }
  return substitute(field, to);
}

/// thickness - |sin x cos y + sin y cos z + sin z cos x|, lengths times `frequency`.
inline Expression gyroid(double frequency, double thickness) {
  const auto times = [](const Expression& a, const Expression& b) { return of(Multiply(), a, b); };
  std::array<Expression, 3> s, c;
  for (int i = 0; i < 3; ++i) {
    const Expression at = times(constant(frequency), coordinate(i));
    s[i] = call(make_operation(Sine()), {at});
    c[i] = call(make_operation(Cosine()), {at});
  }
  Expression sum = of(Add(), times(s[0], c[1]), times(s[1], c[2]));
  sum = of(Add(), sum, times(s[2], c[0]));
  return of(Subtract(), constant(thickness), call(make_operation(Abs()), {sum}));
}

inline BoundingBox cube(double half) { return {{-half, -half, -half}, {half, half, half}}; }
inline BoundingBox padded(const Vec3& half) {
  const double pad = 2e-4 * norm(half);
  const Vec3 by{pad, pad, pad};
  return {-1.0 * half - by, half + by};
}
inline double cell_of(const BoundingBox& bounds, int resolution) {
  const Vec3 size = bounds.size();
  return std::max({size[0], size[1], size[2]}) / resolution;
}

struct Count {
  size_t open_edges = 0;    // not in exactly two faces, once in each direction
  size_t bad_vertices = 0;  // whose faces are not one fan, or that have none
  size_t bad_faces = 0;     // with an index twice
  long euler = 0;
  bool closed() const { return open_edges + bad_vertices + bad_faces == 0; }
};

inline Count count(const Mesh& mesh) {
  struct DirectedEdge {
    std::array<uint32_t, 2> ends;
    uint32_t face;
    bool operator<(const DirectedEdge& other) const { return ends < other.ends; }
  };
  Count result;
  std::vector<DirectedEdge> edges;
  std::vector<std::vector<uint32_t>> faces_at(mesh.vertices.size());
  for (uint32_t f = 0; f < mesh.faces.size(); ++f) {
    const auto& face = mesh.faces[f];
    result.bad_faces += std::set<uint32_t>(face.begin(), face.end()).size() != 4;
    for (int k = 0; k < 4; ++k) {
      edges.push_back({{face[k], face[(k + 1) % 4]}, f});
      faces_at[face[k]].push_back(f);
    }
  }
  std::sort(edges.begin(), edges.end());
  const auto faces_with = [&](uint32_t from, uint32_t to) {
    const auto [first, last] =
        std::equal_range(edges.begin(), edges.end(), DirectedEdge{{from, to}, 0});
    return std::vector<DirectedEdge>(first, last);
  };
  size_t forward = 0;
  for (const auto& edge : edges) {
    result.open_edges += faces_with(edge.ends[0], edge.ends[1]).size() != 1 ||
                         faces_with(edge.ends[1], edge.ends[0]).size() != 1;
    forward += edge.ends[0] < edge.ends[1];
  }
  for (uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    // Walks from face to face around the vertex; a fan comes back after all of its faces.
    size_t steps = 0;
    uint32_t face = faces_at[v].empty() ? 0 : faces_at[v][0];
    do {
      const auto& corners = mesh.faces[face];
      const size_t k = std::find(corners.begin(), corners.end(), v) - corners.begin();
      const auto next = faces_with(v, corners[(k + 3) % 4]);
      if (next.empty()) break;
      face = next[0].face;
      ++steps;
    } while (face != faces_at[v][0] && steps <= faces_at[v].size());
    result.bad_vertices += faces_at[v].empty() || steps != faces_at[v].size();
  }
  result.euler = long(mesh.vertices.size()) - long(forward) + long(mesh.faces.size());
  return result;
}

/// Largest |f| / |grad f| at the vertices.
inline double distance_from_surface(const Mesh& mesh, const Expression& field) {
  const size_t n = mesh.vertices.size();
  std::vector<double> values(n), gradients(3 * n);
  Evaluator(field).gradients(mesh.vertices[0].data(), n, values.data(), gradients.data());
  double worst = 0;
  for (size_t i = 0; i < n; ++i) {
    const Vec3 g{gradients[3 * i], gradients[3 * i + 1], gradients[3 * i + 2]};
    worst = std::max(worst, std::abs(values[i]) / norm(g));
  }
  return worst;
}

/// Volume by the divergence theorem, quads as two triangles.
inline double volume(const Mesh& mesh) {
  double sum = 0;
  for (const auto& f : mesh.faces) {
    const auto& v = mesh.vertices;
    sum += dot(v[f[0]], cross(v[f[1]], v[f[2]])) + dot(v[f[0]], cross(v[f[2]], v[f[3]]));
  }
  return sum / 6;
}

/// Faces whose own normal points away from the normals at their corners.
inline size_t turned_faces(const Mesh& mesh) {
  size_t turned = 0;
  for (size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto& face = mesh.faces[f];
    Vec3 sum{};
    for (size_t k = 0; k < 4; ++k) sum = sum + mesh.corner_normals[4 * f + k];
    const Vec3 own = cross(mesh.vertices[face[2]] - mesh.vertices[face[0]],
                           mesh.vertices[face[3]] - mesh.vertices[face[1]]);
    turned += !(dot(own, sum) > 0);
  }
  return turned;
}

inline double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const double t = dot(p - a, b - a) / dot(b - a, b - a);
  return norm(p - (a + std::clamp(t, 0.0, 1.0) * (b - a)));
}

}  // namespace sardf::checks

// Closed quad meshes with creases and normals, for tests of atlas and bake.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <vector>

#include "sardf/mesh.hpp"

namespace sample {

using sardf::Mesh;
using sardf::Vec3;
// Vec3 is a std::array: its operators are not found by its own namespace.
using sardf::operator+;
using sardf::operator-;
using sardf::operator*;

inline constexpr double pi = 3.14159265358979323846;

/// Collects faces by position; finishes with normals and creases.
class Builder {
 public:
  uint32_t vertex(const Vec3& p) {
    const std::array<int64_t, 3> key{std::llround(p[0] * 1e7), std::llround(p[1] * 1e7),
                                     std::llround(p[2] * 1e7)};
    const auto [at, added] = known_.emplace(key, static_cast<uint32_t>(mesh_.vertices.size()));
    if (added) mesh_.vertices.push_back(p);
    return at->second;
  }
  /// Four points counter-clockwise from outside; the last two equal for a triangle.
  void face(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    mesh_.faces.push_back({vertex(a), vertex(b), vertex(c), vertex(d)});
  }
  /// Edges where the face normals turn by more than `crease` degrees become creases.
  Mesh finish(double crease = 35) {
    std::vector<Vec3> normals;
    std::map<std::array<uint32_t, 2>, std::vector<size_t>> sides;
    for (size_t f = 0; f < mesh_.faces.size(); ++f) {
      const auto& v = mesh_.faces[f];
      const Vec3 &a = mesh_.vertices[v[0]], &c = mesh_.vertices[v[2]];
      normals.push_back(sardf::normalized(sardf::cross(mesh_.vertices[v[1]] - a, c - a) +
                                          sardf::cross(c - a, mesh_.vertices[v[3]] - a)));
      for (size_t k = 0; k < 4; ++k) {
        mesh_.corner_normals.push_back(normals.back());
        const auto [low, high] = std::minmax(v[k], v[(k + 1) % 4]);
        if (low != high) sides[{low, high}].push_back(f);
      }
    }
    for (const auto& [edge, faces] : sides)
      if (faces.size() == 2 &&
          sardf::dot(normals[faces[0]], normals[faces[1]]) < std::cos(crease * pi / 180))
        mesh_.creases.push_back(edge);
    return std::move(mesh_);
  }

 private:
  Mesh mesh_;
  std::map<std::array<int64_t, 3>, uint32_t> known_;
};

/// rows × columns quads over at(u, v), u and v in [0, 1]; outside is the side of du × dv.
inline void add_grid(Builder& builder, int columns, int rows,
                     const std::function<Vec3(double, double)>& at) {
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const double u = static_cast<double>(i) / columns, v = static_cast<double>(j) / rows;
      const double un = static_cast<double>(i + 1) / columns;
      const double vn = static_cast<double>(j + 1) / rows;
      builder.face(at(u, v), at(un, v), at(un, vn), at(u, vn));
    }
}

/// The surface of the unit cells whose lower corners `inside` accepts: boxes, plates with holes.
inline Mesh cells(int nx, int ny, int nz, const std::function<bool(int, int, int)>& inside) {
  Builder builder;
  const std::array<int, 3> count{nx, ny, nz};
  const auto set = [&](const std::array<int, 3>& c) {
    for (size_t k = 0; k < 3; ++k)
      if (c[k] < 0 || c[k] >= count[k]) return false;
    return inside(c[0], c[1], c[2]);
  };
  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x)
        for (size_t k = 0; k < 3; ++k)
          for (const int side : {0, 1}) {
            std::array<int, 3> other{x, y, z};
            other[k] += side ? 1 : -1;
            if (!set({x, y, z}) || set(other)) continue;
            Vec3 origin{double(x), double(y), double(z)}, a{0, 0, 0}, b{0, 0, 0};
            origin[k] += side;
            a[(k + 1) % 3] = 1;
            b[(k + 2) % 3] = 1;
            if (!side) std::swap(a, b);
            builder.face(origin, origin + a, origin + a + b, origin + b);
          }
  return builder.finish();
}

inline Mesh box(int nx, int ny, int nz) {
  return cells(nx, ny, nz, [](int, int, int) { return true; });
}

/// A plate with 3 × 2 square holes.
inline Mesh plate_with_holes() {
  return cells(60, 40, 4, [](int x, int y, int) {
    return !(x % 20 >= 6 && x % 20 < 14 && y % 20 >= 6 && y % 20 < 14);
  });
}

inline Mesh sphere(int n) {
  Builder builder;
  for (size_t k = 0; k < 3; ++k)
    for (const double side : {-1.0, 1.0})
      add_grid(builder, n, n, [&](double u, double v) {
        Vec3 p{0, 0, 0};
        p[k] = side;
        p[(k + 1) % 3] = std::tan((2 * u - 1) * pi / 4) * side;
        p[(k + 2) % 3] = std::tan((2 * v - 1) * pi / 4);
        return sardf::normalized(p);
      });
  return builder.finish();
}

inline Mesh torus(int n, double large, double small) {
  Builder builder;
  add_grid(builder, 3 * n, n, [&](double u, double v) {
    const double a = 2 * pi * u, b = 2 * pi * v, r = large + small * std::cos(b);
    return Vec3{r * std::cos(a), r * std::sin(a), small * std::sin(b)};
  });
  return builder.finish();
}

/// Radius 1, along z; the caps have triangles at their middle.
inline Mesh capped_cylinder(int n, double height) {
  Builder builder;
  const auto rim = [](double u, double r, double z) {
    return Vec3{r * std::cos(2 * pi * u), r * std::sin(2 * pi * u), z};
  };
  const int rings = std::max(2, n / 6);
  add_grid(builder, n, std::max(1, static_cast<int>(height * n / 6)),
           [&](double u, double v) { return rim(u, 1, v * height); });
  for (const double z : {0.0, height})
    for (int i = 0; i < n; ++i) {
      const double u = static_cast<double>(i) / n, un = static_cast<double>((i + 1) % n) / n;
      for (int j = 0; j < rings; ++j) {
        const double r = static_cast<double>(j) / rings, rn = static_cast<double>(j + 1) / rings;
        const Vec3 a = rim(u, r, z), b = rim(u, rn, z), c = rim(un, rn, z), d = rim(un, r, z);
        if (j == 0)
          z > 0 ? builder.face(a, b, c, c) : builder.face(a, c, b, b);
        else
          z > 0 ? builder.face(a, b, c, d) : builder.face(d, c, b, a);
      }
    }
  return builder.finish();
}

/// Surface nets of f >= 0 on n³ cells of the cube [-reach, reach]³; smooth solids only.
inline Mesh surface_nets(const std::function<double(const Vec3&)>& f, double reach, int n) {
  const double h = 2 * reach / n;
  const auto at = [&](int i, int j, int k) {
    return Vec3{-reach + i * h, -reach + j * h, -reach + k * h};
  };
  const int m = n + 1;
  std::vector<double> values;
  for (int k = 0; k < m; ++k)
    for (int j = 0; j < m; ++j)
      for (int i = 0; i < m; ++i) values.push_back(f(at(i, j, k)));
  const auto value = [&](const std::array<int, 3>& c) {
    return values[(static_cast<size_t>(c[2]) * m + c[1]) * m + c[0]];
  };
  const auto crossing = [&](const std::array<int, 3>& c, size_t axis) {
    std::array<int, 3> d = c;
    ++d[axis];
    const double t = value(c) / (value(c) - value(d));
    Vec3 p = at(c[0], c[1], c[2]);
    p[axis] += t * h;
    return p;
  };
  const auto changes = [&](const std::array<int, 3>& c, size_t axis) {
    std::array<int, 3> d = c;
    ++d[axis];
    return (value(c) >= 0) != (value(d) >= 0);
  };
  const auto centre = [&](const std::array<int, 3>& cell) {
    Vec3 sum{0, 0, 0};
    double count = 0;
    for (size_t axis = 0; axis < 3; ++axis)
      for (int corner = 0; corner < 4; ++corner) {
        std::array<int, 3> c = cell;
        c[(axis + 1) % 3] += corner & 1;
        c[(axis + 2) % 3] += corner >> 1;
        if (!changes(c, axis)) continue;
        sum = sum + crossing(c, axis);
        ++count;
      }
    return (1 / count) * sum;
  };
  Builder builder;
  for (int k = 1; k < n; ++k)
    for (int j = 1; j < n; ++j)
      for (int i = 1; i < n; ++i)
        for (size_t axis = 0; axis < 3; ++axis) {
          const std::array<int, 3> c{i, j, k};
          if (!changes(c, axis)) continue;
          std::array<Vec3, 4> p;
          for (size_t corner = 0; corner < 4; ++corner) {
            std::array<int, 3> cell = c;
            cell[(axis + 1) % 3] -= corner == 0 || corner == 3;
            cell[(axis + 2) % 3] -= corner < 2;
            p[corner] = centre(cell);
          }
          if (value(c) >= 0)
            builder.face(p[0], p[1], p[2], p[3]);
          else
            builder.face(p[3], p[2], p[1], p[0]);
        }
  return builder.finish(180);
}

/// Banchoff's tanglecube: one smooth surface of genus 5.
inline Mesh tanglecube(int n) {
  return surface_nets(
      [](const Vec3& p) {
        double sum = -11.8;
        for (const double x : p) sum -= x * x * x * x - 5 * x * x;
        return sum;
      },
      3, n);
}

}  // namespace sample

#include "sardf/uv_check.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "sardf/bake_stages.hpp"
#include "sardf/error.hpp"
#include "sardf/evaluate.hpp"
#include "sardf/pulse.hpp"

namespace sardf {
namespace {

using baking::tile_size;

/// Texels: coordinates that are stored in float must not make neighbours overlap.
constexpr double margin = 0.02;

/// How far inside of the triangle's edges a place is, in texels; negative outside.
class TriangleDepth {
 public:
  TriangleDepth(const Vec2& a, const Vec2& b, const Vec2& c) : at_{a, b, c} {
    const double area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    for (size_t k = 0; k < 3; ++k) {
      const Vec2 &p = at_[k], &q = at_[(k + 1) % 3];
      const double length = std::hypot(q[0] - p[0], q[1] - p[1]);
      const double scale = length > 0 ? (area < 0 ? -1 : 1) / length : 0;
      across_[k] = {-scale * (q[1] - p[1]), scale * (q[0] - p[0])};
    }
    is_flat_ = !(std::abs(area) > 0);
  }
  bool is_flat() const { return is_flat_; }
  double operator()(double x, double y) const {
    double depth = std::numeric_limits<double>::infinity();
    for (size_t k = 0; k < 3; ++k)
      depth = std::min(depth, across_[k][0] * (x - at_[k][0]) + across_[k][1] * (y - at_[k][1]));
    return depth;
  }

 private:
  std::array<Vec2, 3> at_, across_;
  bool is_flat_ = false;
};

/// The texels of one tile, and how often they lie on the mesh and inside of a triangle.
class TileCount {
 public:
  TileCount(const baking::UvLayout& layout, size_t tile) : layout_(layout) {
    x0_ = static_cast<int>(tile) % layout.tiles_across * tile_size;
    y0_ = static_cast<int>(tile) / layout.tiles_across * tile_size;
    x1_ = std::min(x0_ + tile_size, layout.size);
    y1_ = std::min(y0_ + tile_size, layout.size);
  }

  void add_face(uint32_t face) {
    std::array<Vec2, 4> t;
    for (size_t k = 0; k < 4; ++k)
      t[k] = baking::texel_of(*layout_.mesh, 4 * size_t(face) + k, layout_.size);
    for (size_t k = 1; k < 3; ++k) add_triangle(t[0], t[k], t[k + 1]);
  }

  size_t on_mesh() const { return size_t(std::count(on_.begin(), on_.end(), 1)); }
  size_t overlapping() const {
    return size_t(std::count_if(inside_.begin(), inside_.end(), [](int n) { return n > 1; }));
  }

 private:
  void add_triangle(const Vec2& a, const Vec2& b, const Vec2& c) {
    const TriangleDepth depth(a, b, c);
    if (depth.is_flat()) return;
    const auto first = [](double from, int least) {
      return static_cast<int>(std::ceil(std::clamp(from, double(least), 1e6)));
    };
    const auto [left, right] = std::minmax({a[0], b[0], c[0]});
    const auto [top, bottom] = std::minmax({a[1], b[1], c[1]});
    for (int y = first(top, y0_); y < y1_ && y <= bottom; ++y)
      for (int x = first(left, x0_); x < x1_ && x <= right; ++x) {
        const double inside = depth(x, y);
        const size_t i = size_t(y - y0_) * tile_size + size_t(x - x0_);
        if (inside >= 0) on_[i] = 1;
        if (inside > margin) inside_[i] = std::min(inside_[i] + 1, 2);
      }
  }

  const baking::UvLayout& layout_;
  int x0_, y0_, x1_, y1_;
  std::array<int, baking::tile_texels> on_{}, inside_{};
};

bool reaches_out(const Mesh& mesh, size_t face, double by) {
  const auto begin = mesh.corner_uv.begin() + static_cast<std::ptrdiff_t>(4 * face);
  return std::any_of(begin, begin + 4, [by](const Vec2& uv) {
    return uv[0] < -by || uv[0] > 1 + by || uv[1] < -by || uv[1] > 1 + by;
  });
}

}  // namespace

double texels_per_unit(const Mesh& mesh, int size) {
  if (mesh.corner_uv.size() != 4 * mesh.faces.size())
    throw Error("a mesh of " + std::to_string(mesh.faces.size()) + " faces has " +
                std::to_string(mesh.corner_uv.size()) + " texture coordinates, not 4 for each");
  double texels = 0, area = 0;
  for (size_t face = 0; face < mesh.faces.size(); ++face)
    for (size_t k = 1; k < 3; ++k) {
      const Vec2 *uv = &mesh.corner_uv[4 * face], &p = uv[k], &q = uv[k + 1];
      const auto& v = mesh.faces[face];
      const Vec3& origin = mesh.vertices[v[0]];
      texels +=
          std::abs((p[0] - uv[0][0]) * (q[1] - uv[0][1]) - (p[1] - uv[0][1]) * (q[0] - uv[0][0]));
      area += norm(cross(mesh.vertices[v[k]] - origin, mesh.vertices[v[k + 1]] - origin));
    }
  return area > 0 ? size * std::sqrt(texels / area) : 0;
}

UvReport check_uv(const TexelMap& texels, const Progress& progress) {
  const baking::UvLayout& layout = texels.layout();
  const Mesh& mesh = *layout.mesh;
  UvReport report;
  report.faces = mesh.faces.size();
  for (size_t face = 0; face < report.faces; ++face)
    report.outside += reaches_out(mesh, face, margin / layout.size);
  report.texels_per_unit = texels_per_unit(mesh, layout.size);
  Pulse pulse(progress);
  std::atomic<size_t> on_mesh{0}, overlapping{0};
  tbb::parallel_for(size_t(0), layout.tiles(), [&](size_t tile) {
    pulse(double(tile) / double(layout.tiles()));
    TileCount count(layout, tile);
    for (const uint32_t face : layout.faces.of(tile)) count.add_face(face);
    on_mesh += count.on_mesh();
    overlapping += count.overlapping();
  });
  report.texels = on_mesh;
  report.overlapping = overlapping;
  return report;
}

SurfaceReport check_surface(const Mesh& mesh, const Expression& solid, double tolerance) {
  SurfaceReport report;
  report.vertices = mesh.vertices.size();
  std::vector<double> value(report.vertices), gradient(3 * report.vertices);
  if (report.vertices == 0) return report;
  const Evaluator evaluator(solid);
  const double* points = mesh.vertices[0].data();
  if (evaluator.has_gradients()) {
    evaluator.gradients(points, report.vertices, value.data(), gradient.data());
  } else {
    evaluator.values(points, report.vertices, value.data());
  }
  for (size_t i = 0; i < report.vertices; ++i) {
    const double slope = std::hypot(gradient[3 * i], gradient[3 * i + 1], gradient[3 * i + 2]);
    double distance = std::abs(value[i]);
    if (slope > 0 && std::isfinite(slope)) distance /= slope;
    if (!(distance < std::numeric_limits<double>::infinity()))
      distance = std::numeric_limits<double>::infinity();
    report.off += distance > tolerance;
    report.farthest = std::max(report.farthest, distance);
  }
  return report;
}

}  // namespace sardf

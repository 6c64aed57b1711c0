// The texels that lie on the mesh or beside it, tile by tile, and their points.

#include <algorithm>
#include <cmath>

#include "sardf/bake_stages.hpp"

namespace sardf::baking {
namespace {

/// Texels first to last, both included; empty when first > last.
struct TexelBox {
  int x0, y0, x1, y1;
  void limit(const TexelBox& to) {
    x0 = std::max(x0, to.x0);
    y0 = std::max(y0, to.y0);
    x1 = std::min(x1, to.x1);
    y1 = std::min(y1, to.y1);
  }
};

/// The texels whose centres lie in the bounds of the points, grown by `margin`, within `within`.
template <size_t N>
TexelBox texels_around(const std::array<Vec2, N>& points, double margin, const TexelBox& within) {
  Vec2 lo = points[0], hi = points[0];
  for (const Vec2& p : points) {
    lo = {std::min(lo[0], p[0]), std::min(lo[1], p[1])};
    hi = {std::max(hi[0], p[0]), std::max(hi[1], p[1])};
  }
  // Limited as numbers first: coordinates far outside the image do not fit an int.
  const auto limited = [](double a) { return static_cast<int>(std::clamp(a, -1e6, 1e6)); };
  TexelBox box{limited(std::ceil(lo[0] - margin)), limited(std::ceil(lo[1] - margin)),
               limited(std::floor(hi[0] + margin)), limited(std::floor(hi[1] + margin))};
  box.limit(within);
  return box;
}

TexelBox image_box(const UvLayout& layout) { return {0, 0, layout.size - 1, layout.size - 1}; }

std::array<Vec2, 4> texels_of_face(const UvLayout& layout, size_t face) {
  std::array<Vec2, 4> result;
  for (size_t k = 0; k < 4; ++k) result[k] = texel_of(*layout.mesh, 4 * face + k, layout.size);
  return result;
}

/// Rounding of a centre on an edge must not leave a crack between two triangles.
constexpr double edge_margin = 1e-9;

template <class BoxOf>
TileBins make_bins(const UvLayout& layout, size_t items, BoxOf box_of) {
  const auto for_tiles = [&](size_t item, auto visit) {
    const TexelBox box = box_of(item);
    if (box.x0 > box.x1 || box.y0 > box.y1) return;
    for (int y = box.y0 / tile_size; y <= box.y1 / tile_size; ++y)
      for (int x = box.x0 / tile_size; x <= box.x1 / tile_size; ++x)
        visit(size_t(y) * layout.tiles_across + x);
  };
  TileBins bins;
  bins.start.assign(layout.tiles() + 1, 0);
  for (size_t i = 0; i < items; ++i) for_tiles(i, [&](size_t tile) { ++bins.start[tile + 1]; });
  for (size_t t = 0; t < layout.tiles(); ++t) bins.start[t + 1] += bins.start[t];
  bins.items.resize(bins.start.back());
  std::vector<uint32_t> at(bins.start.begin(), bins.start.end() - 1);
  for (size_t i = 0; i < items; ++i)
    for_tiles(i, [&](size_t tile) { bins.items[at[tile]++] = static_cast<uint32_t>(i); });
  return bins;
}

double longest_edge(const Mesh& mesh, uint32_t face) {
  const auto& v = mesh.faces[face];
  double longest = 0;
  for (size_t k = 0; k < 4; ++k)
    longest = std::max(longest, norm(mesh.vertices[v[(k + 1) % 4]] - mesh.vertices[v[k]]));
  return longest;
}

/// A number for each texel of a tile, by rows.
using Numbers = std::array<uint32_t, tile_texels>;
constexpr uint32_t nothing = UINT32_MAX;

using Floats = std::array<float, 3>;
Floats floats(const Vec3& a) { return {float(a[0]), float(a[1]), float(a[2])}; }

/// A triangle of the mesh and of the UV map; a point of the map is at t + b s + c r.
struct Triangle {
  Vec2 t, s, r;
  double inverse;  // of the determinant of s and r
  Vec3 p, e1, e2;
  Floats normal;
  float limit;
  uint32_t face, second;  // the second of its corners in the face; the first is 0

  double b(double x, double y) const { return ((x - t[0]) * r[1] - (y - t[1]) * r[0]) * inverse; }
  double c(double x, double y) const { return (s[0] * (y - t[1]) - s[1] * (x - t[0])) * inverse; }
  Vec3 point(double x, double y) const { return p + b(x, y) * e1 + c(x, y) * e2; }
};

/// Columns of a row.
struct Span {
  double first, last;
  /// Keeps those where value + (x - at) slope >= -edge_margin. Of NaN nothing is known.
  void keep(double value, double slope, double at) {
    const double zero = at - (value + edge_margin) / slope;
    if (slope > 0) first = std::max(first, std::ceil(zero));
    if (slope < 0) last = std::min(last, std::floor(zero));
    if (slope == 0 && value < -edge_margin) last = first - 1;
  }
};

/// Writes n texels' points, on a line from `from` to `to`.
void write_line(TilePoints& out, const Vec3& from, const Vec3& to, size_t n) {
  const double scale = n > 1 ? 1 / double(n - 1) : 0;
  for (size_t axis = 0; axis < 3; ++axis) {
    float* at = &out.point[axis][out.count];
    const double start = from[axis], step = scale * (to[axis] - from[axis]);
    for (int i = 0; i < static_cast<int>(n); ++i) at[i] = float(start + i * step);
  }
}

/// One tile's texels while they are being found.
class TileRaster {
 public:
  TileRaster(const UvLayout& layout, size_t tile, TexelCorners* corners)
      : layout_(layout), mesh_(*layout.mesh), corners_(corners), box_(image_box(layout)) {
    const int x = static_cast<int>(tile) % layout.tiles_across * tile_size;
    const int y = static_cast<int>(tile) / layout.tiles_across * tile_size;
    box_.limit({x, y, x + tile_size - 1, y + tile_size - 1});
    on_triangle_.fill(nothing);
    nearest_.fill(nothing);
  }

  void add_face(uint32_t face) {
    const std::array<Vec2, 4> t = texels_of_face(layout_, face);
    const auto& v = mesh_.faces[face];
    const double limit = 0.5 * longest_edge(mesh_, face);
    for (size_t k = 1; k < 3; ++k)
      add_triangle({t[0], t[k], t[k + 1]},
                   {mesh_.vertices[v[0]], mesh_.vertices[v[k]], mesh_.vertices[v[k + 1]]}, limit,
                   face, static_cast<uint32_t>(k));
  }

  void add_border(uint32_t index) {
    const Border& border = layout_.borders[index];
    const TexelBox box = texels_around<2>({border.a, border.b}, layout_.reach, box_);
    const double reach = layout_.reach * layout_.reach;
    for (int y = box.y0; y <= box.y1; ++y)
      for (int x = box.x0; x <= box.x1; ++x) {
        const size_t i = local(x, y);
        if (on_triangle_[i] != nothing) continue;
        const Vec2 from = offset(border, x, y, along(border, x, y));
        const double squared = from[0] * from[0] + from[1] * from[1];
        if (squared > reach || (nearest_[i] != nothing && squared >= distance_[i])) continue;
        nearest_[i] = index;
        distance_[i] = squared;
      }
  }

  void collect(TilePoints& out) {
    out.x = box_.x0;
    out.y = box_.y0;
    out.width = box_.x1 - box_.x0 + 1;
    out.height = box_.y1 - box_.y0 + 1;
    out.count = 0;
    for (int y = box_.y0; y <= box_.y1; ++y)
      for (int x = box_.x0; x <= box_.x1;) {
        const size_t i = local(x, y);
        if (on_triangle_[i] != nothing) {
          x += collect_run(out, x, y);
        } else if (nearest_[i] != nothing) {
          continue_surface(out, x++, y);
        } else {
          ++x;
        }
      }
  }

 private:
  size_t local(int x, int y) const { return size_t(y - box_.y0) * tile_size + size_t(x - box_.x0); }

  void add_triangle(const std::array<Vec2, 3>& t, const std::array<Vec3, 3>& p, double limit,
                    uint32_t face, uint32_t second) {
    Triangle made;
    made.t = t[0];
    made.s = {t[1][0] - t[0][0], t[1][1] - t[0][1]};
    made.r = {t[2][0] - t[0][0], t[2][1] - t[0][1]};
    made.inverse = 1 / (made.s[0] * made.r[1] - made.s[1] * made.r[0]);
    if (!std::isfinite(made.inverse)) return;
    made.p = p[0];
    made.e1 = p[1] - p[0];
    made.e2 = p[2] - p[0];
    made.normal = floats(unit_or_zero(cross(made.e1, made.e2)));
    made.limit = float(limit);
    made.face = face;
    made.second = second;
    const uint32_t number = static_cast<uint32_t>(triangles_.size());
    triangles_.push_back(made);
    const TexelBox box = texels_around(t, edge_margin, box_);
    const double by_b = made.r[1] * made.inverse, by_c = -made.s[1] * made.inverse;
    for (int y = box.y0; y <= box.y1; ++y) {
      Span span{double(box.x0), double(box.x1)};
      const double b = made.b(box.x0, y), c = made.c(box.x0, y);
      span.keep(b, by_b, box.x0);
      span.keep(c, by_c, box.x0);
      span.keep(1 - b - c, -by_b - by_c, box.x0);
      if (!(span.first <= span.last)) continue;
      uint32_t* row = &on_triangle_[local(box_.x0, y)];
      const int last = static_cast<int>(span.last) - box_.x0;
      for (int i = static_cast<int>(span.first) - box_.x0; i <= last; ++i)
        if (row[i] == nothing) row[i] = number;
    }
  }

  /// Writes the texels from (x, y) on that lie on the same triangle; how many they are.
  int collect_run(TilePoints& out, int x, int y) {
    const size_t first = local(x, y), end = local(box_.x1, y) + 1;
    size_t last = first;
    while (last + 1 < end && on_triangle_[last + 1] == on_triangle_[first]) ++last;
    const size_t n = last - first + 1;
    const Triangle& on = triangles_[on_triangle_[first]];
    write_line(out, on.point(x, y), on.point(x + double(n - 1), y), n);
    for (size_t axis = 0; axis < 3; ++axis)
      std::fill_n(&out.normal[axis][out.count], n, on.normal[axis]);
    std::fill_n(&out.limit[out.count], n, on.limit);
    for (size_t i = 0; i < n; ++i) out.texel[out.count + i] = static_cast<uint16_t>(first + i);
    if (corners_) write_corners(on, x, y, out.count, n);
    out.count += n;
    return static_cast<int>(n);
  }

  void write_corners(const Triangle& on, int x, int y, size_t at, size_t n) {
    for (size_t i = 0; i < n; ++i) {
      const double b = on.b(x + double(i), y), c = on.c(x + double(i), y);
      corners_->face[at + i] = on.face;
      auto& weight = corners_->weight[at + i] = {float(1 - b - c), 0, 0, 0};
      weight[on.second] = float(b);
      weight[on.second + 1] = float(c);
    }
  }
  /// The place t of a border.
  void write_corners(const Border& border, double t, size_t at) const {
    const auto& v = mesh_.faces[border.face];
    const auto corner = [&v](uint32_t vertex) {
      return size_t(std::find(v.begin(), v.end() - 1, vertex) - v.begin());
    };
    corners_->face[at] = border.face;
    auto& weight = corners_->weight[at] = {0, 0, 0, 0};
    weight[corner(border.vertex[0])] += float(1 - t);
    weight[corner(border.vertex[1])] += float(t);
  }

  /// Where on the border, in [0, 1], the point nearest to texel (x, y) lies.
  static double along(const Border& border, int x, int y) {
    const double ex = border.b[0] - border.a[0], ey = border.b[1] - border.a[1];
    const double length = ex * ex + ey * ey;
    if (length == 0) return 0;
    return std::clamp(((x - border.a[0]) * ex + (y - border.a[1]) * ey) / length, 0.0, 1.0);
  }
  static Vec2 offset(const Border& border, int x, int y, double t) {
    return {x - border.a[0] - t * (border.b[0] - border.a[0]),
            y - border.a[1] - t * (border.b[1] - border.a[1])};
  }

  void continue_surface(TilePoints& out, int x, int y) const {
    const size_t i = local(x, y);
    const Border& border = layout_.borders[nearest_[i]];
    const double t = along(border, x, y);
    const Vec2 d = offset(border, x, y, t);
    const auto mixed = [t](const Vec3& a, const Vec3& b) { return a + t * (b - a); };
    const Slopes &at_a = layout_.slopes[border.slopes[0]], &at_b = layout_.slopes[border.slopes[1]];
    const Vec3 by_x = mixed(at_a.by_x, at_b.by_x), by_y = mixed(at_a.by_y, at_b.by_y);
    const Vec3 beyond = d[0] * by_x + d[1] * by_y;
    const Vec3 point =
        mixed(mesh_.vertices[border.vertex[0]], mesh_.vertices[border.vertex[1]]) + beyond;
    const Vec3 normal = unit_or_zero(cross(by_x, by_y));
    for (size_t axis = 0; axis < 3; ++axis) {
      out.point[axis][out.count] = float(point[axis]);
      out.normal[axis][out.count] = float(normal[axis]);
    }
    // Beyond a crease the zero set belongs to another face.
    out.limit[out.count] =
        border.crease ? 0.0f : float(0.5 * (longest_edge(mesh_, border.face) + norm(beyond)));
    if (corners_) write_corners(border, t, out.count);
    out.texel[out.count++] = static_cast<uint16_t>(i);
  }

  const UvLayout& layout_;
  const Mesh& mesh_;
  TexelCorners* corners_;  // or null
  TexelBox box_;
  std::vector<Triangle> triangles_;
  Numbers on_triangle_, nearest_;             // index of the triangle; of the border
  std::array<double, tile_texels> distance_;  // to it, squared
};

}  // namespace

void fill_bins(UvLayout& layout) {
  const TexelBox image = image_box(layout);
  layout.faces = make_bins(layout, layout.mesh->faces.size(), [&](size_t face) {
    return texels_around(texels_of_face(layout, face), edge_margin, image);
  });
  layout.borders_near = make_bins(layout, layout.borders.size(), [&](size_t i) {
    return texels_around<2>({layout.borders[i].a, layout.borders[i].b}, layout.reach, image);
  });
}

void find_texels(const UvLayout& layout, size_t tile, TilePoints& points, TexelCorners* corners) {
  TileRaster raster(layout, tile, corners);
  for (const uint32_t face : layout.faces.of(tile)) raster.add_face(face);
  for (const uint32_t border : layout.borders_near.of(tile)) raster.add_border(border);
  raster.collect(points);
}

}  // namespace sardf::baking

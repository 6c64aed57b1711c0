// The stages of a bake: borders of the UV map, texels of one tile, projection on the solid.
//
// Texel coordinates here: x right and y down, in texels, whole numbers at texel centres.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "sardf/local_evaluator.hpp"
#include "sardf/mesh.hpp"
#include "sardf/numbers/lanes.hpp"

namespace sardf::baking {

/// Edge of the square tiles in which texels are worked on.
inline constexpr int tile_size = 64;
inline constexpr int tile_texels = tile_size * tile_size;

/// The surface point's derivatives by texel coordinates.
struct Slopes {
  Vec3 by_x{}, by_y{};
};

/// An edge where the UV map ends, from a to b.
struct Border {
  Vec2 a{}, b{};  // texel coordinates
  uint32_t face = 0;
  std::array<uint32_t, 2> vertex{};  // mesh vertices
  std::array<uint32_t, 2> slopes{};  // indices into UvLayout::slopes
  bool crease = false;
};

/// Which items touch each tile.
struct TileBins {
  std::vector<uint32_t> start, items;
  std::span<const uint32_t> of(size_t tile) const {
    return {items.data() + start[tile], items.data() + start[tile + 1]};
  }
};

struct UvLayout {
  const Mesh* mesh = nullptr;
  int size = 0;
  double reach = 0;  // texels beyond a border that get a value
  int tiles_across = 0;
  std::vector<Border> borders;
  std::vector<Slopes> slopes;  // means over the triangles around each vertex of a border
  TileBins faces, borders_near;
  size_t tiles() const { return size_t(tiles_across) * tiles_across; }
};

/// Texel coordinates of a face's corner.
inline Vec2 texel_of(const Mesh& mesh, size_t corner, int size) {
  const Vec2& uv = mesh.corner_uv[corner];
  return {uv[0] * size - 0.5, (1 - uv[1]) * size - 0.5};
}

/// Finds the borders and the slopes at their vertices. `report` throws to cancel.
void find_borders(UvLayout& layout, const std::function<void()>& report);
/// Sorts faces and borders into the tiles that they touch.
void fill_bins(UvLayout& layout);

/// A number that is linear in texel coordinates: value + x by_x + y by_y.
struct Linear {
  double value, by_x, by_y;
  double at(double x, double y) const { return value + x * by_x + y * by_y; }
};

/// A triangle of the mesh and of the UV map: the weights of its second and third corner and the
/// coordinates of its points, all linear from the texel (x0, y0) of the tile on.
struct Triangle {
  int x0, y0;
  Linear b, c;
  std::array<Linear, 3> point;
  std::array<Vec3, 3> corner;
  uint32_t face, second;  // the second of its corners in the face; the first is 0
  uint32_t texels;        // of the tile
  bool is_thin;           // whether weights change too much from texel to texel for float
};

/// Points of a row on one triangle, side by side.
struct TexelRun {
  uint16_t first;  // of the points
  uint8_t x, y;    // texel of the first point, from the tile's first on
  uint8_t count;
  uint32_t on;  // of the triangles
};

/// A triangle, or a place beside the mesh, that points of a tile lie on.
struct PointSurface {
  std::array<float, 3> normal;
  float limit;  // how far points may be moved
};

/// The covered texels of one tile and their points, row by row.
struct TilePoints {
  int x = 0, y = 0;  // of the tile, in texels
  size_t count = 0;
  std::array<uint64_t, tile_size> covered;    // a bit for each texel of a row, the first the lowest
  std::array<uint16_t, tile_size + 1> start;  // the first point of each row; at the end, `count`
  /// Points by coordinate; what is behind `count` has no meaning.
  std::array<std::array<float, tile_texels + tile_size>, 3> point;
  std::array<uint32_t, tile_texels + tile_size> on;  // of `surfaces`
  std::vector<PointSurface> surfaces;                // of the triangles, then those beside the mesh
  std::vector<Triangle> triangles;
  std::vector<TexelRun> runs;  // on triangles, in the points' order
};

/// Of which face the texels of a tile are, and with which weights of its four corners; those of one
/// beside the mesh are of the nearest place on the border.
struct TexelCorners {
  std::array<uint32_t, tile_texels> face;
  std::array<std::array<float, 4>, tile_texels> weight;
};

/// work(i, count, x, y) for the runs of points of rows [first, last) whose texels (x, y),
/// (x + 1, y), ... of the image lie side by side; i is the first one's index.
template <class Work>
void for_runs(const TilePoints& points, int first, int last, Work work) {
  for (int row = first; row < last; ++row) {
    uint64_t left = points.covered[size_t(row)];
    size_t i = points.start[size_t(row)];
    while (left != 0) {
      const int x = std::countr_zero(left), count = std::countr_one(left >> x);
      work(i, size_t(count), points.x + x, points.y + row);
      i += size_t(count);
      left = x + count < 64 ? left >> (x + count) << (x + count) : 0;
    }
  }
}

/// work(first, last) for rows [first, last) with some points, at most `most` (not less than
/// tile_size) together.
template <class Work>
void for_blocks(const TilePoints& points, size_t most, Work work) {
  for (int first = 0; first < tile_size;) {
    int last = first + 1;
    while (last < tile_size &&
           size_t(points.start[size_t(last + 1)] - points.start[size_t(first)]) <= most) {
      ++last;
    }
    if (points.start[size_t(last)] > points.start[size_t(first)]) work(first, last);
    first = last;
  }
}

/// Fills `points` for a tile, and `corners` if it is given.
void find_texels(const UvLayout& layout, size_t tile, TilePoints& points,
                 TexelCorners* corners = nullptr);

/// How points of a triangle are moved onto a curved surface: by polynomials in the texel
/// coordinates from the triangle's (x0, y0) on, one for each axis (the fourth lane is unused).
struct Bend {
  static constexpr int degree = 4;
  /// factor[p][q] is that of x^p y^q, 0 where p + q > degree.
  std::array<std::array<Lanes<Baseline>, degree + 1>, degree + 1> factor;
};

/// Along what the points of a curved triangle get onto the surface: gradient / |gradient|² of the
/// field, linear between the corners. A step of minus the field's value times that is Newton's.
struct Directions {
  std::array<float, 3> origin, to_b, to_c;  // the weights of a point from its place
  std::array<std::array<float, 3>, 3> corner;

  std::array<float, 3> at(const std::array<float, 3>& point) const {
    float b = 0, c = 0;
    for (size_t axis = 0; axis < 3; ++axis) {
      b += (point[axis] - origin[axis]) * to_b[axis];
      c += (point[axis] - origin[axis]) * to_c[axis];
    }
    std::array<float, 3> result;
    for (size_t axis = 0; axis < 3; ++axis)
      result[axis] = (1 - b - c) * corner[0][axis] + b * corner[1][axis] + c * corner[2][axis];
    return result;
  }
};

/// How the points of a tile's curved triangles are moved together.
struct Guides {
  static constexpr uint32_t none = UINT32_MAX;
  std::vector<uint32_t> bend_of, directions_of;  // for each triangle one of those below, or none
  std::vector<Bend> bends;
  std::vector<Directions> directions;
};

/// Finds guides of the triangles that do not lie within `tolerance` of the zero set of `solid`
/// already, with enough texels: directions where gradients are within 30 degrees of the triangle's
/// normal, and bends where those move nearly all points to within the tolerance, by at most the
/// triangle's limit.
void find_guides(const LocalEvaluator& solid, const TilePoints& points, float tolerance,
                 Guides& guides);

/// Moves the points that are farther than `tolerance`, by the field, onto the zero set of `solid`.
void project(const LocalEvaluator& solid, TilePoints& points, float tolerance);

/// The gradients of points [first, first + n) of a tile, by coordinate, become the colours of the
/// solid's normal in the mesh's tangent space (bake.hpp).
void tangent_normals(const Mesh& mesh, std::span<const std::array<float, 4>> tangents,
                     const TexelCorners& corners, size_t first, size_t n, float* const* rows);

}  // namespace sardf::baking

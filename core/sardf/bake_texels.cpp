// The texels that lie on the mesh or beside it, tile by tile, and their points.

#include <algorithm>
#include <cmath>

#include "sardf/bake_stages.hpp"
#include "sardf/numbers/lanes.hpp"

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
    longest = std::max(longest, quick_norm(mesh.vertices[v[(k + 1) % 4]] - mesh.vertices[v[k]]));
  return longest;
}

/// Of a vector that may be 0.
std::array<float, 3> direction_of(const Vec3& a) {
  const double length = quick_norm(a), by = length > 0 ? 1 / length : 0;
  return {float(by * a[0]), float(by * a[1]), float(by * a[2])};
}

/// Whether weights change so much from texel to texel that rounding would move points off the
/// triangle.
bool is_thin(const Triangle& on) {
  constexpr double steep = 1e4;
  return !(std::abs(on.b.by_x) < steep && std::abs(on.b.by_y) < steep &&
           std::abs(on.c.by_x) < steep && std::abs(on.c.by_y) < steep);
}

/// The columns of each row of a box where some linear numbers are not negative.
class Spans {
 public:
  explicit Spans(const TexelBox& box) : rows_(box.y1 - box.y0 + 1) {
    std::fill_n(first_.begin(), rows_, 0);
    std::fill_n(last_.begin(), rows_, box.x1 - box.x0);
  }

  /// Keeps the texels where the number is at least -edge_margin. Of NaN nothing is known.
  void keep(const Linear& number) {
    // A number that changes by less than the margin in a row is taken as constant there.
    constexpr double flat = edge_margin / (16 * tile_size);
    const double value = number.value + edge_margin;
    if (!(std::abs(number.by_x) > flat)) {
      for (int row = 0; row < rows_; ++row)
        if (value + row * number.by_y < 0) last_[size_t(row)] = -1;
      return;
    }
    const double zero = -value / number.by_x, by_y = -number.by_y / number.by_x;
    if (number.by_x > 0) {
      for (int row = 0; row < rows_; ++row)
        first_[size_t(row)] = std::max(first_[size_t(row)], zero + row * by_y);
    } else {
      for (int row = 0; row < rows_; ++row)
        last_[size_t(row)] = std::min(last_[size_t(row)], zero + row * by_y);
    }
  }

  /// The first column of a row, and the one behind its last; not less than the first where there
  /// are none.
  std::pair<int, int> of(int row) const {
    // Limits are columns of a tile or beside it: rounded up and down by way of positive numbers.
    constexpr double most = tile_size;
    const double first = std::min(first_[size_t(row)], most);
    const double last = std::max(last_[size_t(row)], -1.0);
    const int from = tile_size - static_cast<int>(most - first);
    return {from, std::max(from, static_cast<int>(last + 1))};
  }

 private:
  int rows_;
  std::array<double, tile_size> first_, last_;
};

/// The bits [first, last) of a row, some at least.
uint64_t bits_between(int first, int last) {
  return ~uint64_t(0) >> (64 - (last - first)) << first;
}

// Runs are written eight texels at a time: up to seven more are written behind them.
constexpr size_t at_once = 8;

constexpr auto counts = [] {
  std::array<float, tile_size> all{};
  for (size_t i = 0; i < all.size(); ++i) all[i] = float(i);
  return all;
}();

/// The numbers of a run, value + i step.
void write_line(float* to, double value, double step, size_t n) {
  using L = Lanes<Baseline>;
  const L from(value), by(step);
  for (size_t i = 0; i < n; i += at_once)
    for (size_t k = i; k < i + at_once; k += L::width)
      (from + L::load(&counts[k]) * by).store(to + k);
}

void write_number(uint32_t* to, uint32_t number, size_t n) {
  for (size_t i = 0; i < n; i += at_once)
    for (size_t k = i; k < i + at_once; ++k) to[k] = number;
}

/// One tile's texels while they are being found.
class TileRaster {
 public:
  TileRaster(const UvLayout& layout, size_t tile, TilePoints& out, TexelCorners* corners)
      : layout_(layout),
        mesh_(*layout.mesh),
        out_(out),
        corners_(corners),
        box_(image_box(layout)) {
    const int x = static_cast<int>(tile) % layout.tiles_across * tile_size;
    const int y = static_cast<int>(tile) / layout.tiles_across * tile_size;
    box_.limit({x, y, x + tile_size - 1, y + tile_size - 1});
    on_triangle_.fill(0);
    near_border_.fill(0);
    starts_.fill(0);
    out_.surfaces.clear();
    out_.triangles.clear();
    out_.runs.clear();
  }

  /// Where faces overlap, the one that was added last is seen.
  void add_face(uint32_t face) {
    const std::array<Vec2, 4> t = texels_of_face(layout_, face);
    const auto& v = mesh_.faces[face];
    const float limit = float(0.5 * longest_edge(mesh_, face));
    for (const size_t k : {2, 1})
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
        const size_t i = local(x, y), row = size_t(y - box_.y0);
        const uint64_t bit = uint64_t(1) << (x - box_.x0);
        if (on_triangle_[row] & bit) continue;
        const Vec2 from = offset(border, x, y, along(border, x, y));
        const double squared = from[0] * from[0] + from[1] * from[1];
        if (squared > reach || ((near_border_[row] & bit) && squared >= distance_[i])) continue;
        near_border_[row] |= bit;
        on_[i] = index;
        distance_[i] = squared;
      }
  }

  void collect() {
    out_.x = box_.x0;
    out_.y = box_.y0;
    out_.count = 0;
    for (int row = 0; row < tile_size; ++row) {
      const uint64_t on_mesh = on_triangle_[size_t(row)];
      uint64_t left = on_mesh | near_border_[size_t(row)];
      out_.covered[size_t(row)] = left;
      out_.start[size_t(row)] = static_cast<uint16_t>(out_.count);
      while (left != 0) {
        const int x = std::countr_zero(left);
        int n = 1;
        if (on_mesh >> x & 1) {
          n = length_of_run(x, row);
          write_run(x, row, size_t(n));
        } else {
          continue_surface(box_.x0 + x, box_.y0 + row);
        }
        left &= ~bits_between(x, x + n);
      }
    }
    out_.start[size_t(tile_size)] = static_cast<uint16_t>(out_.count);
  }

 private:
  size_t local(int x, int y) const { return size_t(y - box_.y0) * tile_size + size_t(x - box_.x0); }

  void add_triangle(const std::array<Vec2, 3>& t, const std::array<Vec3, 3>& p, float limit,
                    uint32_t face, uint32_t second) {
    const Vec2 s{t[1][0] - t[0][0], t[1][1] - t[0][1]}, r{t[2][0] - t[0][0], t[2][1] - t[0][1]};
    const double inverse = 1 / (s[0] * r[1] - s[1] * r[0]);
    if (!std::isfinite(inverse)) return;
    const TexelBox box = texels_around(t, edge_margin, box_);
    if (box.x0 > box.x1 || box.y0 > box.y1) return;
    const Vec3 e1 = p[1] - p[0], e2 = p[2] - p[0];
    const double dx = box.x0 - t[0][0], dy = box.y0 - t[0][1];
    Triangle made;
    made.x0 = box.x0 - box_.x0;
    made.y0 = box.y0 - box_.y0;
    made.b = {(dx * r[1] - dy * r[0]) * inverse, r[1] * inverse, -r[0] * inverse};
    made.c = {(s[0] * dy - s[1] * dx) * inverse, -s[1] * inverse, s[0] * inverse};
    for (size_t k = 0; k < 3; ++k)
      made.point[k] = {p[0][k] + made.b.value * e1[k] + made.c.value * e2[k],
                       made.b.by_x * e1[k] + made.c.by_x * e2[k],
                       made.b.by_y * e1[k] + made.c.by_y * e2[k]};
    made.corner = p;
    made.face = face;
    made.second = second;
    made.texels = 0;
    made.is_thin = is_thin(made);
    const uint32_t number = static_cast<uint32_t>(out_.triangles.size());
    out_.triangles.push_back(made);
    out_.surfaces.push_back({direction_of(cross(e1, e2)), limit});
    fill(made, box, number);
  }

  void fill(const Triangle& triangle, const TexelBox& box, uint32_t number) {
    const Linear &b = triangle.b, &c = triangle.c;
    Spans spans(box);
    spans.keep(b);
    spans.keep(c);
    spans.keep({1 - b.value - c.value, -b.by_x - c.by_x, -b.by_y - c.by_y});
    for (int y = 0; y <= box.y1 - box.y0; ++y) {
      const auto [from, to] = spans.of(y);
      const int row = y + triangle.y0, first = from + triangle.x0, last = to + triangle.x0;
      if (first == last) continue;
      mark_run(row, first, last, number);
    }
  }

  /// The texels [first, last) of a row become a run; what is left of another one behind it begins
  /// there.
  void mark_run(int row, int first, int last, uint32_t number) {
    uint32_t* const on = &on_[size_t(row * tile_size)];
    uint64_t &starts = starts_[size_t(row)], &covered = on_triangle_[size_t(row)];
    if (last < tile_size && (covered & ~starts) >> last & 1) {
      on[last] = on[63 - std::countl_zero(starts & bits_between(0, last))];
      starts |= bits_between(last, last + 1);
    }
    const uint64_t texels = bits_between(first, last);
    starts = (starts & ~texels) | bits_between(first, first + 1);
    covered |= texels;
    on[first] = number;
  }

  int length_of_run(int x, int row) const {
    const uint64_t others = ~on_triangle_[size_t(row)] | starts_[size_t(row)];
    return 1 + std::countr_zero(others >> x >> 1 | uint64_t(1) << (tile_size - 1 - x));
  }

  /// Writes the n texels of a row from column x on, all on the same triangle.
  void write_run(int x, int row, size_t n) {
    const uint32_t number = on_[size_t(row * tile_size + x)];
    Triangle& on = out_.triangles[number];
    if (on.is_thin) {
      write_thin_run(on, x, row, n);
    } else {
      for (size_t axis = 0; axis < 3; ++axis)
        write_line(&out_.point[axis][out_.count], on.point[axis].at(x - on.x0, row - on.y0),
                   on.point[axis].by_x, n);
    }
    write_number(&out_.on[out_.count], number, n);
    if (corners_) write_corners(on, x, row, out_.count, n);
    out_.runs.push_back({uint16_t(out_.count), uint8_t(x), uint8_t(row), uint8_t(n), number});
    on.texels += static_cast<uint32_t>(n);
    out_.count += n;
  }

  /// The weights of a triangle's corners at a texel of the tile, on the triangle in spite of
  /// rounding.
  static std::array<double, 3> weights_at(const Triangle& on, int x, int row) {
    const double b = std::clamp(on.b.at(x - on.x0, row - on.y0), 0.0, 1.0);
    const double c = std::clamp(on.c.at(x - on.x0, row - on.y0), 0.0, 1 - b);
    return {1 - b - c, b, c};
  }

  void write_thin_run(const Triangle& on, int x, int row, size_t n) {
    const auto& v = mesh_.faces[on.face];
    const Vec3 &p0 = mesh_.vertices[v[0]], &p1 = mesh_.vertices[v[on.second]],
               &p2 = mesh_.vertices[v[on.second + 1]];
    for (size_t i = 0; i < n; ++i) {
      const auto [a, b, c] = weights_at(on, x + static_cast<int>(i), row);
      for (size_t axis = 0; axis < 3; ++axis)
        out_.point[axis][out_.count + i] = float(a * p0[axis] + b * p1[axis] + c * p2[axis]);
    }
  }

  void write_corners(const Triangle& on, int x, int row, size_t at, size_t n) {
    for (size_t i = 0; i < n; ++i) {
      const auto [a, b, c] = weights_at(on, x + static_cast<int>(i), row);
      corners_->face[at + i] = on.face;
      auto& weight = corners_->weight[at + i] = {float(a), 0, 0, 0};
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

  void continue_surface(int x, int y) {
    const Border& border = layout_.borders[on_[local(x, y)]];
    const double t = along(border, x, y);
    const Vec2 d = offset(border, x, y, t);
    const auto mixed = [t](const Vec3& a, const Vec3& b) { return a + t * (b - a); };
    const Slopes &at_a = layout_.slopes[border.slopes[0]], &at_b = layout_.slopes[border.slopes[1]];
    const Vec3 by_x = mixed(at_a.by_x, at_b.by_x), by_y = mixed(at_a.by_y, at_b.by_y);
    const Vec3 beyond = d[0] * by_x + d[1] * by_y;
    const Vec3 point =
        mixed(mesh_.vertices[border.vertex[0]], mesh_.vertices[border.vertex[1]]) + beyond;
    for (size_t axis = 0; axis < 3; ++axis) out_.point[axis][out_.count] = float(point[axis]);
    // Beyond a crease the zero set belongs to another face.
    const double limit =
        border.crease ? 0 : 0.5 * (longest_edge(mesh_, border.face) + quick_norm(beyond));
    out_.on[out_.count] = static_cast<uint32_t>(out_.surfaces.size());
    out_.surfaces.push_back({direction_of(cross(by_x, by_y)), float(limit)});
    if (corners_) write_corners(border, t, out_.count);
    ++out_.count;
  }

  const UvLayout& layout_;
  const Mesh& mesh_;
  TilePoints& out_;
  TexelCorners* corners_;  // or null
  TexelBox box_;
  /// Bits of rows: texels on triangles, the first ones of runs on the same triangle, and those near
  /// a border.
  std::array<uint64_t, tile_size> on_triangle_, starts_, near_border_;
  /// Index of the triangle, for the first texel of a run, or of the border.
  std::array<uint32_t, tile_texels> on_;
  std::array<double, tile_texels> distance_;  // to the border, squared
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
  TileRaster raster(layout, tile, points, corners);
  // Where faces overlap, the first one is seen.
  const std::span<const uint32_t> faces = layout.faces.of(tile);
  for (size_t i = faces.size(); i-- > 0;) raster.add_face(faces[i]);
  for (const uint32_t border : layout.borders_near.of(tile)) raster.add_border(border);
  raster.collect();
}

}  // namespace sardf::baking

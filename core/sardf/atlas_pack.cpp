// The atlas's last stage: puts the charts into the image, all at one scale. Their true outlines are
// placed on a bitmap, largest first, each at the lowest free place of four orientations. Packing
// their boxes instead (stb_rect_pack) leaves more than half of the image unused for rings, discs
// and the branched charts of lattices; here small charts also find places in the holes of large
// ones. Debian has no library for outlines with holes under a licence and of a size that fit.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "sardf/atlas_bitmap.hpp"
#include "sardf/atlas_stages.hpp"

namespace sardf::atlas {
namespace {

constexpr double pi = 3.141592653589793;

double cross2(const Vec2& o, const Vec2& a, const Vec2& b) {
  return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
}

/// Convex hull by Andrew's monotone chain.
std::vector<Vec2> hull_of(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end());
  std::vector<Vec2> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const size_t base = hull.size();
    for (const Vec2& p : points) {
      while (hull.size() >= base + 2 && cross2(hull[hull.size() - 2], hull.back(), p) <= 0)
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  if (hull.empty()) hull.push_back(points[0]);
  return hull;
}

struct Box {
  Vec2 low{INFINITY, INFINITY}, high{-INFINITY, -INFINITY};
  double width() const { return high[0] - low[0]; }
  double height() const { return high[1] - low[1]; }
};

Vec2 turn(const Vec2& p, double cosine, double sine) {
  return {cosine * p[0] - sine * p[1], sine * p[0] + cosine * p[1]};
}

Box box_of(const std::vector<Vec2>& points, double cosine, double sine) {
  Box box;
  for (const Vec2& p : points) {
    const Vec2 q = turn(p, cosine, sine);
    for (size_t k = 0; k < 2; ++k) {
      box.low[k] = std::min(box.low[k], q[k]);
      box.high[k] = std::max(box.high[k], q[k]);
    }
  }
  return box;
}

/// A chart turned into its smallest box.
struct Piece {
  const std::vector<Vec2>* triangles;
  double cosine = 1, sine = 0;
  Box box;
};

Piece turn_to_smallest_box(const std::vector<Vec2>& triangles) {
  const std::vector<Vec2> hull = hull_of(triangles);
  Piece best{&triangles, 1, 0, box_of(hull, 1, 0)};
  for (int degree = 1; degree < 90; ++degree) {
    const double cosine = std::cos(degree * pi / 180), sine = std::sin(degree * pi / 180);
    const Box box = box_of(hull, cosine, sine);
    if (box.width() * box.height() < 0.999 * best.box.width() * best.box.height())
      best = {&triangles, cosine, sine, box};
  }
  return best;
}

struct Sizes {
  int side;       // cells along the image, without its border
  int border;     // in cells
  int cell;       // texels
  double gutter;  // in cells
};

Sizes sizes_of(int size, int gutter, int cell) {
  const int border = ((gutter + 1) / 2 + cell - 1) / cell;
  return {size / cell - 2 * border, border, cell, static_cast<double>(gutter) / cell};
}

/// The piece's cells at `scale` texels per unit.
Bitmap draw(const Piece& piece, double scale, const Sizes& sizes) {
  const double to_cells = scale / sizes.cell;
  Bitmap bitmap(static_cast<int>(std::ceil(piece.box.width() * to_cells)) + 1,
                static_cast<int>(std::ceil(piece.box.height() * to_cells)) + 1);
  const auto cells = [&](const Vec2& p) -> Vec2 {
    const Vec2 q = turn(p, piece.cosine, piece.sine);
    return {to_cells * (q[0] - piece.box.low[0]), to_cells * (q[1] - piece.box.low[1])};
  };
  const std::vector<Vec2>& t = *piece.triangles;
  for (size_t i = 0; i + 2 < t.size(); i += 3)
    bitmap.add_triangle(cells(t[i]), cells(t[i + 1]), cells(t[i + 2]));
  return bitmap;
}

Placement placement_of(const Piece& piece, const Bitmap& bitmap, int quarter_turns, int x, int y,
                       double scale, const Sizes& sizes) {
  Placement place{piece.cosine, piece.sine, {0, 0}};
  Vec2 offset{-scale * piece.box.low[0], -scale * piece.box.low[1]};
  // Bitmap::turned moves (x, y) to (height - y, x).
  double width = sizes.cell * bitmap.width(), height = sizes.cell * bitmap.height();
  for (int i = 0; i < quarter_turns; ++i) {
    offset = {height - offset[1], offset[0]};
    const double cosine = place.cosine;
    place.cosine = -place.sine;
    place.sine = cosine;
    std::swap(width, height);
  }
  place.offset = {offset[0] + sizes.cell * (x + sizes.border),
                  offset[1] + sizes.cell * (y + sizes.border)};
  return place;
}

/// Places every piece at the given scale, or returns an empty list.
std::vector<Placement> place_all(const std::vector<Piece>& pieces, double scale, const Sizes& sizes,
                                 const Report& report) {
  Sheet sheet(sizes.side, static_cast<int>(std::ceil(sizes.gutter)) + 1);
  std::vector<Placement> placements;
  for (const Piece& piece : pieces) {
    report();
    int best_top = sizes.side + 1;
    int best_x = 0, best_y = 0;
    Placement best_place;
    std::vector<Run> best_runs;
    const Bitmap upright = draw(piece, scale, sizes);
    Bitmap bitmap = upright;
    for (int turns = 0; turns < 4; ++turns) {
      if (turns > 0) bitmap = bitmap.turned();
      int x = 0, y = 0;
      if (!sheet.find_place(bitmap.runs_within(sizes.gutter), bitmap.width(), bitmap.height(),
                            best_top - 1, x, y))
        continue;
      best_top = y + bitmap.height();
      best_x = x;
      best_y = y;
      best_place = placement_of(piece, upright, turns, x, y, scale, sizes);
      best_runs = bitmap.runs();
    }
    if (best_runs.empty()) return {};
    sheet.occupy(best_runs, best_x, best_y);
    placements.push_back(best_place);
  }
  return placements;
}

double area_of(const std::vector<Vec2>& triangles) {
  double area = 0;
  for (size_t i = 0; i + 2 < triangles.size(); i += 3)
    area += 0.5 * cross2(triangles[i], triangles[i + 1], triangles[i + 2]);
  return area;
}

}  // namespace

Packing pack(const std::vector<std::vector<Vec2>>& charts, int size, int gutter,
             const Report& report) {
  std::vector<Piece> pieces;
  double area = 0;
  for (const auto& chart : charts) {
    report();
    pieces.push_back(turn_to_smallest_box(chart));
    area += area_of(chart);
  }
  std::vector<uint32_t> order(charts.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    const Box &p = pieces[a].box, &q = pieces[b].box;
    return p.width() + p.height() > q.width() + q.height();
  });
  std::vector<Piece> sorted;
  for (const uint32_t c : order) sorted.push_back(pieces[c]);

  Packing packing;
  std::vector<Placement> best;
  const auto attempt = [&](double scale, int cell) {
    const Sizes sizes = sizes_of(size, gutter, cell);
    if (sizes.side < 1) return false;
    std::vector<Placement> placements = place_all(sorted, scale, sizes, report);
    if (placements.empty()) return false;
    best = std::move(placements);
    packing.scale = scale;
    return true;
  };
  // Half of the cell size of the coarse search costs four times as much and gains a few percent.
  const int coarse = std::max(1, size / 512), fine = std::max(1, size / 1024);
  const double whole = size / std::sqrt(area);
  double low = 0, high = whole;
  for (double scale = 0.72 * whole; low == 0 && scale > 1e-3 * whole; scale *= 0.85) {
    if (attempt(scale, coarse))
      low = scale;
    else
      high = scale;
  }
  if (low == 0) return packing;
  for (int i = 0; i < 5; ++i) {
    const double middle = 0.5 * (low + high);
    (attempt(middle, coarse) ? low : high) = middle;
  }
  for (double scale = 1.06 * low; scale > low; scale -= 0.012 * low)
    if (attempt(scale, fine)) break;
  packing.placements.resize(charts.size());
  for (size_t i = 0; i < order.size(); ++i) packing.placements[order[i]] = best[i];
  return packing;
}

}  // namespace sardf::atlas

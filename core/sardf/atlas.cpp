#include "sardf/atlas.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "sardf/atlas_stages.hpp"
#include "sardf/error.hpp"
#include "sardf/pulse.hpp"

namespace sardf {
namespace {

constexpr size_t chart_limit = 60;
/// Charts are halved for better packing below this share of texels used, and at most so often.
constexpr double wanted_use = 0.58;
constexpr int most_splits = 4;
/// Share of the image that charts are expected to cover; sets the gutter in scene units before the
/// true scale is known. Chosen low, so that charts keep the gutter to themselves.
constexpr double expected_use = 0.5;
/// Two texels for the bilinear lookups from both sides and one for rounding.
constexpr double thin_gutter = 3;

/// The charts' triangles in the plane; charts in order of their first face.
std::vector<std::vector<Vec2>> outline(const Mesh& mesh, const atlas::Layout& layout,
                                       const std::vector<Chart>& charts) {
  std::vector<std::vector<Vec2>> result(charts.size());
  for (size_t c = 0; c < charts.size(); ++c)
    for (const uint32_t f : charts[c].faces) {
      const Vec2* flat = &layout.flat[4 * f];
      result[c].insert(result[c].end(), {flat[0], flat[1], flat[2]});
      if (mesh.faces[f][2] != mesh.faces[f][3])
        result[c].insert(result[c].end(), {flat[0], flat[2], flat[3]});
    }
  return result;
}

void check(int size, int gutter) {
  if (size < 16 || size > 16384)
    throw Error("an atlas of " + std::to_string(size) + " texels; accepted are 16 to 16384");
  if (gutter < 1 || gutter > size / 8)
    throw Error("a gutter of " + std::to_string(gutter) + " texels; accepted are 1 to " +
                std::to_string(size / 8) + " for this size");
}

double area_of(const atlas::Surface& surface) {
  double area = 0;
  for (const double a : surface.area) area += a;
  if (!(area > 0)) throw Error("an atlas needs a surface with area, found only flat faces");
  return area;
}

atlas::Layout lay_out(const atlas::Surface& surface, int size, int gutter, Pulse& pulse,
                      const atlas::Report& report) {
  const double unit = std::sqrt(area_of(surface) / expected_use) / size;
  const double gap = gutter * unit, thin_gap = std::min(gap, thin_gutter * unit);
  pulse.stage(0.15);
  const std::vector<uint32_t> patches = atlas::cut_patches(surface, report);
  pulse.stage(0.3);
  atlas::Layout layout = atlas::flatten_patches(surface, patches, thin_gap, report);
  pulse.stage(0.65);
  atlas::sew_charts(surface, layout, gap, thin_gap, chart_limit, report);
  pulse.stage(0.7);
  atlas::polish(surface, layout, thin_gap, report);
  return layout;
}

/// Charts in order of their first face.
std::vector<Chart> list_charts(const atlas::Layout& layout) {
  std::vector<Chart> charts;
  for (const auto& faces : layout.faces)
    if (!faces.empty()) {
      charts.emplace_back();
      charts.back().faces = faces;
    }
  std::sort(charts.begin(), charts.end(),
            [](const Chart& a, const Chart& b) { return a.faces[0] < b.faces[0]; });
  return charts;
}

struct Packed {
  std::vector<Chart> charts;
  atlas::Packing packing;
};

Packed pack(const Mesh& mesh, const atlas::Layout& layout, int size, int gutter,
            const atlas::Report& report) {
  Packed packed{list_charts(layout), {}};
  packed.packing = atlas::pack(outline(mesh, layout, packed.charts), size, gutter, report);
  return packed;
}

/// Packs the layout; halves its largest charts while they leave too much of the image unused, as a
/// few large rings and discs do.
Packed pack_well(const atlas::Surface& surface, atlas::Layout& layout, int size, int gutter,
                 const atlas::Report& report) {
  const double area = area_of(surface), texels = static_cast<double>(size) * size;
  const auto use = [&](const Packed& packed) {
    return packed.packing.scale * packed.packing.scale * area / texels;
  };
  Packed best = pack(*surface.mesh, layout, size, gutter, report);
  atlas::Layout trial = layout;
  for (int i = 0; i < most_splits && use(best) < wanted_use; ++i) {
    const size_t charts = atlas::halve_largest(surface, trial, chart_limit, report);
    if (charts == 0) break;
    Packed packed = pack(*surface.mesh, trial, size, gutter, report);
    if (use(packed) <= use(best)) continue;
    best = std::move(packed);
    layout = trial;
  }
  if (best.packing.scale == 0)
    throw Error(std::to_string(best.charts.size()) + " charts with gutters of " +
                std::to_string(gutter) + " texels do not fit in " + std::to_string(size) + "² " +
                "texels; use a larger size or a smaller gutter");
  return best;
}

/// Moves the layout's flat corners to texels.
void place(const Packed& packed, atlas::Layout& layout) {
  const double scale = packed.packing.scale;
  for (size_t c = 0; c < packed.charts.size(); ++c) {
    const auto& [cosine, sine, offset] = packed.packing.placements[c];
    for (const uint32_t f : packed.charts[c].faces)
      for (uint32_t i = 4 * f; i < 4 * f + 4; ++i) {
        const Vec2 p = layout.flat[i];
        layout.flat[i] = {scale * (cosine * p[0] - sine * p[1]) + offset[0],
                          scale * (sine * p[0] + cosine * p[1]) + offset[1]};
      }
  }
}

}  // namespace

Atlas make_atlas(Mesh& mesh, int size, int gutter, const Progress& progress) {
  check(size, gutter);
  Pulse pulse(progress);
  const atlas::Report report = [&pulse] { pulse(0); };
  pulse.stage(0.05);
  report();
  const atlas::Surface surface = atlas::build_surface(mesh);
  atlas::Layout layout = lay_out(surface, size, gutter, pulse, report);
  pulse.stage(0.95);
  Packed packed = pack_well(surface, layout, size, gutter, report);
  place(packed, layout);
  Atlas result;
  result.size = size;
  result.gutter = gutter;
  result.texels_per_unit = packed.packing.scale;
  result.charts = std::move(packed.charts);
  result.chart_of_face.resize(mesh.faces.size());
  double texels = 0;
  for (uint32_t c = 0; c < result.charts.size(); ++c) {
    Chart& chart = result.charts[c];
    for (const uint32_t f : chart.faces) result.chart_of_face[f] = c;
    atlas::describe(atlas::build_chart(surface, layout, chart.faces), result.texels_per_unit,
                    chart);
    texels += chart.area * chart.density_mean * chart.density_mean;
  }
  result.texels_used = texels / (static_cast<double>(size) * size);
  for (Vec2& p : layout.flat) p = {p[0] / size, p[1] / size};
  mesh.corner_uv = std::move(layout.flat);
  return result;
}

}  // namespace sardf

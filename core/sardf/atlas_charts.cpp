// The atlas's fourth stage: every patch becomes a flat chart; one that folds, overlaps itself or
// stretches too much is halved until it does not.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "sardf/atlas_stages.hpp"

namespace sardf::atlas {
namespace {

constexpr double patch_stretch = 1.6;
constexpr double nearly_flat = 1.01;
constexpr int patch_iterations = 6;
constexpr int final_iterations = 10;

void sew_within(const Surface& surface, const std::vector<uint32_t>& faces, Layout& layout) {
  for (const uint32_t f : faces)
    for (uint32_t h = 4 * f; h < 4 * f + 4; ++h) {
      const uint32_t twin = surface.twin[h];
      layout.sewn[h] = twin != none && std::binary_search(faces.begin(), faces.end(), twin / 4);
    }
}

/// A face alone: its two triangles unfolded around their common edge.
void unfold(const Surface& surface, uint32_t face, Layout& layout) {
  const uint32_t h = 4 * face;
  const Vec3 ab = surface.point(h + 1) - surface.point(h);
  const Vec3 ac = surface.point(h + 2) - surface.point(h);
  const Vec3 ad = surface.point(h + 3) - surface.point(h);
  const double length = norm(ac);
  const auto beside = [&](const Vec3& way, double side) -> Vec2 {
    if (length == 0) return {side * norm(way), 0};
    return {side * norm(cross(ac, way)) / length, dot(ac, way) / length};
  };
  layout.flat[h] = {0, 0};
  layout.flat[h + 1] = beside(ab, 1);
  layout.flat[h + 2] = {0, length};
  layout.flat[h + 3] =
      surface.vertex(h + 2) == surface.vertex(h + 3) ? Vec2{0, length} : beside(ad, -1);
}

bool flatten(const Surface& surface, const std::vector<uint32_t>& faces, double gap, Layout& layout,
             const Report& report) {
  sew_within(surface, faces, layout);
  if (faces.size() == 1) {
    unfold(surface, faces[0], layout);
    return true;
  }
  project(surface, faces, layout);
  ChartMesh chart = build_chart(surface, layout, faces);
  const Quality quality = measure(chart);
  const bool flat = quality.folded == 0 && quality.stretch_high < nearly_flat;
  relax(chart, flat ? 0 : patch_iterations, report);
  return measure(chart).stretch_high < patch_stretch &&
         store_embedded(surface, faces, gap, chart, layout, report);
}

}  // namespace

bool store_embedded(const Surface& surface, const std::vector<uint32_t>& faces, double gap,
                    ChartMesh& chart, Layout& layout, const Report& report) {
  if (measure(chart).folded > 0) return false;
  store_chart(chart, faces, layout);
  if (is_embedded(surface, layout, faces, gap)) return true;
  if (!remove_crossings(chart) || measure(chart).folded > 0) return false;
  relax(chart, 0, report);
  store_chart(chart, faces, layout);
  return is_embedded(surface, layout, faces, gap);
}

std::vector<std::vector<uint32_t>> halve(const Surface& surface, const Layout& layout,
                                         const std::vector<uint32_t>& faces) {
  Vec2 low{INFINITY, INFINITY}, high{-INFINITY, -INFINITY};
  for (const uint32_t f : faces)
    for (size_t k = 0; k < 2; ++k) {
      low[k] = std::min(low[k], layout.flat[4 * f][k]);
      high[k] = std::max(high[k], layout.flat[4 * f][k]);
    }
  const size_t axis = high[0] - low[0] > high[1] - low[1] ? 0 : 1;
  std::vector<double> sorted;
  for (const uint32_t f : faces) sorted.push_back(layout.flat[4 * f][axis]);
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<long>(faces.size() / 2),
                   sorted.end());
  const double middle = sorted[faces.size() / 2];
  std::vector<int> side(faces.size());
  for (size_t i = 0; i < faces.size(); ++i) side[i] = layout.flat[4 * faces[i]][axis] < middle;
  // Equal coordinates (a sliver of faces in one line) must not keep all faces on one side.
  if (std::count(side.begin(), side.end(), side[0]) == static_cast<long>(faces.size()))
    side[0] = !side[0];
  std::vector<std::vector<uint32_t>> parts;
  std::vector<char> seen(faces.size(), 0);
  for (size_t start = 0; start < faces.size(); ++start) {
    if (seen[start]) continue;
    parts.emplace_back();
    std::vector<size_t> stack{start};
    seen[start] = 1;
    while (!stack.empty()) {
      const size_t i = stack.back();
      stack.pop_back();
      parts.back().push_back(faces[i]);
      for (uint32_t h = 4 * faces[i]; h < 4 * faces[i] + 4; ++h) {
        if (surface.twin[h] == none || !layout.sewn[h]) continue;
        const auto at = std::lower_bound(faces.begin(), faces.end(), surface.twin[h] / 4);
        if (at == faces.end() || *at != surface.twin[h] / 4) continue;
        const auto j = static_cast<size_t>(at - faces.begin());
        if (seen[j] || side[j] != side[i]) continue;
        seen[j] = 1;
        stack.push_back(j);
      }
    }
    std::sort(parts.back().begin(), parts.back().end());
  }
  return parts;
}

Layout flatten_patches(const Surface& surface, const std::vector<uint32_t>& patch_of_face,
                       double gap, const Report& report) {
  const size_t count = surface.face_count();
  Layout layout{std::vector<uint32_t>(count),
                {},
                std::vector<char>(4 * count, 0),
                std::vector<Vec2>(4 * count, Vec2{0, 0})};
  std::vector<std::vector<uint32_t>> patches(
      *std::max_element(patch_of_face.begin(), patch_of_face.end()) + 1);
  for (uint32_t f = 0; f < count; ++f) patches[patch_of_face[f]].push_back(f);
  std::vector<std::vector<std::vector<uint32_t>>> charts(patches.size());
  tbb::parallel_for(size_t{0}, patches.size(), [&](size_t p) {
    std::vector<std::vector<uint32_t>> waiting;
    if (!patches[p].empty()) waiting.push_back(patches[p]);
    while (!waiting.empty()) {
      report();
      const std::vector<uint32_t> faces = std::move(waiting.back());
      waiting.pop_back();
      if (flatten(surface, faces, gap, layout, report)) {
        charts[p].push_back(faces);
      } else {
        project(surface, faces, layout);
        for (auto& part : halve(surface, layout, faces)) waiting.push_back(std::move(part));
      }
    }
  });
  for (auto& parts : charts)
    for (auto& faces : parts) {
      for (const uint32_t f : faces)
        layout.chart_of_face[f] = static_cast<uint32_t>(layout.faces.size());
      layout.faces.push_back(std::move(faces));
    }
  return layout;
}

void polish(const Surface& surface, Layout& layout, double gap, const Report& report) {
  tbb::parallel_for(size_t{0}, layout.faces.size(), [&](size_t c) {
    const std::vector<uint32_t>& faces = layout.faces[c];
    if (faces.empty()) return;
    report();
    ChartMesh chart = build_chart(surface, layout, faces);
    const Quality before = measure(chart);
    if (before.stretch_high < 1.01) return;
    const ChartMesh old = chart;
    relax(chart, final_iterations, report);
    const Quality quality = measure(chart);
    if (quality.stretch_mean > before.stretch_mean) return;
    if (!store_embedded(surface, faces, gap, chart, layout, report))
      store_chart(old, faces, layout);
  });
}

size_t halve_largest(const Surface& surface, Layout& layout, size_t limit, const Report& report) {
  std::vector<std::pair<double, size_t>> charts;
  for (size_t c = 0; c < layout.faces.size(); ++c) {
    if (layout.faces[c].empty()) continue;
    double area = 0;
    for (const uint32_t f : layout.faces[c]) area += surface.area[f];
    charts.emplace_back(area, c);
  }
  std::sort(charts.rbegin(), charts.rend());
  size_t count = charts.size();
  const size_t before = count, old_count = layout.faces.size();
  for (const auto& [area, c] : charts) {
    if (area < 0.5 * charts[0].first || layout.faces[c].size() < 2) break;
    auto parts = halve(surface, layout, layout.faces[c]);
    if (count + parts.size() - 1 > limit) continue;
    count += parts.size() - 1;
    layout.faces[c].clear();
    for (auto& part : parts) {
      for (const uint32_t f : part)
        layout.chart_of_face[f] = static_cast<uint32_t>(layout.faces.size());
      layout.faces.push_back(std::move(part));
    }
  }
  for (uint32_t h = 0; h < layout.sewn.size(); ++h)
    if (layout.sewn[h] && layout.chart_of_face[surface.twin[h] / 4] != layout.chart_of_face[h / 4])
      layout.sewn[h] = 0;
  // A half of a stretched chart has a scale of its own.
  for (size_t c = old_count; c < layout.faces.size(); ++c) {
    ChartMesh chart = build_chart(surface, layout, layout.faces[c]);
    relax(chart, 0, report);
    store_chart(chart, layout.faces[c], layout);
  }
  return count > before ? count : 0;
}

}  // namespace sardf::atlas

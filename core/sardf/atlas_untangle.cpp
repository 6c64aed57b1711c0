// Unfolds the few triangles that relaxing leaves folded, mostly slivers along creases. Each vertex
// near one moves to where the worst of its triangles is best (Freitag, Plassmann 2000, "Local
// optimization-based simplicial mesh untangling and improvement"): a triangle's area is linear in
// the place of one vertex, so the least of them is concave and a plain search finds its top.
#include <algorithm>
#include <cmath>

#include "sardf/atlas_stages.hpp"

namespace sardf::atlas {
namespace {

constexpr int sweeps = 12;
/// Triangles with this share of their own area are good enough to be left alone.
constexpr double enough = 0.2;

/// The triangle's signed area in the plane over its own.
double ratio(const ChartMesh& chart, size_t triangle) {
  const auto& [a, b, c] = chart.triangles[triangle];
  const Vec2 &p = chart.flat[a], &q = chart.flat[b], &r = chart.flat[c];
  const double area = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
  return area / (chart.shapes[triangle][0] * chart.shapes[triangle][2]);
}

double least_ratio(const ChartMesh& chart, const std::vector<size_t>& triangles) {
  double least = enough;
  for (const size_t t : triangles) least = std::min(least, ratio(chart, t));
  return least;
}

void improve(ChartMesh& chart, uint32_t vertex, const std::vector<size_t>& triangles) {
  double best = least_ratio(chart, triangles);
  double step = 0;
  for (const size_t t : triangles) step = std::max(step, chart.shapes[t][0]);
  const double smallest = 1e-4 * step;
  while (best < enough && step > smallest) {
    const Vec2 start = chart.flat[vertex];
    Vec2 found = start;
    for (int direction = 0; direction < 8; ++direction) {
      const double angle = direction * 0.7853981633974483;
      chart.flat[vertex] = {start[0] + step * std::cos(angle), start[1] + step * std::sin(angle)};
      const double value = least_ratio(chart, triangles);
      if (value <= best) continue;
      best = value;
      found = chart.flat[vertex];
    }
    chart.flat[vertex] = found;
    if (found == start) step *= 0.5;
  }
}

}  // namespace

void untangle(ChartMesh& chart) {
  std::vector<char> close(chart.flat.size());
  std::vector<std::vector<size_t>> around(chart.flat.size());
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    std::fill(close.begin(), close.end(), char{0});
    bool folded = false;
    for (size_t t = 0; t < chart.triangles.size(); ++t) {
      if (!folds(chart, t)) continue;
      folded = true;
      for (const uint32_t v : chart.triangles[t]) close[v] = 1;
    }
    if (!folded) return;
    for (auto& triangles : around) triangles.clear();
    for (size_t t = 0; t < chart.triangles.size(); ++t)
      for (const uint32_t v : chart.triangles[t])
        if (close[v]) around[v].push_back(t);
    for (uint32_t v = 0; v < close.size(); ++v)
      if (close[v]) improve(chart, v, around[v]);
  }
}

}  // namespace sardf::atlas

// Finds where segments in the plane cross, and smooths charts where their boundaries do.
#include <algorithm>
#include <cmath>

#include "sardf/atlas_stages.hpp"

namespace sardf::atlas {
namespace {

constexpr int rounds = 12;
/// A chart that overlaps itself with more crossings than this is not mended.
constexpr size_t most_crossings = 16;

double side_of(const Segment& s, const Vec2& p) {
  return (s.b[0] - s.a[0]) * (p[1] - s.a[1]) - (s.b[1] - s.a[1]) * (p[0] - s.a[0]);
}

bool cross(const Segment& s, const Segment& t) {
  return side_of(s, t.a) * side_of(s, t.b) < 0 && side_of(t, s.a) * side_of(t, s.b) < 0;
}

struct Boundary {
  std::vector<std::array<uint32_t, 2>> edges;
  std::vector<std::vector<uint32_t>> neighbours;  // of each vertex, along all edges
};

Boundary boundary_of(const ChartMesh& chart) {
  Boundary result;
  result.neighbours.resize(chart.flat.size());
  std::vector<std::array<uint32_t, 4>> sides;  // edge with smaller vertex first, then as directed
  for (const auto& t : chart.triangles)
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t a = t[k], b = t[(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), a, b});
    }
  std::sort(sides.begin(), sides.end());
  for (size_t i = 0; i < sides.size();) {
    const bool inner =
        i + 1 < sides.size() && sides[i][0] == sides[i + 1][0] && sides[i][1] == sides[i + 1][1];
    result.neighbours[sides[i][0]].push_back(sides[i][1]);
    result.neighbours[sides[i][1]].push_back(sides[i][0]);
    if (!inner) result.edges.push_back({sides[i][2], sides[i][3]});
    i += inner ? 2 : 1;
  }
  return result;
}

}  // namespace

std::vector<std::array<size_t, 2>> crossings(const std::vector<Segment>& segments, size_t most) {
  double length = 0;
  for (const Segment& s : segments) length += std::hypot(s.b[0] - s.a[0], s.b[1] - s.a[1]);
  const double cell = 2 * length / static_cast<double>(segments.size()) + 1e-300;
  const auto column = [&](double v) { return static_cast<int64_t>(std::floor(v / cell)); };
  // Sorted by cell; segments in one cell are then compared with each other.
  std::vector<std::array<int64_t, 3>> cells;
  for (size_t i = 0; i < segments.size(); ++i) {
    const auto [x0, x1] = std::minmax(segments[i].a[0], segments[i].b[0]);
    const auto [y0, y1] = std::minmax(segments[i].a[1], segments[i].b[1]);
    for (int64_t y = column(y0); y <= column(y1); ++y)
      for (int64_t x = column(x0); x <= column(x1); ++x)
        cells.push_back({x, y, static_cast<int64_t>(i)});
  }
  std::sort(cells.begin(), cells.end());
  std::vector<std::array<size_t, 2>> result;
  for (size_t i = 0; i < cells.size(); ++i)
    for (size_t j = i + 1;
         j < cells.size() && cells[j][0] == cells[i][0] && cells[j][1] == cells[i][1]; ++j) {
      const auto a = static_cast<size_t>(cells[i][2]), b = static_cast<size_t>(cells[j][2]);
      if (!cross(segments[a], segments[b])) continue;
      result.push_back({a, b});
      if (result.size() >= most) return result;
    }
  return result;
}

bool remove_crossings(ChartMesh& chart) {
  const Boundary boundary = boundary_of(chart);
  for (int round = 0; round < rounds; ++round) {
    std::vector<Segment> segments;
    for (const auto& [a, b] : boundary.edges) segments.push_back({chart.flat[a], chart.flat[b]});
    const auto found = crossings(segments, most_crossings + 1);
    if (found.empty()) return round > 0;
    if (found.size() > most_crossings) return false;
    std::vector<uint32_t> close;
    for (const auto& pair : found)
      for (const size_t segment : pair)
        for (const uint32_t v : boundary.edges[segment]) {
          close.push_back(v);
          // The knot's surroundings give way when its own vertices are not enough.
          if (round > 2)
            close.insert(close.end(), boundary.neighbours[v].begin(), boundary.neighbours[v].end());
        }
    std::sort(close.begin(), close.end());
    close.erase(std::unique(close.begin(), close.end()), close.end());
    for (const uint32_t v : close) {
      Vec2 sum{0, 0};
      for (const uint32_t w : boundary.neighbours[v])
        sum = {sum[0] + chart.flat[w][0], sum[1] + chart.flat[w][1]};
      const auto count = static_cast<double>(boundary.neighbours[v].size());
      chart.flat[v] = {0.5 * (chart.flat[v][0] + sum[0] / count),
                       0.5 * (chart.flat[v][1] + sum[1] / count)};
    }
    untangle(chart);
  }
  return false;
}

}  // namespace sardf::atlas

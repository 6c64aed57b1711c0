// Checks of flat charts by their boundaries. A chart whose triangles all keep their winding covers
// no point twice when its boundary curves are simple, apart from each other, and only one of them
// turns to the left: the turning numbers of the curves sum up to the chart's Euler characteristic.
#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "sardf/atlas_stages.hpp"

namespace sardf::atlas {
namespace {

/// The samples sorted by square cell, to look up those near a point.
class Grid {
 public:
  Grid(const std::vector<BoundarySample>& samples, double cell) : cell_(cell) {
    order_.reserve(samples.size());
    for (uint32_t i = 0; i < samples.size(); ++i)
      order_.emplace_back(key(column(samples[i].position[0]), column(samples[i].position[1])), i);
    std::sort(order_.begin(), order_.end());
    for (uint32_t i = 0; i < order_.size(); ++i)
      if (i == 0 || order_[i].first != order_[i - 1].first) first_.emplace(order_[i].first, i);
  }

  template <typename Visit>
  bool any_near(const Vec2& at, const Visit& visit) const {
    const int64_t x = column(at[0]), y = column(at[1]);
    for (int64_t dy = -1; dy <= 1; ++dy)
      for (int64_t dx = -1; dx <= 1; ++dx) {
        const uint64_t wanted = key(x + dx, y + dy);
        const auto found = first_.find(wanted);
        if (found == first_.end()) continue;
        for (size_t i = found->second; i < order_.size() && order_[i].first == wanted; ++i)
          if (visit(order_[i].second)) return true;
      }
    return false;
  }

 private:
  int64_t column(double v) const { return static_cast<int64_t>(std::floor(v / cell_)); }
  static uint64_t key(int64_t x, int64_t y) {
    return (static_cast<uint64_t>(x) << 32) ^ (static_cast<uint64_t>(y) & 0xFFFFFFFFu);
  }
  double cell_;
  std::vector<std::pair<uint64_t, uint32_t>> order_;
  std::unordered_map<uint64_t, uint32_t> first_;
};

bool face_each_other(const BoundarySample& p, const BoundarySample& q, double dx, double dy,
                     double distance) {
  return p.outward[0] * dx + p.outward[1] * dy > 0.2 * distance &&
         -q.outward[0] * dx - q.outward[1] * dy > 0.2 * distance;
}

double turning(const Layout& layout, const Surface& surface, const std::vector<uint32_t>& loop) {
  double sum = 0;
  for (size_t i = 0; i < loop.size(); ++i) {
    const Vec2 &a = layout.flat[loop[i]], &b = layout.flat[surface.next(loop[i])];
    sum += a[0] * b[1] - a[1] * b[0];
  }
  return sum;
}

}  // namespace

std::vector<std::vector<uint32_t>> boundary_loops(const Surface& surface, const Layout& layout,
                                                  const std::vector<uint32_t>& faces) {
  std::vector<std::vector<uint32_t>> loops;
  const auto on_boundary = [&](uint32_t h) { return !layout.sewn[h] && !surface.degenerate(h); };
  std::unordered_map<uint32_t, bool> seen;
  for (const uint32_t f : faces)
    for (uint32_t h = 4 * f; h < 4 * f + 4; ++h)
      if (on_boundary(h)) seen.emplace(h, false);
  for (const uint32_t f : faces)
    for (uint32_t h = 4 * f; h < 4 * f + 4; ++h) {
      if (!on_boundary(h) || seen[h]) continue;
      loops.emplace_back();
      for (uint32_t at = h; !seen[at];) {
        seen[at] = true;
        loops.back().push_back(at);
        at = surface.next(at);
        while (!on_boundary(at))
          at = surface.degenerate(at) ? surface.next(at) : surface.next(surface.twin[at]);
      }
    }
  return loops;
}

std::vector<BoundarySample> sample_boundary(const Surface& surface, const Layout& layout,
                                            const std::vector<std::vector<uint32_t>>& loops,
                                            double gap) {
  std::vector<BoundarySample> samples;
  for (uint32_t l = 0; l < loops.size(); ++l) {
    const size_t first = samples.size();
    double arc = 0;
    for (const uint32_t h : loops[l]) {
      const Vec2 &a = layout.flat[h], &b = layout.flat[surface.next(h)];
      const double dx = b[0] - a[0], dy = b[1] - a[1], length = std::hypot(dx, dy);
      if (length == 0) continue;
      const int parts = 1 + static_cast<int>(std::min(2 * length / gap, 1e4));
      const Vec2 outward{dy / length, -dx / length};
      for (int i = 0; i < parts; ++i) {
        const double t = (i + 0.5) / parts;
        // Slightly inside, so that two sides of a seam without any gap also face each other.
        samples.push_back(
            {{a[0] + t * dx - 0.05 * gap * outward[0], a[1] + t * dy - 0.05 * gap * outward[1]},
             outward,
             l,
             arc + t * length,
             0});
      }
      arc += length;
    }
    for (size_t i = first; i < samples.size(); ++i) samples[i].loop_length = arc;
  }
  return samples;
}

bool too_close(const std::vector<BoundarySample>& samples, double gap) {
  const Grid grid(samples, gap);
  for (const BoundarySample& p : samples) {
    const bool found = grid.any_near(p.position, [&](uint32_t i) {
      const BoundarySample& q = samples[i];
      const double dx = q.position[0] - p.position[0], dy = q.position[1] - p.position[1];
      const double distance = std::hypot(dx, dy);
      if (distance >= gap || distance == 0) return false;
      if (p.loop == q.loop) {
        const double way = std::abs(p.arc - q.arc);
        if (std::min(way, p.loop_length - way) <= 4 * gap) return false;
      }
      return face_each_other(p, q, dx, dy, distance);
    });
    if (found) return true;
  }
  return false;
}

bool is_embedded(const Surface& surface, const Layout& layout, const std::vector<uint32_t>& faces,
                 double gap) {
  const auto loops = boundary_loops(surface, layout, faces);
  int outer = 0;
  for (const auto& loop : loops) outer += turning(layout, surface, loop) > 0;
  std::vector<Segment> segments;
  for (const auto& loop : loops)
    for (const uint32_t h : loop)
      segments.push_back({layout.flat[h], layout.flat[surface.next(h)]});
  return outer == 1 && crossings(segments, 1).empty() &&
         !too_close(sample_boundary(surface, layout, loops, gap), gap);
}

}  // namespace sardf::atlas

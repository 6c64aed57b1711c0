#include "sardf/atlas_seams.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace sardf::atlas {

Motion after(const Motion& second, const Motion& first) {
  return {second.cosine * first.cosine - second.sine * first.sine,
          second.sine * first.cosine + second.cosine * first.sine, second(first.shift)};
}

Motion fit(const std::vector<PointPair>& pairs) {
  Vec2 from{0, 0}, to{0, 0};
  double weight = 0;
  for (const PointPair& pair : pairs) {
    weight += pair.weight;
    for (size_t k = 0; k < 2; ++k) {
      from[k] += pair.weight * pair.from[k];
      to[k] += pair.weight * pair.to[k];
    }
  }
  from = {from[0] / weight, from[1] / weight};
  to = {to[0] / weight, to[1] / weight};
  double along = 0, across = 0;
  for (const PointPair& pair : pairs) {
    const double px = pair.from[0] - from[0], py = pair.from[1] - from[1];
    const double qx = pair.to[0] - to[0], qy = pair.to[1] - to[1];
    along += pair.weight * (px * qx + py * qy);
    across += pair.weight * (px * qy - py * qx);
  }
  const double length = std::hypot(along, across);
  Motion motion;
  if (length > 0) motion = {along / length, across / length, {0, 0}};
  const Vec2 turned = motion.turn(from);
  motion.shift = {to[0] - turned[0], to[1] - turned[1]};
  return motion;
}

std::vector<std::vector<uint32_t>> runs_of(const Surface& surface,
                                           const std::vector<uint32_t>& half_edges) {
  std::map<uint32_t, std::vector<size_t>> at_vertex;
  for (size_t i = 0; i < half_edges.size(); ++i) {
    at_vertex[surface.vertex(half_edges[i])].push_back(i);
    at_vertex[surface.vertex(surface.next(half_edges[i]))].push_back(i);
  }
  std::vector<std::vector<uint32_t>> result;
  std::vector<char> seen(half_edges.size(), 0);
  for (size_t start = 0; start < half_edges.size(); ++start) {
    if (seen[start]) continue;
    result.emplace_back();
    std::vector<size_t> stack{start};
    seen[start] = 1;
    while (!stack.empty()) {
      const uint32_t h = half_edges[stack.back()];
      stack.pop_back();
      result.back().push_back(h);
      for (const uint32_t v : {surface.vertex(h), surface.vertex(surface.next(h))})
        for (const size_t j : at_vertex[v])
          if (!seen[j]) {
            seen[j] = 1;
            stack.push_back(j);
          }
    }
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const auto& p, const auto& q) { return p.size() > q.size(); });
  return result;
}

std::vector<BoundarySample> without_near(const std::vector<BoundarySample>& samples,
                                         const std::vector<Vec2>& points, double reach) {
  const auto cell = [&](const Vec2& p) {
    return std::pair{static_cast<int64_t>(std::floor(p[0] / reach)),
                     static_cast<int64_t>(std::floor(p[1] / reach))};
  };
  std::set<std::pair<int64_t, int64_t>> near;
  for (const Vec2& p : points) {
    const auto [x, y] = cell(p);
    for (int64_t dy = -1; dy <= 1; ++dy)
      for (int64_t dx = -1; dx <= 1; ++dx) near.emplace(x + dx, y + dy);
  }
  std::vector<BoundarySample> result;
  for (const BoundarySample& s : samples)
    if (!near.contains(cell(s.position))) result.push_back(s);
  return result;
}

}  // namespace sardf::atlas

// Geometry of the seams along which charts are sewn. Private to core/sardf/atlas*.cpp.
#pragma once

#include "sardf/atlas_stages.hpp"

namespace sardf::atlas {

/// A rotation and a shift of the plane.
struct Motion {
  double cosine = 1, sine = 0;
  Vec2 shift{0, 0};
  Vec2 turn(const Vec2& p) const {
    return {cosine * p[0] - sine * p[1], sine * p[0] + cosine * p[1]};
  }
  Vec2 operator()(const Vec2& p) const {
    const Vec2 q = turn(p);
    return {q[0] + shift[0], q[1] + shift[1]};
  }
};
Motion after(const Motion& second, const Motion& first);

struct PointPair {
  Vec2 from, to;
  double weight;
};
/// The motion that brings all `from` closest to their `to`, by weighted least squares.
Motion fit(const std::vector<PointPair>& pairs);

/// Half-edges grouped by connection through mesh vertices; the longest group first.
std::vector<std::vector<uint32_t>> runs_of(const Surface& surface,
                                           const std::vector<uint32_t>& half_edges);

/// The samples without those within about `reach` of one of the points.
std::vector<BoundarySample> without_near(const std::vector<BoundarySample>& samples,
                                         const std::vector<Vec2>& points, double reach);

}  // namespace sardf::atlas

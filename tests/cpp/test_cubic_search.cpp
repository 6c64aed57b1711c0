// Nearest points of cubic curves for blocks of points: each as if the point stood alone, on every
// instruction set, and what is called proven against a dense sampling.
#include <gtest/gtest.h>

#include <cstring>

#include "feature_checks.hpp"
#include "sardf/cubic_search.hpp"
#include "sardf/curve_set.hpp"
#include "sardf/kernels.hpp"

namespace sardf {
namespace {

using features::Draw;

/// Curves with cusps, corners, straight parts and equal points, in space and in the plane.
CurveData cubic_curve(Draw& draw, int kind) {
  CurveData data;
  data.control_points = draw.points(4 + draw.below(9), 3);
  data.closed = kind % 4 == 1;
  for (size_t i = 1; i < data.control_points.size(); ++i) {
    if (kind % 3 == 1 && draw.below(2)) data.control_points[i] = data.control_points[i - 1];
    if (kind % 5 == 2) data.control_points[i][2] = data.control_points[0][2];
  }
  data.control_points.back() = {4, 4, 4};
  return data;
}

using Rows = std::array<std::vector<double>, 3>;

/// Points in a ball, in a row, all alike, or anywhere.
Rows block_of_points(Draw& draw, const Vec3& centre, int kind, size_t n) {
  Rows rows;
  const double size = std::pow(10, draw.uniform(-6, 1));
  const Vec3 step = 1.0 / double(n) * draw.point(size);
  for (size_t i = 0; i < n; ++i) {
    Vec3 p = centre + draw.point(size);
    if (kind % 4 == 1) p = centre + double(i) * step;
    if (kind % 4 == 2) p = centre;
    if (kind % 4 == 3 && i % 100 == 7) p[i % 3] = i % 200 == 7 ? 1e200 : std::nan("");
    for (size_t k = 0; k < 3; ++k) rows[k].push_back(p[k]);
  }
  return rows;
}

/// Equal bits, so that NaNs are equal, too.
bool are_same(const Nearest& a, const Nearest& b) {
  return std::memcmp(&a.point, &b.point, sizeof a.point) == 0 &&
         std::memcmp(&a.distance, &b.distance, sizeof a.distance) == 0 &&
         std::memcmp(&a.gradient, &b.gradient, sizeof a.gradient) == 0 && a.part == b.part &&
         std::memcmp(&a.parameters, &b.parameters, sizeof a.parameters) == 0;
}

TEST(CubicSearchSlow, PointsOfABlockAreFoundAsIfAlone) {
  Draw draw(31);
  for (int kind = 0; kind < 400; ++kind) {
    SCOPED_TRACE(kind);
    const CurveSet curve("c", "", cubic_curve(draw, kind));
    const size_t n = size_t(1 + draw.below(kind % 7 == 0 ? 700 : 260));
    // Every other block stands on the curve or beside it.
    Vec3 centre = draw.point(5);
    if (kind % 2) centre = curve.nearest(centre).point;
    const Rows rows = block_of_points(draw, centre, kind / 2, n);
    const double* const points[] = {rows[0].data(), rows[1].data(), rows[2].data()};
    std::vector<Nearest> found(n);
    curve.nearest_points(points, n, found.data());
    for (size_t i = 0; i < n; ++i) {
      const Nearest alone = curve.nearest({rows[0][i], rows[1][i], rows[2][i]});
      ASSERT_TRUE(are_same(found[i], alone))
          << i << ": " << found[i].distance << " and " << alone.distance;
    }
  }
}

/// A Bezier point by repeated means, which the product does not use.
Vec3 bezier(const std::vector<Weighted>& points, double t) {
  std::vector<Vec3> at;
  for (const Weighted& p : points) at.push_back({p[0], p[1], p[2]});
  for (; at.size() > 1; at.pop_back()) {
    for (size_t i = 0; i + 1 < at.size(); ++i) at[i] = (1 - t) * at[i] + t * at[i + 1];
  }
  return at[0];
}

/// The least distance of 2000 points, and a bound of what it may be too large by.
std::pair<double, double> sampled_distance(const std::vector<Weighted>& points, const Vec3& p) {
  double best = infinity, apart = 0;
  Vec3 before = bezier(points, 0);
  for (int i = 0; i <= 2000; ++i) {
    const Vec3 at = bezier(points, i / 2000.0);
    best = std::min(best, norm(at - p));
    apart = std::max(apart, norm(at - before));
    before = at;
  }
  return {best, apart};
}

TEST(CubicSearchSlow, WhatIsProvenIsTheNearestPoint) {
  Draw draw(32);
  int proven = 0;
  for (int kind = 0; kind < 1500; ++kind) {
    SCOPED_TRACE(kind);
    std::vector<Weighted> points;
    // From nearly straight to anything.
    const Vec3 step = draw.point(2);
    const double bend = std::pow(10, draw.uniform(-2, 0.5));
    for (const double k : {0, 1, 2, 3}) {
      const Vec3 at = k * step + draw.point(bend);
      points.push_back({at[0], at[1], at[2], 1});
    }
    if (kind % 8 == 0) points[1] = points[0];
    const BoxTree tree(std::vector<Extent>{extent_of(points)}, 1);
    const CubicSearch search(points, tree);
    Vec3 p = draw.point(5);
    if (kind % 4 == 1) p = bezier(points, draw.uniform(0, 1)) + draw.point(1e-3);
    const CubicFound found = search.nearest(p);
    const Vec3 there = bezier(points, found.parameter);
    EXPECT_LE(norm(p + found.toward - there), 1e-14);
    if (!found.is_proven) continue;
    ++proven;
    const auto [distance, apart] = sampled_distance(points, p);
    EXPECT_LE(norm(found.toward), distance + 1e-14);
    EXPECT_GE(norm(found.toward), distance - apart);
  }
  EXPECT_GT(proven, 750);
}

// Of a half circle the nearest points of its middle are no single one; beyond it the ends are.
TEST(CubicSearch, ProvesNothingNearCentresOfCurvature) {
  const std::vector<Weighted> arc{{1, 0, 0, 1}, {1, 0.5523, 0, 1}, {0.5523, 1, 0, 1}, {0, 1, 0, 1}};
  const CubicPiece piece(arc.data());
  EXPECT_FALSE(piece.is_proven({0, 0, 0}, 0));
  EXPECT_TRUE(piece.is_proven({0.5, 0.5, 0}, 0.1));
  EXPECT_FALSE(piece.is_proven({0.5, 0.5, 0}, 0.7));
  EXPECT_TRUE(piece.is_proven({2, -0.2, 0}, 0.1));
}

struct Bests {
  std::array<std::vector<double>, 7> rows;
  CubicBests of(const Rows& points) {
    for (auto& row : rows) row.assign(points[0].size(), 0);
    rows[0].assign(points[0].size(), infinity);
    return {{points[0].data(), points[1].data(), points[2].data()},
            rows[0].data(),
            rows[1].data(),
            rows[2].data(),
            rows[3].data(),
            {rows[4].data(), rows[5].data(), rows[6].data()}};
  }
};

TEST(CubicSearch, InstructionSetsGiveTheSameBits) {
  std::vector<CubicSolver> solvers{cubic_solver()};
  if (instruction_set() >= InstructionSet::avx2) solvers.push_back(avx2_cubic_solver());
  if (instruction_set() == InstructionSet::avx512) solvers.push_back(avx512_cubic_solver());
  Draw draw(34);
  for (int kind = 0; kind < 300; ++kind) {
    const Rows points = block_of_points(draw, draw.point(2), 0, 64);
    std::vector<CubicPiece> pieces;
    for (int k = 0; k < 3; ++k) {
      std::vector<Weighted> corners;
      for (const Vec3& p : draw.points(4, 3)) corners.push_back({p[0], p[1], p[2], 1});
      if (k == 2) corners[3] = corners[0];
      pieces.emplace_back(corners.data());
    }
    Bests expected;
    const CubicBests single = expected.of(points);
    for (int k : {2, 0, 1}) single_cubic_solver()(pieces[size_t(k)], k, single, 64);
    for (const CubicSolver solver : solvers) {
      Bests other;
      const CubicBests bests = other.of(points);
      for (int k : {0, 1, 2}) solver(pieces[size_t(k)], k, bests, 64);
      for (size_t row = 0; row < 7; ++row) EXPECT_EQ(other.rows[row], expected.rows[row]);
    }
  }
}

}  // namespace
}  // namespace sardf

#include "sardf/cubic_search.hpp"

#include <algorithm>

namespace sardf {

namespace {

// Smaller blocks are searched point by point.
constexpr size_t least_block = 8;
// Where so many pieces may be nearest, halves of a block are cheaper unless it is small.
constexpr size_t few_pieces = 8, small_block = 32;

/// Room for rounding, of distances that are added up: for a ball it is many times that for a point.
double with_room(double distance, double magnitude, double share) {
  return distance + share * (distance + magnitude);
}
constexpr double room_of_point = 0x1p-44, room_of_ball = 0x1p-40;

}  // namespace

CubicSearch::CubicSearch(std::span<const Weighted> points, const BoxTree& tree) : tree_(&tree) {
  for (size_t i = 0; i < points.size(); i += 4) pieces_.emplace_back(&points[i]);
  magnitude_ = tree.extent().magnitude();
}

CubicFound CubicSearch::nearest(const Vec3& point) const {
  double key = infinity, squared = infinity, parameter = 0, part = 0;
  Vec3 toward{};
  const CubicBests best{{&point[0], &point[1], &point[2]},   &key, &squared, &parameter, &part,
                        {&toward[0], &toward[1], &toward[2]}};
  const CubicSolver solve_one = single_cubic_solver();
  double reach = infinity, bound = infinity, unproven = infinity;
  tree_->visit_near(point, bound, [&](size_t i) {
    const double least = pieces_[i].least_distance(point);
    if (least > reach) return;
    solve_one(pieces_[i], double(i), best, 1);
    reach = with_room(std::sqrt(squared), magnitude_, room_of_point);
    bound = reach * reach;
    if (!pieces_[i].is_proven(point, 0)) unproven = std::min(unproven, least);
  });
  return {unproven > reach, toward, size_t(part), parameter};
}

CubicSearch::Near CubicSearch::pieces_near(const Vec3& centre, double radius, size_t most) const {
  const Vec3 toward = nearest(centre).toward;
  const double reach = with_room(quick_norm(toward) + 2 * radius, magnitude_, room_of_ball);
  Near near;
  double bound = reach * reach;
  tree_->visit_near(centre, bound, [&](size_t i) {
    if (pieces_[i].least_distance(centre) > reach) return;
    near.is_proven = near.is_proven && near.count < most && pieces_[i].is_proven(centre, radius);
    if (near.is_proven) near.piece[near.count++] = i;
    if (!near.is_proven) bound = 0;  // ends the visits
  });
  return near;
}

bool CubicSearch::solve(const Points& points, size_t n, CubicFound* found) const {
  Extent box;
  for (size_t i = 0; i < n; ++i) box.add(Vec3{points[0][i], points[1][i], points[2][i]});
  const Vec3 centre = 0.5 * (box.lo + box.hi), corner = box.hi - centre;
  const double radius = quick_norm(corner) * (1 + 0x1p-40);
  const Near near = pieces_near(centre, radius, n > small_block ? few_pieces : most_pieces);
  if (!near.is_proven) return false;
  const size_t whole = (n + 7) / 8 * 8;
  std::array<std::array<double, most_points>, 7> rows;
  for (auto& row : rows) std::fill_n(row.begin(), whole, 0);
  std::fill_n(rows[0].begin(), whole, infinity);
  const CubicBests bests{{points[0], points[1], points[2]},
                         rows[0].data(),
                         rows[1].data(),
                         rows[2].data(),
                         rows[3].data(),
                         {rows[4].data(), rows[5].data(), rows[6].data()}};
  static const CubicSolver solver = cubic_solver();
  for (size_t k = 0; k < near.count; ++k) {
    solver(pieces_[near.piece[k]], double(near.piece[k]), bests, whole);
  }
  for (size_t i = 0; i < n; ++i) {
    found[i] = {true, {rows[4][i], rows[5][i], rows[6][i]}, size_t(rows[3][i]), rows[2][i]};
  }
  return true;
}

void CubicSearch::nearest(const Points& points, size_t n, CubicFound* found) const {
  if (n <= least_block) {
    for (size_t i = 0; i < n; ++i) found[i] = nearest({points[0][i], points[1][i], points[2][i]});
    return;
  }
  if (solve(points, n, found)) return;
  const size_t half = (n / 2 + 7) / 8 * 8;
  nearest(points, half, found);
  nearest({points[0] + half, points[1] + half, points[2] + half}, n - half, found + half);
}

}  // namespace sardf

// The nearest points of a curve of cubic pieces for a block of points at once.
//
// For a ball around the points, with centre c and radius r, only pieces within d(c) + 2 r of c can
// hold a nearest point. Where CubicPiece proves for all of these that Newton's iteration finds
// their nearest points, the iteration alone gives the answer for every point. Else the block is
// halved, down to single points; what is not proven for these is left to CurveSearch.
//
// A point gets the same bits in whatever block it stands: the proof for a block implies that for
// each of its points, with more room than rounding takes, and pieces that only the block's ball
// reaches are farther away.
#pragma once

#include <span>

#include "sardf/box_tree.hpp"
#include "sardf/cubic_piece.hpp"

namespace sardf {

/// A nearest point, in the pieces' coordinates.
struct CubicFound {
  bool is_proven = false;
  Vec3 toward{};  // from the point to it
  size_t part = 0;
  double parameter = 0;
};

class CubicSearch {
 public:
  static constexpr size_t most_points = 256;

  CubicSearch() = default;
  /// `points`: four for each piece, with weights of 1, in the tree's order. `tree` must outlive it.
  CubicSearch(std::span<const Weighted> points, const BoxTree& tree);

  /// Of finite points whose squares are finite.
  CubicFound nearest(const Vec3& point) const;
  /// By coordinate.
  using Points = std::array<const double*, 3>;
  /// The same for up to most_points points. Numbers up to the next multiple of 8 are read, too.
  void nearest(const Points& points, size_t n, CubicFound* found) const;

 private:
  static constexpr size_t most_pieces = 16;
  /// The pieces that may hold the nearest point of a ball's points, if all of them are proven.
  struct Near {
    std::array<size_t, most_pieces> piece{};
    size_t count = 0;
    bool is_proven = true;
  };
  Near pieces_near(const Vec3& centre, double radius, size_t most) const;
  bool solve(const Points& points, size_t n, CubicFound* found) const;

  std::vector<CubicPiece> pieces_;
  const BoxTree* tree_ = nullptr;
  double magnitude_ = 0;  // of the pieces' coordinates
};

}  // namespace sardf

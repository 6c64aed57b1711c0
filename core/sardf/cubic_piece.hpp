// A cubic piece of a curve, prepared for the search of many points' nearest points on it.
//
// For a point p let a = C(0) - p. Half the derivative of |C(t) - p|² is f(t) = (C(t) - p)·C'(t), a
// polynomial of degree 5 whose coefficients are linear in a. In Bernstein form they tell, for all
// points of a ball at once,
// - that f is nowhere positive, or nowhere negative: an end of the piece is nearest; or
// - that f rises everywhere: Newton's iteration finds the only minimum.
#pragma once

#include <array>
#include <cstddef>

#include "sardf/box_tree.hpp"
#include "sardf/bspline_pieces.hpp"

namespace sardf {

/// C(t) = start + t (by_1 + t (by_2 + t by_3)).
struct CubicPiece {
  Vec3 start{}, by_1{}, by_2{}, by_3{};
  /// Coefficient k of f by powers is constant[k] + (k + 1) a·by_(k + 1).
  std::array<double, 6> constant{};
  /// Coefficient k of f in Bernstein form is level[k] + a·along[k].
  std::array<double, 6> level{};
  std::array<Vec3, 6> along{};
  std::array<double, 6> length{};  // of `along`
  std::array<double, 5> change{};  // lengths of the differences of `along`
  double longest = 0;              // of `length`
  Vec3 chord{};                    // from start to end
  double height = 0;               // no point of the piece is farther from the chord
  Extent box;                      // of the Bezier points

  /// From four Bezier points whose weights are 1.
  explicit CubicPiece(const Weighted* points);

  /// Bounds the distance from below: the chord's less the height, and the box's. Its slope is at
  /// most 1.
  double least_distance(const Vec3& point) const;
  /// Whether it is proven for every point of the ball that a CubicSolver finds the nearest point of
  /// the piece. What is proven for a ball is so for each of its points alone, rounding included.
  bool is_proven(const Vec3& centre, double radius) const;
};

/// The nearest points found so far for a block of points, by arrays; all have the same length, a
/// multiple of 8.
struct CubicBests {
  const double* point[3];
  /// Squared distances by which pieces are compared: those at ends count for a little more, since
  /// of points that differ by rounding alone the minimum has the right direction.
  double* key;
  double *squared, *parameter, *part;
  double* toward[3];  // from the point to the nearest point
};

/// Compares the best points [0, n), n a multiple of 8, with those on the piece; `part` is its
/// number. The result for a point depends on nothing but this point and which pieces it is
/// compared with, in whatever order.
using CubicSolver = void (*)(const CubicPiece& piece, double part, const CubicBests& bests,
                             size_t n);

/// The one that this machine runs, and one for single points (n any number); all give the same
/// bits.
CubicSolver cubic_solver();
CubicSolver single_cubic_solver();
CubicSolver avx2_cubic_solver();
CubicSolver avx512_cubic_solver();

}  // namespace sardf

// The nearest point of a Bezier curve, polynomial or rational, with certainty.
//
// The squared distance from a point p is a quotient Q/W: with A_i = P_i w_i - p w_i, Q = |A|² and W
// = w² are polynomials in Bernstein form of twice the degree. A piece is done with
// - when no coefficient of g = Q - T² W is negative, T being the best distance found less a
//   tolerance: a polynomial is nowhere below its least coefficient; or
// - when g is convex (no second difference of its coefficients is negative) with second derivative
//   of at least a > 0, and at the minimum that Newton's iteration found g - g'²/(2a) is not
//   negative: a strongly convex function is nowhere below that.
// Any other piece is halved. Both conditions are checked on what was computed, so that neither a
// missed minimum nor a failed iteration can go unnoticed, and a piece so short that its ends tell
// all ends the search in any case.
// Sources: Farouki and Rajan 1988, "Algorithms for polynomials in Bernstein form"; the idea of
// bounding squared distances by their coefficients: Chen, Yong, Wang, Paul and Xu 2008,
// "Computing the minimum distance between a point and a NURBS curve".
#pragma once

#include "sardf/bspline_pieces.hpp"

namespace sardf {

/// The state of a search: its point, and the best that is known.
struct CurveSearch {
  Vec3 point{};
  double rounding = 0;     // of coordinates: a distance below it is 0
  double squared = 1e300;  // the least squared distance found
  size_t part = 0;         // where: which piece, and its parameter
  double parameter = 0;

  /// Squared distance that pieces are compared with: of the best distance less the tolerance.
  double threshold() const;
  /// The same less rounding alone.
  double tight_threshold() const { return squared * (1 - 0x1p-49); }
  /// Takes note of a point of the part, also where the best one is nearer by rounding alone and
  /// this one `is_minimum`: of such points the minimum has the right direction.
  void note(double squared_there, size_t piece, double at, bool is_minimum);
  /// Takes note of the pieces' points that are nearer. `points`: degree + 1 of them.
  template <bool rational>
  void visit(const Weighted* points, int degree, size_t piece);
  /// Last steps of Newton's iteration on the whole piece that the best point is on, where rounding
  /// is least. The distance has all its digits before; its direction needs twice as many.
  void polish(const Weighted* points, int degree);
};

/// A point of a Bezier curve relative to `origin`, with its derivatives by the parameter.
struct CurvePoint {
  Vec3 at{}, first{}, second{};
};
CurvePoint curve_point(const Weighted* points, int degree, double t, const Vec3& origin);

extern template void CurveSearch::visit<false>(const Weighted*, int, size_t);
extern template void CurveSearch::visit<true>(const Weighted*, int, size_t);

}  // namespace sardf

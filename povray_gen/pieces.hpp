// A solid's surface in several boxes, each with a formula that is shorter and a bound of the
// gradient that is smaller than those of the whole.
//
// POV-Ray looks for a surface between the two places where a ray passes a container, by halving.
// Where the containers hold little but surface, and the formula only what matters in them, that
// takes fewer calls of shorter functions.
#pragma once

#include <vector>

#include "sardf/certify.hpp"
#include "sardf/progress.hpp"

namespace sardf::povray {

struct Piece {
  BoundingBox box;
  /// In the box and `reach` around equal to the whole solid, bit for bit, where either is within
  /// `exact_within`; elsewhere it has the same sign.
  Expression solid;
  /// A bound of |grad solid| in the box where |solid| <= band; infinity if that of the whole is no
  /// larger.
  double gradient = infinity;
  /// The values beyond which the solid is steeper and has to be cut off; infinity: none.
  double band = infinity;
};

struct PieceOptions {
  double overlap = 0;              ///< how far pieces extend beyond the faces that they share
  double reach = 0;                ///< how far outside of its box a piece is evaluated
  double exact_within = infinity;  ///< values beyond need only the right sign
  double accuracy = 0;             ///< to which POV-Ray finds the surface
  double gradient = infinity;      ///< a bound of |grad solid| in the bounds
  Progress progress = {};
};

/// Boxes within `bounds`, but for the overlap, that are proven to hold all of the surface: what
/// lies outside of them is proven to be all inside or all outside the solid. As many as are
/// estimated to take the least time; one, the bounds themselves with the whole solid, where
/// splitting does not pay. The order, and all else, depends on nothing but the input. Cancelled.
std::vector<Piece> pieces_of(const Expression& solid, const BoundingBox& bounds,
                             const PieceOptions& options);

}  // namespace sardf::povray

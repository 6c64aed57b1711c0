// Tensor-product B-splines as an operation on two or three inputs.
#pragma once

#include <optional>

#include "sardf/operation.hpp"
#include "sardf/spline_grid.hpp"

namespace sardf {

/// The sum of coefficient times function. A point outside the box has the value of the nearest
/// point of the box: the function is continuous everywhere, and as smooth as its degree within the
/// box; its derivative across a face of the box is that from inside on the face and 0 beyond.
///
/// Bounds over a box are proven: control points of Bernstein polynomials where the box lies in a
/// few spans, else the coefficients that act there. The derivative by an input is such an operation
/// of a degree less; an input of degree 0 has none.
OperationPointer spline_operation(const SplineGrid& grid, std::vector<double> coefficients);

/// The box that a spline operation's functions are on, and the inputs by which it jumps to 0 beyond
/// it; by the others it goes on as at the nearest point of the box.
struct SplineReach {
  std::array<Interval, 3> box;
  std::array<bool, 3> jumps{};
};
/// Nothing for other operations.
std::optional<SplineReach> spline_reach(const Operation& operation);

}  // namespace sardf

// Tensor-product B-splines as an operation on two or three inputs.
#pragma once

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

}  // namespace sardf

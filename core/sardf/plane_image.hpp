// A picture of where a solid is, on a plane: the sign of its field at every pixel.
#pragma once

#include <cstdint>
#include <vector>

#include "sardf/evaluate.hpp"

namespace sardf {

/// Pixels on the rectangle from `lo` to `hi` of the plane at height z, in scene units. Row 0 is at
/// the top, where y is largest; a pixel stands for the point in its middle.
struct PlaneView {
  Vec2 lo{-1, -1}, hi{1, 1};
  double z = 0;
  int width = 512, height = 512;

  double x(int column) const { return lo[0] + (column + 0.5) * ((hi[0] - lo[0]) / width); }
  double y(int row) const { return hi[1] - (row + 0.5) * ((hi[1] - lo[1]) / height); }
};

/// For every pixel, row after row, 1 where the field (first output) is not negative and 0
/// elsewhere, NaN included. Tiles in which the sign is proven to be one are filled; in the others
/// the program is shortened (shorten.hpp) before they are divided. Values that floats cannot tell
/// from 0, within 2^-13 of the field's range over the view, are computed in double: the picture is
/// that of the field in double. Throws Error for an empty or infinite rectangle or a size out of 1
/// to 65 536, and Cancelled.
std::vector<uint8_t> sign_image(const Evaluator& field, const PlaneView& view,
                                const Progress& progress = {});

}  // namespace sardf

// The three shapes that evaluation is measured on, as expressions and with their bounds.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "sardf/evaluate.hpp"

namespace sardf::bench {

enum class Shape { spheres, block, blended_block };

/// 16 spheres in a plane with a box subtracted (min and max); a block with five holes and a torus
/// (min and max); the same with a blend of radius 0.5.
Expression shape(Shape which, const std::string& rounded = "sardf");
/// What the block with rounded edges is made of: three materials by the distances to the bore's
/// boundary and to two corners, to the power -exponent; and the colour that they average to.
struct Graded {
  std::vector<Expression> fractions, color;
};
Graded graded_block(double exponent);
/// A box around the shape, 10 % larger.
BoundingBox bounds(Shape which);
std::string name(Shape which);

/// Points in a row of the grid over a shape's bounds, rows in a slice, and slices.
inline constexpr size_t side = 256, slices = 64, points_in_grid = side * side * slices;

/// work(x, y, z) on the rows of the grid.
template <class T, class Work>
void for_rows(Shape which, Work work) {
  const BoundingBox box = bounds(which);
  const Vec3 size = box.size();
  alignas(64) T x[side], y[side], z[side];
  for (size_t i = 0; i < side; ++i) x[i] = T(box.lo[0] + size[0] * double(i) / (side - 1));
  for (size_t k = 0; k < slices; ++k) {
    std::fill_n(z, side, T(box.lo[2] + size[2] * double(k) / (slices - 1)));
    for (size_t j = 0; j < side; ++j) {
      std::fill_n(y, side, T(box.lo[1] + size[1] * double(j) / (side - 1)));
      work(x, y, z);
    }
  }
}

}  // namespace sardf::bench

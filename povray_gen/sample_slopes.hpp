// How steep trilinear interpolation of samples is, box by box.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "povray_gen/sample_grid.hpp"
#include "sardf/work.hpp"

namespace sardf::povray {

/// Of the interpolated function over a box; of nothing at first.
struct SampleBounds {
  static Interval nothing() { return {infinity, -infinity}; }
  Interval codes = nothing();  ///< its values, in the numbers that are stored
  /// Its partial derivatives, in those numbers per length.
  std::array<Interval, 3> partials{nothing(), nothing(), nothing()};
  double squares = 0;  ///< the square of its longest gradient

  void add(const SampleBounds& other);
};

/// Bounds of cells, of blocks of 4 cells along each axis, of 8, 16, ...: a box takes those of the
/// finest level of which few are enough.
class SampleSlopes {
 public:
  /// Throws Cancelled.
  SampleSlopes(const SampleGrid& grid, std::span<const uint32_t> codes, Work& work);

  /// Over all cells that the box meets, or is nearest to where it lies outside of the grid. Bounds
  /// hold but for rounding by a few units in the last place.
  SampleBounds over(const std::array<Interval, 3>& box, std::span<const uint32_t> codes) const;

 private:
  struct Level {
    std::array<int, 3> counts;  // of blocks
    std::vector<SampleBounds> blocks;
  };
  struct CellRange {
    std::array<int, 3> first, last;
  };
  SampleBounds of_cell(const std::array<int, 3>& cell, std::span<const uint32_t> codes) const;
  template <class Bounds>
  static SampleBounds joined(const CellRange& range, int shift, const Bounds& bounds);

  SampleGrid grid_;
  std::array<int, 3> cells_{1, 1, 1};
  std::array<size_t, 3> stride_{};
  std::array<double, 3> per_step_{};
  std::vector<Level> levels_;
};

}  // namespace sardf::povray

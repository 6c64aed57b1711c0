// The points at which a function is sampled.
#pragma once

#include <array>
#include <cstddef>

#include "sardf/numbers/interval.hpp"
#include "sardf/vec.hpp"

namespace sardf::povray {

/// Of things that stand in rows along each axis, where x runs fastest.
size_t index_of(const std::array<int, 3>& counts, const std::array<int, 3>& position);
std::array<int, 3> position_of(const std::array<int, 3>& counts, size_t index);

/// Points in rows along each axis; x runs fastest.
struct SampleGrid {
  std::array<Interval, 3> box;         ///< from the first point to the last
  std::array<int, 3> counts{1, 1, 1};  ///< points along each axis; 1: the value does not change

  bool varies(int axis) const { return counts[axis] > 1; }
  double step(int axis) const {
    return varies(axis) ? (box[axis].hi - box[axis].lo) / (counts[axis] - 1) : 0;
  }
  /// Along one axis in the density file: one more layer follows the last.
  int stored(int axis) const { return varies(axis) ? counts[axis] + 1 : 1; }
  size_t size() const { return size_t(counts[0]) * size_t(counts[1]) * size_t(counts[2]); }
  double stored_size() const { return double(stored(0)) * stored(1) * stored(2); }
  std::array<int, 3> position(size_t index) const { return position_of(counts, index); }
  size_t index(const std::array<int, 3>& position) const { return index_of(counts, position); }
  Vec3 point(size_t index) const;
  /// The point `at` steps from the first.
  Vec3 place(const Vec3& at) const;
};

}  // namespace sardf::povray

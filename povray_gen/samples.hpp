// A function given by its values on a grid, as POV-Ray's density files hold and interpolate them.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "sardf/numbers/interval.hpp"
#include "sardf/output_file.hpp"
#include "sardf/vec.hpp"
#include "sardf/work.hpp"

namespace sardf::povray {

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
  std::array<int, 3> position(size_t index) const;
  size_t index(const std::array<int, 3>& position) const;
  Vec3 point(size_t index) const;
  /// The point `at` steps from the first.
  Vec3 place(const Vec3& at) const;
};

/// Between the samples lies what `density_file df3 ... interpolate 1` computes: trilinear
/// interpolation, exact to 3e-16 of the range of values (tried in POV-Ray 3.7.0.10). It stays
/// between its samples, so that no value leaves [0, 1], where POV-Ray's patterns wrap around, and
/// its slope is bounded by difference quotients. `interpolate 2` is a Catmull-Rom spline, computed
/// to 6e-8 only, which normals from differences would show. At equal size it is 80 times better and
/// more for smooth functions, which need few samples either way, but only 1.5 to 1.9 times at
/// kinks, which decide the size of distances' samples.
class Samples {
 public:
  /// `values`: at the grid's points, finite. Throws Cancelled.
  Samples(const SampleGrid& grid, std::span<const double> values, Work& work);

  const SampleGrid& grid() const { return grid_; }
  /// Interpolated; outside the box, the value at the nearest point of it. `gradient` may be null.
  double value(const Vec3& at, Vec3* gradient) const;

  /// Encloses all values.
  Interval range() const { return range_; }
  /// Encloses each partial derivative between the samples.
  const std::array<Interval, 3>& partials() const { return partials_; }
  /// Bounds the gradient's length.
  double steepest() const { return steepest_; }
  /// Bound of what the storage as whole numbers of 32 bits changes.
  double rounding() const { return 0.5 * scale_ + 1e-15 * range_.magnitude(); }
  /// Where the function is farthest from linear: up to `count` samples, at most one of each row.
  std::vector<size_t> most_bent(size_t count, Work& work) const;

  /// A value as offset() + factor() × that of the density file, or range().lo where rounding makes
  /// that less: roots and logarithms of distances must not become NaN.
  double offset() const { return low_ - scale_; }
  double factor() const;
  /// The whole density file. The progress is asked after every part whether to go on; throws
  /// Cancelled.
  void write_to(OutputFile& file, const Progress& progress = {}) const;

 private:
  void bound_slopes(Work& work);
  double bend(size_t index) const;

  SampleGrid grid_;
  std::unique_ptr<uint32_t[]> codes_;  // value = low_ + scale_ × (code - 1)
  double low_ = 0, scale_ = 0;
  Interval range_;
  std::array<Interval, 3> partials_;
  double steepest_ = 0;
};

}  // namespace sardf::povray

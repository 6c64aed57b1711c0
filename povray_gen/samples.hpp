// A function given by its values on a grid, as POV-Ray's density files hold and interpolate them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "povray_gen/sample_slopes.hpp"
#include "sardf/operation.hpp"
#include "sardf/output_file.hpp"

namespace sardf::povray {

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
  /// Encloses the values and each partial derivative over a box, and bounds the gradient's length.
  Slope over(const std::array<Interval, 3>& box) const;
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
  double bend(size_t index) const;

  SampleGrid grid_;
  std::unique_ptr<uint32_t[]> codes_;  // value = low_ + scale_ × (code - 1)
  double low_ = 0, scale_ = 0;
  Interval range_;
  std::optional<SampleSlopes> slopes_;
};

}  // namespace sardf::povray

// A scene sampled on a grid, as 3-D textures take it: where its solid is and what colour it has.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "sardf/scene.hpp"

namespace sardf {

/// Cells over a box, `counts` along x, y and z; a sample stands for the middle of its cell, as a
/// texel of a texture that covers the box does.
struct TexelGrid {
  BoundingBox box;
  std::array<int, 3> counts{128, 128, 128};

  size_t size() const { return size_t(counts[0]) * counts[1] * counts[2]; }
  double cell(int axis) const { return (box.hi[axis] - box.lo[axis]) / counts[axis]; }
  /// The coordinate of sample i along an axis.
  double at(int axis, int i) const { return box.lo[axis] + (i + 0.5) * cell(axis); }
};

/// Which samples get a colour.
enum class Colored {
  nothing,
  /// The corners of every cube of eight neighbouring samples with a sample inside and one outside:
  /// those that interpolation on the surface takes. What lies beyond the grid counts as outside.
  surface,
  /// The corners of every cube of eight with a sample inside: wherever one may cut the solid open.
  inside,
};

/// "none", "surface" or "inside". Throws Error for another word.
Colored colored_samples(const std::string& name);

struct VolumeSampling {
  TexelGrid grid;
  /// What is sampled: the solid with its sections cut away, or whole.
  bool sections = true;
  Colored colored = Colored::surface;
  /// What the colours are, 1 to 3 components; none: the base colour, linear.
  std::vector<Expression> components;
};

/// Samples in order, x fastest, then y.
struct VolumeSamples {
  /// Of the solid's field, positive inside; computed in float. What is no number counts as outside,
  /// and nothing is larger than the box's diagonal, up to its sign.
  std::unique_ptr<float[]> field;
  /// Four for each sample: the components, 0 where there are fewer than three, and 1; where a
  /// sample has no colour, or one that is not finite, four zeros. Null: nothing was to be coloured.
  std::unique_ptr<float[]> colors;
  /// At least the length of the gradient of the field that is interpolated between eight samples: a
  /// step of |field| / steepness does not cross its surface.
  double steepness = 0;
  /// Least and largest first component of all coloured samples; lo > hi where there are none.
  Interval range{infinity, -infinity};
};

/// Samples on all threads with programs shortened for blocks (shorten.hpp): the same numbers as
/// Evaluator::values in float, whatever the number of threads. Throws Error: a box that is empty or
/// infinite, counts out of 1 to 2048, more than 2^28 samples or more than three components;
/// and Cancelled.
VolumeSamples sample_volume(const Scene& scene, const VolumeSampling& sampling,
                            const Progress& progress = {});

}  // namespace sardf

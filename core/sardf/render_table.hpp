// Many rays side by side in single precision; private to core/sardf/render*.cpp.
//
// Coordinates count from the middle of the box and depths from where the box begins, so that the
// roundings are shares of the box's size wherever the camera stands. A place is from + depth along,
// and both are those of a square's middle ray and what a pixel to the right and one down adds.
// With u = 2^-24, three roundings are of the sums (|middle ray|, and twice what was added to it),
// two of each part that is added, and two of the product and the sum with it: the place is off by
// at most 5 u times the way from the middle to where the ray begins and on to the place, and 4 u
// times the pixels' share of it. One more is for the box's own half. A place is then moved into the
// box, which is convex: it comes no farther from any point there.
#pragma once

#include <array>
#include <cstddef>

#include "sardf/evaluate.hpp"

namespace sardf::rendering {

inline constexpr double rounding_unit = 0x1p-24;
inline constexpr double rounding_of_places = 6;
/// By which depths and lengths are taken shorter, or ends farther, than computed; as a share.
inline constexpr double depth_slack = 0x1p-22;

/// The share of the expected step that is taken, and the least by which a guess must be farther.
inline constexpr double caution = 0.95, least_gain = 1.1;

/// What is the same for all rays of a picture.
struct RayFrame {
  std::array<float, 3> middle{}, half{};  // of the box
  double begin = 0;                       // depths in the table count from here
  float range = 0;                        // the depth of the box's end
  float error = 0;                        // of the field's values
  float misplaced = 0;                    // the most that places are off, in scene units
  float per_slope = 0;                    // one by the bound of the slope, not more
  float tolerance = 0;                    // scene units, along rays
};

/// A square of pixels whose rays begin together.
struct RaySquare {
  static constexpr int edge = 8, rays = edge * edge;
  // The middle ray, and what a pixel to the right or down adds to it.
  std::array<float, 3> from, from_right, from_down, along, along_right, along_down;
  float clear, per_length;
  int left, top, right, bottom;  // pixels of the picture, those behind the last ones at the end
};

/// Rays of a tile, by numbers. Whole blocks are worked on: what is behind `count` has no meaning.
struct alignas(cache_line) RayTable {
  // Rows that begin a multiple of 4 KiB apart, or nearly so, would wait for each other: processors
  // tell what was just written by the lowest bits of its place.
  static constexpr size_t capacity = 32 * 32, room = capacity + 48;
  using Row = std::array<float, room>;
  enum State : int { going, missed, met, unsure };

  size_t count = 0;
  Row x, y;  // of the pixel, in the picture
  std::array<Row, 3> from, along;
  Row per_length;            // at most the depth that a unit of length along the ray makes
  Row end;                   // the ray leaves the box before
  Row clear;                 // nothing of the solid lies before this depth
  Row trial;                 // where the next sample is taken
  Row before, before_value;  // the last sample that lies outside; the value 0: none
  Row beyond, beyond_value;  // the sample that lies inside, or may do so
  Row state;                 // a State

  State state_of(size_t i) const { return State(int(state[i])); }
  /// use(a, b) for each row of two tables.
  template <class Use>
  static void for_rows(const RayTable& one, RayTable& other, Use use) {
    for (size_t axis = 0; axis < 3; ++axis) {
      use(one.from[axis], other.from[axis]);
      use(one.along[axis], other.along[axis]);
    }
    for (const auto row :
         {&RayTable::x, &RayTable::y, &RayTable::per_length, &RayTable::end, &RayTable::clear,
          &RayTable::trial, &RayTable::before, &RayTable::before_value, &RayTable::beyond,
          &RayTable::beyond_value, &RayTable::state}) {
      use(one.*row, other.*row);
    }
  }
};

/// Points of a block and what is there.
struct alignas(cache_line) RayBlock {
  static constexpr size_t capacity = Evaluator::block_size;
  float xyz[3][capacity], value[capacity];
  float channels[3][capacity];
};

/// The work on rays [first, first + n), compiled for each instruction set (render_kernels.hpp).
struct RayKernels {
  /// Writes the rays of a square at the table's end; those that have nothing to look for are
  /// missed.
  void (*begin)(const RayFrame&, const RaySquare&, RayTable&);
  /// The places of the trials.
  void (*place)(const RayFrame&, const RayTable&, size_t first, size_t n, RayBlock&);
  /// Uses the values there. `reach`: how far along each ray its sample proves it clear, or null
  /// where the frame's slope tells. The number of rays that are still going.
  size_t (*use)(const RayFrame&, RayTable&, size_t first, size_t n, const float* value,
                const float* reach);
  /// Copies the rays that are in a state to the end of another table, or within their own to its
  /// beginning and drops all the others; in their order.
  void (*copy)(const RayTable& from, RayTable::State which, RayTable& to);
  /// `trial` becomes where the surface is expected between `before` and `beyond`; the places
  /// `aside` before it, and from `behind` on (a multiple of 16, not less than n) those behind it.
  void (*place_aside)(const RayFrame&, RayTable&, size_t first, size_t n, float aside,
                      size_t behind, RayBlock&);
  /// Of places and values so made: where the surface is proven to lie between the two and their
  /// colours agree to within `equal`, the mean limited to [0, 1] becomes the colour of the former;
  /// where not, the trial becomes NaN.
  void (*mix)(const RayFrame&, RayTable&, size_t first, size_t n, float equal, size_t behind,
              RayBlock&);
};

/// The kernels that this machine runs.
const RayKernels& ray_kernels();
const RayKernels& avx2_ray_kernels();
const RayKernels& avx512_ray_kernels();

}  // namespace sardf::rendering

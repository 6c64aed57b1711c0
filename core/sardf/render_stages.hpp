// The stages in which a tile's rays find the solid; private to core/sardf/render*.cpp.
//
// A solid is where its field is >= 0. The field changes by at most L along a unit of length, L from
// certified bounds (render_slopes.hpp), so that a ball of the radius d / L around a point with the
// value -d holds nothing of it. Beams of rays, then single rays, go from ball to ball; all that is
// called clear of the solid is proven so.
#pragma once

#include <span>
#include <vector>

#include "sardf/render_rays.hpp"
#include "sardf/render_slopes.hpp"
#include "sardf/render_watch.hpp"

namespace sardf::rendering {

/// What is looked at, and from where.
struct Subject {
  const Evaluator& solid;
  BoundingBox bounds;  // the solid has no point outside
  Rays rays;
  LocalSlopes slopes;
  double tolerance;     // scene units, along rays
  double error_single;  // of the field's values
  double error_double;
  bool single = true;  // whether single precision is good enough to begin with
};

/// Coordinates and values of up to `capacity` points as arrays.
template <class T>
struct Block {
  static constexpr size_t capacity = Evaluator::block_size;
  T xyz[3][capacity], value[capacity];

  void set(size_t i, const Vec3& p) {
    for (int axis = 0; axis < 3; ++axis) xyz[axis][i] = T(p[axis]);
  }
  void evaluate(const Evaluator& solid, size_t n) {
    T* out = value;
    solid.block(xyz[0], xyz[1], xyz[2], n, &out);
  }
};

struct Ray {
  enum class State : uint8_t {
    on_its_way,
    unsure,  // single precision does not tell whether `beyond` lies in the solid
    met,     // `beyond` lies in the solid
    missed,
  };
  int x, y;  // of its pixel, in the picture
  Line line;
  double per_length;  // at most the depth that a unit of length along the ray makes
  double end;         // the ray leaves the bounds there
  double clear;       // nothing of the solid lies before this depth
  double tolerance;   // as depth
  double trial;       // where the next sample is taken
  // The last place known to lie outside and its value (NaN: none); the place where the solid is
  // met, at last on its surface.
  double before, before_value, beyond, beyond_value;
  State state = State::on_its_way;
};

/// A square of pixels.
struct Tile {
  int x, y, edge;
};

/// Replaces `rays` by those of the tile's pixels that beams of rays do not prove to show nothing,
/// as far as beams are proven clear. The picture's edge cuts the tile.
void begin_rays(const Subject& subject, const Tile& tile, int width, int height,
                std::vector<Ray>& rays, Watch& watch);

/// Moves on those rays that are on their way, at most `most_steps` steps each, until each is
/// unsure, has met the solid or missed it. In double no ray becomes unsure, and the unsure go on.
template <class T>
void march(const Subject& subject, std::span<Ray> rays, int most_steps, Watch& watch);

/// Brings all rays that are on their way to an end: by intervals of the field, which prove
/// stretches clear where steps are short, or where no bound of the slope is known.
void march_by_intervals(const Subject& subject, std::span<Ray> rays, Watch& watch);

/// Moves `beyond` of rays that have met the solid onto its surface, in double.
void find_roots(const Subject& subject, std::span<Ray* const> rays, Watch& watch);

/// For pictures without depth, in single precision: of rays that have met the solid, `trial`
/// becomes a depth with the surface proven to lie less than `aside` along the ray before or behind
/// it; NaN where that is not so at the first try. The bracket of `before` and `beyond` stays.
void find_rough_roots(const Subject& subject, std::span<Ray* const> rays, double aside,
                      Watch& watch);

}  // namespace sardf::rendering

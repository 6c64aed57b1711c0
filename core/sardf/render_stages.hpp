// The stages in which a tile's rays find the solid; private to core/sardf/render*.cpp.
//
// A solid is where its field is >= 0. The field changes by at most L along a unit of length, L from
// certified bounds (render_slopes.hpp), so that a ball of the radius d / L around a point with the
// value -d holds nothing of it. Beams of rays, then single rays, go from ball to ball; all that is
// called clear of the solid is proven so. Single precision does most of it, for many rays at once
// (render_table.hpp); what it leaves open, rays one by one go on with in double.
#pragma once

#include <span>
#include <vector>

#include "sardf/local_evaluator.hpp"
#include "sardf/render_rays.hpp"
#include "sardf/render_slopes.hpp"
#include "sardf/render_table.hpp"
#include "sardf/render_watch.hpp"

namespace sardf::rendering {

/// What is looked at, and from where.
struct Subject {
  const LocalEvaluator& solid;
  BoundingBox bounds;  // the solid has no point outside
  Rays rays;
  LocalSlopes slopes;
  double tolerance;     // scene units, along rays
  double error_single;  // of the field's values
  double error_double = 0;
  bool single = true;  // whether single precision is good enough to begin with
  RayFrame frame{};    // if `single`
};

/// Coordinates and values of up to `capacity` points as arrays.
template <class T>
struct alignas(cache_line) Block {
  static constexpr size_t capacity = Evaluator::block_size;
  T xyz[3][capacity], value[capacity];

  void set(size_t i, const Vec3& p) {
    for (int axis = 0; axis < 3; ++axis) xyz[axis][i] = T(p[axis]);
  }
  void evaluate(const LocalEvaluator& solid, size_t n) {
    T* out = value;
    solid.block(xyz[0], xyz[1], xyz[2], n, &out);
  }
};

struct Ray {
  enum class State : uint8_t {
    on_its_way,
    met,  // `beyond` lies in the solid
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

/// The rays of a square of pixels, as far as they go on together.
struct Beam {
  double x, y, edge;  // the middle and the side, in pixels
  double clear;       // nothing of the solid lies before this depth
  Line line{};
  Spread spread{};
  bool done = false;
};
inline constexpr int smallest_edge = RaySquare::edge;
/// The beams of a tile that are not proven to show nothing; smallest_edge pixels wide.
std::vector<Beam> find_beams(const Subject& subject, const Tile& tile, Watch& watch);

/// What a frame has to say of places and depths; the rest of it is left.
RayFrame frame_of_places(const Rays& rays, const BoundingBox& bounds, int width, int height);

/// Appends the rays of a beam's pixels. The picture's edge cuts beams.
void begin_rays(const Subject& subject, const Beam& beam, int width, int height, RayTable& table);
/// Appends those of several beams as single rays.
void begin_rays(const Subject& subject, const std::vector<Beam>& beams, int width, int height,
                std::vector<Ray>& rays);
/// A ray of a table in double. Rays in single precision are not quite the true ones: where that may
/// matter, it is on its way from where it is proven clear, and what it meets is seen anew.
Ray ray_of(const Subject& subject, const RayTable& table, size_t i);

/// Rays of a tile: on their way, sure to have met the solid, and such that double has to go on
/// with.
struct RayTables {
  RayTable going, met, open;
};
/// Moves the rays of beams until they have met the solid or missed it; those that may have met it,
/// or need very many steps, are open.
void march(const Subject& subject, const std::vector<Beam>& beams, int width, int height,
           RayTables& rays, Watch& watch);
/// The like for rays that are on their way, in double.
void march(const Subject& subject, std::span<Ray> rays, int most_steps, Watch& watch);

/// Brings all rays that are on their way to an end: by intervals of the field, which prove
/// stretches clear where steps are short, or where no bound of the slope is known.
void march_by_intervals(const Subject& subject, std::span<Ray> rays, Watch& watch);

/// Moves `beyond` of rays that have met the solid onto its surface, in double.
void find_roots(const Subject& subject, std::span<Ray> rays, Watch& watch);

}  // namespace sardf::rendering

// Beams: squares of pixels whose rays go from ball to ball together, in ever smaller squares.
#include <algorithm>
#include <cmath>

#include "sardf/render_stages.hpp"

namespace sardf::rendering {

namespace {

// A beam's steps end when they are shorter than this share of its radius; smaller beams go on.
constexpr double shortest_step = 0.7;
constexpr int most_steps = 64;
// By depth: less would be lost in its roundings.
constexpr double least_tolerance = 1e-14;
constexpr int split = 4;  // along each side
constexpr int smallest_edge = 8;

struct Beam {
  double x, y, edge;  // the middle and the side, in pixels
  double clear;       // nothing of the solid lies before this depth
  Line line{};
  Spread spread{};
  bool done = false;
};

Vec3 clamped(const BoundingBox& box, const Vec3& p) {
  Vec3 out;
  for (int axis = 0; axis < 3; ++axis) out[axis] = std::clamp(p[axis], box.lo[axis], box.hi[axis]);
  return out;
}

// How much deeper a ball around the middle of the beam at this depth reaches on all of its rays.
// With s the step, a the middle ray's direction and w(t) a corner's offset, the slab's corners lie
// at s a + w(t + s) from the ball's centre; that is quadratic in s, and the slab is their hull.
double step_in_ball(const Beam& beam, double depth, double radius) {
  const Spread& w = beam.spread;
  const double wide = w.at(depth);
  if (!(radius > wide)) return 0;
  const double square = dot(beam.line.along, beam.line.along) + w.growth * w.growth + 2 * w.lean;
  const double half = depth * (w.growth * w.growth + w.lean);
  const double rest = (radius - wide) * (radius + wide);
  return rest / (half + std::sqrt(half * half + square * rest));
}

// Moves the beams on until the solid is too near for their width or they have left the box.
template <class T>
void advance(const Subject& subject, std::vector<Beam>& beams, double end, Watch& watch) {
  const double error = std::is_same_v<T, float> ? subject.error_single : subject.error_double;
  std::vector<Beam*> active;
  for (Beam& beam : beams) {
    beam.line = subject.rays.through(beam.x, beam.y);
    beam.spread = subject.rays.spread(beam.x, beam.y, beam.edge);
    active.push_back(&beam);
  }
  thread_local Block<T> block;
  for (int steps = 0; steps < most_steps && !active.empty(); ++steps) {
    watch.check();
    for (size_t first = 0; first < active.size(); first += Block<T>::capacity) {
      const size_t n = std::min(Block<T>::capacity, active.size() - first);
      Vec3 inside[Block<T>::capacity];
      for (size_t i = 0; i < n; ++i) {
        const Beam& beam = *active[first + i];
        inside[i] = clamped(subject.bounds, beam.line.at(beam.clear));
        block.set(i, inside[i]);
      }
      block.evaluate(subject.solid, n);
      for (size_t i = 0; i < n; ++i) {
        Beam& beam = *active[first + i];
        // Of the box, which is convex, all that lies within `radius` of its point nearest to the
        // beam's is clear; so is what lies as far from the beam's as that makes with the way there.
        const double radius =
            subject.slopes.clear_radius(inside[i], -double(block.value[i]) - error);
        const Vec3 way = beam.line.at(beam.clear) - inside[i];
        const double step =
            step_in_ball(beam, beam.clear, std::sqrt(radius * radius + dot(way, way)));
        const double wide = beam.spread.at(beam.clear);
        beam.done = !(step > shortest_step * wide);
        if (step > 0) beam.clear += step * (1 - 1e-9);
        beam.done = beam.done || beam.clear >= end;
      }
    }
    std::erase_if(active, [](const Beam* beam) { return beam->done; });
  }
}

std::vector<Beam> split_beams(const std::vector<Beam>& beams, double end) {
  std::vector<Beam> parts;
  for (const Beam& beam : beams) {
    if (beam.clear >= end) continue;
    const double edge = beam.edge / split;
    for (int k = 0; k < split * split; ++k) {
      parts.push_back({beam.x + (k % split - 0.5 * (split - 1)) * edge,
                       beam.y + (k / split - 0.5 * (split - 1)) * edge, edge, beam.clear});
    }
  }
  return parts;
}

// The stretches of a row's rays in the box as arrays, which the compiler makes SIMD of: what
// stretch_in says, but that a ray which only touches the box may have none.
struct Row {
  static constexpr int capacity = smallest_edge;
  double from[3][capacity], along[3][capacity], begin[capacity], end[capacity];

  void set(int i, const Line& line) {
    for (int axis = 0; axis < 3; ++axis) {
      from[axis][i] = line.from[axis];
      along[axis][i] = line.along[axis];
    }
  }
  void stretch(const BoundingBox& box) {
    std::fill_n(begin, capacity, 0.0);
    std::fill_n(end, capacity, infinity);
    for (int axis = 0; axis < 3; ++axis) {
      const double lo = box.lo[axis], hi = box.hi[axis];
      for (int i = 0; i < capacity; ++i) {
        // A line that moves less than this has left no box along the axis where all numbers end.
        const double a = std::abs(along[axis][i]) > 1e-280 ? along[axis][i] : 1e-280;
        const double inverse = 1 / a;
        const double first = (lo - from[axis][i]) * inverse, last = (hi - from[axis][i]) * inverse;
        begin[i] = std::max(begin[i], std::min(first, last));
        end[i] = std::min(end[i], std::max(first, last));
      }
    }
  }
};

// Finishes a ray that has pixel, line, per_length and end; false where it is clear to its end.
bool begin_ray(const Subject& subject, double clear, Ray& ray) {
  ray.clear = clear;
  if (!(ray.clear <= ray.end)) return false;
  ray.clear = subject.slopes.clear_until(ray.line, ray.clear, std::nan(""));
  ray.tolerance = std::max(subject.tolerance * ray.per_length, least_tolerance * ray.end);
  ray.trial = std::min(ray.clear + ray.tolerance, ray.end);
  ray.before = ray.before_value = std::nan("");
  ray.beyond = ray.beyond_value = infinity;
  return ray.clear <= ray.end;
}

// Appends the rays of the beam's pixels.
void append_rays(const Subject& subject, const Beam& beam, int width, int height,
                 std::vector<Ray>& rays) {
  const int left = int(beam.x - 0.5 * beam.edge), top = int(beam.y - 0.5 * beam.edge);
  const int right = std::min(width, left + int(beam.edge));
  const int bottom = std::min(height, top + int(beam.edge));
  // A bound for all of them does: over a few pixels it hardly changes.
  const double per_length = subject.rays.shortest_step(beam.x, beam.y, beam.edge);
  Row row{};
  for (int y = top; y < bottom; ++y) {
    for (int x = left; x < right; ++x) row.set(x - left, subject.rays.through(x + 0.5, y + 0.5));
    row.stretch(subject.bounds);
    for (int i = 0; i < right - left; ++i) {
      if (row.begin[i] > row.end[i]) continue;
      Ray& ray = rays.emplace_back();
      ray.x = left + i;
      ray.y = y;
      for (int axis = 0; axis < 3; ++axis) {
        ray.line.from[axis] = row.from[axis][i];
        ray.line.along[axis] = row.along[axis][i];
      }
      ray.per_length = per_length;
      ray.end = row.end[i];
      if (!begin_ray(subject, std::max(beam.clear, row.begin[i]), ray)) rays.pop_back();
    }
  }
}

}  // namespace

void begin_rays(const Subject& subject, const Tile& tile, int width, int height,
                std::vector<Ray>& rays, Watch& watch) {
  const Stretch depths = subject.rays.depths(subject.bounds);
  const double middle = 0.5 * tile.edge;
  std::vector<Beam> beams{{tile.x + middle, tile.y + middle, double(tile.edge), depths.begin}};
  while (true) {
    if (subject.single) {
      advance<float>(subject, beams, depths.end, watch);
    } else {
      advance<double>(subject, beams, depths.end, watch);
    }
    if (beams.empty() || beams[0].edge <= smallest_edge) break;
    beams = split_beams(beams, depths.end);
  }
  rays.clear();
  for (const Beam& beam : beams) {
    if (beam.clear >= depths.end) continue;
    append_rays(subject, beam, width, height, rays);
  }
}

}  // namespace sardf::rendering

// Beams: squares of pixels whose rays go from ball to ball together, in ever smaller squares.
#include <algorithm>
#include <cmath>
#include <optional>

#include "sardf/render_stages.hpp"

namespace sardf::rendering {

namespace {

// A beam's steps end when they are shorter than this share of its radius; smaller beams go on.
constexpr double shortest_step = 0.7;
constexpr int most_steps = 64;
// By depth: less would be lost in its roundings.
constexpr double least_tolerance = 1e-14;
constexpr int split = 4;  // along each side

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
  const double square = w.longest_square(beam.line.along);
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

double tolerance_of(const Subject& subject, const Ray& ray) {
  return std::max(subject.tolerance * ray.per_length, least_tolerance * ray.end);
}

// A ray that may have something to look for; none where it is clear to its end.
std::optional<Ray> ray_at(const Subject& subject, const Beam& beam, int x, int y) {
  Ray ray;
  ray.x = x;
  ray.y = y;
  ray.line = subject.rays.through(x + 0.5, y + 0.5);
  // A bound for all of the beam's does: over a few pixels it hardly changes.
  ray.per_length = subject.rays.shortest_step(beam.x, beam.y, beam.edge);
  const Stretch stretch = stretch_in(ray.line, subject.bounds);
  ray.end = stretch.end;
  const double clear = std::max(beam.clear, stretch.begin);
  if (!(clear <= ray.end)) return std::nullopt;
  ray.clear = subject.slopes.clear_until(ray.line, clear, std::nan(""));
  ray.tolerance = tolerance_of(subject, ray);
  ray.trial = std::min(ray.clear + ray.tolerance, ray.end);
  ray.before = ray.before_value = std::nan("");
  ray.beyond = ray.beyond_value = infinity;
  return ray.clear <= ray.end ? std::optional(ray) : std::nullopt;
}

// The most that places in single precision are off the rays' true ones.
double misplacement(const Rays& rays, const BoundingBox& bounds, const Stretch& depths, int width,
                    int height) {
  double steepest = 0;
  for (const double x : {0, width}) {
    for (const double y : {0, height})
      steepest = std::max(steepest, norm(rays.through(x, y).along));
  }
  // Rays that meet the box begin no farther from it than they go on.
  const double way = 0.5 * bounds.diagonal() + 2 * (depths.end - depths.begin) * steepest;
  // Right and down are perpendicular; together they are at most sqrt(2) times the corner's.
  const Spread square = rays.spread(0.5 * width, 0.5 * height, RaySquare::edge);
  const double pixels = 1.5 * square.at(depths.end);
  return rounding_of_places * rounding_unit * (way + pixels);
}

std::array<float, 3> floats(const Vec3& a) { return {float(a[0]), float(a[1]), float(a[2])}; }

RaySquare square_of(const Subject& subject, const Beam& beam, int width, int height) {
  // Neighbouring rays differ by the same everywhere.
  const Rays& rays = subject.rays;
  const Line middle = rays.through(beam.x, beam.y), right = rays.through(beam.x + 1, beam.y),
             down = rays.through(beam.x, beam.y + 1);
  const double begin = subject.frame.begin;
  const Vec3 from = middle.at(begin);
  RaySquare square;
  square.from = floats(from - subject.bounds.center());
  square.from_right = floats(right.at(begin) - from);
  square.from_down = floats(down.at(begin) - from);
  square.along = floats(middle.along);
  square.along_right = floats(right.along - middle.along);
  square.along_down = floats(down.along - middle.along);
  const double slack = double(subject.frame.range) * depth_slack;
  square.clear = float(std::max(0.0, beam.clear - begin - slack));
  square.per_length =
      float(rays.shortest_step(beam.x, beam.y, beam.edge) * (1 - 2 * rounding_unit));
  square.left = int(beam.x - 0.5 * beam.edge);
  square.top = int(beam.y - 0.5 * beam.edge);
  square.right = std::min(width, square.left + RaySquare::edge);
  square.bottom = std::min(height, square.top + RaySquare::edge);
  return square;
}

}  // namespace

std::vector<Beam> find_beams(const Subject& subject, const Tile& tile, Watch& watch) {
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
  std::erase_if(beams, [&](const Beam& beam) { return beam.clear >= depths.end; });
  return beams;
}

RayFrame frame_of_places(const Rays& rays, const BoundingBox& bounds, int width, int height) {
  RayFrame frame;
  for (size_t axis = 0; axis < 3; ++axis) {
    frame.middle[axis] = float(bounds.center()[axis]);
    frame.half[axis] = float(0.5 * bounds.size()[axis]);
  }
  const Stretch depths = rays.depths(bounds);
  frame.begin = depths.begin;
  frame.range = float((depths.end - depths.begin) * (1 + depth_slack));
  frame.misplaced = float(misplacement(rays, bounds, depths, width, height) * (1 + depth_slack));
  return frame;
}

void begin_rays(const Subject& subject, const Beam& beam, int width, int height, RayTable& table) {
  ray_kernels().begin(subject.frame, square_of(subject, beam, width, height), table);
}

void begin_rays(const Subject& subject, const std::vector<Beam>& beams, int width, int height,
                std::vector<Ray>& rays) {
  for (const Beam& beam : beams) {
    const int left = int(beam.x - 0.5 * beam.edge), top = int(beam.y - 0.5 * beam.edge);
    const int right = std::min(width, left + smallest_edge);
    const int bottom = std::min(height, top + smallest_edge);
    for (int y = top; y < bottom; ++y) {
      for (int x = left; x < right; ++x) {
        if (const auto ray = ray_at(subject, beam, x, y)) rays.push_back(*ray);
      }
    }
  }
}

Ray ray_of(const Subject& subject, const RayTable& table, size_t i) {
  Ray ray;
  ray.x = int(table.x[i]);
  ray.y = int(table.y[i]);
  ray.line = subject.rays.through(ray.x + 0.5, ray.y + 0.5);
  ray.per_length = double(table.per_length[i]);
  const auto depth = [&](float t) { return subject.frame.begin + double(t); };
  // What a place that is off by so much can change of a value.
  const double moved = subject.slopes.largest() * double(subject.frame.misplaced);
  const bool is_before = double(table.before_value[i]) < -moved;
  ray.before = is_before ? depth(table.before[i]) : std::nan("");
  ray.before_value = is_before ? double(table.before_value[i]) : std::nan("");
  ray.clear = depth(table.clear[i]);
  ray.beyond = table.state_of(i) == RayTable::going ? infinity : depth(table.beyond[i]);
  ray.beyond_value = double(table.beyond_value[i]);
  if (table.state_of(i) == RayTable::met && is_before && ray.beyond_value > moved) {
    ray.state = Ray::State::met;
    return ray;
  }
  ray.end = stretch_in(ray.line, subject.bounds).end;
  ray.tolerance = tolerance_of(subject, ray);
  ray.trial = std::min({ray.clear + ray.tolerance, ray.beyond, ray.end});
  return ray;
}

}  // namespace sardf::rendering

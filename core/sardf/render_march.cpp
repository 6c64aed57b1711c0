// Single rays from ball to ball.
//
// All before `clear` is proven to hold nothing of the solid. A sample's ball counts when it reaches
// back to `clear` + `tolerance` at least: a stretch of the solid longer than the tolerance cannot
// lie in what is left between. So none is missed: either all of what was stepped over is clear, or
// a sample falls into the stretch. A sample at `clear` + `tolerance` always counts; one farther
// ahead, where the ball is expected to reach just so far back, is a guess, and where it fails the
// ray is sampled there instead. Steps that count are never shorter than the tolerance, so that
// every ray comes to an end.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "sardf/render_stages.hpp"

namespace sardf::rendering {

namespace {

using State = Ray::State;

double surest_trial(const Ray& ray) { return std::min(ray.clear + ray.tolerance, ray.end); }

// With the depths d and e of the field at two places, and its slope -k between them as a share of
// the bound, balls around both touch when they are (d + e) / L apart, and e = d - k L times that.
double next_trial(const Ray& ray, double reach, double former, double former_value) {
  const double surest = surest_trial(ray);
  if (!(former_value < 0) || !(reach > 0)) return surest;
  const double depth = -ray.before_value;
  const double share = (-former_value - depth) * reach / ((ray.before - former) * depth);
  const double step = caution * 2 * reach / (1 + std::clamp(share, -0.5, 1.0));
  const double guess = ray.before + step;
  return guess > ray.before + least_gain * reach + ray.tolerance && guess < ray.end ? guess
                                                                                    : surest;
}

// `point` is where the sample was taken. NaN lies outside and proves nothing.
void use_sample(const Subject& subject, Ray& ray, const Vec3& point, double value) {
  const double error = subject.error_double, surest = surest_trial(ray);
  const bool is_guess = ray.trial > surest;
  if (value >= 0) {
    if (is_guess) {
      ray.trial = surest;
      return;
    }
    ray.beyond = ray.trial;
    ray.beyond_value = value;
    ray.state = State::met;
    return;
  }
  const double reach = subject.slopes.clear_radius(point, -value - error) * ray.per_length;
  if (is_guess && !(ray.trial - reach <= surest)) {
    ray.trial = surest;
    return;
  }
  const double former = ray.before, former_value = ray.before_value;
  ray.before = ray.trial;
  ray.before_value = value;
  ray.clear = std::max(ray.before + reach,
                       subject.slopes.clear_until(ray.line, ray.before, -value - error));
  ray.trial = next_trial(ray, reach, former, former_value);
  if (!(ray.clear < ray.end)) ray.state = State::missed;
}

// The depths that a table's samples prove clear, where the slope changes from place to place.
void find_reaches(const Subject& subject, const RayTable& table, size_t first, size_t n,
                  const RayBlock& block, float* reach) {
  for (size_t k = 0; k < n; ++k) {
    reach[k] = 0;
    const double depth = -double(block.value[k]) - double(subject.frame.error);
    if (table.state_of(first + k) != RayTable::going || !(depth > 0)) continue;
    const Vec3 at{block.xyz[0][k], block.xyz[1][k], block.xyz[2][k]};
    const double radius = subject.slopes.clear_radius(at, depth) - double(subject.frame.misplaced);
    reach[k] = float(radius * double(table.per_length[first + k]) * (1 - depth_slack));
  }
}

// One step of all rays; the number of those that are going on.
size_t step(const Subject& subject, RayTable& table, Watch& watch) {
  const RayKernels& kernels = ray_kernels();
  thread_local RayBlock block;
  thread_local float reaches[RayBlock::capacity];
  float* const reach = subject.slopes.is_uniform() ? nullptr : reaches;
  size_t going = 0;
  for (size_t first = 0; first < table.count; first += RayBlock::capacity) {
    watch.check();
    const size_t n = std::min(RayBlock::capacity, table.count - first);
    kernels.place(subject.frame, table, first, n, block);
    float* out = block.value;
    subject.solid.block(block.xyz[0], block.xyz[1], block.xyz[2], n, &out);
    if (reach) find_reaches(subject, table, first, n, block, reach);
    going += kernels.use(subject.frame, table, first, n, block.value, reach);
  }
  return going;
}

// Of whole lanes, rays behind the last one count as ended.
void end_room(RayTable& table) {
  constexpr size_t most_lanes = 16;
  std::fill_n(&table.state[table.count], most_lanes, float(RayTable::missed));
}

}  // namespace

void march(const Subject& subject, const std::vector<Beam>& beams, int width, int height,
           RayTables& rays, Watch& watch) {
  // What is known of so many rays lies in a processor's nearest cache, and makes a whole block.
  constexpr size_t most_going = RayBlock::capacity;
  // Ended rays cost as much as others until they are taken out, which costs more than a step.
  constexpr double crowded = 0.75;
  // Without new rays. Those that need more are few.
  constexpr int most_steps = 512;
  const RayKernels& kernels = ray_kernels();
  auto [going, met, open] = std::tie(rays.going, rays.met, rays.open);
  going.count = met.count = open.count = 0;
  auto next = beams.begin();
  for (int steps = 0; going.count > 0 || next != beams.end(); ++steps) {
    for (; next != beams.end() && going.count + RaySquare::rays <= most_going; ++next) {
      begin_rays(subject, *next, width, height, going);
      steps = 0;
    }
    end_room(going);
    const size_t left = step(subject, going, watch);
    const bool is_last = steps == most_steps;
    if (!is_last && double(left) > crowded * double(going.count)) continue;
    kernels.copy(going, RayTable::met, met);
    kernels.copy(going, RayTable::unsure, open);
    kernels.copy(going, RayTable::going, is_last ? open : going);
    if (is_last) going.count = 0;
  }
}

void march(const Subject& subject, std::span<Ray> rays, int most_steps, Watch& watch) {
  thread_local std::vector<Ray*> active;
  active.clear();
  for (Ray& ray : rays) {
    if (ray.state == State::on_its_way) active.push_back(&ray);
  }
  thread_local Block<double> block;
  for (int steps = 0; steps < most_steps && !active.empty(); ++steps) {
    for (size_t first = 0; first < active.size(); first += block.capacity) {
      watch.check();
      const size_t n = std::min(block.capacity, active.size() - first);
      Vec3 points[Block<double>::capacity];
      for (size_t i = 0; i < n; ++i) {
        const Ray& ray = *active[first + i];
        points[i] = ray.line.at(ray.trial);
        block.set(i, points[i]);
      }
      block.evaluate(subject.solid, n);
      for (size_t i = 0; i < n; ++i) {
        use_sample(subject, *active[first + i], points[i], block.value[i]);
      }
    }
    std::erase_if(active, [](const Ray* ray) { return ray->state != State::on_its_way; });
  }
}

}  // namespace sardf::rendering

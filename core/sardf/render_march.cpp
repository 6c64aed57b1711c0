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

#include "sardf/render_stages.hpp"

namespace sardf::rendering {

namespace {

using State = Ray::State;

double surest_trial(const Ray& ray) { return std::min(ray.clear + ray.tolerance, ray.end); }

// The share of the expected step that is taken, and the least by which a guess must be farther.
constexpr double caution = 0.95, least_gain = 1.1;

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
void use_sample(const Subject& subject, Ray& ray, const Vec3& point, double value, double error,
                bool decides) {
  const double surest = surest_trial(ray);
  const bool is_guess = ray.trial > surest;
  if (!(value < (decides ? 0 : -error)) && !(decides && std::isnan(value))) {
    if (is_guess) {
      ray.trial = surest;
      return;
    }
    ray.beyond = ray.trial;
    ray.beyond_value = value;
    ray.state = decides || value > error ? State::met : State::unsure;
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

}  // namespace

template <class T>
void march(const Subject& subject, std::span<Ray> rays, int most_steps, Watch& watch) {
  constexpr bool decides = std::is_same_v<T, double>;
  const double error = decides ? subject.error_double : subject.error_single;
  thread_local std::vector<Ray*> active;
  active.clear();
  for (Ray& ray : rays) {
    if (decides && ray.state == State::unsure) ray.state = State::on_its_way;
    if (ray.state == State::on_its_way) active.push_back(&ray);
  }
  thread_local Block<T> block;
  for (int steps = 0; steps < most_steps && !active.empty(); ++steps) {
    for (size_t first = 0; first < active.size(); first += Block<T>::capacity) {
      watch.check();
      const size_t n = std::min(Block<T>::capacity, active.size() - first);
      Vec3 points[Block<T>::capacity];
      for (size_t i = 0; i < n; ++i) {
        const Ray& ray = *active[first + i];
        points[i] = ray.line.at(ray.trial);
        block.set(i, points[i]);
      }
      block.evaluate(subject.solid, n);
      for (size_t i = 0; i < n; ++i) {
        use_sample(subject, *active[first + i], points[i], double(block.value[i]), error, decides);
      }
    }
    std::erase_if(active, [](const Ray* ray) { return ray->state != State::on_its_way; });
  }
}

template void march<float>(const Subject&, std::span<Ray>, int, Watch&);
template void march<double>(const Subject&, std::span<Ray>, int, Watch&);

}  // namespace sardf::rendering

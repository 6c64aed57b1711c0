// Single rays from ball to ball.
//
// A sample is taken at `clear` + `tolerance`, where all before `clear` is proven to hold nothing of
// the solid. A stretch of the solid longer than the tolerance cannot lie between the two, so that
// none is missed: either all of what was stepped over is clear, or a sample falls into the stretch.
// Steps are never shorter than the tolerance, so that every ray comes to an end.
#include <algorithm>
#include <cmath>

#include "sardf/render_stages.hpp"

namespace sardf::rendering {

namespace {

using State = Ray::State;

double sample_depth(const Ray& ray) { return std::min(ray.clear + ray.tolerance, ray.end); }

// `point` is where the sample was taken. NaN lies outside and proves nothing.
void use_sample(const Subject& subject, Ray& ray, const Vec3& point, double value, double error,
                bool decides) {
  const double depth = sample_depth(ray);
  if (decides ? value >= 0 : value > error) {
    ray.beyond = depth;
    ray.beyond_value = value;
    ray.state = State::met;
    return;
  }
  if (!decides && !(value < -error)) {
    ray.state = State::unsure;
    return;
  }
  ray.before = depth;
  ray.before_value = value;
  const double radius = subject.slopes.clear_radius(point, -value - error);
  ray.clear = std::max(depth + radius * ray.per_length,
                       subject.slopes.clear_until(ray.line, depth, -value - error));
  if (!(ray.clear < ray.end)) ray.state = State::missed;
}

}  // namespace

template <class T>
void march(const Subject& subject, std::span<Ray> rays, int most_steps, Watch& watch) {
  constexpr bool decides = std::is_same_v<T, double>;
  const double error = decides ? subject.error_double : subject.error_single;
  std::vector<Ray*> active;
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
        points[i] = ray.line.at(sample_depth(ray));
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

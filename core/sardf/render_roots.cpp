// Where exactly rays meet the surface: regula falsi in double, with bisection where it is slow.
#include <algorithm>
#include <cmath>

#include "sardf/render_stages.hpp"

namespace sardf::rendering {

namespace {

// The surface is found to this share of the bounds' diagonal, and a jump of the field's value too.
constexpr double accuracy = 1e-9;
// One step of the secant from here is exact to far less than `accuracy`, being quadratic.
constexpr double last_step = 1e-6;
constexpr int fast_steps = 8, most_steps = 60;

// A ray's surface lies between `outside` and `inside`.
struct Bracket {
  Ray* ray;
  double outside, outside_value, inside, inside_value, trial = 0;
  bool done = false;
};

Bracket bracket_of(Ray& ray) {
  // What is known to be clear is known to lie outside; its value is not known.
  const bool sampled = ray.before_value < 0;
  return {&ray, sampled ? ray.before : ray.clear, sampled ? ray.before_value : std::nan(""),
          ray.beyond, ray.beyond_value};
}

double secant_slope(const Bracket& b) {
  return (b.inside_value - b.outside_value) / (b.inside - b.outside);
}

double next_trial(const Bracket& b, int step) {
  const double middle = 0.5 * (b.outside + b.inside);
  const double secant = b.inside - b.inside_value / secant_slope(b);
  const bool usable = step < fast_steps && secant > b.outside && secant < b.inside;
  return usable ? secant : middle;
}

// Sets `beyond` when it is known.
void use_value(Bracket& b, double value, double diagonal) {
  const double slope = secant_slope(b);
  const double newton = b.trial - value / slope;
  if (std::abs(newton - b.trial) <= last_step * diagonal * b.ray->per_length &&
      newton >= b.outside && newton <= b.inside) {
    b.ray->beyond = newton;
    b.done = true;
    return;
  }
  if (value >= 0) {
    b.inside = b.trial;
    b.inside_value = value;
  } else {
    b.outside = b.trial;
    b.outside_value = value;
  }
  b.ray->beyond = b.inside;
  b.done = b.inside - b.outside <= accuracy * diagonal * b.ray->per_length;
}

}  // namespace

void find_roots(const Subject& subject, std::span<Ray> rays, Watch& watch) {
  std::vector<Bracket> brackets;
  for (Ray& ray : rays) {
    if (ray.state == Ray::State::met) brackets.push_back(bracket_of(ray));
  }
  const double diagonal = subject.bounds.diagonal();
  thread_local Block<double> block;
  for (int step = 0; step < most_steps && !brackets.empty(); ++step) {
    for (size_t first = 0; first < brackets.size(); first += block.capacity) {
      watch.check();
      const size_t n = std::min(block.capacity, brackets.size() - first);
      for (size_t i = 0; i < n; ++i) {
        Bracket& b = brackets[first + i];
        b.trial = next_trial(b, step);
        block.set(i, b.ray->line.at(b.trial));
      }
      block.evaluate(subject.solid, n);
      for (size_t i = 0; i < n; ++i) use_value(brackets[first + i], block.value[i], diagonal);
    }
    std::erase_if(brackets, [](const Bracket& b) { return b.done; });
  }
}

}  // namespace sardf::rendering

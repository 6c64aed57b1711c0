// Where exactly rays meet the surface: the secant method in double, kept within a bracket, with
// bisection where it is slow.
#include <algorithm>
#include <cmath>

#include "sardf/render_stages.hpp"

namespace sardf::rendering {

namespace {

// The surface is found to this share of the bounds' diagonal, and a jump of the field's value too.
constexpr double accuracy = 1e-9;
constexpr int fast_steps = 10, most_steps = 70;

struct Sample {
  double t, value;
};

// A ray's surface lies between `outside` and `inside`; `last` is the sample taken last, and at
// first the one nearer to the surface.
struct Bracket {
  Ray* ray;
  Sample outside, inside, last;
  double trial = 0;
  bool done = false;
};

Bracket bracket_of(Ray& ray) {
  // What is known to be clear is known to lie outside; its value is not known.
  const Sample inside{ray.beyond, ray.beyond_value};
  if (!(ray.before_value < 0)) return {&ray, {ray.clear, std::nan("")}, inside, inside};
  const Sample outside{ray.before, ray.before_value};
  return {&ray, outside, inside, -outside.value < inside.value ? outside : inside};
}

double secant(const Sample& a, const Sample& b) {
  return a.t - a.value * (b.t - a.t) / (b.value - a.value);
}

bool is_within(const Bracket& b, double t) { return t > b.outside.t && t < b.inside.t; }

void set_first_trial(Bracket& b) {
  b.trial = secant(b.outside, b.inside);
  if (!is_within(b, b.trial)) b.trial = 0.5 * (b.outside.t + b.inside.t);
}

// The slope between the last two samples counts, since near the surface they are nearer to it than
// the bracket's ends: that a ray comes in at a grazing angle is seen only there.
void use_value(Bracket& b, double value, double diagonal, int step) {
  const double enough = accuracy * diagonal * b.ray->per_length;
  const Sample sample{b.trial, value};
  const double next = secant(sample, b.last);
  (value >= 0 ? b.inside : b.outside) = sample;
  b.last = sample;
  if (std::abs(next - sample.t) <= enough && (is_within(b, next) || next == sample.t)) {
    b.ray->beyond = next;
    b.done = true;
    return;
  }
  b.ray->beyond = b.inside.t;
  b.done = b.inside.t - b.outside.t <= enough;
  b.trial = step < fast_steps && is_within(b, next) ? next : 0.5 * (b.outside.t + b.inside.t);
}

}  // namespace

void find_roots(const Subject& subject, std::span<Ray> rays, Watch& watch) {
  thread_local std::vector<Bracket> brackets;
  brackets.clear();
  for (Ray& ray : rays) brackets.push_back(bracket_of(ray));
  for (Bracket& b : brackets) set_first_trial(b);
  const double diagonal = subject.bounds.diagonal();
  thread_local Block<double> block;
  for (int step = 0; step < most_steps && !brackets.empty(); ++step) {
    for (size_t first = 0; first < brackets.size(); first += block.capacity) {
      watch.check();
      const size_t n = std::min(block.capacity, brackets.size() - first);
      for (size_t i = 0; i < n; ++i) {
        const Bracket& b = brackets[first + i];
        block.set(i, b.ray->line.at(b.trial));
      }
      block.evaluate(subject.solid, n);
      for (size_t i = 0; i < n; ++i) use_value(brackets[first + i], block.value[i], diagonal, step);
    }
    std::erase_if(brackets, [](const Bracket& b) { return b.done; });
  }
}

}  // namespace sardf::rendering

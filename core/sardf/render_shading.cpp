#include "sardf/render_shading.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sardf/render_rounding.hpp"

namespace sardf::rendering {

namespace {

// Directions to the lights by the picture's right, its top and the camera.
constexpr Vec3 key_place{-0.6, 0.9, 0.8}, first_fill{1, 0.1, 0.6}, second_fill{0.2, -0.7, -0.5};
constexpr double key_strength = 0.95, first_strength = 0.3, second_strength = 0.2;
constexpr double ambient = 0.1, diffuse = 0.8, specular = 0.15, shininess = 33;

// The key light's radius by its distance: how soft shadows are.
constexpr double light_radius = 0.08;
// Where shadow rays begin and how far they go, and how far the sky is looked for, in diagonals.
constexpr double lift = 1e-3, farthest = 1, sky_reach = 0.12;
constexpr int shadow_steps = 48, sky_steps = 4;
// Shadow rays' steps are no shorter than this, in diagonals.
constexpr double shortest_step = 2e-3;

Vec3 direction_to(const Rays& rays, const Vec3& place) {
  const auto& [right, up, ahead] = rays.axes();
  return normalized(place[0] * right + place[1] * up - place[2] * ahead);
}

// Values of the field at one point for each of some hits.
class Probe {
 public:
  Probe(const Subject& subject, Watch& watch) : subject_(subject), watch_(watch) {}

  /// use(i, value) after place(i) has given the point of item i.
  template <class Place, class Use>
  void run(size_t n, Place place, Use use) {
    for (size_t first = 0; first < n; first += Block<float>::capacity) {
      watch_.check();
      const size_t count = std::min(Block<float>::capacity, n - first);
      for (size_t i = 0; i < count; ++i) block_.set(i, place(first + i));
      block_.evaluate(subject_.solid, count);
      for (size_t i = 0; i < count; ++i) use(first + i, double(block_.value[i]));
    }
  }

 private:
  const Subject& subject_;
  Watch& watch_;
  Block<float> block_;
};

// A distance as far as the field's slope lets one conclude from a value.
double distance_from(const Subject& subject, const Vec3& point, double value) {
  Vec3 inside;
  for (int axis = 0; axis < 3; ++axis) {
    inside[axis] = std::clamp(point[axis], subject.bounds.lo[axis], subject.bounds.hi[axis]);
  }
  return subject.slopes.clear_radius(inside, -value);
}

// The share of the key light that reaches each hit: the least of the free distance beside the way
// to it by the light's radius as seen from there.
std::vector<double> key_shares(const Subject& subject, std::span<const Hit> hits, const Vec3& to,
                               Watch& watch) {
  const double diagonal = subject.bounds.diagonal();
  struct Way {
    size_t hit;
    double gone;
  };
  std::vector<double> shares(hits.size(), 1);
  std::vector<Way> ways;
  for (size_t i = 0; i < hits.size(); ++i) {
    if (dot(hits[i].normal, to) > 0) {
      ways.push_back({i, lift * diagonal});
    } else {
      shares[i] = 0;
    }
  }
  const auto place = [&](size_t k) {
    const Hit& hit = hits[ways[k].hit];
    return hit.at + lift * diagonal * hit.normal + ways[k].gone * to;
  };
  Probe probe(subject, watch);
  for (int step = 0; step < shadow_steps && !ways.empty(); ++step) {
    probe.run(ways.size(), place, [&](size_t k, double value) {
      Way& way = ways[k];
      const double free = value >= 0 ? 0 : distance_from(subject, place(k), value);
      double& share = shares[way.hit];
      share = std::min(share, free / (light_radius * way.gone));
      way.gone += std::max(free, shortest_step * diagonal);
    });
    std::erase_if(ways, [&](const Way& way) {
      return !(shares[way.hit] > 0.01) || way.gone > farthest * diagonal;
    });
  }
  for (double& share : shares) share = share > 0.01 ? share * share * (3 - 2 * share) : 0;
  return shares;
}

// How much of the sky each hit sees: distances along the normal that are shorter than the way
// there tell of something beside it; nearer ones count more.
std::vector<double> sky_shares(const Subject& subject, std::span<const Hit> hits, Watch& watch) {
  const double diagonal = subject.bounds.diagonal();
  std::vector<double> shares(hits.size(), 1);
  Probe probe(subject, watch);
  double weight = 0.5;
  for (int step = 1; step <= sky_steps; ++step, weight *= 0.6) {
    const double way = sky_reach * diagonal * step / sky_steps;
    const auto place = [&](size_t i) { return hits[i].at + way * hits[i].normal; };
    probe.run(hits.size(), place, [&](size_t i, double value) {
      const double free = value >= 0 ? 0 : distance_from(subject, place(i), value);
      shares[i] -= weight * std::clamp(1 - free / way, 0.0, 1.0);
    });
  }
  for (double& share : shares) share = std::clamp(share, 0.0, 1.0);
  return shares;
}

// How far from the surface, along the ray and in diagonals, normals and colours are taken.
constexpr double beside = 1e-5;
constexpr double farthest_aside = 1e-4;
// Colours in single precision are taken on both sides of the surface. Where a colour changes
// abruptly on the surface, or rounding tells, the two differ.
constexpr double equal_colors = 0.25 / 255;
// Coordinates in single precision tell points apart well enough up to so many diagonals.
constexpr double far = 16;

// Operations in double that are worth being evaluated twice where that saves finding the surface.
constexpr int most_in_double = 3;

bool is_near(const BoundingBox& box) { return norm(box.lo) + norm(box.hi) < far * box.diagonal(); }

double shown(double channel) { return channel > 0 ? std::min(channel, 1.0) : 0; }

// The colours that single precision gives so far before and behind the surface; the numbers of
// those that need double come into `open`.
void find_single_colors(const LocalEvaluator& color, std::span<Hit> hits, double aside,
                        std::vector<size_t>& open, Watch& watch) {
  constexpr size_t half = Block<float>::capacity / 2;
  thread_local Block<float> block;
  thread_local float channels[3][Block<float>::capacity];
  float* const out[3] = {channels[0], channels[1], channels[2]};
  open.clear();
  for (size_t first = 0; first < hits.size(); first += half) {
    watch.check();
    const size_t n = std::min(half, hits.size() - first);
    for (size_t i = 0; i < n; ++i) {
      const Hit& hit = hits[first + i];
      const Vec3 way = aside * hit.toward;
      block.set(i, hit.at + way);
      block.set(n + i, hit.at - way);
    }
    color.block(block.xyz[0], block.xyz[1], block.xyz[2], 2 * n, out);
    for (size_t i = 0; i < n; ++i) {
      Hit& hit = hits[first + i];
      bool equal = true;
      for (int c = 0; c < 3; ++c) {
        const double before = channels[c][i], behind = channels[c][n + i];
        equal = equal && std::abs(before - behind) <= equal_colors;
        hit.color[c] = shown(0.5 * (before + behind));
      }
      if (!equal) open.push_back(first + i);
    }
  }
}

}  // namespace

void find_normals(const Subject& subject, std::span<Hit> hits, Watch& watch) {
  // On the surface itself the direction to the nearest point of a curve or mesh is all rounding.
  const double aside = beside * subject.bounds.diagonal();
  thread_local Block<double> block;
  thread_local double slopes[3][Block<double>::capacity];
  double* const gradient[3] = {slopes[0], slopes[1], slopes[2]};
  for (size_t first = 0; first < hits.size(); first += block.capacity) {
    watch.check();
    const size_t n = std::min(block.capacity, hits.size() - first);
    for (size_t i = 0; i < n; ++i) {
      block.set(i, hits[first + i].at + aside * hits[first + i].toward);
    }
    subject.solid.whole().gradient_block(block.xyz[0], block.xyz[1], block.xyz[2], n, block.value,
                                         gradient);
    for (size_t i = 0; i < n; ++i) {
      const Vec3 inward{slopes[0][i], slopes[1][i], slopes[2][i]};
      const double length = norm(inward);
      if (length > 0 && length < infinity) hits[first + i].normal = (-1 / length) * inward;
    }
  }
}

bool single_does(const BoundingBox& box, const Evaluator& color) {
  // Twice in double would be a waste.
  return is_near(box) && is_single(color);
}

bool single_pays(const BoundingBox& box, const Evaluator& color) {
  const std::vector<Instruction>& steps = color.tape().instructions();
  const auto is_quick = [](const Instruction& step) { return step.operation->is_quick(); };
  const auto is_in_double = [](const Instruction& step) { return !step.operation->has_formula(); };
  return is_near(box) && std::all_of(steps.begin(), steps.end(), is_quick) &&
         std::count_if(steps.begin(), steps.end(), is_in_double) <= most_in_double;
}

void mix_colors(const Subject& subject, const LocalEvaluator& color, RayTable& table, Watch& watch,
                const std::function<void(size_t first, size_t n, const RayBlock&)>& use) {
  constexpr size_t half = RayBlock::capacity / 2;
  thread_local RayBlock block;
  float* const value = block.value;
  float* const channels[3] = {block.channels[0], block.channels[1], block.channels[2]};
  // Far enough that rounding does not hide on which side of the surface a place lies, and nearer
  // than a tenth of a pixel.
  const double diagonal = subject.bounds.diagonal();
  const float aside = float(
      std::min(beside * diagonal + 4 * double(subject.frame.error), farthest_aside * diagonal));
  for (size_t first = 0; first < table.count; first += half) {
    watch.check();
    const size_t n = std::min(half, table.count - first);
    const size_t behind = (n + 15) / 16 * 16;
    ray_kernels().place_aside(subject.frame, table, first, n, aside, behind, block);
    subject.solid.block(block.xyz[0], block.xyz[1], block.xyz[2], behind + n, &value);
    color.block(block.xyz[0], block.xyz[1], block.xyz[2], behind + n, channels);
    ray_kernels().mix(subject.frame, table, first, n, float(equal_colors), behind, block);
    use(first, n, block);
  }
}

void find_colors(const Subject& subject, const LocalEvaluator& color, std::span<Hit> hits,
                 Watch& watch) {
  std::vector<size_t> open;
  if (single_does(subject.bounds, color.whole())) {
    find_single_colors(color, hits, beside * subject.bounds.diagonal(), open, watch);
  } else {
    open.resize(hits.size());
    std::iota(open.begin(), open.end(), size_t(0));
  }
  thread_local Block<double> block;
  thread_local double channels[3][Block<double>::capacity];
  double* const out[3] = {channels[0], channels[1], channels[2]};
  for (size_t first = 0; first < open.size(); first += block.capacity) {
    watch.check();
    const size_t n = std::min(block.capacity, open.size() - first);
    for (size_t i = 0; i < n; ++i) block.set(i, hits[open[first + i]].at);
    color.block(block.xyz[0], block.xyz[1], block.xyz[2], n, out);
    for (size_t i = 0; i < n; ++i) {
      for (int c = 0; c < 3; ++c) hits[open[first + i]].color[c] = shown(channels[c][i]);
    }
  }
}

void light(const Subject& subject, std::span<Hit> colored, Watch& watch) {
  std::vector<Hit> hits(colored.begin(), colored.end());
  for (Hit& hit : hits) {
    if (hit.normal == Vec3{}) hit.normal = hit.toward;
  }
  const Vec3 key = direction_to(subject.rays, key_place);
  const std::vector<double> lit = key_shares(subject, hits, key, watch);
  const std::vector<double> sky = sky_shares(subject, hits, watch);
  for (size_t i = 0; i < hits.size(); ++i) {
    const Hit& hit = hits[i];
    const auto facing = [&](const Vec3& to) { return std::max(0.0, dot(hit.normal, to)); };
    const double fills = first_strength * facing(direction_to(subject.rays, first_fill)) +
                         second_strength * facing(direction_to(subject.rays, second_fill));
    const double all =
        sky[i] * (ambient + diffuse * fills) + diffuse * key_strength * lit[i] * facing(key);
    const double shine = std::pow(facing(normalized(key + hit.toward)), shininess);
    for (double& channel : colored[i].color) {
      channel = all * channel + specular * key_strength * lit[i] * shine;
    }
  }
}

}  // namespace sardf::rendering

#include "sardf/mesher_samples.hpp"

#include <algorithm>
#include <cmath>

namespace sardf::mesher {

namespace {

// Normals that differ less belong to one side: cos(15 degrees).
constexpr double same_side = 0.9659;

}  // namespace

Samples::Samples(const Places& places, std::span<const uint32_t> vertices) : vertices_(vertices) {
  first_.reserve(vertices.size() + 1);
  samples_.reserve(5 * vertices.size());
  for (const uint32_t v : vertices) {
    first_.push_back(uint32_t(samples_.size()));
    for (const uint32_t use : places.uses(v)) {
      const Vec3 at = places.crossing(use / 4);
      samples_.push_back({use, at, at, places.normal(use / 4)});
    }
  }
  first_.push_back(uint32_t(samples_.size()));
}

void Samples::take(const Field& field, const std::vector<Vec3>& vertices, double distance) {
  for (size_t k = 0; k < vertex_count(); ++k) {
    const Vec3& from = vertices[vertex(k)];
    for (Sample& sample : of(k)) {
      const Vec3 way = sample.target - from;
      const double length = norm(way);
      sample.at = from + (length > distance ? distance / length : 1) * way;
    }
  }
  Points<double> points;
  for (size_t begin = 0; begin < samples_.size(); begin += points.capacity) {
    const size_t n = std::min(points.capacity, samples_.size() - begin);
    for (size_t i = 0; i < n; ++i) points.set(i, samples_[begin + i].at);
    field.differentiate(points, n);
    for (size_t i = 0; i < n; ++i) {
      Sample& sample = samples_[begin + i];
      const Vec3 gradient = points.gradient_at(i);
      sample.normal = outward_normal(gradient);
      sample.steepness = norm(gradient);
      sample.height = -points.value[i] / sample.steepness;
    }
  }
}

int find_sides(std::span<Sample> samples) {
  std::array<Vec3, most_sides> first;
  int sides = 0;
  for (Sample& sample : samples) {
    sample.side = -1;
    if (!(dot(sample.normal, sample.normal) > 0.5) || !(std::abs(sample.height) < infinity)) {
      continue;
    }
    int side = 0;
    while (side < sides && dot(first[side], sample.normal) < same_side) ++side;
    if (side == sides) first[sides++] = sample.normal;
    sample.side = side;
  }
  return sides;
}

}  // namespace sardf::mesher

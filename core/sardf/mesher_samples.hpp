// The surface sampled around vertices; private to core/sardf/mesher*.cpp.
#pragma once

#include <span>

#include "sardf/mesher_stages.hpp"

namespace sardf::mesher {

/// The least distance of samples from their vertex, in cells: it tells an edge from a fillet.
inline constexpr double nearest_distance = 0.01;

struct Sample {
  uint32_t use;
  Vec3 target;  // the sample is taken on the way there from the vertex
  Vec3 at;
  Vec3 normal{};      // unit outward normal; 0: none
  double height = 0;  // above the surface along the normal, to first order
  double steepness = 0;
  int side = -1;
};

/// More sides than a vertex has uses.
inline constexpr int most_sides = 16;

/// The samples of some vertices: one for each use.
class Samples {
 public:
  /// At first the samples and their targets are the faces' crossings.
  Samples(const Places& places, std::span<const uint32_t> vertices);

  size_t vertex_count() const { return vertices_.size(); }
  uint32_t vertex(size_t k) const { return vertices_[k]; }
  std::span<Sample> of(size_t k) {
    return std::span(samples_).subspan(first_[k], first_[k + 1] - first_[k]);
  }
  /// Samples the field on the way from each vertex to the targets, `distance` away or there.
  void take(const Field& field, const std::vector<Vec3>& vertices, double distance);

 private:
  std::span<const uint32_t> vertices_;
  std::vector<uint32_t> first_;
  std::vector<Sample> samples_;
};

/// Gives each sample with a normal its side, those with like normals the same; the number of sides.
int find_sides(std::span<Sample> samples);

}  // namespace sardf::mesher

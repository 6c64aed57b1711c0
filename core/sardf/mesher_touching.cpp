// Vertices that touch, though they belong to different pieces of surface.
#include <bit>
#include <map>
#include <memory>

#include "sardf/mesher_stages.hpp"

namespace sardf::mesher {

namespace {

using Rounded = std::array<float, 3>;

Rounded rounded(const Vec3& p) { return {float(p[0]), float(p[1]), float(p[2])}; }

Vec3 middle_of_crossings(const Places& places, uint32_t vertex) {
  const Uses uses = places.uses(vertex);
  Vec3 sum{};
  for (const uint32_t use : uses) sum = sum + places.crossing(use / 4);
  return (1.0 / uses.count) * sum;
}

// Numbers of which most are not known, found with few looks into a tree.
class RoundedPlaces {
 public:
  void add(const Rounded& place) {
    places_[place] = 0;
    const uint32_t k = hash(place);
    filter_[k / 64] |= uint64_t(1) << k % 64;
  }
  bool may_contain(const Rounded& place) const {
    const uint32_t k = hash(place);
    return filter_[k / 64] >> k % 64 & 1;
  }
  int* find(const Rounded& place) {
    const auto found = places_.find(place);
    return found == places_.end() ? nullptr : &found->second;
  }

 private:
  static constexpr int bits = 16;
  static uint32_t hash(const Rounded& place) {
    uint32_t h = 0;
    // 0 and -0 are equal.
    for (const float x : place) h = (h ^ std::bit_cast<uint32_t>(x + 0.0f)) * 0x9E3779B1u;
    return h >> (32 - bits);
  }

  std::map<Rounded, int> places_;  // how many vertices are there
  std::array<uint64_t, (1 << bits) / 64> filter_{};
};

// Vertices at the same place in single precision, or nearly so in the same cell, one of which must
// lie out of its cell or share it.
std::vector<uint32_t> touching_vertices(const Grid& grid, const Net& net, const Places& places,
                                        const Vertices& vertices, Work& work) {
  const size_t count = net.vertex_count();
  // Bit 0: out of its cell; bit 1: touches one in the same cell; bit 2: may be at a place of one
  // that is out.
  Large<uint8_t> marks(count);
  work.run(count, 4096, [&](size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) {
      const uint32_t v = uint32_t(i);
      marks[v] = !places.is_in_cell(v, vertices.at[v]);
      const uint32_t begin = net.first_vertex[net.cell[v]];
      for (uint32_t w = begin; w < count && net.cell[w] == net.cell[v]; ++w) {
        if (w != v && norm(vertices.at[v] - vertices.at[w]) <= 1e-4 * grid.cell) marks[v] |= 2;
      }
    }
  });
  const auto outer = std::make_unique<RoundedPlaces>();
  for (uint32_t v = 0; v < count; ++v) {
    if (marks[v] & 1) outer->add(rounded(vertices.at[v]));
  }
  work.run(count, 4096, [&](size_t first, size_t last) {
    for (size_t v = first; v < last; ++v) {
      if (outer->may_contain(rounded(vertices.at[v]))) marks[v] |= 4;
    }
  });
  const auto number_at = [&](uint32_t v) {
    return marks[v] & 4 ? outer->find(rounded(vertices.at[v])) : nullptr;
  };
  for (uint32_t v = 0; v < count; ++v) {
    if (int* number = number_at(v)) ++*number;
  }
  std::vector<uint32_t> result;
  for (uint32_t v = 0; v < count; ++v) {
    const int* number = number_at(v);
    if ((marks[v] & 2) || (number && *number > 1)) result.push_back(v);
  }
  return result;
}

}  // namespace

void separate(const Grid& grid, const Net& net, const Places& places, Vertices& vertices,
              Work& work) {
  // Each vertex goes a little towards the middle of its own crossings.
  for (const uint32_t v : touching_vertices(grid, net, places, vertices, work)) {
    const Vec3 middle = middle_of_crossings(places, v);
    vertices.at[v] = vertices.at[v] + 2e-3 * (middle - vertices.at[v]);
  }
}

}  // namespace sardf::mesher

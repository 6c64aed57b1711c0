// Vertices that touch, though they belong to different pieces of surface.
#include <algorithm>
#include <bit>
#include <iterator>

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

// Tells of most places that they are none of those that were added.
class Filter {
 public:
  void add(const Rounded& place) {
    const uint32_t k = hash(place);
    bits_[k / 64] |= uint64_t(1) << k % 64;
  }
  bool may_contain(const Rounded& place) const {
    const uint32_t k = hash(place);
    return bits_[k / 64] >> k % 64 & 1;
  }

 private:
  static constexpr int size = 20;
  static uint32_t hash(const Rounded& place) {
    uint32_t h = 0;
    // 0 and -0 are equal.
    for (const float x : place) h = (h ^ std::bit_cast<uint32_t>(x + 0.0f)) * 0x9E3779B1u;
    return h >> (32 - size);
  }

  std::vector<uint64_t> bits_ = std::vector<uint64_t>((1 << size) / 64);
};

// The vertices at places in the filter.
std::vector<uint32_t> vertices_at(const Filter& filter, const Vertices& vertices, Work& work) {
  return collected<uint32_t>(vertices.at.size(), 16384, work,
                             [&](size_t v, std::vector<uint32_t>& to) {
                               if (filter.may_contain(rounded(vertices.at[v])))
                                 to.push_back(uint32_t(v));
                             });
}

// Those at the same place as one of `outer`, more than one there, appended; all ascending.
void add_meeting(const std::vector<uint32_t>& outer, const Vertices& vertices, Work& work,
                 std::vector<uint32_t>& to) {
  Filter filter;
  for (const uint32_t v : outer) filter.add(rounded(vertices.at[v]));
  std::vector<uint32_t> order = vertices_at(filter, vertices, work);
  const auto place = [&](uint32_t v) { return rounded(vertices.at[v]); };
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t v, uint32_t w) { return place(v) < place(w); });
  for (auto first = order.begin(); first != order.end();) {
    const auto last =
        std::find_if(first, order.end(), [&](uint32_t v) { return place(v) != place(*first); });
    const bool any_outer = std::any_of(
        first, last, [&](uint32_t v) { return std::binary_search(outer.begin(), outer.end(), v); });
    if (last - first > 1 && any_outer) to.insert(to.end(), first, last);
    first = last;
  }
}

// Vertices at the same place in single precision, or nearly so in the same cell, one of which must
// lie out of its cell or share it.
std::vector<uint32_t> touching_vertices(const Grid& grid, const Net& net, const Places& places,
                                        const Vertices& vertices, Work& work) {
  std::vector<uint32_t> suspects;
  std::set_union(vertices.sharp.begin(), vertices.sharp.end(), vertices.apart.begin(),
                 vertices.apart.end(), std::back_inserter(suspects));
  std::vector<uint32_t> outer, result;
  for (const uint32_t v : suspects) {
    if (!places.is_in_cell(v, vertices.at[v])) outer.push_back(v);
    bool touches = false;
    const uint32_t begin = net.first_vertex[net.cell[v]];
    for (uint32_t w = begin; w < net.vertex_count() && net.cell[w] == net.cell[v]; ++w) {
      touches |= w != v && norm(vertices.at[v] - vertices.at[w]) <= 1e-4 * grid.cell;
    }
    if (touches) result.push_back(v);
  }
  if (!outer.empty()) add_meeting(outer, vertices, work, result);
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
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

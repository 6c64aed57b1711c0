// Where the UV map ends, and how its surface continues there.

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "sardf/bake_stages.hpp"

namespace sardf::baking {
namespace {

constexpr uint32_t none = std::numeric_limits<uint32_t>::max();

uint32_t next_corner(uint32_t corner) { return corner / 4 * 4 + (corner + 1) % 4; }

uint32_t vertex_of(const Mesh& mesh, uint32_t corner) { return mesh.faces[corner / 4][corner % 4]; }

/// For each corner the first one with the same vertex and texture coordinates.
std::vector<uint32_t> first_alike(const Mesh& mesh) {
  const auto key = [&](uint32_t corner) {
    const Vec2& uv = mesh.corner_uv[corner];
    return std::tuple(vertex_of(mesh, corner), uv[0], uv[1]);
  };
  std::vector<uint32_t> order(mesh.corner_uv.size()), first(order.size());
  for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  tbb::parallel_sort(order.begin(), order.end(), [&](uint32_t i, uint32_t j) {
    return std::tuple_cat(key(i), std::tuple(i)) < std::tuple_cat(key(j), std::tuple(j));
  });
  for (size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && key(order[i]) == key(order[i - 1]);
    first[order[i]] = same ? first[order[i - 1]] : order[i];
  }
  return first;
}

/// The corners at which an edge starts that no other face shares in the UV map; ascending.
std::vector<uint32_t> border_corners(const Mesh& mesh, const std::vector<uint32_t>& alike) {
  struct Edge {
    uint32_t low, high, corner;
    bool joins(const Edge& other) const { return low == other.low && high == other.high; }
    bool operator<(const Edge& other) const {
      return std::tie(low, high, corner) < std::tie(other.low, other.high, other.corner);
    }
  };
  std::vector<Edge> edges;
  edges.reserve(alike.size());
  for (uint32_t i = 0; i < alike.size(); ++i) {
    const uint32_t j = next_corner(i);
    if (vertex_of(mesh, i) == vertex_of(mesh, j)) continue;
    edges.push_back({std::min(alike[i], alike[j]), std::max(alike[i], alike[j]), i});
  }
  tbb::parallel_sort(edges.begin(), edges.end());
  std::vector<uint32_t> result;
  for (size_t i = 0; i < edges.size(); ++i) {
    const bool shared = (i > 0 && edges[i].joins(edges[i - 1])) ||
                        (i + 1 < edges.size() && edges[i].joins(edges[i + 1]));
    if (!shared) result.push_back(edges[i].corner);
  }
  std::sort(result.begin(), result.end());
  return result;
}

/// Sum of slopes weighted by the area in the image: slivers, whose slopes mean nothing, vanish.
struct SlopeSum {
  Slopes sum;
  double area = 0;
  void add(const Mesh& mesh, int size, uint32_t face, uint32_t k) {
    const std::array<uint32_t, 3> corner{4 * face, 4 * face + k, 4 * face + k + 1};
    const Vec2 a = texel_of(mesh, corner[0], size), b = texel_of(mesh, corner[1], size),
               c = texel_of(mesh, corner[2], size);
    const Vec3& origin = mesh.vertices[vertex_of(mesh, corner[0])];
    const Vec3 p = mesh.vertices[vertex_of(mesh, corner[1])] - origin,
               q = mesh.vertices[vertex_of(mesh, corner[2])] - origin;
    const Vec2 s{b[0] - a[0], b[1] - a[1]}, t{c[0] - a[0], c[1] - a[1]};
    const double determinant = s[0] * t[1] - s[1] * t[0];
    const double sign = determinant < 0 ? -1 : 1;
    sum.by_x = sum.by_x + sign * (t[1] * p - s[1] * q);
    sum.by_y = sum.by_y + sign * (s[0] * q - t[0] * p);
    area += std::abs(determinant);
  }
  Slopes mean() const {
    if (!(area > 0)) return {};
    return {(1 / area) * sum.by_x, (1 / area) * sum.by_y};
  }
};

/// Slopes at the vertices where `index` (by corner) is not none.
std::vector<Slopes> slopes_at(const UvLayout& layout, const std::vector<uint32_t>& alike,
                              const std::vector<uint32_t>& index, size_t count) {
  const Mesh& mesh = *layout.mesh;
  std::vector<SlopeSum> sums(count);
  for (uint32_t i = 0; i < alike.size(); ++i) {
    const uint32_t at = index[alike[i]];
    if (at == none) continue;
    for (const uint32_t k : {1u, 2u}) sums[at].add(mesh, layout.size, i / 4, k);
  }
  std::vector<Slopes> result;
  result.reserve(count);
  for (const SlopeSum& s : sums) result.push_back(s.mean());
  return result;
}

}  // namespace

void find_borders(UvLayout& layout, const std::function<void()>& report) {
  const Mesh& mesh = *layout.mesh;
  const std::vector<uint32_t> alike = first_alike(mesh);
  report();
  const std::vector<uint32_t> corners = border_corners(mesh, alike);
  report();
  std::vector<uint32_t> index(alike.size(), none);
  uint32_t count = 0;
  const auto slopes_index = [&](uint32_t corner) {
    uint32_t& at = index[alike[corner]];
    if (at == none) at = count++;
    return at;
  };
  for (const uint32_t i : corners) {
    const uint32_t j = next_corner(i), p = vertex_of(mesh, i), q = vertex_of(mesh, j);
    const std::array<uint32_t, 2> edge{std::min(p, q), std::max(p, q)};
    layout.borders.push_back({texel_of(mesh, i, layout.size),
                              texel_of(mesh, j, layout.size),
                              i / 4,
                              {p, q},
                              {slopes_index(i), slopes_index(j)},
                              std::binary_search(mesh.creases.begin(), mesh.creases.end(), edge)});
  }
  layout.slopes = slopes_at(layout, alike, index, count);
}

}  // namespace sardf::baking

// Normals at the corners of faces: at an edge each face has that of its own side.
#include <algorithm>

#include "sardf/mesher_samples.hpp"

namespace sardf::mesher {

namespace {

// A face whose own normal differs more from the surface's at its crossing, 60 degrees, does not lie
// on the crossing's side.
constexpr double agreeing_cosine = 0.5;

// What a face shows of its side of an edge: a point and a normal there.
struct Side {
  Vec3 at, normal;
};

// The face's crossing, unless the face itself lies on the other side, as a sliver along the edge
// may.
Side side_of(uint32_t face, const Net& net, const CrossingPoints& crossings,
             const Vertices& vertices) {
  const auto& v = net.faces[face];
  const auto& at = vertices.at;
  const Vec3 own = cross(at[v[2]] - at[v[0]], at[v[3]] - at[v[1]]);
  const double length = norm(own);
  if (!(dot(own, crossings.normal[face]) < agreeing_cosine * length)) {
    return {crossings.at[face], crossings.normal[face]};
  }
  return {0.25 * (at[v[0]] + at[v[1]] + at[v[2]] + at[v[3]]), (1 / length) * own};
}

using Normals = std::array<Vec3, most_sides>;

// The normal of the sample's side; but the way to a point of a curved edge's outer side may leave
// that side, and then another side fits the face far better.
Vec3 choose(const Normals& normals, int sides, int side, const Vec3& expected) {
  constexpr double far_better = 0.2;
  double fit = side >= 0 ? dot(normals[side], expected) + far_better : -infinity;
  int best = std::max(side, 0);
  for (int other = 0; other < sides; ++other) {
    if (dot(normals[other], expected) <= fit) continue;
    best = other;
    fit = dot(normals[other], expected);
  }
  return normals[best];
}

// The mean normal of each side.
Normals mean_normals(std::span<const Sample> samples, int sides) {
  Normals normals{};
  for (const Sample& s : samples) {
    if (s.side >= 0) normals[s.side] = normals[s.side] + s.normal;
  }
  for (int side = 0; side < sides; ++side) normals[side] = normalized(normals[side]);
  return normals;
}

}  // namespace

std::vector<Vec3> find_normals(const Field& field, const Grid& grid, const Net& net,
                               const CrossingPoints& crossings, const Vertices& vertices,
                               Work& work) {
  std::vector<Vec3> result(net.uses.size());
  work.run(net.faces.size(), 4096, [&](size_t first, size_t last) {
    for (size_t face = first; face < last; ++face) {
      for (size_t k = 0; k < 4; ++k) result[4 * face + k] = vertices.normal[net.faces[face][k]];
    }
  });
  const auto side = [&](uint32_t use) { return side_of(use / 4, net, crossings, vertices); };
  work.run(vertices.sharp.size(), 32, [&](size_t first, size_t last) {
    Samples samples(net, crossings, std::span(vertices.sharp).subspan(first, last - first));
    for (size_t k = 0; k < samples.vertex_count(); ++k) {
      for (Sample& s : samples.of(k)) s.target = side(s.use).at;
    }
    samples.take(field, vertices, nearest_distance * grid.cell);
    for (size_t k = 0; k < samples.vertex_count(); ++k) {
      const int sides = find_sides(samples.of(k));
      const Normals normals = mean_normals(samples.of(k), sides);
      for (const Sample& s : samples.of(k)) {
        const Vec3 expected = side(s.use).normal;
        result[s.use] = sides > 0 ? choose(normals, sides, s.side, expected) : expected;
      }
    }
  });
  return result;
}

}  // namespace sardf::mesher

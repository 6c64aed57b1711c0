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
Side side_of(uint32_t face, const Mesh& mesh, const Places& places) {
  const auto& v = mesh.faces[face];
  const auto& at = mesh.vertices;
  const Vec3 own = cross(at[v[2]] - at[v[0]], at[v[3]] - at[v[1]]);
  const double length = norm(own);
  const Vec3 there = places.normal(face);
  if (!(dot(own, there) < agreeing_cosine * length)) return {places.crossing(face), there};
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

// The normals of the faces' corners at sharp vertices.
void find_sharp_normals(const Field& field, const Grid& grid, const Places& places,
                        const Vertices& vertices, Mesh& mesh, Work& work) {
  const auto side = [&](uint32_t use) { return side_of(use / 4, mesh, places); };
  work.run(vertices.sharp.size(), 32, [&](size_t first, size_t last) {
    Samples samples(places, std::span(vertices.sharp).subspan(first, last - first));
    for (size_t k = 0; k < samples.vertex_count(); ++k) {
      for (Sample& s : samples.of(k)) s.target = side(s.use).at;
    }
    samples.take(field, mesh.vertices, nearest_distance * grid.cell);
    for (size_t k = 0; k < samples.vertex_count(); ++k) {
      const int sides = find_sides(samples.of(k));
      const Normals normals = mean_normals(samples.of(k), sides);
      for (const Sample& s : samples.of(k)) {
        const Vec3 expected = side(s.use).normal;
        mesh.corner_normals[s.use] =
            sides > 0 ? choose(normals, sides, s.side, expected) : expected;
      }
    }
  });
}

std::vector<uint32_t> faces_at(const std::vector<uint32_t>& vertices, const Places& places,
                               Work& work) {
  auto faces =
      collected<uint32_t>(vertices.size(), 256, work, [&](size_t i, std::vector<uint32_t>& to) {
        for (const uint32_t use : places.uses(vertices[i])) to.push_back(use / 4);
      });
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return faces;
}

// Where the field has no gradient, the face's own normal must do.
void fill_normals(Mesh& mesh, uint32_t f) {
  for (size_t k = 0; k < 4; ++k) {
    Vec3& normal = mesh.corner_normals[4 * size_t(f) + k];
    if (dot(normal, normal) > 0.5) continue;
    const auto& face = mesh.faces[f];
    const Vec3 n = cross(mesh.vertices[face[2]] - mesh.vertices[face[0]],
                         mesh.vertices[face[3]] - mesh.vertices[face[1]]);
    normal = norm(n) > 0 ? normalized(n) : Vec3{0, 0, 1};
  }
}

}  // namespace

void finish_faces(const Field& field, const Grid& grid, const Places& places,
                  const Vertices& vertices, Mesh& mesh, Work& work) {
  resize_on_all_threads(mesh.corner_normals, 4 * mesh.faces.size());
  work.run(mesh.faces.size(), 1024, [&](size_t first, size_t last) {
    finish_smooth_faces(grid, vertices, mesh, first, last);
  });
  find_sharp_normals(field, grid, places, vertices, mesh, work);
  const std::vector<uint32_t> faces = faces_at(vertices.sharp, places, work);
  mesh.creases = find_creases(mesh, vertices, faces, work);
  work.run(faces.size(), 1024, [&](size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) {
      fill_normals(mesh, faces[i]);
      choose_diagonal(mesh, faces[i]);
    }
  });
}

}  // namespace sardf::mesher

#include "sardf/mesher.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>

#include "sardf/error.hpp"
#include "sardf/mesher_stages.hpp"
#include "sardf/short_number.hpp"

namespace sardf {

namespace mesher {

namespace {

constexpr int least_resolution = 4, most_resolution = 1'000'000;

// Cells that the grid is wider than the bounds, both sides together; and where in the cells the
// middle of the bounds comes to lie, so that planes of symmetry and round numbers do not fall on
// grid points.
constexpr double extra_cells = 0.8;
constexpr Vec3 shift{0.11, 0.13, 0.07};

size_t free_memory() {
  std::ifstream info("/proc/meminfo");
  std::string name, unit;
  for (size_t kib; info >> name >> kib; std::getline(info, unit)) {
    if (name == "MemAvailable:") return kib * 1024;
  }
  return size_t(sysconf(_SC_PHYS_PAGES)) * size_t(sysconf(_SC_PAGESIZE));
}

Grid make_grid(const BoundingBox& bounds, const MeshOptions& options) {
  const Vec3 size = bounds.size();
  const double longest = std::max({size[0], size[1], size[2]});
  if (!(std::min({size[0], size[1], size[2]}) > 0) || !(longest < infinity)) {
    throw Error("the bounds of a mesh must be finite and have positive size");
  }
  Grid grid;
  if (options.cell_size != 0) {
    if (!(options.cell_size > 0) || !(options.cell_size * most_resolution >= longest) ||
        !(options.cell_size * least_resolution <= longest)) {
      throw Error("cell size " + short_number(options.cell_size, 6) + " is not between " +
                  short_number(longest / most_resolution) + " and " +
                  short_number(longest / least_resolution) +
                  ", the longest side of the bounds divided by " + std::to_string(most_resolution) +
                  " and by " + std::to_string(least_resolution));
    }
    grid.cell = options.cell_size;
  } else {
    if (options.resolution < least_resolution || options.resolution > most_resolution) {
      throw Error("resolution " + std::to_string(options.resolution) + " is not between " +
                  std::to_string(least_resolution) + " and " + std::to_string(most_resolution));
    }
    grid.cell = longest / (options.resolution - extra_cells);
  }
  double farthest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double cells = std::ceil(size[axis] / grid.cell + extra_cells - 1e-6);
    grid.blocks[axis] = int32_t(std::ceil(cells / block_cells));
    grid.origin[axis] = bounds.center()[axis] - (0.5 * cells + shift[axis]) * grid.cell;
    farthest = std::max({farthest, std::abs(bounds.lo[axis]), std::abs(bounds.hi[axis])});
  }
  // 16 roundings of the largest coordinate.
  grid.single = 16 * 0x1p-24 * farthest < 1e-3 * grid.cell;
  return grid;
}

Vec3 middle_of_crossings(const Net& net, const CrossingPoints& crossings, uint32_t vertex) {
  Vec3 sum{};
  const uint32_t begin = net.first_use[vertex], end = net.first_use[vertex + 1];
  for (uint32_t i = begin; i < end; ++i) sum = sum + crossings.at[net.uses[i] / 4];
  return (1.0 / (end - begin)) * sum;
}

bool is_in_cell(const Grid& grid, const Index3& cell, const Vec3& point) {
  for (int axis = 0; axis < 3; ++axis) {
    if (point[axis] < grid.coordinate(axis, cell[axis]) ||
        point[axis] > grid.coordinate(axis, cell[axis] + 1)) {
      return false;
    }
  }
  return true;
}

// Vertices at the same place in single precision, or nearly so in the same cell, one of which must
// lie out of its cell or share it.
std::vector<uint32_t> touching_vertices(const Grid& grid, const Cells& cells, const Net& net,
                                        const Vertices& vertices, Work& work) {
  const auto rounded = [&](uint32_t v) {
    const Vec3& p = vertices.at[v];
    return std::array<float, 3>{float(p[0]), float(p[1]), float(p[2])};
  };
  std::map<std::array<float, 3>, int> places;
  std::vector<uint8_t> touching(net.vertex_count()), out(net.vertex_count());
  work.run(net.vertex_count(), 4096, [&](size_t first, size_t last) {
    for (size_t v = first; v < last; ++v) {
      out[v] = !is_in_cell(grid, cells.at[net.cell[v]], vertices.at[v]);
    }
  });
  for (uint32_t v = 0; v < net.vertex_count(); ++v) {
    if (out[v]) places[rounded(v)] = 0;
    for (uint32_t w = v; w > 0 && net.cell[w - 1] == net.cell[v]; --w) {
      if (norm(vertices.at[v] - vertices.at[w - 1]) > 1e-4 * grid.cell) continue;
      touching[v] = touching[w - 1] = 1;
    }
  }
  const auto place_of = [&](uint32_t v) {
    return places.empty() ? places.end() : places.find(rounded(v));
  };
  for (uint32_t v = 0; v < net.vertex_count(); ++v) {
    if (const auto place = place_of(v); place != places.end()) ++place->second;
  }
  std::erase_if(places, [](const auto& place) { return place.second < 2; });
  std::vector<uint32_t> result;
  for (uint32_t v = 0; v < net.vertex_count(); ++v) {
    if (touching[v] || place_of(v) != places.end()) result.push_back(v);
  }
  return result;
}

// Pieces of surface that touch stay apart: programs that merge equal points would join them. Each
// vertex goes a little towards the middle of its own crossings.
void separate(const Grid& grid, const Cells& cells, const Net& net, const CrossingPoints& crossings,
              Vertices& vertices, Work& work) {
  for (const uint32_t v : touching_vertices(grid, cells, net, vertices, work)) {
    const Vec3 middle = middle_of_crossings(net, crossings, v);
    vertices.at[v] = vertices.at[v] + 2e-3 * (middle - vertices.at[v]);
  }
}

// Where the field has no gradient, the face's own normal must do.
void fill_normals(Mesh& mesh) {
  for (size_t f = 0; f < mesh.faces.size(); ++f) {
    for (int k = 0; k < 4; ++k) {
      Vec3& normal = mesh.corner_normals[4 * f + k];
      if (dot(normal, normal) > 0.5) continue;
      const auto& face = mesh.faces[f];
      const Vec3 n = cross(mesh.vertices[face[2]] - mesh.vertices[face[0]],
                           mesh.vertices[face[3]] - mesh.vertices[face[1]]);
      normal = norm(n) > 0 ? normalized(n) : Vec3{0, 0, 1};
    }
  }
}

}  // namespace

}  // namespace mesher

Mesh make_mesh(const Evaluator& solid, const BoundingBox& bounds, const MeshOptions& options) {
  using namespace mesher;
  const Grid grid = make_grid(bounds, options);
  Field field(solid, bounds);
  Work work(options.progress);
  const size_t limit = options.memory_limit ? options.memory_limit : free_memory();
  work.stage(0.4);
  Cells cells = find_cells(field, grid, limit, work);
  if (cells.at.empty()) {
    throw Error("the solid has no surface within its bounds, or it is thinner than a cell (" +
                short_number(grid.cell) + " scene units) everywhere");
  }
  work.stage(0.5);
  Net net = build_net(cells, grid, work);
  work.stage(0.7);
  const CrossingPoints crossings = find_crossings(field, grid, cells.crossings, work);
  cells.crossings = {};
  work.stage(0.85);
  Vertices vertices = place_vertices(field, grid, net, crossings, work);
  work.stage(0.97);
  place_features(field, grid, net, crossings, vertices, work);
  separate(grid, cells, net, crossings, vertices, work);
  work.stage(1);
  Mesh mesh;
  mesh.corner_normals = find_normals(field, grid, net, crossings, vertices, work);
  mesh.creases = find_creases(net, vertices, mesh.corner_normals);
  mesh.vertices = std::move(vertices.at);
  mesh.faces = std::move(net.faces);
  fill_normals(mesh);
  choose_diagonals(mesh, work);
  return mesh;
}

}  // namespace sardf

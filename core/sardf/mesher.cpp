#include "sardf/mesher.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>

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

}  // namespace

}  // namespace mesher

Mesh make_mesh(const Evaluator& solid, const BoundingBox& bounds, const MeshOptions& options) {
  using namespace mesher;
  const Grid grid = make_grid(bounds, options);
  Field field(solid, bounds);
  Work work(options.progress);
  const size_t limit = options.memory_limit ? options.memory_limit : free_memory();
  work.stage(0.5);
  Cells cells = find_cells(field, grid, limit, work);
  if (cells.at.empty()) {
    throw Error("the solid has no surface within its bounds, or it is thinner than a cell (" +
                short_number(grid.cell) + " scene units) everywhere");
  }
  work.stage(0.55);
  Net net = build_net(cells, work);
  const Places places(grid, cells, net);
  work.stage(0.75);
  Vertices vertices = place_vertices(field, grid, cells, net, work);
  work.stage(0.9);
  place_features(field, grid, net, places, vertices, work);
  separate(grid, net, places, vertices, work);
  work.stage(1);
  Mesh mesh;
  mesh.vertices = std::move(vertices.at);
  mesh.faces = std::move(net.faces);
  finish_faces(field, grid, places, vertices, mesh, work);
  return mesh;
}

}  // namespace sardf

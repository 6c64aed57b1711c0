// Distances to a mesh of a million triangles, on one thread, signed by either rule; and with
// Embree's point query where that is installed. Times are processor time, of all threads for
// builds.
#include <benchmark/benchmark.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "sardf/evaluate.hpp"
#include "sardf/mesh_set.hpp"
#if defined(SARDF_EMBREE)
#include "embree_distance.hpp"
#endif

namespace sardf::bench {
namespace {

// A cube's grid blown up to a sphere with bumps.
TriangleMesh bumpy_sphere() {
  constexpr int n = 289;
  TriangleMesh mesh;
  std::map<std::array<int, 3>, uint32_t> numbers;
  const auto vertex = [&](const std::array<int, 3>& at) {
    const auto [known, is_new] = numbers.try_emplace(at, uint32_t(mesh.vertices.size()));
    if (is_new) {
      Vec3 p;
      for (size_t k = 0; k < 3; ++k) {
        p[k] = std::tan((2.0 * at[k] / n - 1) * std::numbers::pi / 4);
      }
      p = normalized(p);
      const double bumps = std::sin(9 * p[0]) * std::sin(11 * p[1]) * std::sin(8 * p[2]);
      const double ripples = std::sin(90 * p[0] + 80 * p[1]);
      mesh.vertices.push_back((1 + 0.05 * bumps + 0.002 * ripples) * p);
    }
    return known->second;
  };
  for (size_t side = 0; side < 6; ++side) {
    for (int i = 0; i < n * n; ++i) {
      // Counter-clockwise seen from outside; on the lower sides with both directions exchanged.
      const auto corner = [&](int u, int v) {
        if (side % 2 == 0) std::swap(u, v);
        std::array<int, 3> at{};
        at[side / 2] = side % 2 ? n : 0;
        at[(side / 2 + 1) % 3] = i % n + u;
        at[(side / 2 + 2) % 3] = i / n + v;
        return vertex(at);
      };
      mesh.triangles.push_back({corner(0, 0), corner(1, 0), corner(1, 1)});
      mesh.triangles.push_back({corner(0, 0), corner(1, 1), corner(0, 1)});
      mesh.polygons.insert(mesh.polygons.end(), 2, uint32_t(mesh.polygon_count++));
    }
  }
  return mesh;
}

const TriangleMesh& mesh() {
  static const TriangleMesh made = bumpy_sphere();
  return made;
}

const MeshDataPointer& data() {
  static const auto made = std::make_shared<const MeshData>(mesh());
  return made;
}

// Rows of a grid around the mesh, or random points of the same cube.
std::array<std::vector<double>, 3> points(bool coherent) {
  constexpr int side = 48;
  std::mt19937_64 engine(1);
  std::uniform_real_distribution<double> at(-1.2, 1.2);
  std::array<std::vector<double>, 3> all;
  for (int i = 0; i < side * side * side; ++i) {
    const std::array<int, 3> cell{i % side, i / side % side, i / side / side};
    for (size_t k = 0; k < 3; ++k) {
      all[k].push_back(coherent ? -1.2 + 2.4 * cell[k] / (side - 1) : at(engine));
    }
  }
  return all;
}

void count(benchmark::State& state, size_t n) {
  state.counters["points"] =
      benchmark::Counter(double(n) * double(state.iterations()), benchmark::Counter::kIsRate);
}

void distance_to(benchmark::State& state, const PointSetPointer& set, bool coherent) {
  const Evaluator evaluator(
      call(distance_operation(set), {coordinate(0), coordinate(1), coordinate(2)}));
  const auto all = points(coherent);
  const size_t n = all[0].size();
  std::vector<double> out(Evaluator::block_size);
  double* to = out.data();
  for (auto _ : state) {
    for (size_t i = 0; i < n; i += out.size()) {
      evaluator.block(&all[0][i], &all[1][i], &all[2][i], std::min(out.size(), n - i), &to);
      benchmark::DoNotOptimize(to);
    }
  }
  count(state, n);
}

void mesh_signed(benchmark::State& state, const char* sign, bool coherent) {
  distance_to(state, solid_of_mesh(data(), sign).set, coherent);
}
BENCHMARK_CAPTURE(mesh_signed, normals_grid, "normals", true);
BENCHMARK_CAPTURE(mesh_signed, normals_random, "normals", false);
BENCHMARK_CAPTURE(mesh_signed, winding_grid, "winding", true);
BENCHMARK_CAPTURE(mesh_signed, winding_random, "winding", false);

void mesh_unsigned(benchmark::State& state, bool coherent) {
  distance_to(state, surface_of_mesh(data(), {}), coherent);
}
BENCHMARK_CAPTURE(mesh_unsigned, grid, true);
BENCHMARK_CAPTURE(mesh_unsigned, random, false);

void mesh_build_tree(benchmark::State& state) {
  mesh();
  for (auto _ : state) {
    const TriangleTree tree(mesh().vertices, mesh().triangles);
    benchmark::DoNotOptimize(&tree);
  }
}
BENCHMARK(mesh_build_tree)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

void mesh_check_solid(benchmark::State& state) {
  const TriangleTree& tree = data()->tree();
  for (auto _ : state) {
    const MeshSolidity solidity(tree);
    benchmark::DoNotOptimize(&solidity);
  }
}
BENCHMARK(mesh_check_solid)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

#if defined(SARDF_EMBREE)
void embree_unsigned(benchmark::State& state, bool coherent) {
  static const EmbreeMesh embree(mesh());
  const auto all = points(coherent);
  const size_t n = all[0].size();
  for (auto _ : state) {
    for (size_t i = 0; i < n; ++i) {
      benchmark::DoNotOptimize(
          embree.distance(float(all[0][i]), float(all[1][i]), float(all[2][i])));
    }
  }
  count(state, n);
}
BENCHMARK_CAPTURE(embree_unsigned, grid, true);
BENCHMARK_CAPTURE(embree_unsigned, random, false);

void embree_build(benchmark::State& state) {
  mesh();
  for (auto _ : state) {
    const EmbreeMesh embree(mesh());
    benchmark::DoNotOptimize(&embree);
  }
}
BENCHMARK(embree_build)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
#endif

}  // namespace
}  // namespace sardf::bench

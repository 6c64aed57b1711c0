// Meshes of the peers' shapes at equal cells, on one and on two threads.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <algorithm>

#include "register.hpp"
#include "sardf/mesher.hpp"
#include "shapes.hpp"

namespace sardf::bench {
namespace {

void mesh_shape(benchmark::State& state, Shape which, int threads) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, size_t(threads));
  const Evaluator solid(shape(which));
  MeshOptions options;
  const Vec3 size = bounds(which).size();
  options.cell_size = std::max({size[0], size[1], size[2]}) / double(state.range(0));
  size_t quads = 0;
  for (auto _ : state) quads = make_mesh(solid, bounds(which), options).faces.size();
  state.counters["quads"] = double(quads);
}

}  // namespace

void register_meshing() {
  for (const Shape which : {Shape::spheres, Shape::block, Shape::blended_block}) {
    for (const int threads : {1, 2}) {
      benchmark::RegisterBenchmark(
          ("mesh/" + name(which) + "/threads:" + std::to_string(threads)).c_str(), mesh_shape,
          which, threads)
          ->Arg(256)
          ->Arg(1024)
          ->UseRealTime()
          ->Unit(benchmark::kMillisecond);
    }
  }
}

}  // namespace sardf::bench

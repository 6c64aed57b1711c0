// Mesh, atlas and bake per stage: S3 with three materials and two channels, on one thread.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include "../tests/cpp/bake_scenes.hpp"
#include "sardf/bake_stages.hpp"

namespace sardf::test {
namespace {

constexpr int resolution = 128;

struct OneThread {
  tbb::global_control limit{tbb::global_control::max_allowed_parallelism, 1};
};

std::vector<BakeChannel> channels() {
  const std::vector<Expression> fractions = inverse_distance(
      {abs(cylinder({0, 0, 0}, 3)), distance_to({10, -6, 4}), distance_to({-10, 6, 4})}, 2);
  std::vector<Expression> color;
  for (const Vec3& rgb : {Vec3{0.1, 0.9, 0.3}, Vec3{0.2, 0.7, 0.6}, Vec3{0.3, 0.5, 0.9}}) {
    Expression sum = constant(0);
    for (size_t m = 0; m < 3; ++m) sum = sum + constant(rgb[m]) * fractions[m];
    color.push_back(sum);
  }
  return {{"base_color", color}, {"fractions_1", fractions}};
}

const Part& part(int size) {
  static const Part small(block_with_bores(), block_bounds(), resolution, 2048);
  static const Part large(block_with_bores(), block_bounds(), resolution, 4096);
  return size == 2048 ? small : large;
}

void make_surface_mesh(benchmark::State& state) {
  const OneThread one;
  const Evaluator solid(block_with_bores());
  MeshOptions options;
  options.resolution = resolution;
  for (auto _ : state) benchmark::DoNotOptimize(make_mesh(solid, block_bounds(), options));
}

void unwrap(benchmark::State& state) {
  const OneThread one;
  Mesh mesh = part(2048).mesh;
  for (auto _ : state) benchmark::DoNotOptimize(make_atlas(mesh, int(state.range(0))));
}

void index_texels(benchmark::State& state) {
  const OneThread one;
  const Part& p = part(int(state.range(0)));
  for (auto _ : state) TexelMap texels(p.mesh, int(state.range(0)));
}

void find_points(benchmark::State& state) {
  const Part& p = part(int(state.range(0)));
  const TexelMap texels(p.mesh, int(state.range(0)));
  baking::TilePoints points;
  size_t found = 0;
  for (auto _ : state)
    for (size_t tile = 0; tile < texels.layout().tiles(); ++tile) {
      baking::find_texels(texels.layout(), tile, points);
      found += points.count;
    }
  state.SetItemsProcessed(int64_t(found));
}

void find_and_project_points(benchmark::State& state) {
  const Part& p = part(int(state.range(0)));
  const TexelMap texels(p.mesh, int(state.range(0)));
  const Evaluator solid(p.solid);
  baking::TilePoints points;
  size_t found = 0;
  for (auto _ : state)
    for (size_t tile = 0; tile < texels.layout().tiles(); ++tile) {
      baking::find_texels(texels.layout(), tile, points);
      for (size_t i = 0; i < points.count; i += Evaluator::block_size)
        baking::project(solid, points, i, std::min(Evaluator::block_size, points.count - i), 5e-6f);
      found += points.count;
    }
  state.SetItemsProcessed(int64_t(found));
}

void bake_two_channels(benchmark::State& state) {
  const OneThread one;
  const Part& p = part(int(state.range(0)));
  const TexelMap texels(p.mesh, int(state.range(0)));
  const std::vector<BakeChannel> wanted = channels();
  const auto ignore = [](size_t, Image&&, const std::vector<unsigned char>&) {};
  size_t covered = 0;
  for (auto _ : state) covered += bake(texels, p.solid, wanted, ignore).covered;
  state.SetItemsProcessed(int64_t(covered));
}

BENCHMARK(make_surface_mesh)->Unit(benchmark::kMillisecond);
BENCHMARK(unwrap)->Arg(2048)->Unit(benchmark::kMillisecond);
BENCHMARK(index_texels)->Arg(2048)->Arg(4096)->Unit(benchmark::kMillisecond);
BENCHMARK(find_points)->Arg(2048)->Arg(4096)->Unit(benchmark::kMillisecond);
BENCHMARK(find_and_project_points)->Arg(2048)->Arg(4096)->Unit(benchmark::kMillisecond);
BENCHMARK(bake_two_channels)->Arg(2048)->Arg(4096)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sardf::test

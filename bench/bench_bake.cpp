// Mesh, atlas and bake per stage: S3 with three materials and two channels, on one thread; and a
// base colour of 8192² texels beside the rates of its own evaluation at the texels' points.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include "../tests/cpp/bake_scenes.hpp"
#include "sardf/bake_stages.hpp"
#include "shapes.hpp"

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
  const LocalEvaluator solid(Evaluator{p.solid}, block_bounds());
  baking::TilePoints points;
  size_t found = 0;
  for (auto _ : state)
    for (size_t tile = 0; tile < texels.layout().tiles(); ++tile) {
      baking::find_texels(texels.layout(), tile, points);
      baking::project(solid, points, 5e-6f);
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

constexpr int large = 8192;

const Part& large_part() {
  static const Part part(bench::shape(bench::Shape::blended_block), block_bounds(), resolution,
                         large);
  return part;
}

/// Points of every 16th tile of the large image, each as a bake evaluates it.
struct CoveredPoints {
  std::array<std::vector<float>, 3> at;
  CoveredPoints() {
    const TexelMap texels(large_part().mesh, large);
    const LocalEvaluator solid(Evaluator{large_part().solid}, block_bounds());
    const auto points = std::make_unique<baking::TilePoints>();
    for (size_t tile = 0; tile < texels.layout().tiles(); tile += 16) {
      baking::find_texels(texels.layout(), tile, *points);
      baking::project(solid, *points, 5e-6f);
      for (size_t axis = 0; axis < 3; ++axis)
        at[axis].insert(at[axis].end(), points->point[axis].begin(),
                        points->point[axis].begin() + points->count);
    }
  }
};

/// The evaluation alone, block by block: of the colour, or of the field and the colour.
void evaluate_covered(benchmark::State& state) {
  static const CoveredPoints points;
  std::vector<Expression> outputs = bench::graded_block(2).color;
  if (state.range(0)) outputs.push_back(large_part().solid);
  const Evaluator evaluator(outputs);
  constexpr size_t block = Evaluator::block_size;
  Scratch<float> storage;
  float* const rows = storage.get(outputs.size() * block);
  std::vector<float*> out;
  for (size_t k = 0; k < outputs.size(); ++k) out.push_back(rows + k * block);
  const size_t count = points.at[0].size();
  for (auto _ : state)
    for (size_t i = 0; i < count; i += block) {
      evaluator.block(&points.at[0][i], &points.at[1][i], &points.at[2][i],
                      std::min(block, count - i), out.data());
      benchmark::DoNotOptimize(rows);
      benchmark::ClobberMemory();
    }
  state.SetItemsProcessed(int64_t(count) * int64_t(state.iterations()));
}

/// The same evaluation of the colour, its results written into memory that is new, as for so many
/// points they have to be.
void evaluate_into_memory(benchmark::State& state) {
  static const CoveredPoints points;
  const Evaluator evaluator(bench::graded_block(2).color);
  constexpr size_t block = Evaluator::block_size, times = 16;
  const size_t count = points.at[0].size();
  for (auto _ : state) {
    ImageSamples results;
    results.resize(3 * times * count);
    float* out[3] = {results.data(), &results[times * count], &results[2 * times * count]};
    for (size_t time = 0; time < times; ++time)
      for (size_t i = 0; i < count; i += block) {
        const size_t n = std::min(block, count - i);
        evaluator.block(&points.at[0][i], &points.at[1][i], &points.at[2][i], n, out);
        for (float*& to : out) to += n;
      }
    benchmark::DoNotOptimize(results.data());
  }
  state.SetItemsProcessed(int64_t(times * count) * int64_t(state.iterations()));
}

/// A bake of the base colour with so many threads; with or without the points' movement.
void bake_base_color(benchmark::State& state) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  size_t(state.range(0)));
  const Part& p = large_part();
  const TexelMap texels(p.mesh, large);
  const std::vector<BakeChannel> wanted{{"base_color", bench::graded_block(2).color}};
  const auto ignore = [](size_t, Image&&, const std::vector<unsigned char>&) {};
  size_t covered = 0;
  for (auto _ : state)
    covered += bake(texels, state.range(1) ? p.solid : nullptr, wanted, ignore).covered;
  state.SetItemsProcessed(int64_t(covered));
}

/// Filling a fresh image of that size, whose pages come into being as in a bake: what no bake can
/// be faster than.
void write_image(benchmark::State& state) {
  const TexelMap texels(large_part().mesh, large);
  const auto points = std::make_unique<baking::TilePoints>();
  size_t covered = 0;
  for (size_t tile = 0; tile < texels.layout().tiles(); ++tile) {
    baking::find_texels(texels.layout(), tile, *points);
    covered += points->count;
  }
  for (auto _ : state) {
    Image image{large, large, 3, {}};
    image.samples.resize(size_t(large) * large * 3);
    std::fill(image.samples.begin(), image.samples.end(), 0.5f);
    benchmark::DoNotOptimize(image.samples.data());
  }
  state.SetItemsProcessed(int64_t(covered) * int64_t(state.iterations()));
}

BENCHMARK(make_surface_mesh)->Unit(benchmark::kMillisecond);
BENCHMARK(unwrap)->Arg(2048)->Unit(benchmark::kMillisecond);
BENCHMARK(index_texels)->Arg(2048)->Arg(4096)->Unit(benchmark::kMillisecond);
BENCHMARK(find_points)->Arg(2048)->Arg(4096)->Unit(benchmark::kMillisecond);
BENCHMARK(find_and_project_points)->Arg(2048)->Arg(4096)->Unit(benchmark::kMillisecond);
BENCHMARK(bake_two_channels)->Arg(2048)->Arg(4096)->Unit(benchmark::kMillisecond);
BENCHMARK(evaluate_covered)->ArgName("field")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK(evaluate_into_memory)->Unit(benchmark::kMillisecond);
BENCHMARK(write_image)->Unit(benchmark::kMillisecond);
BENCHMARK(bake_base_color)
    ->ArgNames({"threads", "move"})
    ->ArgsProduct({{1, 2}, {0, 1}})
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sardf::test

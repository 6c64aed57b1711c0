// What shortened programs save: pictures of a field of thousands of steps, and meshes of thousands
// of spheres. On one thread; times are processor time.
//
// $SARDF_PROSPERO is the path of prospero.vm, from the examples of Fidget; without it the pictures
// are left out.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <cstdlib>
#include <random>

#include "sardf/bounds.hpp"
#include "sardf/constructor.hpp"
#include "sardf/local_evaluator.hpp"
#include "sardf/mesher.hpp"
#include "sardf/plane_image.hpp"
#include "sardf/shorten.hpp"
#include "sardf/vm_file.hpp"

namespace sardf::bench {
namespace {

const char* prospero_path() { return std::getenv("SARDF_PROSPERO"); }

// The field of prospero.vm and a view of all of it.
struct Prospero {
  explicit Prospero(int size) { view.width = view.height = size; }
  Evaluator field{read_vm(prospero_path())};
  PlaneView view;
};

bool is_skipped(benchmark::State& state) {
  if (prospero_path()) return false;
  state.SkipWithError("$SARDF_PROSPERO is not the path of prospero.vm");
  return true;
}

void draw_prospero(benchmark::State& state) {
  if (is_skipped(state)) return;
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const auto [field, view] = Prospero(int(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(sign_image(field, view));
}
BENCHMARK(draw_prospero)->Arg(1024)->Arg(4096)->Unit(benchmark::kMillisecond);

// The same picture from every pixel in double: the time, and whether it is the same.
void draw_prospero_densely(benchmark::State& state) {
  if (is_skipped(state)) return;
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const auto [field, view] = Prospero(int(state.range(0)));
  std::vector<double> points, values(size_t(view.width) * view.height);
  for (int row = 0; row < view.height; ++row) {
    for (int column = 0; column < view.width; ++column) {
      points.insert(points.end(), {view.x(column), view.y(row), 0});
    }
  }
  for (auto _ : state) field.values(points.data(), values.size(), values.data());
  const std::vector<uint8_t> drawn = sign_image(field, view);
  size_t differ = 0;
  for (size_t i = 0; i < values.size(); ++i) differ += drawn[i] != (values[i] >= 0);
  state.counters["pixels_that_differ"] = double(differ);
  if (differ > 0) state.SkipWithError("the pruned picture differs from the dense one");
}
BENCHMARK(draw_prospero_densely)->Arg(1024)->Iterations(1)->Unit(benchmark::kMillisecond);

// Balls in the unit cube whose surfaces add up to 6, as many as asked for.
Evaluator balls(int count, const std::string& blend) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> in_cube(0, 1);
  const double radius = std::sqrt(6 / (4 * 3.141592653589793 * count));
  const BlendPointer join =
      blend == "min_max" ? make_blend(blend, {}) : make_blend(blend, {Value(0.5 * radius)});
  std::vector<Field> all;
  for (int i = 0; i < count; ++i) {
    const Vec3 center{in_cube(engine), in_cube(engine), in_cube(engine)};
    all.push_back(make_field("sphere", {center, radius}));
  }
  return Evaluator(make_field("union", {all, join}).expression());
}

void mesh_balls(benchmark::State& state, const std::string& blend) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Evaluator field = balls(int(state.range(0)), blend);
  MeshOptions options;
  options.resolution = 256;
  size_t faces = 0;
  for (auto _ : state) {
    faces = make_mesh(field, {{-0.1, -0.1, -0.1}, {1.1, 1.1, 1.1}}, options).faces.size();
  }
  state.counters["faces"] = double(faces);
}
BENCHMARK_CAPTURE(mesh_balls, min_max, "min_max")
    ->Arg(1000)
    ->Arg(10000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(mesh_balls, sardf, "sardf")->Arg(1000)->Arg(10000)->Unit(benchmark::kMillisecond);

void bound_balls(benchmark::State& state, const std::string& blend) {
  const Evaluator field = balls(int(state.range(0)), blend);
  for (auto _ : state) benchmark::DoNotOptimize(certified_bounds(field));
}
BENCHMARK_CAPTURE(bound_balls, min_max, "min_max")
    ->Arg(1000)
    ->Arg(10000)
    ->Unit(benchmark::kMillisecond);

// Values at points beside each other, block by block, as texels and rays have them, once programs
// for where they lie are made.
void evaluate_balls(benchmark::State& state) {
  const LocalEvaluator local(balls(1000, "sardf"), {{0, 0, 0}, {1, 1, 1}});
  constexpr size_t block = Evaluator::block_size, blocks = 200;
  constexpr int rounds = 64;  // until all programs are made
  std::mt19937 engine(2);
  std::uniform_real_distribution<float> in_cube(0, 1), beside(0, 0.02f);
  std::vector<float> at[3];
  for (size_t i = 0; i < blocks; ++i) {
    for (auto& row : at) {
      const float middle = in_cube(engine);
      for (size_t k = 0; k < block; ++k) row.push_back(middle + beside(engine));
    }
  }
  float out[block];
  float* to = out;
  const auto evaluate = [&] {
    for (size_t i = 0; i < at[0].size(); i += block) {
      if (state.range(0)) {
        local.block(&at[0][i], &at[1][i], &at[2][i], block, &to);
      } else {
        local.whole().block(&at[0][i], &at[1][i], &at[2][i], block, &to);
      }
      benchmark::DoNotOptimize(to);
    }
  };
  for (int i = 0; i < rounds; ++i) evaluate();
  for (auto _ : state) evaluate();
  state.SetItemsProcessed(int64_t(state.iterations()) * int64_t(blocks * block));
}
BENCHMARK(evaluate_balls)->ArgName("local")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

// One pass over a program of ten thousand balls, for a box in which few of them matter.
void shorten_balls(benchmark::State& state, const std::string& blend) {
  const Evaluator field = balls(10000, blend);
  const BoundingBox box{{0.4, 0.4, 0.4}, {0.5, 0.5, 0.5}};
  size_t steps = 0;
  for (auto _ : state) {
    steps = Shortening(field, box).shortened().tape().instructions().size();
  }
  state.counters["steps"] = double(steps);
}
BENCHMARK_CAPTURE(shorten_balls, min_max, "min_max")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(shorten_balls, sardf, "sardf")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sardf::bench

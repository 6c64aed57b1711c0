// Scenes sampled for 3-D textures, as the preview in Blender does it: the drilled block of peers'
// benchmarks with three materials, and a hundred solids. Real time on all threads.
#include <benchmark/benchmark.h>

#include <random>

#include "sardf/scene_file.hpp"
#include "sardf/volume_samples.hpp"

namespace sardf::bench {
namespace {

// The block that shapes.hpp has, as a scene.
Scene drilled_block() {
  return Scene(parse_scene(R"({"sardf": 1,
    "fields": {
      "bore": {"cylinder": {"radius": 3}},
      "part": {"union": {"blend": {"sardf": 0.5}, "of": [
        {"difference": {"blend": {"sardf": 0.5}, "of": [
          {"box": {"size": [20, 12, 8]}}, "bore",
          {"cylinder": {"center": [-8, -4, 0], "radius": 1}},
          {"cylinder": {"center": [-8, 4, 0], "radius": 1}},
          {"cylinder": {"center": [8, -4, 0], "radius": 1}},
          {"cylinder": {"center": [8, 4, 0], "radius": 1}}]}},
        {"torus": {"major_radius": 5, "minor_radius": 1}}]}}},
    "solid": "part",
    "materials": {"steel": {"color": "#8a8f98"}, "carbide": {"color": "#2b3a67"},
                  "brass": {"color": "#c0a030"}},
    "fractions": {"inverse_distance": {"features": [
      {"at": {"boundary": {"solid": "bore"}}, "material": "carbide", "exponent": 2},
      {"at": {"circle": {"radius": 5}}, "material": "brass", "exponent": 2},
      {"at": {"segment": {"a": [10, -6, 0], "b": [10, 6, 0]}}, "material": "steel"}]}}})",
                           ""));
}

// A hundred boxes and balls, joined; three materials.
Scene hundred_solids(const std::string& blend) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> place(-4, 4);
  const auto vector = [&] {
    std::string text = "[";
    for (int axis = 0; axis < 3; ++axis) {
      text += (axis ? ", " : "") + std::to_string(place(engine));
    }
    return text + "]";
  };
  std::string all;
  for (int i = 0; i < 100; ++i) {
    all += (i ? ", " : "") +
           std::string(i % 2 ? R"({"sphere": {"radius": 0.8, "center": )"
                             : R"({"box": {"size": [1, 1.4, 0.8], "center": )") +
           vector() + "}}";
  }
  return Scene(parse_scene(
      R"({"sardf": 1, "solid": {"union": {"of": [)" + all + R"(], "blend": )" + blend + R"(}},
    "materials": {"a": {"color": "#8a8f98"}, "b": {"color": "#2b3a67"}, "c": {"color": "#c0a030"}},
    "fractions": {"inverse_distance": {"features": [
      {"at": {"point": {"at": [-4, 0, 0]}}, "material": "a"},
      {"at": {"point": {"at": [4, 0, 0]}}, "material": "b"},
      {"at": {"segment": {"a": [0, -4, 0], "b": [0, 4, 0]}}, "material": "c"}]}}})",
      ""));
}

void sample(benchmark::State& state, const Scene& scene, Colored colored) {
  VolumeSampling sampling;
  const int n = int(state.range(0));
  const Vec3 room = (2.0 / n) * scene.bounds().size();
  sampling.grid = {{scene.bounds().lo - room, scene.bounds().hi + room}, {n, n, n}};
  sampling.colored = colored;
  for (auto _ : state) benchmark::DoNotOptimize(sample_volume(scene, sampling).field);
}

void sample_block(benchmark::State& state, Colored colored) {
  sample(state, drilled_block(), colored);
}
BENCHMARK_CAPTURE(sample_block, surface, Colored::surface)
    ->Arg(32)
    ->Arg(128)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(sample_block, inside, Colored::inside)
    ->Arg(32)
    ->Arg(128)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

void sample_hundred(benchmark::State& state, const std::string& blend) {
  sample(state, hundred_solids(blend), Colored::inside);
}
BENCHMARK_CAPTURE(sample_hundred, min_max, "\"min_max\"")
    ->Arg(32)
    ->Arg(128)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(sample_hundred, sardf, R"({"sardf": 0.2})")
    ->Arg(32)
    ->Arg(128)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sardf::bench

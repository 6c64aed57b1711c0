// Points per second of distances to features that are found by a search, on one thread, and the
// time that making them takes.
#include <benchmark/benchmark.h>

#include <random>

#include "register.hpp"
#include "sardf/constructor.hpp"
#include "sardf/evaluate.hpp"
#include "sardf/ops_features.hpp"

namespace sardf::bench {
namespace {

constexpr size_t block = 256, blocks = 16;

/// Random points of a box about the feature, block by block.
struct Points {
  std::vector<double> x, y, z;
  explicit Points(double size) {
    std::mt19937_64 engine(1);
    std::uniform_real_distribution<double> side(-size, size);
    for (size_t i = 0; i < block * blocks; ++i) {
      x.push_back(side(engine));
      y.push_back(side(engine));
      z.push_back(side(engine));
    }
  }
};

void search(benchmark::State& state, const Field& field, double size, bool gradient) {
  const Evaluator evaluator(field.expression());
  const Points points(size);
  alignas(64) double out[block], slopes[3][block];
  double *to = out, *by[3] = {slopes[0], slopes[1], slopes[2]};
  for (auto _ : state) {
    for (size_t i = 0; i < blocks; ++i) {
      const double *x = &points.x[i * block], *y = &points.y[i * block], *z = &points.z[i * block];
      gradient ? evaluator.gradient_block(x, y, z, block, out, by)
               : evaluator.block(x, y, z, block, &to);
      benchmark::DoNotOptimize(out);
      benchmark::ClobberMemory();
    }
  }
  state.counters["points"] = benchmark::Counter(double(block * blocks) * double(state.iterations()),
                                                benchmark::Counter::kIsRate);
}

void make(benchmark::State& state, const std::string& name, const std::vector<Value>& arguments) {
  for (auto _ : state) benchmark::DoNotOptimize(make_field(name, arguments));
}

/// A walk of `count` steps that fills a cube of half side 2.
std::vector<Vec3> walk(size_t count) {
  std::mt19937_64 engine(2);
  std::uniform_real_distribution<double> side(-1, 1);
  std::vector<Vec3> corners{{0, 0, 0}};
  const double step = 4 / std::sqrt(double(count));
  while (corners.size() < count) {
    Vec3 next = corners.back() + step * Vec3{side(engine), side(engine), side(engine)};
    for (double& a : next) a = std::clamp(a, -2.0, 2.0);
    corners.push_back(next);
  }
  return corners;
}

PointGrid hills(size_t side) {
  PointGrid rows(side, std::vector<Vec3>(side));
  for (size_t i = 0; i < side; ++i) {
    for (size_t j = 0; j < side; ++j) {
      const double x = 4.0 * double(i) / double(side - 1) - 2;
      const double y = 4.0 * double(j) / double(side - 1) - 2;
      rows[i][j] = {x, y, 0.5 * std::sin(3 * x) * std::cos(2 * y)};
    }
  }
  return rows;
}

void add(const std::string& name, const std::string& constructor,
         const std::map<std::string, Value>& given, double size) {
  std::vector<Value> arguments;
  for (const ParameterInfo& p : find_constructor(constructor)->parameters) {
    const auto found = given.find(p.name);
    arguments.push_back(found == given.end() ? p.default_value : found->second);
  }
  const Field field = make_field(constructor, arguments);
  benchmark::RegisterBenchmark(("feature/" + name).c_str(), search, field, size, false);
  benchmark::RegisterBenchmark(("feature_gradient/" + name).c_str(), search, field, size, true);
  benchmark::RegisterBenchmark(("feature_made/" + name).c_str(), make, constructor, arguments)
      ->Unit(benchmark::kMillisecond);
}

}  // namespace

void register_features() {
  const std::vector<Vec3> s_curve{{0.7, 2.6, 0},    {0.35, 3.05, 0},   {-0.75, 3, 0},
                                  {-0.85, 2.05, 0}, {0, 1.5, 0},       {0.85, 0.95, 0},
                                  {0.75, 0, 0},     {-0.35, -0.05, 0}, {-0.7, 0.4, 0}};
  add("s_curve", "bspline_curve", {{"control_points", s_curve}}, 3);
  add("curve_of_1000", "bspline_curve", {{"control_points", walk(1003)}}, 3);
  add("surface_16x16", "bspline_surface", {{"control_points", hills(16)}}, 3);
  add("helix", "helix", {{"radius", 1.0}, {"pitch", 0.7}}, 3);
  add("helix_with_ends", "helix",
      {{"radius", 1.0}, {"pitch", 0.7}, {"start", -720.0}, {"end", 720.0}}, 3);
  // About where the tree takes over from the formula.
  for (const size_t count : {most_in_formula / 4, most_in_formula, most_in_formula + 1}) {
    add("polyline_of_" + std::to_string(count), "polyline", {{"vertices", walk(count)}}, 3);
  }
  add("polyline_of_100000", "polyline", {{"vertices", walk(100001)}}, 3);
}

}  // namespace sardf::bench

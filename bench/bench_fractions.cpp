// Fractions and colour of three materials by the distances to three features, evaluated together
// with the field of the block with rounded edges: against the field alone, on one thread. Times are
// processor time.
#include <benchmark/benchmark.h>

#include "register.hpp"
#include "shapes.hpp"

namespace sardf::bench {
namespace {

void evaluate_outputs(benchmark::State& state, const std::vector<Expression>& outputs) {
  const Evaluator evaluator(outputs);
  Scratch<float> storage;
  float* const rows = storage.get(outputs.size() * side);
  std::vector<float*> out;
  for (size_t k = 0; k < outputs.size(); ++k) out.push_back(rows + k * side);
  for (auto _ : state) {
    for_rows<float>(Shape::blended_block, [&](const float* x, const float* y, const float* z) {
      evaluator.block(x, y, z, side, out.data());
      benchmark::DoNotOptimize(rows);
      benchmark::ClobberMemory();
    });
  }
  state.counters["points"] = benchmark::Counter(double(points_in_grid) * double(state.iterations()),
                                                benchmark::Counter::kIsRate);
  state.counters["instructions"] = double(evaluator.tape().instructions().size());
}

}  // namespace

void register_fractions() {
  const Expression field = shape(Shape::blended_block);
  const auto add = [](const std::string& name, const std::vector<Expression>& outputs) {
    benchmark::RegisterBenchmark(("fractions/" + name).c_str(), evaluate_outputs, outputs);
  };
  add("field", {field});
  for (const double exponent : {1.0, 2.0, 2.5}) {
    const Graded graded = graded_block(exponent);
    std::vector<Expression> all{field};
    all.insert(all.end(), graded.fractions.begin(), graded.fractions.end());
    all.insert(all.end(), graded.color.begin(), graded.color.end());
    const std::string by = "exponent:" + std::to_string(exponent).substr(0, 3);
    add(by + "/color", graded.color);
    add(by + "/field_fractions_color", all);
  }
}

}  // namespace sardf::bench

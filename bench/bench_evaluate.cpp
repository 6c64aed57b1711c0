// Points per second of bulk evaluation on one thread: the engine, hand-written loops, doubles,
// gradients, and each operation alone. Times are processor time, so other load hardly counts.
#include <benchmark/benchmark.h>

#include "hand_loops.hpp"
#include "register.hpp"
#include "sardf/constructor.hpp"
#include "sardf/constructor_of.hpp"
#include "sardf/ops.hpp"
#include "shapes.hpp"

namespace sardf::bench {
namespace {

void count(benchmark::State& state, size_t points) {
  state.counters["points"] =
      benchmark::Counter(double(points) * double(state.iterations()), benchmark::Counter::kIsRate);
}

template <class T>
void evaluate_shape(benchmark::State& state, Shape which) {
  const Evaluator evaluator(shape(which));
  alignas(64) T out[side];
  T* to = out;
  for (auto _ : state) {
    for_rows<T>(which, [&](const T* x, const T* y, const T* z) {
      evaluator.block(x, y, z, side, &to);
      benchmark::DoNotOptimize(out);
      benchmark::ClobberMemory();
    });
  }
  count(state, points_in_grid);
}

template <class T>
void differentiate_shape(benchmark::State& state, Shape which) {
  const Evaluator evaluator(shape(which));
  alignas(64) T out[side], gradient[3][side];
  T* to[3] = {gradient[0], gradient[1], gradient[2]};
  for (auto _ : state) {
    for_rows<T>(which, [&](const T* x, const T* y, const T* z) {
      evaluator.gradient_block(x, y, z, side, out, to);
      benchmark::DoNotOptimize(out);
      benchmark::ClobberMemory();
    });
  }
  count(state, points_in_grid);
}

void run_loop(benchmark::State& state, Shape which, Loop loop) {
  const Evaluator evaluator(shape(which));
  alignas(64) float out[side], expected[side];
  float* to = expected;
  // The hand-written loop computes the same function.
  float worst = 0;
  for_rows<float>(which, [&](const float* x, const float* y, const float* z) {
    loop(x, y, z, out, side);
    evaluator.block(x, y, z, side, &to);
    for (size_t i = 0; i < side; ++i) worst = std::max(worst, std::abs(out[i] - expected[i]));
  });
  if (!(worst < 2e-5f)) return state.SkipWithError("the hand-written loop differs");
  for (auto _ : state) {
    for_rows<float>(which, [&](const float* x, const float* y, const float* z) {
      loop(x, y, z, out, side);
      benchmark::DoNotOptimize(out);
      benchmark::ClobberMemory();
    });
  }
  count(state, points_in_grid);
}

void run_operation(benchmark::State& state, const OperationPointer& operation) {
  alignas(64) float in[max_arity][side], out[side];
  std::array<const float*, max_arity> at;
  for (size_t k = 0; k < max_arity; ++k) {
    at[k] = in[k];
    for (size_t i = 0; i < side; ++i) in[k][i] = float((i * (k + 3) * 7919) % 1000) * 0.004f - 2;
  }
  const Kernels& kernels = operation->kernels();
  for (auto _ : state) {
    kernels.value(operation->object(), at.data(), out, side);
    benchmark::DoNotOptimize(out);
    benchmark::ClobberMemory();
  }
  count(state, side);
}

/// An operation with parameters in the middle of what it takes.
template <class Op>
OperationPointer sample() {
  Op op{};
  if constexpr (requires { op.vertices; }) {
    using Point = typename decltype(op.vertices)::value_type;
    op.vertices = {Point{-2, -2}, Point{2, -1}, Point{1, 1.5}, Point{-1, 2}};
  }
  if constexpr (std::is_same_v<Op, Points>) op.at = {{-1, 0, 0}, {1, 1, 0}, {0, 0, 2}};
  if constexpr (std::is_same_v<Op, Ellipsoid>) op.radii = {3, 2, 1};
  if constexpr (std::is_same_v<Op, Ellipse>) op.radii = {3, 1};
  if constexpr (std::is_same_v<Op, IntegerPower>) op.exponent = 5;
  return make_operation(op);
}

void register_loops(const std::string& set, const HandLoops& loops) {
  const std::pair<Shape, Loop> all[] = {{Shape::spheres, loops.spheres},
                                        {Shape::block, loops.block},
                                        {Shape::blended_block, loops.blended_block}};
  for (const auto& [which, loop] : all) {
    benchmark::RegisterBenchmark(("hand_" + set + "/" + name(which)).c_str(), run_loop, which,
                                 loop);
  }
}

}  // namespace

void register_evaluation() {
  for (const Shape which : {Shape::spheres, Shape::block, Shape::blended_block}) {
    const std::string shape = "/" + name(which);
    benchmark::RegisterBenchmark(("evaluate_float" + shape).c_str(), evaluate_shape<float>, which);
    benchmark::RegisterBenchmark(("evaluate_double" + shape).c_str(), evaluate_shape<double>,
                                 which);
    benchmark::RegisterBenchmark(("gradient_float" + shape).c_str(), differentiate_shape<float>,
                                 which);
    benchmark::RegisterBenchmark(("gradient_double" + shape).c_str(), differentiate_shape<double>,
                                 which);
  }
#if defined(SARDF_X86)
  if (instruction_set() >= InstructionSet::avx2) register_loops("avx2", hand_loops_avx2());
  if (instruction_set() >= InstructionSet::avx512) register_loops("avx512", hand_loops_avx512());
#endif
  Ops::for_each([]<class Op>(std::type_identity<Op>) {
    benchmark::RegisterBenchmark(("operation/" + std::string(Op::name)).c_str(), run_operation,
                                 sample<Op>());
  });
}

}  // namespace sardf::bench

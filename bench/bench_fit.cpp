// Fitted functions: least squares in the plane, Ritz's method in space, at the papers' sizes.
#include <benchmark/benchmark.h>

#include "sardf/arithmetic.hpp"
#include "sardf/fit.hpp"

namespace sardf {
namespace {

void report(benchmark::State& state, const FitReport& r) {
  state.counters["unknowns"] = double(r.unknowns);
  state.counters["iterations"] = r.iterations;
  state.counters["residual"] = r.residual;
}

// 1 - u² + u³ Phi towards 1 - u / (1 + u), u the distance to a ring.
void least_squares(benchmark::State& state) {
  const double n = double(state.range(0));
  const Expression one = constant(1);
  const Expression u = abs(length(coordinate(0), coordinate(1) - one) - one);
  FitProblem p;
  p.grid = spline_grid({-2, -0.5, 0}, {2, 3.5, 0}, {n, n}, 3);
  p.start = one - u * u;
  p.factor = u * u * u;
  p.values = one - u / (one + u);
  for (auto _ : state) report(state, fit(p).report);
}

// A cube with a round hole: 1 on the hole, 0 on the four walls.
void ritz(benchmark::State& state) {
  const double n = double(state.range(0));
  const Expression x = coordinate(0), y = coordinate(1), one = constant(1);
  const Expression u1 = length(x, y) - constant(0.25), u2 = min(one - abs(x), one - abs(y));
  FitProblem p;
  p.grid = spline_grid({-1, -1, -1}, {1, 1, 1}, {n, n, n}, 3);
  p.start = u2 / (u1 + u2);
  p.factor = u1 * u2;
  p.solid = u1;
  p.smoothness = 1;
  for (auto _ : state) report(state, fit(p).report);
}

BENCHMARK(least_squares)->Arg(21)->Arg(81)->Unit(benchmark::kMillisecond);
BENCHMARK(ritz)->Arg(15)->Arg(31)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
}  // namespace sardf

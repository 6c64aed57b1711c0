#include <benchmark/benchmark.h>

#include "register.hpp"

int main(int count, char** arguments) {
  // Not before main: the operations' names are static objects.
  sardf::bench::register_evaluation();
  sardf::bench::register_features();
  sardf::bench::register_fractions();
  sardf::bench::register_meshing();
  benchmark::Initialize(&count, arguments);
  if (benchmark::ReportUnrecognizedArguments(count, arguments)) return 1;
  benchmark::RunSpecifiedBenchmarks();
}

// Table 1 of the SARDF paper: the time of an intersection and a union on n × n points of
// [-10, 10]², by four blends, with the paper's ratios beside ours.
//
// What is timed is what evaluation does at a node of a tree:
//   scalar   Operation::evaluate for one point of doubles, once for each point, as the paper did
//   double   Operation::evaluate for 256 points of doubles, two at a time
//   others   the operation's kernel for 256 points of floats, on each instruction set of the
//   machine
// The same loop calls every operation: x comes from an array made beforehand; y, one number for a
// row, is written 256 times per row into a buffer; results go to a buffer of 256 and are not looked
// at. Rows are cut into strips of 2048 points, so that all of this stays in the first cache for
// every n. The line "loop" has the time of the loop alone, which every other time includes.
//
// Times are the thread's processor time; the blends take turns within each run, and a ratio is the
// median of the ratios of the runs. Small grids are repeated within a run. On a machine with other
// work, pin the program to a core: taskset -c 1 table1.
//
// Before, it sums the grid of 1001 × 1001 points, R = 1, and compares with the golden sums: the
// doubles within the file's tolerance, floats within 2e-7 of the sum of the magnitudes. It ends
// with 1 if one differs.
#include <time.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>

#include "sardf/constructor.hpp"
#include "sardf/kernels.hpp"
#include "shapes.hpp"

namespace sardf::bench {
namespace {

constexpr size_t block = 256, strip = 8 * block;
constexpr double points_in_run = 1e7;
const std::vector<std::string> blends{"min_max", "r_function", "sardf", "sardf_c1"};
const std::vector<std::string> joins{"intersection", "union"};

OperationPointer make(const std::string& blend, const std::string& join, double radius) {
  const bool rounded = blend.starts_with("sardf");
  const BlendPointer made = rounded ? make_blend(blend, {radius}) : make_blend(blend, {});
  return join == "union" ? made->unite : made->intersection;
}

/// out = operation(in[0], in[1]) for n points.
template <class T>
struct Call;

template <>
struct Call<double> {
  const Operation* operation = nullptr;
  void operator()(const double* const* in, double* out, size_t n) const {
    operation->evaluate(in, out, n);
  }
};

/// The same, one point after the other.
struct CallForEach {
  const Operation* operation = nullptr;
  void operator()(const double* const* in, double* out, size_t n) const {
    for (size_t i = 0; i < n; ++i) {
      const double at[2] = {in[0][i], in[1][i]};
      out[i] = operation->evaluate(at);
    }
  }
};

template <>
struct Call<float> {
  Kernels::Value kernel;
  const void* object;
  void operator()(const float* const* in, float* out, size_t n) const {
    kernel(object, in, out, (n + 15) / 16 * 16);
  }
};

/// Does nothing, unknown to the compiler.
struct Nothing {
  template <class T>
  void operator()(const T* const*, T* out, size_t) const {
    asm volatile("" : : "r"(out) : "memory");
  }
};

/// Where the columns are, on a cache line's beginning, with room for a last block.
template <class T>
class Coordinates {
 public:
  explicit Coordinates(size_t n) : all_(n + 32, T(10)) {
    while (size_t(all_.data() + first_) % 64 != 0) ++first_;
    for (size_t i = 0; i < n; ++i) all_[first_ + i] = T(-10 + 20 * double(i) / double(n - 1));
  }
  const T* data() const { return all_.data() + first_; }

 private:
  std::vector<T> all_;
  size_t first_ = 0;
};

/// call on the grid's blocks; then seen(out, count).
template <class T, class Call, class Seen>
void for_blocks(const T* x, size_t n, const Call& call, Seen seen) {
  alignas(64) T y[block], out[block];
  for (size_t left = 0; left < n; left += strip) {
    const size_t right = std::min(n, left + strip);
    for (size_t row = 0; row < n; ++row) {
      std::fill_n(y, block, x[row]);
      for (size_t i = left; i < right; i += block) {
        const size_t count = std::min(block, right - i);
        const T* const in[2] = {x + i, y};
        call(in, out, count);
        seen(out, count);
      }
    }
  }
}

double seconds() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

double time_of(const std::function<void()>& work) {
  const double start = seconds();
  work();
  return seconds() - start;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + long(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// times[i][run], by turns.
std::vector<std::vector<double>> take_turns(const std::vector<std::function<void()>>& works,
                                            int runs) {
  std::vector<std::vector<double>> times(works.size());
  for (const auto& work : works) work();
  for (int run = 0; run < runs; ++run) {
    for (size_t i = 0; i < works.size(); ++i) times[i].push_back(time_of(works[i]));
  }
  return times;
}

double ratio(const std::vector<double>& times, const std::vector<double>& to) {
  std::vector<double> each(times.size());
  std::transform(times.begin(), times.end(), to.begin(), each.begin(), std::divides());
  return median(each);
}

/// The paper's ratios of SARDF to min or max and to the R-function.
const std::map<std::string, std::pair<double, double>> paper{{"intersection", {3.7, 2.1}},
                                                             {"union", {3.6, 1.9}}};

template <class T, class CallOf>
void time_blends(const std::string& path, size_t n, int runs, const CallOf& call_of) {
  const Coordinates<T> columns(n);
  const double points = double(n) * double(n);
  const int repeats = std::max(1, int(points_in_run / points));
  const auto work_of = [&](auto call) -> std::function<void()> {
    return [x = columns.data(), n, repeats, call] {
      for (int i = 0; i < repeats; ++i) for_blocks(x, n, call, [](const T*, size_t) {});
    };
  };
  for (const std::string& join : joins) {
    std::vector<std::function<void()>> works;
    for (const std::string& blend : blends) works.push_back(work_of(call_of(blend, join)));
    works.push_back(work_of(Nothing()));
    const auto times = take_turns(works, runs);
    const auto print = [&](const std::string& what, const std::vector<double>& time) {
      std::printf("%-9s %6zu  %-12s  %-10s  %8.3f", path.c_str(), n, join.c_str(), what.c_str(),
                  1e9 * median(time) / points / repeats);
    };
    for (size_t b = 0; b < blends.size(); ++b) {
      print(blends[b], times[b]);
      std::printf("  %7.2f  %7.2f  %8.2f", ratio(times[b], times[0]), ratio(times[b], times[1]),
                  ratio(times[b], times[2]));
      if (blends[b] == "sardf") {
        std::printf("   %.1f and %.1f", paper.at(join).first, paper.at(join).second);
      }
      std::printf("\n");
    }
    print("loop", times.back());
    std::printf("\n");
    std::fflush(stdout);
  }
}

std::vector<InstructionSet> instruction_sets() {
  std::vector<InstructionSet> sets;
  for (const auto set : {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512}) {
    if (set <= instruction_set()) sets.push_back(set);
  }
  return sets;
}

/// with(path, call_of) for the doubles and for each instruction set.
template <class With>
void for_paths(double radius, With with) {
  std::vector<OperationPointer> kept;
  const auto made = [&](const std::string& blend, const std::string& join) {
    return kept.emplace_back(make(blend, join, radius)).get();
  };
  with.template operator()<double>("scalar",
                                   [&](const std::string& blend, const std::string& join) {
                                     return CallForEach{made(blend, join)};
                                   });
  with.template operator()<double>("double",
                                   [&](const std::string& blend, const std::string& join) {
                                     return Call<double>{made(blend, join)};
                                   });
  for (const InstructionSet set : instruction_sets()) {
    with.template operator()<float>(instruction_set_name(set), [&](const std::string& blend,
                                                                   const std::string& join) {
      const Operation* operation = made(blend, join);
      return Call<float>{listed_kernels(set, operation->info().name)->value, operation->object()};
    });
  }
}

struct Sums {
  double sum = 0, magnitudes = 0, least = infinity, most = -infinity;
};

template <class T, class Call>
Sums sums_of(const Call& call) {
  constexpr size_t n = 1001;
  Sums sums;
  for_blocks(Coordinates<T>(n).data(), n, call, [&](const T* out, size_t count) {
    for (size_t i = 0; i < count; ++i) {
      sums.sum += out[i];
      sums.magnitudes += std::abs(double(out[i]));
      sums.least = std::min(sums.least, double(out[i]));
      sums.most = std::max(sums.most, double(out[i]));
    }
  });
  return sums;
}

struct Golden {
  double radius = 0, tolerance = 0;
  std::map<std::string, Sums> sums;  // by blend and join
};

double number_after(const std::string& text, const std::string& key) {
  const size_t at = text.find(key);
  if (at == std::string::npos) throw std::runtime_error("no " + key + " in the golden sums");
  return std::strtod(text.c_str() + at + key.size(), nullptr);
}

Golden read_golden() {
  std::ifstream file(SARDF_SOURCE_DIR "/tests/golden/sardf_table1_checksums.csv");
  std::string line;
  std::getline(file, line);
  Golden golden{number_after(line, "\"R\": "), number_after(line, "\"tolerance_abs\": "), {}};
  std::getline(file, line);
  for (const std::string& join : joins) {
    for (const char* blend : {"sardf", "min_max", "r_function"}) {
      Sums sums;
      int operation;
      std::getline(file, line);
      if (std::sscanf(line.c_str(), "%d,%lf,%lf,%lf,%lf", &operation, &sums.sum, &sums.magnitudes,
                      &sums.least, &sums.most) != 5) {
        throw std::runtime_error("cannot read the golden sums");
      }
      golden.sums[std::string(blend) + " " + join] = sums;
    }
  }
  return golden;
}

bool near(const Sums& a, const Sums& b, double by_sum, double by_extreme) {
  return std::abs(a.sum - b.sum) <= by_sum && std::abs(a.magnitudes - b.magnitudes) <= by_sum &&
         std::abs(a.least - b.least) <= by_extreme && std::abs(a.most - b.most) <= by_extreme;
}

/// Prints the sums; whether all agree. sardf_c1, which the file lacks, is compared with the
/// doubles.
bool check_sums() {
  Golden golden = read_golden();
  bool good = true;
  std::printf("Sums over 1001 × 1001 points, R = %g\n", golden.radius);
  for_paths(golden.radius, [&]<class T>(const std::string& path, const auto& call_of) {
    for (const std::string& join : joins) {
      for (const std::string& blend : blends) {
        const Sums sums = sums_of<T>(call_of(blend, join));
        const Sums& expected = golden.sums.try_emplace(blend + " " + join, sums).first->second;
        constexpr bool exact = std::is_same_v<T, double>;
        const bool same = exact ? near(sums, expected, golden.tolerance * std::abs(expected.sum),
                                       golden.tolerance)
                                : near(sums, expected, 2e-7 * expected.magnitudes, 1e-5);
        good = good && same;
        std::printf("%-9s %-12s  %-10s  %18.6f  off by %9.2e %s\n", path.c_str(), join.c_str(),
                    blend.c_str(), sums.sum, sums.sum - expected.sum, same ? "" : "WRONG");
      }
    }
  });
  return good;
}

/// S3, a block of seven blended parts, through whole evaluation with floats.
void time_blended_block(int runs) {
  const Evaluator sharp(shape(Shape::block)), first(shape(Shape::blended_block)),
      second(shape(Shape::blended_block, "sardf_c1"));
  const auto work_of = [](const Evaluator& evaluator) -> std::function<void()> {
    return [&evaluator] {
      alignas(64) float out[side];
      float* to = out;
      for_rows<float>(Shape::blended_block, [&](const float* x, const float* y, const float* z) {
        evaluator.block(x, y, z, side, &to);
      });
    };
  };
  const auto times = take_turns({work_of(sharp), work_of(first), work_of(second)}, runs);
  std::printf(
      "\nThe blended block S3, R = 0.5, %s: min_max %.2f, sardf %.2f, sardf_c1 %.2f ns per "
      "point; sardf/min_max %.2f, sardf_c1/sardf %.2f\n",
      instruction_set_name(instruction_set()).c_str(), 1e9 * median(times[0]) / points_in_grid,
      1e9 * median(times[1]) / points_in_grid, 1e9 * median(times[2]) / points_in_grid,
      ratio(times[1], times[0]), ratio(times[2], times[1]));
}

int run(int count, char** arguments) {
  CLI::App app("Times the blends on the grids of the SARDF paper's Table 1.", "table1");
  double radius = 1;
  std::vector<size_t> sizes{1001, 10001};
  int runs = 7;
  app.add_option("--radius", radius, "R of SARDF and SARDF C1")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--sizes", sizes, "points on a side; the paper's are 1001,10001,20001,30001")
      ->delimiter(',')
      ->check(CLI::Range(2, 100001))
      ->capture_default_str();
  app.add_option("--runs", runs, "runs to take medians of")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  CLI11_PARSE(app, count, arguments);

  const bool good = check_sums();
  std::printf("\nR = %g, medians of %d runs\n%-9s %6s  %-12s  %-10s  %8s  %7s  %7s  %8s   %s\n",
              radius, runs, "path", "n", "operation", "blend", "ns/point", "/min", "/R-func",
              "/sardf", "the paper's");
  for (const size_t n : sizes) {
    for_paths(radius, [&]<class T>(const std::string& path, const auto& call_of) {
      time_blends<T>(path, n, runs, call_of);
    });
  }
  time_blended_block(runs);
  if (!good) std::printf("Sums differ from the golden ones.\n");
  return good ? 0 : 1;
}

}  // namespace
}  // namespace sardf::bench

int main(int count, char** arguments) {
  try {
    return sardf::bench::run(count, arguments);
  } catch (const std::exception& error) {
    std::cerr << "table1: " << error.what() << "\n";
    return 1;
  }
}

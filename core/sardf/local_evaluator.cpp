#include "sardf/local_evaluator.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <span>
#include <vector>

#include "sardf/local_programs.hpp"
#include "sardf/numbers/lanes.hpp"
#include "sardf/shorten.hpp"

namespace sardf {

namespace {

using local::Cube;
using local::length;

constexpr size_t block_size = Evaluator::block_size;
// A program is tried when so many times the points have been evaluated that could have been
// meanwhile.
constexpr double patience = 1;
// A program of fewer instructions takes hardly longer than what there is to save.
constexpr double long_program = 32;
constexpr int most_levels = 8;
// Points that lie too far apart for a cube are sorted by octants if their evaluation would take
// this long. A few points take as long as one set of lanes.
constexpr double worth_sorting = 10e-6;
constexpr size_t lanes = 16;
// The like for gradients. They tell programs apart where one of them has NaN: there nothing may
// depend on times, or on what was evaluated before. A few levels are made at once instead.
constexpr double long_for_gradients = 200, long_gradient_work = 20'000;
constexpr int most_gradient_levels = 6;

// A surface meets 6 4^n cubes of an edge 2^-n times its own, or so: their programs shall have room,
// even if they are hardly shorter.
int gradient_levels(const Evaluator& whole) {
  constexpr double most_instructions = 4e6;
  int levels = most_gradient_levels;
  while (levels > 1 && length(whole) * 6 * std::pow(4, levels - 1) > most_instructions) --levels;
  return levels;
}

// The shortest of some times: others may have had the processor meanwhile.
template <class Work>
double seconds_of(Work work) {
  using Clock = std::chrono::steady_clock;
  constexpr int times = 3;
  double shortest = infinity;
  for (int i = 0; i < times; ++i) {
    const Clock::time_point begin = Clock::now();
    work();
    shortest = std::min(shortest, std::chrono::duration<double>(Clock::now() - begin).count());
  }
  return shortest;
}

// In single precision, along the box's diagonal.
double seconds_per_point(const Evaluator& evaluator, const BoundingBox& box) {
  float at[3][block_size];
  for (size_t axis = 0; axis < 3; ++axis) {
    const double step = (box.hi[axis] - box.lo[axis]) / block_size;
    for (size_t i = 0; i < block_size; ++i) at[axis][i] = float(box.lo[axis] + double(i) * step);
  }
  std::vector<float> values(evaluator.outputs() * block_size);
  std::vector<float*> out;
  for (size_t k = 0; k < evaluator.outputs(); ++k) out.push_back(&values[k * block_size]);
  const auto evaluate = [&] { evaluator.block(at[0], at[1], at[2], block_size, out.data()); };
  return seconds_of(evaluate) / block_size;
}

template <class T>
using LanesOf = Lanes<std::conditional_t<std::is_same_v<T, float>, Baseline, TwoDoubles>>;

// The least and the greatest of the numbers; false where one of them is not finite.
template <class T>
bool find_range(const T* numbers, size_t n, double& least, double& greatest) {
  using L = LanesOf<T>;
  // 0 times what is not finite is NaN. Several of each, since one would wait for the step before.
  constexpr size_t rows = 4, at_once = rows * L::width;
  T lowest = numbers[0], highest = lowest, rest = lowest * 0;
  size_t i = 0;
  if (n >= at_once) {
    std::array<L, rows> low, high, zeros;
    low.fill(L{double(lowest)});
    high.fill(L{double(lowest)});
    zeros.fill(L{0.0});
    for (; i + at_once <= n; i += at_once) {
      for (size_t k = 0; k < rows; ++k) {
        const L here = L::load(numbers + i + k * L::width);
        low[k] = min(low[k], here);
        high[k] = max(high[k], here);
        zeros[k] = zeros[k] + here * L(0.0);
      }
    }
    const L all_low = min(min(low[0], low[1]), min(low[2], low[3]));
    const L all_high = max(max(high[0], high[1]), max(high[2], high[3]));
    const L all_zeros = (zeros[0] + zeros[1]) + (zeros[2] + zeros[3]);
    for (int k = 0; k < L::width; ++k) {
      lowest = std::min(lowest, all_low.v[k]);
      highest = std::max(highest, all_high.v[k]);
      rest += all_zeros.v[k];
    }
  }
  for (; i < n; ++i) {
    lowest = std::min(lowest, numbers[i]);
    highest = std::max(highest, numbers[i]);
    rest += numbers[i] * 0;
  }
  least = lowest;
  greatest = highest;
  return rest == 0;
}

// Coordinates as arrays, n of them.
template <class T>
struct Points {
  std::array<const T*, 3> at;
  size_t n;

  Vec3 point(size_t i) const { return {at[0][i], at[1][i], at[2][i]}; }
  bool find_box(BoundingBox& box) const {
    for (size_t axis = 0; axis < 3; ++axis) {
      if (!find_range(at[axis], n, box.lo[axis], box.hi[axis])) return false;
    }
    return true;
  }
};

// Points sorted by the octants that they lie in, and room for their results.
template <class T>
class Octants {
 public:
  Octants(const Points<T>& points, const Vec3& center, size_t rows)
      : count_(points.n), results_(rows * block_size) {
    std::array<uint8_t, block_size> of;
    for (size_t i = 0; i < count_; ++i) {
      of[i] = uint8_t(Cube::octant(center, points.point(i)));
      ++begin_[size_t(of[i]) + 1];
    }
    for (size_t k = 0; k < 8; ++k) begin_[k + 1] += begin_[k];
    std::array<size_t, 8> next;
    std::copy_n(begin_.begin(), 8, next.begin());
    for (size_t i = 0; i < count_; ++i) {
      const size_t to = next[of[i]]++;
      place_[i] = uint16_t(to);
      for (size_t axis = 0; axis < 3; ++axis) at_[axis][to] = points.at[axis][i];
    }
  }

  Points<T> points(size_t k) const {
    const auto from = [&](size_t axis) { return at_[axis].data() + begin_[k]; };
    return {{from(0), from(1), from(2)}, begin_[k + 1] - begin_[k]};
  }
  size_t most() const {
    size_t result = 0;
    for (size_t k = 0; k < 8; ++k) result = std::max(result, begin_[k + 1] - begin_[k]);
    return result;
  }
  std::vector<T*> results(size_t k) {
    std::vector<T*> rows;
    for (size_t row = 0; row < results_.size() / block_size; ++row)
      rows.push_back(&results_[row * block_size + begin_[k]]);
    return rows;
  }
  void write(std::span<T* const> rows) const {
    for (size_t row = 0; row < rows.size(); ++row)
      for (size_t i = 0; i < count_; ++i) rows[row][i] = results_[row * block_size + place_[i]];
  }

 private:
  size_t count_;
  std::array<size_t, 9> begin_{};
  std::array<std::array<T, block_size>, 3> at_;
  std::array<uint16_t, block_size> place_;
  std::vector<T> results_;
};

// What it takes to find programs for points.
struct Search {
  const Evaluator& whole;
  Cube& root;
  double long_work;  // instructions times points from which on it is worth it to sort points
  bool waits;        // for programs to be worth it
  int levels;
};

// run(program, points, rows) for all the points, with programs that are good for them.
template <class T, class Run>
void evaluate(const Search& search, const Points<T>& points, std::span<T* const> rows,
              const Run& run) {
  const Evaluator* program = &search.whole;
  BoundingBox box;
  // Points far outside, as of shadow rays, are not worth being told apart.
  if (!points.find_box(box) || !search.root.is_good_for(box)) return run(*program, points, rows);
  const Vec3 center = box.center();
  Cube* cube = &search.root;
  for (int level = 0; level < search.levels && cube->is_good_for(box); ++level) {
    // A cube's program is made from the one around it: what is not there yet ends the search, also
    // if another thread is just making it.
    const bool was_tried = !search.waits || cube->is_tried();
    program = search.waits ? &cube->program_after(points.n, *program) : &cube->program(*program);
    if (!was_tried || length(*program) <= local::short_program ||
        (!search.waits && !cube->is_promising()))
      return run(*program, points, rows);
    cube = &cube->child(Cube::octant(cube->center(), center));
  }
  const double work = length(*program) * double(std::max(points.n, lanes));
  const Vec3 size = box.size();
  // What would fit into the next cube, but does not, lies outside of all of them.
  if (cube->is_good_for(box) || std::max({size[0], size[1], size[2]}) <= cube->edge() ||
      work < search.long_work)
    return run(*program, points, rows);
  Octants<T> octants(points, center, rows.size());
  // Numbers next to each other have none between them.
  if (octants.most() == points.n) return run(*program, points, rows);
  for (size_t k = 0; k < 8; ++k) {
    if (octants.points(k).n > 0) evaluate<T>(search, octants.points(k), octants.results(k), run);
  }
  octants.write(rows);
}

template <class T>
void evaluate_values(const Search& search, const Points<T>& points, T* const* out) {
  const auto run = [](const Evaluator& program, const Points<T>& of, std::span<T* const> rows) {
    program.block(of.at[0], of.at[1], of.at[2], of.n, rows.data());
  };
  evaluate<T>(search, points, {out, search.whole.outputs()}, run);
}

}  // namespace

LocalEvaluator::LocalEvaluator() = default;
LocalEvaluator::~LocalEvaluator() = default;
LocalEvaluator::LocalEvaluator(LocalEvaluator&&) noexcept = default;
LocalEvaluator& LocalEvaluator::operator=(LocalEvaluator&&) noexcept = default;

LocalEvaluator::LocalEvaluator(Evaluator whole, const BoundingBox& box) : whole_(std::move(whole)) {
  const Vec3 size = box.size();
  const double half = 0.5 * std::max({size[0], size[1], size[2]});
  if (length(whole_) < long_program || !(half > 0 && half < infinity)) return;
  const double seconds = seconds_of([&] { Shortening(whole_, box).shortened(); });
  const double per_point = seconds_per_point(whole_, box), wait = patience * seconds / per_point;
  long_work_ = worth_sorting / per_point * length(whole_);
  gradient_levels_ = gradient_levels(whole_);
  // Of the whole box seldom anything can be left out: that shall not make the first parts wait.
  experience_ = std::make_unique<local::Experience>(wait);
  root_ = std::make_unique<Cube>(box.center(), half, wait / local::more_patience, *experience_);
}

void LocalEvaluator::block(const float* x, const float* y, const float* z, size_t n,
                           float* const* out) const {
  if (!root_ || n == 0 || experience_->is_hopeless()) return whole_.block(x, y, z, n, out);
  evaluate_values<float>({whole_, *root_, long_work_, true, most_levels}, {{x, y, z}, n}, out);
}
void LocalEvaluator::block(const double* x, const double* y, const double* z, size_t n,
                           double* const* out) const {
  if (!root_ || n == 0 || experience_->is_hopeless()) return whole_.block(x, y, z, n, out);
  evaluate_values<double>({whole_, *root_, long_work_, true, most_levels}, {{x, y, z}, n}, out);
}

void LocalEvaluator::gradient_block(const float* x, const float* y, const float* z, size_t n,
                                    float* out, float* const* gradient) const {
  const auto run = [](const Evaluator& program, const Points<float>& of,
                      std::span<float* const> to) {
    program.gradient_block(of.at[0], of.at[1], of.at[2], of.n, to[0], &to[1]);
  };
  const std::array<float*, 4> rows{out, gradient[0], gradient[1], gradient[2]};
  const Points<float> points{{x, y, z}, n};
  if (root_ && n > 0 && length(whole_) >= long_for_gradients) {
    evaluate<float>({whole_, *root_, long_gradient_work, false, gradient_levels_}, points, rows,
                    run);
  } else {
    run(whole_, points, rows);
  }
  // -0 + 0 = 0
  for (size_t axis = 0; axis < 3; ++axis)
    for (size_t i = 0; i < n; ++i) gradient[axis][i] += 0.0f;
}

}  // namespace sardf

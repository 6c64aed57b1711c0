// Evaluation by programs for where points lie gives the same bits, and leaves out what is far away.
#include "sardf/local_evaluator.hpp"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <cmath>
#include <cstring>

#include "laws.hpp"
#include "sardf/arithmetic.hpp"
#include "sardf/blend.hpp"
#include "sardf/local_programs.hpp"
#include "sardf/operation_of.hpp"

namespace sardf {
namespace {

using laws::Random;

constexpr double reaches[] = {0, 0.01, 0.1, 0.5, 3};

constexpr size_t most = Evaluator::block_size;

// A ball that tells how often it was asked.
struct CountingBall {
  static constexpr const char *name = "counting_ball", *doc = "For tests.";
  static constexpr Kind kind = Kind::solid;
  static constexpr int arity = 3;
  static inline std::atomic<size_t> calls{0};
  Vec3 center{};
  template <class T>
  T eval(T x, T y, T z) const {
    ++calls;
    return T(0.05) - length(x - T(center[0]), y - T(center[1]), z - T(center[2]));
  }
};

Expression ball(const Vec3& center, double radius) {
  return make_field("sphere", {center, radius}).expression();
}

constexpr BoundingBox unit{{0, 0, 0}, {1, 1, 1}};

Vec3 in_unit(Random& r) {
  return {laws::number_in(r, {0, 1}), laws::number_in(r, {0, 1}), laws::number_in(r, {0, 1})};
}

// Balls in the unit cube, joined by a blend.
Expression balls(int count, Random& r) {
  const BlendPointer blend = make_blend("sardf", {Value(0.03)});
  Expression all = ball({0.5, 0.5, 0.5}, 0.05);
  for (int i = 1; i < count; ++i) all = call(blend->unite, {all, ball(in_unit(r), 0.05)});
  return all;
}

template <class T>
struct Batch {
  size_t n = most;
  T xyz[3][most];

  // Around a place, or anywhere.
  Batch(Random& r, double reach) : n(1 + size_t(r.below(int(most)))) {
    const Vec3 middle = in_unit(r);
    for (size_t i = 0; i < n; ++i) {
      const Vec3 other = in_unit(r);
      for (size_t axis = 0; axis < 3; ++axis)
        xyz[axis][i] = T(middle[axis] + reach * (other[axis] - 0.5));
    }
  }
};

template <class T>
bool same(T a, T b) {
  return std::memcmp(&a, &b, sizeof a) == 0 || (std::isnan(a) && std::isnan(b));
}

template <class T>
void expect_same_values(const LocalEvaluator& local, const Batch<T>& batch) {
  const size_t outputs = local.outputs();
  std::vector<T> one(outputs * most), other(outputs * most);
  std::vector<T*> to, again;
  for (size_t k = 0; k < outputs; ++k) {
    to.push_back(&one[k * most]);
    again.push_back(&other[k * most]);
  }
  const auto& [n, xyz] = batch;
  local.block(xyz[0], xyz[1], xyz[2], n, to.data());
  local.whole().block(xyz[0], xyz[1], xyz[2], n, again.data());
  for (size_t k = 0; k < outputs; ++k)
    for (size_t i = 0; i < n; ++i)
      ASSERT_TRUE(same(to[k][i], again[k][i])) << to[k][i] << " " << again[k][i];
}

struct Gradients {
  float value[most], by[3][most];

  template <class Of>
  Gradients(const Of& of, const Batch<float>& batch) {
    float* const rows[3] = {by[0], by[1], by[2]};
    of.gradient_block(batch.xyz[0], batch.xyz[1], batch.xyz[2], batch.n, value, rows);
  }
};

TEST(LocalEvaluator, HasTheSameBitsNearByAndFarApart) {
  Random r(91);
  const Expression field = balls(120, r), other = balls(40, r);
  const Expression outputs[] = {field, min(field, -other), constant(2) * other};
  const LocalEvaluator local(Evaluator(outputs), unit);
  for (int i = 0; i < laws::effort(600) && !testing::Test::HasFailure(); ++i) {
    const double reach = r.one_of(reaches);
    expect_same_values(local, Batch<float>(r, reach));
    expect_same_values(local, Batch<double>(r, reach));
  }
}

TEST(LocalEvaluator, HasTheSameBitsForWhatIsNoPlace) {
  Random r(92);
  const LocalEvaluator local(Evaluator(balls(60, r)), unit);
  for (const float odd : {NAN, INFINITY, -INFINITY, 1e30f, -0.0f}) {
    for (int i = 0; i < 100; ++i) {
      Batch<float> batch(r, 0.05);
      batch.xyz[i % 3][size_t(r.below(int(batch.n)))] = odd;
      expect_same_values(local, batch);
    }
  }
}

TEST(LocalEvaluator, HasTheSameBitsAtOnePlaceManyTimes) {
  Random r(98);
  const LocalEvaluator local(Evaluator(balls(300, r)), unit);
  for (const float place : {0.3f, 1.4f, 1.9f, -7.0f, 1e6f}) {
    Batch<float> batch(r, 0);
    batch.n = most;
    for (auto& row : batch.xyz) std::fill_n(row, most, place);
    for (int i = 0; i < 100; ++i) expect_same_values(local, batch);
    const Gradients one(local, batch), other(local.whole(), batch);
    EXPECT_TRUE(same(one.by[0][most / 2], other.by[0][most / 2] + 0.0f));
  }
}

TEST(LocalEvaluator, LeavesOutWhatIsFarAway) {
  Random r(93);
  const Expression field = balls(60, r);
  const Expression with = max(field, call(make_operation(CountingBall{{0.95, 0.95, 0.95}}),
                                          {coordinate(0), coordinate(1), coordinate(2)}));
  const LocalEvaluator local(Evaluator(with), unit);
  float out[most];
  float* to = out;
  Batch<float> batch(r, 0);
  batch.n = most;
  for (auto& row : batch.xyz)
    for (float& each : row) each = float(laws::number_in(r, {0.1, 0.15}));
  const auto& [n, xyz] = batch;
  bool is_left_out = false;
  size_t before = 0;
  for (int i = 0; i < 20000 && !is_left_out; ++i) {
    before = CountingBall::calls;
    local.block(xyz[0], xyz[1], xyz[2], n, &to);
    is_left_out = CountingBall::calls == before;
  }
  EXPECT_TRUE(is_left_out);
  local.whole().block(xyz[0], xyz[1], xyz[2], n, &to);
  EXPECT_GT(CountingBall::calls, before);
}

// The angle is 0 where x < 0.4, with no derivative.
Expression balls_and_step(Random& r) {
  const Expression step = function("acos", {min(constant(1.4) - coordinate(0), constant(1))});
  return max(balls(150, r), coordinate(1) - constant(0.5) + step);
}

TEST(LocalEvaluator, HasTheSameGradients) {
  Random r(94);
  const LocalEvaluator local(Evaluator(balls_and_step(r)), unit);
  for (int i = 0; i < laws::effort(300) && !testing::Test::HasFailure(); ++i) {
    const Batch<float> batch(r, r.one_of(reaches));
    const Gradients one(local, batch), other(local.whole(), batch);
    for (size_t k = 0; k < batch.n; ++k) {
      ASSERT_TRUE(same(one.value[k], other.value[k]));
      for (size_t axis = 0; axis < 3; ++axis)
        ASSERT_TRUE(std::isnan(other.by[axis][k]) ||
                    same(one.by[axis][k], other.by[axis][k] + 0.0f))
            << one.by[axis][k] << " " << other.by[axis][k];
    }
  }
}

// Also where the whole program has none: not what was evaluated before, nor how long that took.
TEST(LocalEvaluator, HasTheSameGradientsWheneverItIsAsked) {
  Random r(94);
  const Evaluator whole(balls_and_step(r));
  const LocalEvaluator used(whole, unit);
  float values[most];
  float* to = values;
  for (int i = 0; i < laws::effort(2000); ++i) {
    const Batch<float> batch(r, 0.05);
    used.block(batch.xyz[0], batch.xyz[1], batch.xyz[2], batch.n, &to);
  }
  size_t numbers = 0;
  for (int i = 0; i < 100 && !testing::Test::HasFailure(); ++i) {
    const Batch<float> batch(r, r.one_of(reaches));
    const LocalEvaluator fresh(whole, unit);
    const Gradients one(used, batch), other(fresh, batch), without(whole, batch);
    for (size_t axis = 0; axis < 3; ++axis)
      for (size_t k = 0; k < batch.n; ++k) {
        ASSERT_TRUE(same(one.by[axis][k], other.by[axis][k]));
        numbers += std::isnan(without.by[axis][k]) && !std::isnan(one.by[axis][k]);
      }
  }
  EXPECT_GT(numbers, 0u);
}

TEST(LocalEvaluator, HasTheSameBitsOnAllThreads) {
  Random r(95);
  const LocalEvaluator local(Evaluator(balls(120, r)), unit);
  std::vector<Batch<float>> batches;
  for (int i = 0; i < 64; ++i) batches.emplace_back(r, 0.1);
  tbb::parallel_for(0, 64 * 20, [&](int i) { expect_same_values(local, batches[size_t(i % 64)]); });
}

TEST(LocalPrograms, AreShorterTheSmallerTheCube) {
  Random r(96);
  const Evaluator whole(balls(200, r));
  local::Experience experience{0};
  local::Cube root({0.5, 0.5, 0.5}, 0.5, 0, experience);
  local::Cube* cube = &root;
  const Evaluator* program = &whole;
  const BoundingBox place{{0.3, 0.3, 0.3}, {0.31, 0.31, 0.31}};
  size_t steps = whole.tape().instructions().size();
  for (int level = 0; level < 6; ++level) {
    ASSERT_TRUE(cube->is_good_for(place));
    program = &cube->program_after(1, *program);
    EXPECT_LE(program->tape().instructions().size(), steps);
    steps = program->tape().instructions().size();
    cube = &cube->child(local::Cube::octant(cube->center(), place.center()));
  }
  EXPECT_LT(steps, 60u);
  EXPECT_FALSE(cube->is_good_for(unit));
  EXPECT_EQ(program->value({0.305, 0.302, 0.309}), whole.value({0.305, 0.302, 0.309}));
}

TEST(LocalPrograms, WaitForPoints) {
  Random r(97);
  const Evaluator whole(balls(50, r));
  local::Experience experience{0};
  local::Cube cube({0.2, 0.2, 0.2}, 0.02, 100, experience);
  EXPECT_EQ(&cube.program_after(60, whole), &whole);
  EXPECT_FALSE(cube.is_tried());
  EXPECT_NE(&cube.program_after(60, whole), &whole);
  EXPECT_TRUE(cube.is_tried());
}

}  // namespace
}  // namespace sardf

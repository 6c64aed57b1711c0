// Expressions: equal ones are one node, shared ones run once, and depth costs no stack.
#include <gtest/gtest.h>
#include <pthread.h>
#include <tbb/global_control.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <functional>
#include <thread>

#include "laws.hpp"
#include "sanitized.hpp"
#include "sardf/arithmetic.hpp"
#include "sardf/certify.hpp"
#include "sardf/shorten.hpp"

namespace sardf {
namespace {

const Expression x = coordinate(0), y = coordinate(1), z = coordinate(2);

TEST(Graph, EqualExpressionsAreOneNode) {
  EXPECT_EQ(x + y, x + y);
  EXPECT_NE(x + y, y + x);
  EXPECT_EQ(constant(2), constant(2));
  EXPECT_NE(constant(0.0), constant(-0.0));
  const auto sphere = [](double radius) {
    return make_field("sphere", {Vec3{}, radius}).expression();
  };
  EXPECT_EQ(sphere(1), sphere(1));
  EXPECT_NE(sphere(1), sphere(2));
}

TEST(Graph, ConstantsAreFolded) {
  const Expression folded = constant(2) * constant(3) + constant(1);
  ASSERT_TRUE(is_constant(folded));
  EXPECT_EQ(folded->value, 7);
}

TEST(Graph, SharedPartsRunOnce) {
  // Written out, the 40 levels have 2^40 leaves.
  Expression doubled = x * y;
  for (int i = 0; i < 40; ++i) doubled = doubled + doubled;
  const Evaluator evaluator(doubled);
  EXPECT_EQ(evaluator.tape().instructions().size(), 41u);
  EXPECT_EQ(evaluator.value({3, 5, 0}), 15 * 0x1p40);
}

TEST(Graph, OutputsShareTheirParts) {
  const Expression part = sardf::length(x, y) + z;
  const std::vector<Expression> outputs{part * part, part + constant(1), part};
  const Evaluator evaluator(outputs);
  EXPECT_EQ(evaluator.tape().instructions().size(), 4u);
  double out[3];
  evaluator.values(Vec3{3, 4, 1}, out);
  EXPECT_EQ(out[0], 36);
  EXPECT_EQ(out[1], 7);
  EXPECT_EQ(out[2], 6);
}

TEST(Graph, RegistersAreReused) {
  Expression chain = x;
  for (int i = 0; i < 1000; ++i) chain = sin(i) > 2 ? chain : abs(chain + y);
  EXPECT_LT(Evaluator(chain).tape().registers(), 10u);
}

// They stay in their registers from one block to the next.
TEST(Graph, ConstantsAreThoseOfTheProgramAtEveryPoint) {
  constexpr size_t most = Evaluator::block_size;
  const Evaluator one(constant(2) * x + constant(3)), other(constant(5) * x * y + constant(7)),
      copy = one;
  std::vector<float> at(most, 0.5f), out(most);
  const auto expect = [&](const Evaluator& evaluator, size_t n, float value) {
    float* to = out.data();
    evaluator.block(at.data(), at.data(), at.data(), n, &to);
    for (size_t i = 0; i < n; ++i) EXPECT_EQ(out[i], value) << i << " of " << n;
  };
  for (const size_t n : {size_t(1), size_t(16), size_t(17), most, size_t(5)}) {
    expect(one, n, 4);
    expect(one, n, 4);
    expect(other, n, 8.25f);
    expect(copy, n, 4);
  }
  for (const size_t n : {size_t(1), most}) expect(one, n, 4);
  // The registers of gradients are others, with the same beginning.
  std::vector<float> slope(3 * most);
  float* const to[3] = {&slope[0], &slope[most], &slope[2 * most]};
  other.gradient_block(at.data(), at.data(), at.data(), most, out.data(), to);
  EXPECT_EQ(out[most - 1], 8.25f);
  EXPECT_EQ(to[0][most - 1], 2.5f);
  expect(one, most, 4);
}

TEST(Graph, GradientsOfCoordinatesAndConstants) {
  const double at[3] = {2, 3, 4};
  const auto gradient = [&](const Expression& of) {
    Vec3 out;
    double value;
    Evaluator(of).gradients(at, 1, &value, out.data());
    EXPECT_EQ(value, Evaluator(of).value({2, 3, 4}));
    return out;
  };
  EXPECT_EQ(gradient(y), (Vec3{0, 1, 0}));
  EXPECT_EQ(gradient(constant(5)), (Vec3{0, 0, 0}));
  EXPECT_EQ(gradient(x * constant(5)), (Vec3{5, 0, 0}));
  EXPECT_EQ(gradient(x * x + y * z), (Vec3{4, 4, 3}));
  // A branch that is not taken does not count, whatever its gradient is.
  const Expression undefined = sardf::length(x - constant(2), y - constant(3));
  EXPECT_EQ(gradient(max(undefined, z)), (Vec3{0, 0, 1}));
}

TEST(Graph, SubstitutionKeepsSharing) {
  const Expression part = x * y;
  const std::vector<Expression> both{part + z, part - z};
  const std::vector<Expression> moved = substitute(both, {x + constant(1), y, z});
  EXPECT_EQ(moved[0]->inputs[0], moved[1]->inputs[0]);
  EXPECT_EQ(Evaluator(moved[0]).value({2, 5, 7}), 22);
}

/// Runs work on a thread with 256 KiB of stack, where a recursion 100 000 deep has no room.
void on_small_stack(std::function<void()> work) {
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  ASSERT_EQ(pthread_attr_setstacksize(&attributes, 256 * 1024), 0);
  pthread_t thread;
  const auto call = [](void* f) -> void* {
    (*static_cast<std::function<void()>*>(f))();
    return nullptr;
  };
  ASSERT_EQ(pthread_create(&thread, &attributes, call, &work), 0);
  pthread_join(thread, nullptr);
  pthread_attr_destroy(&attributes);
}

// Levels of min(a, i) joined by sardf with y: no level folds away or repeats.
Expression deep_tree(int levels) {
  const BlendPointer blend = make_blend("sardf", {0.5});
  Expression deep = x;
  for (int i = 0; i < levels; i += 2) {
    deep = call(blend->unite, {call(blend->intersection, {deep, constant(i + 1)}), y});
  }
  return deep;
}

TEST(DeepGraph, NeedsNoStack) {
  const size_t before = live_nodes();
  on_small_stack([] {
    Expression deep = deep_tree(100000);
    const Expression moved = substitute(deep, {x + constant(1), y, z});
    const Evaluator evaluator(moved), original(deep);
    // 256 of the 50 000 constants have a register of their own.
    EXPECT_EQ(evaluator.tape().instructions().size(), 100001u + 50000 - 256);
    EXPECT_EQ(evaluator.value({1, 3, 0}), original.value({2, 3, 0}));
    const BoundingBox box{{0, 2, 0}, {2, 4, 0}};
    const double value = evaluator.value({1, 3, 0});
    EXPECT_TRUE(evaluator.interval(box).contains(value));
    EXPECT_FALSE(std::isnan(evaluator.slope(box).length));
    EXPECT_EQ(Shortening(evaluator, box).shortened().value({1, 3, 0}), value);
    EXPECT_NEAR(error_bound(moved), 100000 * 0.5 * (1 - std::sqrt(0.5)), 1e-6);
    std::vector<float> points(3 * 16, 2), out(16), gradient(3 * 16);
    evaluator.values(points.data(), 16, out.data());
    // A hundred thousand roundings.
    EXPECT_NEAR(out[0], evaluator.value({2, 2, 2}), 2e-3);
    evaluator.gradients(points.data(), 16, out.data(), gradient.data());
    EXPECT_FALSE(std::isnan(gradient[0]));
    const double point[3] = {2, 2, 2};
    double exact, slope[3];
    evaluator.gradients(point, 1, &exact, slope);
    EXPECT_EQ(exact, evaluator.value({2, 2, 2}));
  });
  EXPECT_EQ(live_nodes(), before);
}

// A chain of fields holds constructions as well as expressions.
TEST(DeepGraph, FieldsNeedNoStack) {
  const size_t before = live_nodes();
  on_small_stack([] {
    Field deep = make_field("sphere", {Vec3{}, 1.0});
    for (int i = 0; i < 100000; ++i) {
      deep = make_field("offset", {deep, 1.0 + i});
    }
    EXPECT_LT(Evaluator(deep.expression()).value({0, 0, 0}), infinity);
  });
  EXPECT_EQ(live_nodes(), before);
}

// A union of half a million balls in a row, each beside the next.
TEST(DeepGraphSlow, MayHaveAMillionNodes) {
  const size_t before = live_nodes();
  on_small_stack([] {
    constexpr int count = 500000;
    std::vector<Field> balls;
    for (int i = 0; i < count; ++i) {
      balls.push_back(make_field("sphere", {Vec3{3.0 * i, 0, 0}, 1.0}));
    }
    const Field all = make_field("union", {balls, make_blend("min_max", {})});
    balls.clear();
    const Evaluator full(all.expression());
    EXPECT_EQ(full.tape().instructions().size(), 2u * count - 1);
    EXPECT_EQ(full.value({3.0 * 70000, 0, 0.25}), 0.75);
    const double middle = 3.0 * 400000;
    const Shortening near(full, {{middle - 1, -1, -1}, {middle + 1, 1, 1}});
    EXPECT_LT(near.shortened().tape().instructions().size(), 6u);
    EXPECT_EQ(near.shortened().value({middle, 0.5, 0}), 0.5);
  });
  EXPECT_EQ(live_nodes(), before);
}

// Constants do not need a register each: 256 points of all of them would take a gigabyte.
TEST(DeepGraphSlow, MayHaveManyConstants) {
  Expression sum = x;
  double expected = 2;
  for (int i = 1; i <= 100000; ++i) {
    sum = max(sum, y - constant(i + 0.25)) + constant(0.5 * i);
    expected = std::max(expected, 2.75 - i) + 0.5 * i;
  }
  const Evaluator full(sum);
  EXPECT_LT(full.tape().registers(), 300u);
  EXPECT_EQ(full.value({2, 3, 0}), expected);
  const Evaluator shorter = Shortening(full, {{1, 2, 0}, {3, 4, 0}}).shortened();
  EXPECT_EQ(shorter.value({2, 3, 0}), expected);
  EXPECT_LT(shorter.tape().registers(), 300u);
  const double at[3] = {2, 3, 0};
  double value, gradient[3];
  full.gradients(at, 1, &value, gradient);
  EXPECT_EQ(value, expected);
  EXPECT_EQ(gradient[0] + gradient[1], 1);
  EXPECT_TRUE(full.interval({{2, 3, 0}, {2, 3, 0}}).contains(expected));
}

TEST(Graph, NodesOfAnotherThreadAreFreed) {
  const size_t before = live_nodes();
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([t] {
      laws::Random r{uint64_t(t % 2)};
      for (int i = 0; i < 200; ++i) laws::random_field(r, 1);
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(live_nodes(), before);
}

class ManyPoints : public testing::Test {
 protected:
  ManyPoints() : evaluator_(laws::random_field(random_, 2).expression()), points_(3 * count) {
    for (float& a : points_) a = float(random_.ordinary());
    exact_.assign(points_.begin(), points_.end());
  }
  static constexpr size_t count = 100003;
  laws::Random random_{41};
  Evaluator evaluator_;
  std::vector<float> points_;
  std::vector<double> exact_;
};

TEST_F(ManyPoints, ResultsDoNotDependOnThreads) {
  std::vector<float> single(count), values(count);
  std::vector<double> exact(count), gradient(3 * count), again(count), gradient_again(3 * count);
  const auto bits_agree = [](const auto& a, const auto& b) {
    return std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0;
  };
  {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    evaluator_.values(points_.data(), count, single.data());
    evaluator_.gradients(exact_.data(), count, exact.data(), gradient.data());
  }
  const tbb::global_control two(tbb::global_control::max_allowed_parallelism, 2);
  evaluator_.values(points_.data(), count, values.data());
  evaluator_.gradients(exact_.data(), count, again.data(), gradient_again.data());
  EXPECT_TRUE(bits_agree(single, values));
  EXPECT_TRUE(bits_agree(exact, again));
  EXPECT_TRUE(bits_agree(gradient, gradient_again));
}

TEST_F(ManyPoints, BlocksOfAnyLengthAgree) {
  std::vector<float> whole(count);
  evaluator_.values(points_.data(), count, whole.data());
  for (size_t n : {1, 2, 15, 16, 17, 31, 255, 256}) {
    std::vector<float> in[3], out(n);
    for (size_t i = 0; i < n; ++i) {
      for (int axis = 0; axis < 3; ++axis) in[axis].push_back(points_[3 * i + axis]);
    }
    float* to = out.data();
    evaluator_.block(in[0].data(), in[1].data(), in[2].data(), n, &to);
    for (size_t i = 0; i < n; ++i) EXPECT_EQ(out[i], whole[i]) << n;
  }
}

TEST_F(ManyPoints, ProgressRisesToOneAndCancels) {
  std::vector<double> out(count);
  double last = 0;
  evaluator_.values(exact_.data(), count, out.data(), [&](double share) {
    EXPECT_GE(share, last);
    last = share;
    return true;
  });
  EXPECT_EQ(last, 1);
  EXPECT_THROW(evaluator_.values(exact_.data(), count, out.data(), [](double) { return false; }),
               Cancelled);
}

TEST(Cancel, TakesEffectWithinATenthOfASecond) {
  // 20 000 instructions on a million points: far more than a second of work.
  const Evaluator evaluator(deep_tree(20000));
  const std::vector<float> points(3000000, 1);
  std::vector<float> out(1000000);
  std::chrono::steady_clock::time_point asked;
  int reports = 0;
  const auto cancel = [&](double) {
    asked = std::chrono::steady_clock::now();
    return ++reports < 2;
  };
  EXPECT_THROW(evaluator.values(points.data(), out.size(), out.data(), cancel), Cancelled);
  const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - asked;
  EXPECT_LT(waited.count(), at_once);
}

}  // namespace
}  // namespace sardf

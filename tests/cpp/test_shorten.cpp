// Programs shortened for a box give the same bits there; and they are short.
#include "sardf/shorten.hpp"

#include <gtest/gtest.h>

#include <bit>

#include "laws.hpp"
#include "sardf/arithmetic.hpp"
#include "sardf/blend.hpp"

namespace sardf {
namespace {

using laws::Random;

const Expression x = coordinate(0), y = coordinate(1), z = coordinate(2);

size_t steps(const Evaluator& evaluator) { return evaluator.tape().instructions().size(); }

// Numbers in every bit; 0 and -0 are told apart, one NaN is as good as another.
bool same(double a, double b) {
  return std::bit_cast<uint64_t>(a) == std::bit_cast<uint64_t>(b) ||
         (std::isnan(a) && std::isnan(b));
}
bool equal(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }
// Gradients are sums in which terms of 0 may be left out: 0 may change its sign. What is found to
// be a number has the derivative 0, also where the formula that makes it has none.
bool equal_slopes(double full, double shorter) { return full == shorter || std::isnan(full); }

constexpr size_t points = 32;

template <class T>
struct Sampled {
  std::vector<T> value = std::vector<T>(points), again = value;
  std::vector<T> gradient = std::vector<T>(3 * points);
};
template <class T>
Sampled<T> sampled(const Evaluator& evaluator, const std::vector<T>& at) {
  Sampled<T> s;
  evaluator.values(at.data(), points, s.value.data());
  evaluator.gradients(at.data(), points, s.again.data(), s.gradient.data());
  return s;
}

template <class T>
void expect_same(const Evaluator& full, const Shortening& shortening, const std::vector<T>& at) {
  const Sampled<T> a = sampled(full, at), b = sampled(shortening.shortened(), at);
  const Sampled<T> signs = sampled(shortening.shortened(Wanted::signs), at);
  const Sampled<T> middle = sampled(shortening.shortened(Demand{-0.25, 0.5}), at);
  const auto demanded = [](T value) { return std::clamp(value, T(-0.25), T(0.5)); };
  for (size_t i = 0; i < points; ++i) {
    const auto where = [&] {
      return testing::Message() << (sizeof(T) == 4 ? "float " : "double ") << at[3 * i] << " "
                                << at[3 * i + 1] << " " << at[3 * i + 2];
    };
    EXPECT_TRUE(same(a.value[i], b.value[i])) << a.value[i] << " " << b.value[i] << where();
    EXPECT_TRUE(same(a.value[i], b.again[i])) << where();
    EXPECT_EQ(a.value[i] >= 0, signs.value[i] >= 0) << where();
    EXPECT_TRUE(equal(demanded(a.value[i]), demanded(middle.value[i])))
        << a.value[i] << " " << middle.value[i] << where();
    for (size_t k = 3 * i; k < 3 * i + 3; ++k) {
      EXPECT_TRUE(equal_slopes(a.gradient[k], b.gradient[k]))
          << a.gradient[k] << " " << b.gradient[k] << where();
    }
    if (std::isnan(a.value[i])) {
      EXPECT_TRUE(shortening.may_be_nan()) << where();
    } else {
      EXPECT_TRUE(shortening.range().contains(a.value[i]))
          << a.value[i] << " not in " << shortening.range().lo << " to " << shortening.range().hi
          << where();
    }
  }
}

BoundingBox random_box(Random& r) {
  BoundingBox box;
  const double half = r.decades(-3, 0.5);
  for (int axis = 0; axis < 3; ++axis) {
    const double middle = r.chance(0.2) ? std::round(r.ordinary()) : r.ordinary();
    box.lo[axis] = float(middle - (r.chance(0.1) ? 0 : half));
    box.hi[axis] = float(middle + half);
  }
  return box;
}

void expect_same_in(Random& r, const Evaluator& full, const BoundingBox& box) {
  std::vector<double> at;
  for (size_t i = 0; i < 3 * points; ++i) {
    at.push_back(float(laws::number_in(r, {box.lo[i % 3], box.hi[i % 3]})));
  }
  const Shortening shortening(full, box);
  expect_same(full, shortening, at);
  expect_same(full, shortening, std::vector<float>(at.begin(), at.end()));
}

TEST(ShortenedProgramSlow, HasTheSameBitsForRandomTrees) {
  Random r(61);
  size_t shorter = 0, all = 0;
  for (int i = 0; i < laws::effort(400) && !testing::Test::HasFailure(); ++i) {
    const Evaluator full(laws::random_field(r, 1 + r.below(3)).expression());
    SCOPED_TRACE(testing::Message() << "tree " << i << ", seed " << laws::seed());
    for (int k = 0; k < 4; ++k, ++all) {
      const BoundingBox box = random_box(r);
      expect_same_in(r, full, box);
      shorter += steps(Shortening(full, box).shortened()) < steps(full);
    }
  }
  // Programs that are never shortened would be the same, too.
  EXPECT_GT(shorter, all / 4);
}

// Formulas of minima, maxima, selects and blends of coordinates, where ties and kinks are common.
Expression random_formula(Random& r, int depth) {
  if (depth == 0) {
    if (r.chance(0.3)) return constant(std::round(r.ordinary()));
    return coordinate(r.below(3)) + constant(0.25 * r.below(8));
  }
  const auto part = [&] { return random_formula(r, depth - 1 - int(r.chance(0.2) && depth > 1)); };
  switch (r.below(11)) {
    case 0:
      return abs(part());
    case 1:
      return -part();
    case 2:
      return part() + part();
    case 3:
      return part() - part();
    case 4:
      return select(less(part(), part()), part(), part());
    case 5:
      return function("clamp", {part(), constant(-1), constant(2)});
    case 6:
      return function("sqrt", {part()});
    case 7:
      return min(part(), part());
    case 8:
      return max(part(), part());
    default: {
      const auto& types = blend_types();
      const BlendType& type = types[size_t(r.below(int(types.size())))];
      const BlendPointer blend =
          make_blend(type.name, std::vector<Value>(type.parameters.size(), r.decades(-1, 0.3)));
      const OperationPointer all[] = {blend->intersection, blend->unite, blend->difference};
      return call(r.one_of(all), {part(), part()});
    }
  }
}

TEST(ShortenedProgram, HasTheSameBitsForRandomFormulas) {
  Random r(62);
  for (int i = 0; i < laws::effort(20000) && !testing::Test::HasFailure(); ++i) {
    const Evaluator full(random_formula(r, 2 + r.below(5)));
    SCOPED_TRACE(testing::Message() << "formula " << i << ", seed " << laws::seed());
    expect_same_in(r, full, random_box(r));
  }
}

// What an operation is a copy of, and what it can be, hold for any arguments in the ranges.
TEST(ShortenedProgram, RangesAndFatesHoldForEveryOperation) {
  laws::for_operations(laws::effort(400), [](auto, const Operation& op, Random& r) {
    const int arity = op.info().arity;
    std::array<Enclosure, max_arity> in;
    for (int k = 0; k < arity; ++k) in[k] = {laws::random_interval(r, 1e9), false};
    const Enclosure range = op.range(in.data());
    const Fate fate = op.fate(in.data(), {});
    std::array<std::vector<float>, max_arity> at;
    std::array<const float*, max_arity> pointers{};
    std::vector<float> single(16);
    for (int k = 0; k < arity; ++k) {
      for (int i = 0; i < 16; ++i) {
        const float inside = float(laws::number_in(r, in[k].value));
        at[k].push_back(in[k].value.contains(inside) ? inside : float(in[k].value.lo));
      }
      pointers[k] = at[k].data();
    }
    op.kernels().value(op.object(), pointers.data(), single.data(), 16);
    for (int i = 0; i < 16; ++i) {
      std::array<double, max_arity> one{};
      bool is_inside = true;
      for (int k = 0; k < arity; ++k) {
        one[k] = at[k][i];
        is_inside = is_inside && in[k].value.contains(one[k]);
      }
      if (!is_inside) continue;  // a float between the ends need not exist
      for (const double result : {op.evaluate(one.data()), double(single[i])}) {
        if (std::isnan(result)) {
          EXPECT_TRUE(range.may_be_nan) << testing::PrintToString(one);
        } else {
          EXPECT_TRUE(range.value.contains(result))
              << result << " not in " << range.value.lo << " to " << range.value.hi << " at "
              << testing::PrintToString(one) << testing::PrintToString(op.numbers());
        }
        if (fate.type == Fate::Type::computed) continue;
        const double copied =
            fate.type == Fate::Type::number ? fate.number : one[size_t(fate.input)];
        EXPECT_TRUE(equal(result, fate.negated ? -copied : copied)) << testing::PrintToString(one);
      }
    }
  });
}

TEST(ShortenedProgram, KeepsOnlyWhatMatters) {
  const Expression a = sardf::length(x, y), b = z + constant(10);
  const BoundingBox box{{-1, -1, -1}, {1, 1, 1}};
  const auto shortened = [&](const Expression& e, Wanted wanted = Wanted::values) {
    return Shortening(Evaluator(e), box).shortened(wanted);
  };
  EXPECT_EQ(steps(shortened(min(a, b))), 1u);
  EXPECT_EQ(steps(shortened(max(b, a))), 1u);
  EXPECT_EQ(steps(shortened(min(a, x + constant(1)))), 3u);
  EXPECT_EQ(steps(shortened(select(less(a, b), a, function("sin", {b})))), 1u);
  EXPECT_EQ(steps(shortened(less(b, a))), 0u);
  EXPECT_EQ(steps(shortened(abs(b))), 1u);
  EXPECT_EQ(steps(shortened(abs(-b))), 1u);
  // The negation stays, the blend goes.
  EXPECT_EQ(steps(shortened(call(make_blend("sardf", {1.0})->difference, {b, b}))), 2u);
  EXPECT_EQ(shortened(less(b, a)).value({0, 0, 0}), 0);
  EXPECT_EQ(shortened(abs(-b)).value({0, 0, 0.5}), 10.5);
  // Of a sign nothing is left where it is certain.
  EXPECT_EQ(steps(shortened(max(x, b), Wanted::signs)), 1u);
  EXPECT_EQ(steps(shortened(min(x, a + constant(1)), Wanted::signs)), 0u);
  // What lies below the floor is as good as the floor.
  const Expression low = a - constant(2), lowest = sardf::length(z, y) - constant(3);
  const Evaluator both(max(low, lowest));
  const Shortening of_both(both, box);
  EXPECT_EQ(steps(of_both.shortened(Demand{-1, 1})), 2u);
  EXPECT_EQ(steps(of_both.shortened(Demand{-2, 1})), 5u);
}

// A gear: many edges, of which few matter in a small box.
Expression gear(int teeth) {
  std::vector<Vec2> corners;
  for (int i = 0; i < 4 * teeth; ++i) {
    const double angle = 2 * std::acos(-1) * (i + 0.2 * (i % 2)) / (4 * teeth);
    const double radius = i % 4 < 2 ? 2 : 1.5;
    corners.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return make_field("polygon", {corners}).expression();
}

TEST(ShortenedProgram, OfAPolygonHasTheSameBits) {
  Random r(64);
  const Evaluator full(gear(7));
  for (int i = 0; i < laws::effort(2000) && !testing::Test::HasFailure(); ++i) {
    BoundingBox box;
    const double half = r.decades(-4, 0.3), angle = r.uniform(-4, 4);
    const double radius = r.chance(0.7) ? r.uniform(1.4, 2.1) : r.uniform(0, 4);
    box.lo = {radius * std::cos(angle) - half, radius * std::sin(angle) - half, -1};
    box.hi = {box.lo[0] + 2 * half, box.lo[1] + 2 * half * r.uniform(0, 1), 1};
    expect_same_in(r, full, box);
    // And what is shortened again.
    const BoundingBox part{box.lo, 0.5 * (box.lo + box.hi)};
    expect_same_in(r, Shortening(full, box).shortened(), part);
  }
}

TEST(ShortenedProgram, OfAPolygonHasFewEdges) {
  const Evaluator full(gear(7));
  const BoundingBox box{{1.9, -0.05, 0}, {2, 0.05, 0}};
  const Evaluator shorter = Shortening(full, box).shortened();
  const auto edges = [](const Evaluator& evaluator) {
    Trace trace(2);
    evaluator.tape().instructions()[0].operation->record(trace);
    return trace.steps().size();
  };
  EXPECT_LT(6 * edges(shorter), edges(full));
  EXPECT_NE(full.tape().instructions()[0].operation->numbers(),
            shorter.tape().instructions()[0].operation->numbers());
}

// The first argument of a minimum is not taken where it is no number.
TEST(ShortenedProgram, KnowsWhereNumbersEnd) {
  const Evaluator full(min(log(x), constant(9)));
  const BoundingBox box{{-1, 0, 0}, {1, 0, 0}};
  const Evaluator shorter = Shortening(full, box).shortened();
  EXPECT_EQ(shorter.value({-0.5, 0, 0}), 9);
  EXPECT_EQ(full.value({-0.5, 0, 0}), 9);
  EXPECT_EQ(steps(Shortening(full, {{0.5, 0, 0}, {1, 0, 0}}).shortened()), 1u);
}

// Unit balls in a row, three apart; the middle of number k is at x = 3 k.
Expression row_of_balls(int count, const BlendPointer& blend, bool from_the_left) {
  Expression all;
  for (int i = 0; i < count; ++i) {
    const double at = 3.0 * (from_the_left ? i : count - 1 - i);
    const Expression ball = make_field("sphere", {Vec3{at, 0, 0}, 1.0}).expression();
    all = all ? call(blend->unite, {all, ball}) : ball;
  }
  return all;
}

// However a union is nested, what is left is what can be nearest, by distance at the centre: the
// rounded corners of blends reach R, and ranges 2 r further.
TEST(ShortenedProgram, UnionsKeepTheNearest) {
  constexpr int count = 1000;
  const double half = 0.5, radius = half * std::sqrt(3);
  for (const auto& [name, reach] : {std::pair("min_max", 0.0), std::pair("sardf", 0.8),
                                    std::pair("sardf_c1", 0.8), std::pair("smooth", 0.8)}) {
    const BlendPointer blend = reach == 0 ? make_blend(name, {}) : make_blend(name, {Value(reach)});
    for (const bool from_the_left : {true, false}) {
      const Evaluator full(row_of_balls(count, blend, from_the_left));
      for (const double middle : {0.0, 3.0, 1500.0, 1501.5, 2997.0}) {
        const Vec3 centre{middle, 0.6, -0.4};
        const BoundingBox box{centre - Vec3{half, half, half}, centre + Vec3{half, half, half}};
        size_t near = 0;
        double best = infinity;
        for (int i = 0; i < count; ++i) best = std::min(best, norm(centre - Vec3{3.0 * i, 0, 0}));
        for (int i = 0; i < count; ++i) {
          near += norm(centre - Vec3{3.0 * i, 0, 0}) <= best + 2 * (reach + 2 * radius);
        }
        const Evaluator shorter = Shortening(full, box).shortened();
        EXPECT_LE(steps(shorter), 2 * near - 1) << name << " at " << middle;
        EXPECT_EQ(shorter.value(centre), full.value(centre));
      }
    }
  }
}

TEST(ShortenedProgram, ServesSeveralOutputs) {
  const Expression ball = make_field("sphere", {Vec3{}, 1.0}).expression();
  const std::vector<Expression> outputs{min(ball, x + constant(9)), max(-ball, x), x, constant(4)};
  const Evaluator full(outputs);
  const Shortening shortening(full, {{-0.5, -0.5, -0.5}, {-0.25, 0.5, 0.5}});
  const Evaluator shorter = shortening.shortened();
  EXPECT_EQ(steps(shorter), 3u);  // the ball, its negation and the second maximum
  double a[4], b[4];
  full.values({-0.3, 0.2, 0.1}, a);
  shorter.values({-0.3, 0.2, 0.1}, b);
  for (int k = 0; k < 4; ++k) EXPECT_EQ(a[k], b[k]);
  EXPECT_EQ(shortening.range(3), Interval(4));
}

// A program may be shortened again and again: what its operations need outlives the first one.
TEST(ShortenedProgram, OutlivesTheFullOne) {
  auto full = std::make_unique<Evaluator>(row_of_balls(100, make_blend("sardf", {0.5}), true));
  const Vec3 at{30, 0.5, 0};
  const double value = full->value(at);
  Evaluator shorter = Shortening(*full, {{25, -4, -4}, {35, 4, 4}}).shortened();
  full.reset();
  const Evaluator shortest = Shortening(shorter, {{29, 0, -1}, {31, 1, 1}}).shortened();
  shorter = {};
  EXPECT_EQ(shortest.value(at), value);
}

}  // namespace
}  // namespace sardf

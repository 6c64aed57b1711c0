// The number types: directed rounding, special values, kinks, lanes and records.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "laws.hpp"
#include "sardf/numbers/gradient.hpp"
#include "sardf/numbers/lanes.hpp"
#include "sardf/numbers/trace.hpp"

namespace sardf {
namespace {

using laws::Random;

constexpr double pi = std::numbers::pi;
constexpr double tiny = std::numeric_limits<double>::denorm_min();
const double nan = std::nan("");

TEST(IntervalNumber, RoundsOutwards) {
  EXPECT_LT(rounded_down(1), 1);
  EXPECT_GT(rounded_up(1), 1);
  EXPECT_LT(rounded_down(-1), -1);
  EXPECT_LT(rounded_down(0), 0);
  EXPECT_GT(rounded_up(0), 0);
  EXPECT_LT(rounded_down(tiny), tiny);
  EXPECT_GT(rounded_up(1e308), 1e308);
  // Overflow is no proof that a value is infinite.
  EXPECT_EQ(rounded_down(infinity), DBL_MAX);
  EXPECT_EQ(rounded_up(-infinity), -DBL_MAX);
  EXPECT_EQ(rounded_up(infinity), infinity);
  EXPECT_EQ(rounded_down(-infinity), -infinity);
}

TEST(IntervalNumber, TenthsHoldTheRealSum) {
  // The real sum of the doubles 0.1 and 0.2 lies between the doubles 0.3 and 0.3 + 2^-54.
  const Interval sum = Interval(0.1) + Interval(0.2);
  EXPECT_LE(sum.lo, 0.3);
  EXPECT_GE(sum.hi, 0.30000000000000004);
  EXPECT_LT(sum.hi - sum.lo, 1e-15);
}

TEST(IntervalNumber, ProductsOfZeroAndInfinity) {
  EXPECT_EQ((Interval(0) * Interval::all()).magnitude(), tiny);
  const Interval product = Interval{-2, 3} * Interval{-5, 7};
  EXPECT_TRUE(product.contains(21) && product.contains(-15));
  EXPECT_LT(product.magnitude(), 21.0001);
  EXPECT_EQ((Interval{1, infinity} * Interval{-infinity, -1}).lo, -infinity);
}

TEST(IntervalNumber, QuotientsByZero) {
  const Interval all = Interval::all();
  EXPECT_EQ(Interval(1) / Interval(0), all);
  EXPECT_EQ((Interval{1, 2} / Interval{-1, 1}), all);
  // 1 / -0 is -inf, and -0 lies in [0, 4], too.
  EXPECT_EQ((Interval{1, 2} / Interval{0, 4}), all);
  EXPECT_EQ((Interval{1, 2} / Interval{-4, 0}), all);
  // A quotient by an unbounded divisor tends to 0, and stays finite.
  const Interval far = Interval{1, 2} / Interval{4, infinity};
  EXPECT_LE(far.lo, 0);
  EXPECT_NEAR(far.hi, 0.5, 1e-12);
}

TEST(IntervalNumber, SquaresAndRootsAreNotNegative) {
  EXPECT_EQ((square(Interval{-3, 2}).lo), 0);
  EXPECT_TRUE((square(Interval{-3, 2})).contains(9));
  EXPECT_EQ((sqrt(Interval{-4, 9}).lo), 0);
  EXPECT_TRUE((sqrt(Interval{-4, 9})).contains(3));
  EXPECT_EQ((abs(Interval{-3, 2})), (Interval{0, 3}));
  EXPECT_EQ((abs(Interval{-3, -2})), (Interval{2, 3}));
  EXPECT_GE(sqrt(Interval(tiny)).lo, 0);
}

TEST(IntervalNumber, PeriodicFunctionsKnowTheirTurns) {
  EXPECT_EQ((sin(Interval{0, 4}).hi), 1);
  EXPECT_LT((sin(Interval{0, 4}).lo), std::sin(4) + 1e-12);
  EXPECT_GT((sin(Interval{0, 4}).lo), -0.8);
  EXPECT_EQ((cos(Interval{3, 3.2}).lo), -1);
  EXPECT_LT((cos(Interval{3, 3.2}).hi), -0.98);
  EXPECT_EQ((sin(Interval{-infinity, infinity})), (Interval{-1, 1}));
  EXPECT_EQ((tan(Interval{1, 2})), Interval::all());
  EXPECT_LT((tan(Interval{-1, 1})).hi, 1.6);
  EXPECT_EQ((sin(Interval{1e300, 1e300})), (Interval{-1, 1}));
}

TEST(IntervalNumber, AnglesKnowTheirCut) {
  const Interval across = atan2(Interval{-1, 1}, Interval{-2, -1});
  EXPECT_LE(across.lo, -pi);
  EXPECT_GE(across.hi, pi);
  const Interval right = atan2(Interval{-1, 1}, Interval{1, 2});
  EXPECT_NEAR(right.lo, -pi / 4, 1e-12);
  EXPECT_NEAR(right.hi, pi / 4, 1e-12);
  EXPECT_TRUE(atan2(Interval{0, 1}, Interval{-1, 1}).contains(std::atan2(0.0, -1.0)));
}

TEST(IntervalNumber, PowersOfNegativeBases) {
  EXPECT_TRUE(pow(Interval{-2, 2}, 3).contains(-8));
  EXPECT_TRUE(pow(Interval{-2, 2}, 3).contains(8));
  EXPECT_EQ(pow(Interval{-1, 1}, -1), Interval::all());
  EXPECT_TRUE(pow(Interval{0.5, 2}, Interval{-1, 1}).contains(1));
}

TEST(IntervalNumber, ComparisonsSayWhatIsKnown) {
  const auto known = [](IntervalMask mask) { return std::pair(mask.can_hold, mask.can_fail); };
  EXPECT_EQ(known((Interval{1, 2} < Interval{3, 4})), std::pair(true, false));
  EXPECT_EQ(known((Interval{3, 4} < Interval{1, 2})), std::pair(false, true));
  EXPECT_EQ(known((Interval{1, 3} < Interval{2, 4})), std::pair(true, true));
  EXPECT_EQ(known((Interval{1, 2} < Interval{2, 3})), std::pair(true, true));
  EXPECT_EQ(known((Interval{1, 2} <= Interval{2, 3})), std::pair(true, false));
  EXPECT_EQ(known((Interval{2, 3} < Interval{1, 2})), std::pair(false, true));
  EXPECT_EQ((select(Interval{1, 3} < Interval{2, 4}, Interval(5), Interval(7))), (Interval{5, 7}));
}

// Every function on random boxes, special values included, holds every sample's value.
TEST(IntervalNumber, FunctionsHoldTheirSamples) {
  struct Case {
    const char* name;
    std::function<Interval(Interval, Interval)> of_box;
    std::function<double(double, double)> of_point;
  };
#define SARDF_CASE(expression)                                                         \
  Case {                                                                               \
    #expression, [](Interval a, Interval b) { return void(b), Interval(expression); }, \
        [](double a, double b) { return void(b), double(expression); }                 \
  }
  const Case cases[] = {SARDF_CASE(a + b),     SARDF_CASE(a - b),     SARDF_CASE(a * b),
                        SARDF_CASE(a / b),     SARDF_CASE(-a),        SARDF_CASE(min(a, b)),
                        SARDF_CASE(max(a, b)), SARDF_CASE(abs(a)),    SARDF_CASE(square(a)),
                        SARDF_CASE(sqrt(a)),   SARDF_CASE(exp(a)),    SARDF_CASE(log(a)),
                        SARDF_CASE(sin(a)),    SARDF_CASE(cos(a)),    SARDF_CASE(tan(a)),
                        SARDF_CASE(asin(a)),   SARDF_CASE(acos(a)),   SARDF_CASE(atan2(a, b)),
                        SARDF_CASE(floor(a)),  SARDF_CASE(pow(a, b)), SARDF_CASE(length(a, b))};
#undef SARDF_CASE
  Random r(53);
  for (const Case& c : cases) {
    for (int i = 0; i < laws::effort(5000); ++i) {
      const Interval a = laws::random_interval(r, 1e300), b = laws::random_interval(r, 1e300);
      const Interval bound = c.of_box(a, b);
      ASSERT_FALSE(std::isnan(bound.lo) || std::isnan(bound.hi))
          << c.name << ' ' << a.lo << ' ' << a.hi << ' ' << b.lo << ' ' << b.hi;
      for (int k = 0; k < 4; ++k) {
        const double p = laws::number_in(r, a), q = laws::number_in(r, b), value = c.of_point(p, q);
        if (std::isnan(value)) continue;
        EXPECT_TRUE(bound.contains(value))
            << c.name << " of " << p << ", " << q << " is " << value << ", not in [" << bound.lo
            << ", " << bound.hi << "] over [" << a.lo << ", " << a.hi << "], [" << b.lo << ", "
            << b.hi << ']';
      }
    }
  }
}

using Dual = Gradient<double, 2>;
Dual variable(double a, int i) { return Dual::variable(a, i); }

TEST(GradientNumber, FollowsTheRulesOfDifferentiation) {
  const Dual a = variable(3, 0), b = variable(2, 1);
  EXPECT_EQ((a * b).d, (std::array{2.0, 3.0}));
  EXPECT_EQ((a / b).d, (std::array{0.5, -0.75}));
  EXPECT_EQ((a - b).d, (std::array{1.0, -1.0}));
  EXPECT_EQ(square(a).d[0], 6);
  EXPECT_DOUBLE_EQ(pow(a, b).d[0], 6);
  EXPECT_DOUBLE_EQ(pow(a, b).d[1], 9 * std::log(3));
  EXPECT_DOUBLE_EQ(atan2(a, b).d[0], 2.0 / 13);
  EXPECT_DOUBLE_EQ(atan2(a, b).d[1], -3.0 / 13);
  EXPECT_EQ(length(variable(3, 0), variable(4, 1)).d, (std::array{0.6, 0.8}));
}

TEST(GradientNumber, TakesOneBranchAtAKink) {
  const Dual a = variable(1, 0), b = variable(1, 1);
  EXPECT_EQ(min(a, b).d, (std::array{0.0, 1.0}));
  EXPECT_EQ(max(a, b).d, (std::array{0.0, 1.0}));
  EXPECT_EQ(abs(variable(0, 0)).d[0], 1);
  EXPECT_EQ(abs(variable(-2, 0)).d[0], -1);
  EXPECT_EQ(floor(variable(1.5, 0)).d[0], 0);
}

TEST(GradientNumber, TakesTheMeanWhereFormulasAreSmooth) {
  const Dual a = variable(1, 0), b = variable(1, 1);
  EXPECT_EQ(smaller(a, b).d, (std::array{0.5, 0.5}));
  EXPECT_EQ(larger(a, b).d, (std::array{0.5, 0.5}));
  EXPECT_EQ(smaller(a, variable(2, 1)).d, (std::array{1.0, 0.0}));
  EXPECT_EQ(larger(a, variable(2, 1)).d, (std::array{0.0, 1.0}));
}

TEST(GradientNumber, OfIntervalsIsUnboundedAcrossJumps) {
  using Bound = Gradient<Interval, 1>;
  const Bound a = Bound::variable(Interval{-1, 1}, 0);
  const auto is_unbounded = [](const Bound& g) { return g.d[0].hi == infinity; };
  EXPECT_TRUE(is_unbounded(floor(a)));
  EXPECT_TRUE(is_unbounded(jump(a.v < Interval(0), Bound(1.0), Bound(2.0))));
  EXPECT_FALSE(is_unbounded(floor(Bound::variable(Interval{0.25, 0.75}, 0))));
  EXPECT_TRUE(is_unbounded(atan2(a, Bound(-1.0))));
  EXPECT_FALSE(is_unbounded(atan2(a, Bound(1.0))));
  EXPECT_FALSE(is_unbounded(abs(a)));
}

TEST(LanesNumber, ActOnEveryLane) {
  using L = Lanes<Baseline>;
  const float from[4] = {-2, -0.f, 3, float(nan)};
  const L a = L::load(from);
  const auto lanes = [](L value) {
    std::array<float, 4> out;
    value.store(out.data());
    return out;
  };
  EXPECT_EQ(lanes(abs(a))[0], 2);
  EXPECT_FALSE(std::signbit(lanes(abs(a))[1]));
  EXPECT_EQ(lanes(select(a < L(0.0), L(1.0), L(2.0)))[0], 1);
  EXPECT_EQ(lanes(select(a < L(0.0), L(1.0), L(2.0)))[1], 2);
  // No comparison with NaN holds.
  EXPECT_EQ(lanes(select(a <= L(9.0), L(1.0), L(2.0)))[3], 2);
  EXPECT_EQ(lanes(floor(L(-1.5)))[2], -2);
}

TEST(LanesNumber, ShortcutsSkipOnlyWhatNoLaneNeeds) {
  using L = Lanes<Baseline>;
  const float from[4] = {1, 2, 3, 4};
  const L a = L::load(from);
  int calls = 0;
  const auto costly = [&] {
    ++calls;
    return L(9.0);
  };
  std::array<float, 4> out;
  shortcut(a < L(5.0), a, costly).store(out.data());
  EXPECT_EQ(calls, 0);
  EXPECT_EQ(out, (std::array<float, 4>{1, 2, 3, 4}));
  shortcut(a < L(4.0), a, costly).store(out.data());
  EXPECT_EQ(calls, 1);
  EXPECT_EQ(out, (std::array<float, 4>{1, 2, 3, 9}));
}

TEST(LanesNumber, RestWhenEveryLaneDoes) {
  using L = Lanes<Baseline>;
  const float former[] = {1, 2, 3, 4}, latter[] = {1, 2, 3, 4.5f}, broken[] = {1, 2, 3, NAN};
  EXPECT_TRUE(is_at_rest(L::load(former), L::load(former)));
  EXPECT_FALSE(is_at_rest(L::load(former), L::load(latter)));
  EXPECT_FALSE(is_at_rest(L::load(broken), L::load(broken)));
  EXPECT_TRUE(is_at_rest(0.5, 0.5));
  EXPECT_FALSE(is_at_rest(0.5, 0.5 + 0x1p-53));
  // A derivative may still move when the value rests.
  using G = Gradient<double, 2>;
  G moved = G::variable(3, 0);
  EXPECT_TRUE(is_at_rest(moved, G::variable(3, 0)));
  moved.d[1] = 1e-9;
  EXPECT_FALSE(is_at_rest(moved, G::variable(3, 0)));
  // What encloses or records takes all the steps.
  EXPECT_FALSE(is_at_rest(Interval(1), Interval(1)));
}

TEST(RealNumber, WholePowersAreProducts) {
  for (int n = 1; n <= 64; ++n)
    for (const double a : {0.0, 0.3, 1.0, 1.7, -0.9})
      EXPECT_NEAR(whole_power(a, n), std::pow(a, n), 1e-14 * std::abs(std::pow(a, n)));
  EXPECT_EQ(whole_power(2.0, 63), 0x1p63);
  EXPECT_TRUE(std::isnan(whole_power(nan, 3)));
}

TEST(TraceNumber, SharesEqualTerms) {
  Trace trace(2);
  const Text a = Text::at(0), b = Text::at(1);
  EXPECT_EQ((a * b).step, (a * b).step);
  EXPECT_NE((a * b).step, (b * a).step);
  EXPECT_NE(Text(0.0).step, Text(-0.0).step);
  Text doubled = a;
  const size_t before = trace.steps().size();
  for (int i = 0; i < 50; ++i) doubled = doubled + doubled;
  EXPECT_EQ(trace.steps().size(), before + 50);
}

TEST(TraceNumber, OperandsComeBeforeTheirUsers) {
  for (const laws::ListedOperation& listed : laws::listed_operations()) {
    Random r(61);
    const OperationPointer op = listed.random(r);
    Trace trace(op->info().arity);
    op->record(trace);
    ASSERT_GE(trace.result, 0) << listed.name;
    for (size_t i = 0; i < trace.steps().size(); ++i) {
      for (int operand : trace.steps()[i].operands) EXPECT_LT(operand, int(i)) << listed.name;
    }
  }
}

}  // namespace
}  // namespace sardf

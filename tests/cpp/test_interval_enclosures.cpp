// Enclosures of elementary steps, held to wider arithmetic: every bound contains the real result
// and the double one, for directed cases and for random bit patterns.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <functional>
#include <limits>

#include "laws.hpp"
#include "sardf/numbers/gradient.hpp"

namespace sardf {
namespace {

using laws::Random;
using Bound = Gradient<Interval, 2>;

// Sums, quotients and products of doubles, rounded to 113 bits: what is rounded to more bits stays
// on the same side of every double. (Where there is no such type, long double has as many.)
#if defined(__SIZEOF_FLOAT128__)
using Wide = __float128;
#else
using Wide = long double;
#endif

const double least = std::numeric_limits<double>::denorm_min();

const std::vector<double>& directed() {
  static const std::vector<double> cases = [] {
    std::vector<double> all;
    for (const double a :
         {0.0,   least, 3 * least, 1e-310, DBL_MIN,  1e-300, 1e-160,   1e-8,    0.1,   0.5,
          1.0,   1.5,   2.0,       3.0,    M_PI / 2, M_PI,   2 * M_PI, 10.0,    355.0, 709.78,
          745.0, 1e9,   1e16,      1e154,  1e155,    1e300,  DBL_MAX,  infinity}) {
      for (const double s : {a, -a}) {
        for (const double b : {s, std::nextafter(s, -infinity), std::nextafter(s, infinity)}) {
          all.push_back(b);
        }
      }
    }
    return all;
  }();
  return cases;
}

// Any double but NaN, every exponent as likely; every third of the table.
double any_double(Random& r) {
  if (r.chance(0.3)) return r.one_of(directed());
  const double a = std::ldexp(r.uniform(1, 2), r.below(2099) - 1075);
  return r.chance(0.5) ? -a : r.chance(0.5) ? a : std::ldexp(r.uniform(-2, 2), r.below(40) - 20);
}

Interval any_interval(Random& r) {
  const double a = any_double(r);
  double b = a;
  switch (r.below(4)) {
    case 0:
      b = any_double(r);
      break;
    case 1:
      for (int steps = r.below(4); steps > 0; --steps) b = std::nextafter(b, infinity);
      break;
    case 2:
      b = a * (1 + r.decades(-15, 0));
  }
  return {min(a, b), max(a, b)};
}

double any_in(Random& r, Interval a) {
  const double zero = r.chance(0.5) ? 0.0 : -0.0;
  if (a.contains(0) && r.chance(0.3)) return zero;
  switch (r.below(6)) {
    case 0:
      return a.lo;
    case 1:
      return a.hi;
    case 2:
      return std::clamp(std::nextafter(a.lo, infinity), a.lo, a.hi);
    case 3:
      return std::clamp(std::nextafter(a.hi, -infinity), a.lo, a.hi);
    case 4:
      return std::clamp(any_double(r), a.lo, a.hi);
    default:
      const double middle = 0.5 * a.lo + 0.5 * a.hi;
      return std::isnan(middle) ? 0 : std::clamp(middle, a.lo, a.hi);
  }
}

std::string text(Interval a) {
  std::ostringstream out;
  out.precision(17);
  out << '[' << a.lo << ", " << a.hi << ']';
  return out.str();
}

struct Step {
  const char* name;
  std::function<Interval(Interval, Interval)> of_box;
  std::function<double(double, double)> of_point;
  std::function<Wide(double, double)> exact;  // within `error` of the real result
  double error = 0;                           // relative
};

#define SARDF_STEP(expression, reference, error)                                       \
  Step {                                                                               \
    #expression, [](Interval a, Interval b) { return void(b), Interval(expression); }, \
        [](double a, double b) { return void(b), double(expression); },                \
        [](double a, double b) { return void(b), Wide(reference); }, error             \
  }

// The C library's functions of long double are not those of double, and have 11 bits more.
std::vector<Step> steps() {
  using L = long double;
  constexpr double e = 0x1p-60;
  return {
      SARDF_STEP(a + b, Wide(a) + Wide(b), 0),
      SARDF_STEP(a - b, Wide(a) - Wide(b), 0),
      SARDF_STEP(a * b, Wide(a) * Wide(b), 0),
      SARDF_STEP(a / b, Wide(a) / Wide(b), 0),
      SARDF_STEP(-a, -Wide(a), 0),
      SARDF_STEP(square(a), Wide(a) * Wide(a), 0),
      SARDF_STEP(abs(a), std::fabs(a), 0),
      SARDF_STEP(min(a, b), std::fmin(a, b), 0),
      SARDF_STEP(max(a, b), std::fmax(a, b), 0),
      SARDF_STEP(floor(a), std::floor(a), 0),
      SARDF_STEP(sqrt(a), sqrtl(L(a)), e),
      SARDF_STEP(exp(a), expl(L(a)), e),
      SARDF_STEP(log(a), logl(L(a)), e),
      SARDF_STEP(sin(a), sinl(L(a)), e),
      SARDF_STEP(cos(a), cosl(L(a)), e),
      SARDF_STEP(tan(a), tanl(L(a)), e),
      SARDF_STEP(asin(a), asinl(L(a)), e),
      SARDF_STEP(acos(a), acosl(L(a)), e),
      SARDF_STEP(atan2(a, b), atan2l(L(a), L(b)), e),
      SARDF_STEP(pow(a, b), powl(L(a), L(b)), e),
      SARDF_STEP(length(a, b), hypotl(L(a), L(b)), e),
      // Compositions that formulas are made of: fract, mod, clamp, mix.
      SARDF_STEP(a - floor(a), Wide(a) - Wide(std::floor(a)), 0),
      SARDF_STEP(min(max(a, b), -a), std::fmin(std::fmax(a, b), -a), 0),
  };
}
#undef SARDF_STEP

bool is_finite(Wide a) { return a - a == 0; }

void expect_enclosed(const Step& step, Interval a, Interval b, double p, double q) {
  const Interval bound = step.of_box(a, b);
  const double value = step.of_point(p, q);
  const auto where = [&] {
    std::ostringstream out;
    out.precision(17);
    out << step.name << " of " << p << ", " << q << " is " << value << ", over " << text(a) << ", "
        << text(b) << ": " << text(bound);
    return out.str();
  };
  ASSERT_FALSE(std::isnan(bound.lo) || std::isnan(bound.hi)) << where();
  if (std::isnan(value)) return;
  EXPECT_TRUE(bound.contains(value)) << where();
  if (std::isinf(p) || std::isinf(q)) return;
  const Wide exact = step.exact(p, q), magnitude = exact < 0 ? -exact : exact;
  if (!is_finite(exact)) return;
  const Wide slack = magnitude * step.error;
  EXPECT_TRUE(Wide(bound.lo) <= exact + slack && exact - slack <= Wide(bound.hi)) << where();
}

TEST(IntervalEnclosures, HoldDirectedCases) {
  for (const Step& step : steps()) {
    for (const double p : directed()) {
      for (const double q : directed()) expect_enclosed(step, p, q, p, q);
    }
  }
}

TEST(IntervalEnclosures, HoldRandomBitPatterns) {
  Random r(71);
  for (const Step& step : steps()) {
    for (int i = 0; i < laws::effort(40000); ++i) {
      const Interval a = any_interval(r), b = r.chance(0.1) ? a : any_interval(r);
      expect_enclosed(step, a, b, any_in(r, a), any_in(r, b));
    }
  }
}

// Bounds that are all infinite would hold, too.
TEST(IntervalEnclosures, OfNumbersAreAFewUnitsWide) {
  Random r(72);
  for (const Step& step : steps()) {
    for (int i = 0; i < laws::effort(1000); ++i) {
      const double a = r.uniform(0.01, 0.99), b = r.uniform(0.01, 5);
      const Interval bound = step.of_box(a, b);
      const double width = bound.hi - bound.lo, most = max(bound.magnitude(), 5.0);
      EXPECT_LE(width, 16 * 0x1p-52 * most) << step.name << " of " << a << ", " << b;
    }
  }
}

TEST(IntervalEnclosures, ComparisonsNeverExcludeWhatHappens) {
  Random r(73);
  for (int i = 0; i < laws::effort(100000); ++i) {
    const Interval a = any_interval(r), b = r.chance(0.3) ? a : any_interval(r);
    const double p = any_in(r, a), q = any_in(r, b);
    const auto possible = [](IntervalMask mask, bool holds) {
      return holds ? mask.can_hold : mask.can_fail;
    };
    EXPECT_TRUE(possible(a < b, p < q) && possible(a <= b, p <= q)) << text(a) << text(b);
    EXPECT_TRUE(possible(a > b, p > q) && possible(a >= b, p >= q)) << text(a) << text(b);
    EXPECT_TRUE(possible(!(a < b) || a >= b, !(p < q) || p >= q)) << text(a) << text(b);
    EXPECT_TRUE(select(a < b, a, b).contains(select(p < q, p, q))) << text(a) << text(b);
  }
}

// Every operation, its steps composed: words of the formula language such as sign, step, mix and
// smoothstep on any doubles; shapes and blends between finite ends, since an infinite end stands
// for what is near enough not to overflow.
TEST(IntervalEnclosures, OfOperationsHoldRandomBitPatterns) {
  laws::for_operations(laws::effort(4000), [](auto, const Operation& op, Random& r) {
    std::array<Interval, max_arity> box;
    std::array<double, max_arity> at{};
    double most = 0;
    for (int k = 0; k < op.info().arity; ++k) {
      box[size_t(k)] = k > 0 && r.chance(0.2) ? box[0] : any_interval(r);
      at[size_t(k)] = any_in(r, box[size_t(k)]);
      most = max(most, box[size_t(k)].magnitude());
    }
    if (op.info().kind != Kind::function && most == infinity) return;
    const Interval bound = op.interval(box.data());
    const double value = op.evaluate(at.data());
    if (std::isnan(value)) return;
    EXPECT_TRUE(bound.contains(value))
        << value << " at " << testing::PrintToString(at) << " not in " << text(bound) << " over "
        << text(box[0]) << text(box[1]) << text(box[2]);
  });
}

TEST(IntervalEnclosures, KnowTheEndsOfDomains) {
  const Interval all = Interval::all();
  EXPECT_EQ((pow(Interval{0, 1}, -1)), all);  // pow(-0, -1) is -inf
  EXPECT_EQ(log(Interval{0, 1}).lo, -infinity);
  EXPECT_EQ((asin(Interval{2, 3})), all);
  EXPECT_EQ(asin(Interval{-2, 2}).hi, rounded_up(std::asin(1), 2));
  EXPECT_EQ((Interval{-infinity, 1} + Interval{infinity, infinity}).lo, -infinity);
  EXPECT_EQ(rounded_down(std::nan("")), -infinity);
  EXPECT_EQ(rounded_up(std::nan("")), infinity);
}

// A power of a changing exponent jumps from whole number to whole number where the base is
// negative, and at 0 where it is 0: 0^0 is 1.
TEST(IntervalEnclosures, SlopesOfPowersKnowTheirJumps) {
  const auto steepness = [](Interval base, Interval exponent) {
    const Bound power = pow(Bound::variable(base, 0), Bound::variable(exponent, 1));
    return power.d[1].magnitude();
  };
  EXPECT_EQ(steepness(-2, {2, 3}), infinity);
  EXPECT_EQ(steepness({0, 1}, {0, 1}), infinity);
  EXPECT_LT(steepness({0.5, 2}, {1, 2}), 2.8);
  // |ln 1e-320| is 736.8: the base is far below any float.
  EXPECT_GT(steepness(1e-320, {0, 0.001}), 736);
  // A number as exponent has none.
  EXPECT_LT(pow(Bound::variable(Interval{-2, 2}, 0), Bound(3.0)).d[0].magnitude(), 12.1);
}

}  // namespace
}  // namespace sardf

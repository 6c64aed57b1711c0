// Laws of every operation: intervals, slopes, gains, monotony and exact distances bound what they
// say they bound.
#include <gtest/gtest.h>

#include "laws.hpp"

namespace sardf {
namespace {

using laws::Random;

struct Box {
  std::vector<Interval> sides;
  Box(Random& r, int arity) {
    for (int k = 0; k < arity; ++k) sides.push_back(laws::random_interval(r));
    // Equal sides meet the kinks of symmetric operations.
    if (arity > 1 && r.chance(0.2)) sides[1] = sides[0];
  }
  std::vector<double> point(Random& r) const {
    std::vector<double> at;
    for (const Interval& side : sides) at.push_back(laws::number_in(r, side));
    return at;
  }
};

std::ostream& operator<<(std::ostream& out, const Box& box) {
  for (const Interval& side : box.sides) out << '[' << side.lo << ", " << side.hi << "] ";
  return out;
}

std::string parameters(const Operation& op) {
  return "parameters " + testing::PrintToString(op.numbers());
}

double length(const std::vector<double>& vector) {
  double squares = 0;
  for (double a : vector) squares += a * a;
  return std::sqrt(squares);
}

TEST(BoundLaws, IntervalsHoldEverySample) {
  laws::for_operations(laws::effort(1500), [](auto, const Operation& op, Random& r) {
    const Box box(r, op.info().arity);
    const Interval bound = op.interval(box.sides.data());
    EXPECT_FALSE(std::isnan(bound.lo) || std::isnan(bound.hi)) << box << parameters(op);
    for (int i = 0; i < 8; ++i) {
      const std::vector<double> at = box.point(r);
      const double value = op.evaluate(at.data());
      if (std::isnan(value)) continue;
      EXPECT_TRUE(bound.contains(value))
          << value << " at " << testing::PrintToString(at) << " not in [" << bound.lo << ", "
          << bound.hi << "] over " << box << parameters(op);
    }
  });
}

// A bound that is never tight would pass every other test.
TEST(BoundLaws, IntervalsOfTinyBoxesAreTight) {
  laws::for_operations(laws::effort(200), [](auto, const Operation& op, Random& r) {
    const std::vector<double> at = r.values(op.info().arity, 0);
    const double value = op.evaluate(at.data());
    if (std::isnan(value) || op.info().kind == Kind::function) return;
    std::vector<Interval> sides;
    for (double a : at) sides.push_back({a - 1e-7, a + 1e-7});
    const Interval bound = op.interval(sides.data());
    const bool is_polynomial =
        (op.info().kind == Kind::solid && !op.is_distance()) || op.info().name == "point_squared";
    const bool is_share = op.info().name.starts_with("inverse_share");
    const double steepest = op.info().name == "integer_power" ? 1e8
                            : is_polynomial || is_share       ? 2 * op.gain(sides.data()) + 1
                                                              : 12;
    EXPECT_LE(bound.hi - bound.lo, 2e-7 * steepest)
        << testing::PrintToString(at) << ' ' << parameters(op);
  });
}

// The gradients of the inputs: slopes are those by three coordinates, so a fourth one rises in some
// direction between them.
constexpr Vec3 input_gradients[max_arity] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.6, 0.8, 0}};

Slope slope_over(const Operation& op, const Box& box) {
  std::array<Slope, max_arity> in;
  for (size_t k = 0; k < box.sides.size(); ++k) {
    in[k].value = box.sides[k];
    for (size_t axis = 0; axis < 3; ++axis) in[k].partial[axis] = input_gradients[k][axis];
    in[k].length = 1;
  }
  return op.slope(in.data());
}

TEST(BoundLaws, SlopesHoldGradients) {
  laws::for_operations(laws::effort(1000), [](auto, const Operation& op, Random& r) {
    const Box box(r, op.info().arity);
    const Slope slope = slope_over(op, box);
    const double gain = op.gain(box.sides.data());
    EXPECT_FALSE(std::isnan(slope.length) || std::isnan(gain)) << box << parameters(op);
    for (int i = 0; i < 6; ++i) {
      const std::vector<double> at = box.point(r), by = laws::partials_at(op, at);
      if (std::isnan(length(by))) continue;
      // The partials at a point are rounded, too.
      const double slack = 1e-9 * (1 + length(by));
      Vec3 gradient{};
      double sum = 0;
      for (size_t k = 0; k < by.size(); ++k) {
        sum += std::abs(by[k]);
        // A slope may be infinite, and 0 of it is 0.
        for (size_t axis = 0; axis < 3; ++axis) {
          const double share = input_gradients[k][axis];
          if (share != 0) gradient[axis] += by[k] * share;
        }
      }
      for (size_t axis = 0; axis < 3; ++axis) {
        const Interval bound = slope.partial[axis];
        const double rise = gradient[axis];
        EXPECT_TRUE(bound.lo - slack <= rise && rise <= bound.hi + slack)
            << "slope " << axis << ' ' << rise << " at " << testing::PrintToString(at)
            << " not in [" << bound.lo << ", " << bound.hi << "] over " << box << parameters(op);
      }
      EXPECT_LE(length({gradient.begin(), gradient.end()}), slope.length + slack)
          << testing::PrintToString(at) << " over " << box << parameters(op);
      EXPECT_LE(sum, gain + slack)
          << testing::PrintToString(at) << " over " << box << parameters(op);
    }
  });
}

// |f(p) - f(q)| <= L |p - q|: also across kinks and jumps, where a gradient says nothing.
TEST(BoundLaws, SlopesBoundDifferences) {
  laws::for_operations(
      laws::effort(1000), [](const laws::ListedOperation& listed, const Operation& op, Random& r) {
        // The fields that are built with such operations are held to this in test_laws_trees.cpp.
        if (listed.hides_jumps) return;
        const Box box(r, op.info().arity);
        // Four inputs that change freely are no function of three coordinates.
        const double steepest =
            op.info().arity > 3 ? op.gain(box.sides.data()) : slope_over(op, box).length;
        for (int i = 0; i < 6; ++i) {
          const std::vector<double> p = box.point(r), q = box.point(r);
          std::vector<double> apart(p.size());
          for (size_t k = 0; k < p.size(); ++k) apart[k] = p[k] - q[k];
          const double f = op.evaluate(p.data()), g = op.evaluate(q.data());
          if (!(std::abs(f) + std::abs(g) < infinity)) continue;
          const double most = std::max(laws::magnitude(op, p, f), laws::magnitude(op, q, g));
          const double allowed = steepest * length(apart);
          EXPECT_LE(std::abs(f - g),
                    (std::isnan(allowed) ? infinity : allowed) * (1 + 1e-12) + 1e-13 * most)
              << testing::PrintToString(p) << " and " << testing::PrintToString(q) << " over "
              << box << parameters(op);
        }
      });
}

TEST(BoundLaws, MonotoneOperationsAreMonotone) {
  size_t tested = 0;
  laws::for_operations(laws::effort(1000), [&](const laws::ListedOperation& listed,
                                               const Operation& op, Random& r) {
    if (!listed.monotone.empty()) {
      ++tested;
      const std::vector<double> low = r.values(op.info().arity, 0.2);
      std::vector<double> high = low;
      for (size_t k = 0; k < high.size(); ++k) {
        if (r.chance(0.3)) continue;
        const double step = r.decades(-12, 1) * std::max(1.0, r.chance(0.5) ? std::abs(low[k]) : 0);
        high[k] += listed.monotone[k] * step;
      }
      const double f = op.evaluate(low.data()), g = op.evaluate(high.data());
      const double most = std::max(laws::magnitude(op, low, f), laws::magnitude(op, high, g));
      EXPECT_LE(f, g + 32 * 0x1p-52 * most)
          << testing::PrintToString(low) << " to " << testing::PrintToString(high) << ", "
          << parameters(op);
    }
  });
  EXPECT_GT(tested, 0u);
}

TEST(BoundLaws, DistancesAreDistances) {
  size_t tested = 0, directed = 0;
  laws::for_operations(laws::effort(1000), [&](auto, const Operation& op, Random& r) {
    if (!op.is_distance()) return;
    ++tested;
    const std::vector<double> p = r.values(op.info().arity, 0.05, 1e9);
    std::vector<double> q = r.values(op.info().arity, 0.05, 1e9), apart(p.size());
    const double step = r.decades(-9, 1);
    for (size_t k = 0; k < p.size(); ++k) {
      if (r.chance(0.5)) q[k] = p[k] + step * r.uniform(-1, 1);
      apart[k] = p[k] - q[k];
    }
    const double f = op.evaluate(p.data()), g = op.evaluate(q.data());
    const double most = std::max(laws::magnitude(op, p, f), laws::magnitude(op, q, g));
    EXPECT_LE(std::abs(f - g), length(apart) + 64 * 0x1p-52 * most)
        << testing::PrintToString(p) << " and " << testing::PrintToString(q) << ", "
        << parameters(op);
    const double norm = length(laws::partials_at(op, p));
    if (std::isnan(norm)) return;
    ++directed;
    EXPECT_NEAR(norm, 1, 1e-9) << testing::PrintToString(p) << ' ' << parameters(op);
  });
  EXPECT_GT(directed, tested * 9 / 10);
}

TEST(BoundLaws, BlendErrorsHold) {
  size_t tested = 0;
  laws::for_operations(
      laws::effort(3000), [&](const laws::ListedOperation& listed, const Operation& op, Random& r) {
        // An infinite error and one of 0 are checked with their blends, in test_laws_blends.cpp.
        if (!(op.blend_error() > 0 && op.blend_error() < infinity)) return;
        ++tested;
        const std::vector<double> at = r.values(2, 0.1);
        const bool is_union = listed.name.ends_with("_union");
        const double y = listed.monotone[1] > 0 ? at[1] : -at[1];
        const double plain = is_union ? std::max(at[0], y) : std::min(at[0], y);
        const double value = op.evaluate(at.data());
        const double most = laws::magnitude(op, at, value);
        EXPECT_LE(std::abs(value - plain), op.blend_error() + 16 * 0x1p-52 * most + 1e-150)
            << testing::PrintToString(at) << ' ' << parameters(op);
        // One-sided: an intersection is never above min, a union never below max.
        EXPECT_LE(is_union ? plain - value : value - plain, 16 * 0x1p-52 * most + 1e-150)
            << testing::PrintToString(at) << ' ' << parameters(op);
      });
  EXPECT_GT(tested, 0u);
}

}  // namespace
}  // namespace sardf

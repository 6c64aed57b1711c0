// Law of every operation and constructor: derivatives equal central differences away from kinks.
#include <gtest/gtest.h>

#include "laws.hpp"

namespace sardf {
namespace {

using laws::Random;

/// A derivative by differences, and how far it can be trusted; infinite at a kink.
struct Difference {
  double value;
  double doubt;
};

template <class F>
Difference difference(F f, std::vector<double> at, size_t k, double scale) {
  const double centre = at[k], h = 1e-5 * scale;
  const auto value = [&](double step) {
    at[k] = centre + step;
    return f(at);
  };
  const double here = value(0);
  const double right = (value(h) - here) / h, left = (here - value(-h)) / h;
  const double wide = (value(h) - value(-h)) / (2 * h);
  const double narrow = (value(h / 2) - value(-h / 2)) / h;
  const double size = 1 + std::abs(wide);
  // One-sided slopes that differ by more than a curvature of 100 would make are a kink's.
  const bool smooth = std::abs(right - left) < 1e-3 * size;
  const double rounding = 1e-14 * (std::abs(here) + std::abs(centre) + 1) / h;
  // What is as steep as this comes of quotients near a pole, with fewer digits.
  const double share = size > 1e5 ? 1e-6 : 1e-7;
  return {narrow, smooth ? 2 * std::abs(wide - narrow) + rounding + share * size : infinity};
}

TEST(GradientLaws, PartialsEqualDifferences) {
  laws::for_operations(1, [](const laws::ListedOperation& listed, const Operation&, Random& r) {
    size_t compared = 0, tried = 0;
    OperationPointer op;
    for (int i = 0; i < laws::effort(1000); ++i) {
      if (i % 20 == 0) op = listed.random(r);
      const std::vector<double> at = r.values(op->info().arity, 0);
      std::array<const double*, max_arity> in{};
      std::array<double*, max_arity> to{};
      std::array<double, max_arity> partial{};
      for (size_t k = 0; k < at.size(); ++k) {
        in[k] = &at[k];
        to[k] = &partial[k];
      }
      double value;
      op->partials(in.data(), &value, to.data(), 1);
      if (std::isnan(value)) continue;
      const auto f = [&](const std::vector<double>& x) { return op->evaluate(x.data()); };
      for (size_t k = 0; k < at.size(); ++k) {
        ++tried;
        const Difference expected = difference(f, at, k, 1);
        if (!(expected.doubt < infinity)) continue;
        ++compared;
        EXPECT_NEAR(partial[k], expected.value, expected.doubt)
            << "partial " << k << " at " << testing::PrintToString(at) << ", parameters "
            << testing::PrintToString(op->numbers());
      }
    }
    EXPECT_GT(compared, tried / 2);
  });
}

TEST(GradientLaws, FieldsEqualDifferences) {
  Random r(11);
  size_t compared = 0, tried = 0;
  for (const Constructor& constructor : constructors()) {
    if (!laws::can_be_random(constructor)) continue;
    SCOPED_TRACE(constructor.name);
    for (int i = 0; i < laws::effort(100); ++i) {
      const Evaluator evaluator(random_field(r, constructor, 2).expression());
      const std::vector<double> at = r.values(3, 0);
      double value, gradient[3];
      evaluator.gradients(at.data(), 1, &value, gradient);
      const auto f = [&](const std::vector<double>& x) {
        return evaluator.value({x[0], x[1], x[2]});
      };
      for (size_t axis = 0; axis < 3; ++axis) {
        ++tried;
        const Difference expected = difference(f, at, axis, 1);
        if (!(expected.doubt < infinity)) continue;
        // Where a field that vanishes in a whole region meets another edge, no direction exists.
        if (value == 0 && std::isnan(gradient[axis])) continue;
        ++compared;
        EXPECT_NEAR(gradient[axis], expected.value, expected.doubt)
            << "axis " << axis << " at " << testing::PrintToString(at);
      }
    }
  }
  EXPECT_GT(compared, tried / 2);
}

}  // namespace
}  // namespace sardf

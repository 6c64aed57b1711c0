// Derivatives and Taylor coefficients as expressions.
#include "sardf/derivative.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "error_of.hpp"
#include "povray_gen/function_text.hpp"
#include "povray_harness.hpp"
#include "sardf/arithmetic.hpp"
#include "sardf/constructor.hpp"
#include "sardf/data_operation.hpp"
#include "sardf/evaluate.hpp"
#include "sardf/formula.hpp"

namespace sardf {
namespace {

const Expression X = coordinate(0), Y = coordinate(1), Z = coordinate(2);

Expression formula(const std::string& text) { return parse_formula(text, {}, {}).expression(); }
double value(const Expression& f, const Vec3& at) { return Evaluator(f).value(at); }

Expression made(const char* constructor, std::vector<Value> arguments) {
  return make_field(constructor, std::move(arguments)).expression();
}

std::vector<Expression> some_fields() {
  return {made("sphere", {Vec3{0.1, 0, 0}, 1.0}),
          made("ellipsoid", {Vec3{}, Vec3{2, 1, 0.7}}),
          made("torus", {Vec3{}, Vec3{1, 2, 3}, 1.5, 0.4}),
          made("cone", {Vec3{}, Vec3{0, 1, 1}, 1.2, 0.3, 2.0}),
          made("segment", {Vec3{-1, 0, 0}, Vec3{1, 1, 0.5}}),
          formula("exp(-x)*sin(y*z) + atan2(y + 3, x + 5) + (x + 4)^1.7 + (2 + sin(z))^x"),
          formula("length(x, y, z + 2)*log(5 + x) + asin(x/9) - acos(y/9) + tan(z/9) + mod(x, 7)"),
          formula("max(x*x - y, min(z, x*y)) + abs(z - 3) + smoothstep(-4, 5, x*y)")};
}

TEST(Derivative, OfFormulasInClosedForm) {
  const Vec3 at{0.7, -0.4, 1.3};
  const Expression f = formula("x^3*y + sin(x*z)");
  EXPECT_NEAR(value(derivative(f, 0), at), 3 * 0.49 * -0.4 + 1.3 * std::cos(0.91), 1e-15);
  EXPECT_NEAR(value(derivative(f, 1), at), 0.343, 1e-15);
  EXPECT_NEAR(value(derivative(derivative(f, 0), 2), at), std::cos(0.91) - 0.91 * std::sin(0.91),
              1e-15);
  EXPECT_NEAR(value(derivative(f, Vec3{0, 2, 0}), at), 0.686, 1e-15);
  // What does not vary is no node.
  EXPECT_EQ(derivative(f, 1)->coordinates, 1);
  EXPECT_EQ(derivative(formula("x + 2"), 1), constant(0));
  EXPECT_EQ(derivative(X, 0), constant(1));
}

TEST(Derivative, AtKinksIsThatOfTheBranchThatGivesTheValue) {
  const Vec3 tie{2, 2, 0};
  // Where both give it, the second argument's, as for gradients.
  EXPECT_EQ(value(derivative(formula("min(3*x, 3*y)"), 0), tie), 0);
  EXPECT_EQ(value(derivative(formula("min(3*x, 3*y)"), 1), tie), 3);
  EXPECT_EQ(value(derivative(formula("max(3*x, 3*y)"), 1), tie), 3);
  EXPECT_EQ(value(derivative(formula("abs(z)"), 2), tie), 1);
  EXPECT_EQ(value(derivative(formula("floor(x + z)"), 2), tie), 0);
  // The mean where a blend is smooth across the tie.
  const Expression joined =
      make_field("union", {std::vector<Field>{Field::coordinate(0), Field::coordinate(1)},
                           make_blend("sardf", {0.5})})
          .expression();
  EXPECT_DOUBLE_EQ(value(derivative(joined, 0), tie), value(derivative(joined, 1), tie));
  // A branch that is not taken may have none.
  EXPECT_EQ(value(derivative(formula("max(length(x, y), 1)"), 0), {0, 0, 0}), 0);
  EXPECT_EQ(value(derivative(formula("select(x > 0, sqrt(x), 5*x)"), 0), {-1, 0, 0}), 5);
  EXPECT_TRUE(std::isnan(value(derivative(formula("length(x, y)"), 0), {0, 0, 0})));
}

TEST(Derivative, OfAnExactDistanceIsBounded) {
  const BoundingBox box{{-1, -1, -1}, {1, 1, 1}};
  for (const char* name : {"point", "circle", "segment"}) {
    const std::string word = name;
    const Expression u = word == "point"    ? made(name, {Vec3{}})
                         : word == "circle" ? made(name, {Vec3{}, 0.5, Vec3{0, 0, 1}})
                                            : made(name, {Vec3{}, Vec3{1, 2, 3}});
    for (const Expression& d : gradient(u)) {
      const Interval bound = Evaluator(d).interval(box);
      EXPECT_GE(bound.lo, -1 - 1e-15) << name;
      EXPECT_LE(bound.hi, 1 + 1e-15) << name;
      // NaN is not turned into an end.
    }
    EXPECT_TRUE(std::isnan(value(derivative(u, 0), word == "circle" ? Vec3{0.5, 0, 0} : Vec3{})));
  }
}

TEST(DirectionalSeries, HoldsTheFunctionAlongTheRay) {
  constexpr int order = 12;
  const Vec3 at{0.83, 0.61, 0.47}, along{0.4, -0.5, 0.7};
  for (const Expression& f : some_fields()) {
    const std::vector<Expression> series =
        directional_series(f, {constant(along[0]), constant(along[1]), constant(along[2])}, order);
    ASSERT_EQ(series.size(), size_t(order + 1));
    const Evaluator evaluator(series);
    std::vector<double> c(series.size());
    evaluator.values(at, c.data());
    for (const double h : {-0.03, -0.01, 0.01, 0.03}) {
      double sum = 0;
      for (int k = order; k >= 0; --k) sum = sum * h + c[size_t(k)];
      // The next term is about (h / radius of convergence)^13.
      EXPECT_NEAR(sum, value(f, at + h * along), 1e-11) << f->operation->info().name;
    }
  }
}

TEST(DirectionalSeries, CoefficientsAreDerivatives) {
  const Vec3 at{0.83, 0.61, 0.47}, along{0.4, -0.5, 0.7};
  for (const Expression& f : some_fields()) {
    const std::vector<Expression> series =
        directional_series(f, {constant(along[0]), constant(along[1]), constant(along[2])}, 4);
    Expression d = f;
    for (int k = 1, factorial = 1; k <= 4; factorial *= ++k) {
      d = derivative(d, along);
      const double expected = value(d, at);
      EXPECT_NEAR(value(series[size_t(k)], at) * factorial, expected,
                  1e-9 * (1 + std::abs(expected)))
          << f->operation->info().name << ", order " << k;
    }
  }
}

// exp(x + 2 y - z) as data.
class Wave final : public DataOperation {
 public:
  explicit Wave(bool knows_slope)
      : DataOperation({"wave", Kind::internal, 3, "A wave."}, {double(knows_slope)}),
        knows_slope_(knows_slope) {}
  void evaluate(const double* const* in, double* out, size_t n) const override {
    for (size_t i = 0; i < n; ++i) out[i] = std::exp(in[0][i] + 2 * in[1][i] - in[2][i]);
  }
  using DataOperation::evaluate;
  void partials(const double* const* in, double* out, double* const* partial,
                size_t n) const override {
    evaluate(in, out, n);
    for (size_t i = 0; i < n; ++i) {
      for (size_t k = 0; k < 3; ++k) partial[k][i] = slopes[k] * out[i];
    }
  }
  Interval interval(const Interval*) const override { return {0, infinity}; }
  Slope slope(const Slope* in) const override {
    const std::array<Interval, 3> any{Interval::all(), Interval::all(), Interval::all()};
    return slope_from(in, {0, infinity}, any, infinity);
  }
  Expression derivative(int k, std::span<const Expression> inputs) const override {
    if (!knows_slope_) return nullptr;
    return constant(slopes[size_t(k)]) * call(std::make_shared<Wave>(true), inputs);
  }

 private:
  static constexpr Vec3 slopes{1, 2, -1};
  bool knows_slope_;
};

TEST(DirectionalSeries, OfOperationsWithoutAFormula) {
  const auto wave = std::make_shared<Wave>(true);
  // Along the ray the arguments are 0.3 + s², s and 2 s: exp(0.3 + s²).
  const Expression f = call(wave, {square_root(constant(0.09)) + X * X, X, constant(2) * X});
  const std::vector<Expression> series =
      directional_series(f, {constant(1), constant(0), constant(0)}, 12);
  double factorial = 1;
  for (int k = 0; k <= 12; ++k) {
    if (k > 1 && k % 2 == 0) factorial *= k / 2;
    EXPECT_NEAR(value(series[size_t(k)], {}), k % 2 ? 0 : std::exp(0.3) / factorial, 1e-13) << k;
  }
  EXPECT_NEAR(value(derivative(derivative(f, 0), 0), {}), 2 * std::exp(0.3), 1e-13);

  const Expression unknown = call(std::make_shared<Wave>(false), {X, Y, Z});
  EXPECT_EQ(error_of([&] { derivative(unknown, 0); }), "the derivative of 'wave' is not known");
  EXPECT_EQ(error_of([&] {
              directional_series(unknown, {X, Y, Z}, 2);
            }),
            "the derivative of 'wave' is not known");
}

// Nothing recurses, and the work is linear.
TEST(DerivativeSlow, OfDeepChains) {
  const auto nodes_of_derivative = [](int depth) {
    Expression f = X;
    for (int i = 0; i < depth / 2; ++i) f = function("sin", {f}) + Y;
    const size_t before = live_nodes();
    const std::array<Expression, 3> slopes = gradient(f);
    const std::vector<Expression> series =
        directional_series(f, {constant(1), constant(0), constant(0)}, 2);
    return live_nodes() - before;
  };
  const size_t some = nodes_of_derivative(10000), all = nodes_of_derivative(100000);
  EXPECT_LT(all, 11 * some);
  EXPECT_LT(all, 15u * 100000);
}

// A sum of n products has a derivative of about n products, however often it is derived.
TEST(Derivative, GrowsPolynomially) {
  Expression f = X;
  for (int i = 0; i < 20; ++i) f = f * (f + Y);
  const size_t before = live_nodes();
  const std::vector<Expression> series =
      directional_series(f, {constant(1), constant(0.5), constant(0)}, 12);
  EXPECT_LT(live_nodes() - before, 40u * 13 * 13 * 2);
}

struct OnePoint : PointSet {
  static constexpr Vec3 p{1, 2, 3};
  OnePoint() : PointSet("one_point", "A point.", p) {}
  Nearest nearest(const Vec3& from) const override {
    const double d = norm(from - p);
    return {p, d, (1 / d) * (from - p), 0, {}};
  }
  std::array<Vec3, 3> jacobian(const Vec3&, const Nearest&) const override { return {}; }
  std::array<Interval, 3> bounds() const override { return {1.0, 2.0, 3.0}; }
};

TEST(Foot, IsTheNearestPoint) {
  const auto expect_foot = [](const Expression& u, const Vec3& at, const Vec3& expected) {
    const std::array<Expression, 3> found = foot(u);
    for (size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(value(found[axis], at), expected[axis], 4e-16 * 4) << "axis " << axis;
    }
  };
  const Expression circle = made("circle", {Vec3{0, 0, 1}, 2.0, Vec3{0, 0, 1}});
  expect_foot(circle, {3, 4, 7}, {1.2, 1.6, 1});
  expect_foot(circle, {2, 0, 1}, {2, 0, 1});  // on it
  const Expression segment = made("segment", {Vec3{}, Vec3{4, 0, 0}});
  expect_foot(segment, {1, 2, 2}, {1, 0, 0});
  expect_foot(segment, {7, 4, 0}, {4, 0, 0});
  expect_foot(segment, {3, 0, 0}, {3, 0, 0});
  // By a search: exact and known where the distance has no direction, too.
  const Expression searched = call(distance_operation(std::make_shared<OnePoint>()), {X, Y, Z});
  expect_foot(searched, {0.1, 0.7, -5}, {1, 2, 3});
  expect_foot(searched, {1, 2, 3}, {1, 2, 3});
  expect_foot(substitute(searched, {X + constant(1), Y, Z}), {0.1, 0.7, -5}, {0, 2, 3});
}

TEST(Derivative, PovRayComputesTheSame) {
  std::vector<povray::NamedExpression> fields;
  std::vector<Expression> all;
  for (const Expression& f : some_fields()) {
    const Expression d = derivative(f, 0);
    all.insert(all.end(), {d, derivative(d, 1), directional_series(f, {Z, X, Y}, 3)[3]});
  }
  for (size_t i = 0; i < all.size(); ++i) fields.push_back({"f" + std::to_string(i), all[i]});
  povray::Names names("test");
  povray::FunctionWriter writer(names);
  const std::vector<std::string> functions = writer.declare(fields);
  std::vector<FunctionCall> calls;
  std::vector<double> expected;
  for (size_t i = 0; i < all.size(); ++i) {
    for (const Vec3& at : {Vec3{0.83, 0.61, 0.47}, {-0.5, 1.7, -0.9}, {1.9, -0.8, 2.2}}) {
      calls.push_back({functions[i], {at[0], at[1], at[2]}});
      expected.push_back(value(all[i], at));
    }
  }
  const std::vector<double> found = evaluate_in_povray(writer.text(), calls);
  for (size_t i = 0; i < calls.size(); ++i) {
    EXPECT_NEAR(found[i], expected[i], 1e-9 * (1 + std::abs(expected[i]))) << calls[i].function;
  }
}

}  // namespace
}  // namespace sardf

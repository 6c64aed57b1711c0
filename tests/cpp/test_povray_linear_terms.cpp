// Linear parts of formulas, written with fewer operators: the values stay.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "povray_gen/linear_terms.hpp"

namespace sardf {
namespace {

using povray::Term;
using povray::Terms;

double value_of(const Terms& terms, int root, const std::array<double, 4>& inputs) {
  std::vector<double> values;
  for (int i = 0; i <= root; ++i) {
    const Term& term = terms[i];
    const auto in = [&](size_t k) { return values[size_t(term.operands[k])]; };
    double value = term.value;
    if (term.kind == Term::Kind::input) value = inputs[size_t(term.index)];
    if (term.function == "+") value = in(0) + in(1);
    if (term.function == "-") value = in(0) - in(1);
    if (term.function == "*") value = in(0) * in(1);
    if (term.function == "/") value = in(0) / in(1);
    if (term.function == "negate") value = -in(0);
    if (term.function == "min") value = std::min(in(0), in(1));
    if (term.function == "select") value = in(0) < 0 ? in(1) : in(2);
    values.push_back(value);
  }
  return values[size_t(root)];
}

class LinearTerms : public testing::Test {
 protected:
  LinearTerms() : x_(terms_.input(0)), y_(terms_.input(1)), z_(terms_.input(2)) {}
  int plus(int a, int b) { return terms_.apply("+", {a, b}); }
  int minus(int a, int b) { return terms_.apply("-", {a, b}); }
  int times(double a, int b) { return terms_.apply("*", {terms_.number(a), b}); }

  Terms terms_;
  int x_, y_, z_;
};

TEST_F(LinearTerms, OfAHalfPlaneInAScaledFrameAreFourOperators) {
  const int u = plus(times(1.15, x_), terms_.number(3.2));
  const int v = plus(minus(times(1.15, z_), terms_.number(0.09)), terms_.number(6));
  const int root = plus(times(-0.32, u), times(0.95, v));
  const auto [shorter, end] = with_short_linear_terms(terms_, root);
  EXPECT_GE(terms_.operations(root, 100), 8);
  EXPECT_LE(shorter.operations(end, 100), 4);
  for (const double x : {-3.0, 0.0, 0.7}) {
    for (const double z : {-2.0, 0.1, 5.0}) {
      EXPECT_NEAR(value_of(shorter, end, {x, 9, z, 0}),
                  -0.32 * (1.15 * x + 3.2) + 0.95 * (1.15 * z - 0.09 + 6), 1e-14);
    }
  }
}

TEST_F(LinearTerms, ThatAreShortStayInEveryBit) {
  for (const int root : {x_, minus(terms_.number(3), y_), plus(terms_.number(0.1), z_),
                         minus(times(0.3, x_), times(0.7, y_)), terms_.number(-0.0)}) {
    const auto [shorter, end] = with_short_linear_terms(terms_, root);
    const std::array<double, 4> at{0.123456789, 1.23456789e-7, -12.3456789, 0};
    EXPECT_EQ(value_of(shorter, end, at), value_of(terms_, root, at));
    EXPECT_EQ(shorter.operations(end, 100), terms_.operations(root, 100));
  }
}

// Printers name the inputs x, y and z by their places.
TEST_F(LinearTerms, HaveAllInputsBeforeThem) {
  for (const int root : {x_, y_, z_}) {
    const auto [shorter, end] = with_short_linear_terms(terms_, root);
    EXPECT_EQ(end, root);
    ASSERT_EQ(shorter.size(), 3);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(shorter[axis].kind, Term::Kind::input);
      EXPECT_EQ(shorter[axis].index, axis);
    }
  }
}

TEST_F(LinearTerms, AreThoseOfRandomFormulas) {
  std::mt19937 random(1);
  const auto below = [&](int n) { return int(random() % unsigned(n)); };
  for (int trial = 0; trial < 500; ++trial) {
    Terms terms;
    std::vector<int> made{terms.input(0), terms.input(1), terms.input(2), terms.input(3)};
    for (int i = 0; i < 25; ++i) {
      const int a = made[size_t(below(int(made.size())))],
                b = made[size_t(below(int(made.size())))];
      const int number = terms.number(0.25 * (below(16) - 7) + 0.1);
      switch (below(7)) {
        case 0:
          made.push_back(terms.apply("+", {a, below(2) ? b : number}));
          break;
        case 1:
          made.push_back(terms.apply("-", {below(2) ? number : a, b}));
          break;
        case 2:
          made.push_back(terms.apply("*", {number, b}));
          break;
        case 3:
          made.push_back(terms.apply("/", {a, number}));
          break;
        case 4:
          made.push_back(terms.apply("negate", {a}));
          break;
        case 5:
          made.push_back(terms.apply("min", {a, b}));
          break;
        default:
          made.push_back(terms.apply("*", {a, b}));
      }
    }
    const auto [shorter, end] = with_short_linear_terms(terms, made.back());
    EXPECT_LE(shorter.operations(end, 1000), terms.operations(made.back(), 1000) + 3);
    for (int k = 0; k < 10; ++k) {
      std::array<double, 4> at;
      for (double& a : at) a = std::uniform_real_distribution<double>(-1, 1)(random);
      const double exact = value_of(terms, made.back(), at);
      EXPECT_NEAR(value_of(shorter, end, at), exact, 1e-9 * (1 + std::abs(exact)));
    }
  }
}

}  // namespace
}  // namespace sardf

// Inverse distance weights are a partition of unity wherever they are asked for.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sardf/constructor.hpp"
#include "sardf/evaluate.hpp"
#include "sardf/formula.hpp"
#include "sardf/fractions.hpp"

namespace sardf {
namespace {

class Weights {
 public:
  explicit Weights(uint64_t seed) : engine_(seed) {}

  double uniform(double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(engine_);
  }
  Vec3 point(double reach) {
    return {uniform(-reach, reach), uniform(-reach, reach), uniform(-reach, reach)};
  }

  Field feature(std::vector<Vec3>& on) {
    const Vec3 a = point(3), b = point(3);
    on.push_back(a);
    switch (int(uniform(0, 4))) {
      case 0:
        return make_field("point", {a});
      case 1:
        return make_field("segment", {a, b});
      case 2:
        return make_field("sphere", {a, uniform(0.1, 1.0)});
      default:
        return make_field("polyline", {std::vector<Vec3>{a, b, point(3)}, true});
    }
  }

  RuleValue influence(const Field& at) {
    const auto u = [&] { return formula_field(feature_distance(at), "u", {}); };
    switch (int(uniform(0, 6))) {
      case 0:
        return parse_formula("exp(60*u)", {{"u", u()}}, {});
      case 1:
        return parse_formula("0.3*exp(60*u)", {{"u", u()}}, {});
      case 2:
        return parse_formula("1 + exp(60*u)", {{"u", u()}}, {});
      case 3:
        return parse_formula("exp(-60*u)", {{"u", u()}}, {});
      case 4:
        return Field::number(uniform(0.01, 100));
      default:
        return {};
    }
  }

 private:
  std::mt19937_64 engine_;
};

struct Rule {
  std::vector<Expression> weights;
  std::vector<Vec3> on;  // a point of each feature
};

Rule random_rule(Weights& random, int n) {
  Rule made;
  std::vector<Record> features;
  std::vector<std::string> names;
  for (int i = 0; i < n; ++i) {
    names.push_back("m" + std::to_string(i));
    // Every third begins where the one before it does, so that they meet.
    const Field at = i % 3 == 2 ? make_field("segment", {made.on.back(), random.point(3)})
                                : random.feature(made.on);
    features.push_back(
        {{at, Fractions::material(names.back()), random.uniform(0.1, 12), random.influence(at)}});
  }
  made.weights = lower(make_fractions("inverse_distance", {features}), names, 10);
  return made;
}

std::vector<Vec3> places(Weights& random, const Rule& rule) {
  std::vector<Vec3> all = rule.on;
  for (int i = 0; i < 40; ++i) all.push_back(random.point(4));
  for (int i = 0; i < 10; ++i) all.push_back(random.point(1000));
  for (const double far : {1e8, 1e15, 1e30}) {
    all.push_back({far, 0, 0});
    all.push_back({-far, far, far});
  }
  for (const Vec3& p : rule.on) all.push_back(p + Vec3{1e-13, 0, 0});
  return all;
}

TEST(PartitionOfUnity, HoldsForRandomFeaturesExponentsAndInfluences) {
  Weights random(7);
  for (int round = 0; round < 60; ++round) {
    const int n = 2 + round % 7;
    const Rule rule = random_rule(random, n);
    const Evaluator evaluator(rule.weights);
    for (const Vec3& p : places(random, rule)) {
      std::vector<double> w(size_t(n), 0.0);
      evaluator.values(p, w.data());
      double sum = 0;
      for (const double a : w) {
        EXPECT_GE(a, 0) << p[0] << " " << p[1] << " " << p[2];
        sum += a;
      }
      EXPECT_NEAR(sum, 1, 2.3e-16 * n) << p[0] << " " << p[1] << " " << p[2];
    }
  }
}

TEST(PartitionOfUnity, HoldsInFloat) {
  Weights random(8);
  for (int round = 0; round < 60; ++round) {
    const int n = 2 + round % 7;
    const Rule rule = random_rule(random, n);
    const Evaluator evaluator(rule.weights);
    for (const Vec3& p : places(random, rule)) {
      const float at[3] = {float(p[0]), float(p[1]), float(p[2])};
      std::vector<float> w(size_t(n), 0.0f);
      evaluator.values(at, 1, w.data());
      float sum = 0;
      for (const float a : w) {
        EXPECT_GE(a, 0) << p[0] << " " << p[1] << " " << p[2];
        sum += a;
      }
      EXPECT_NEAR(sum, 1, 1.3e-7 * n) << p[0] << " " << p[1] << " " << p[2];
    }
  }
}

// Where a distance has a direction, the weights have a gradient, and the gradients cancel.
TEST(PartitionOfUnity, HasGradientsThatSumToZero) {
  Weights random(9);
  for (int round = 0; round < 40; ++round) {
    const int n = 2 + round % 5;
    const Rule rule = random_rule(random, n);
    for (const Vec3& p : places(random, rule)) {
      const float at[3] = {float(p[0]), float(p[1]), float(p[2])};
      Vec3 sum{};
      double largest = 0;
      for (const Expression& weight : rule.weights) {
        Vec3 gradient;
        float in_float[3];
        Evaluator(weight).gradients(p.data(), 1, nullptr, gradient.data());
        Evaluator(weight).gradients(at, 1, nullptr, in_float);
        for (int axis = 0; axis < 3; ++axis) {
          EXPECT_TRUE(std::isfinite(gradient[axis])) << p[0] << " " << p[1] << " " << p[2];
          EXPECT_FALSE(std::isnan(in_float[axis])) << p[0] << " " << p[1] << " " << p[2];
        }
        sum = sum + gradient;
        largest = std::max(largest, norm(gradient));
      }
      EXPECT_LE(norm(sum), 1e-12 * std::max(1.0, largest));
    }
  }
}

TEST(PartitionOfUnity, TakesAnyExponent) {
  for (const double exponent : {1e-3, 40.0, 1e6, 1e40, 1e99}) {
    const std::vector<Record> features{
        {{make_field("point", {Vec3{}}), Fractions::material("a"), exponent, {}}},
        {{make_field("point", {Vec3{1, 0, 0}}), Fractions::material("b"), exponent, {}}}};
    const auto weights = lower(make_fractions("inverse_distance", {features}), {"a", "b"}, 1);
    for (const double x : {0.0, 0.2, 0.5, 0.9, 1.0, 50.0}) {
      double w[2];
      Evaluator(weights).values({x, 0, 0}, w);
      EXPECT_NEAR(w[0] + w[1], 1, 1e-15) << exponent << " " << x;
      // The nearer counts at least as much.
      EXPECT_TRUE(x < 0.5 ? w[0] >= w[1] : w[1] >= w[0]) << exponent << " " << x;
    }
  }
}

}  // namespace
}  // namespace sardf

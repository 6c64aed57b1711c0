// The errors of fields that are computed from samples: proven bounds hold, and are not far from
// what is measured.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "povray_gen/scene_samples.hpp"
#include "povray_harness.hpp"
#include "sampled_shapes.hpp"
#include "sardf/arithmetic.hpp"
#include "sardf/operation_of.hpp"
#include "sardf/ops.hpp"
#include "sardf/ops_domain.hpp"
#include "sardf/scene_file.hpp"
#include "source_folder.hpp"

namespace sardf {
namespace {

using povray::FieldError;
using povray::SamplingOptions;
using testing::HasSubstr;

const Expression X = coordinate(0), Y = coordinate(1), Z = coordinate(2);
const BoundingBox bounds{{-1.01, -1.02, -1.03}, {1.04, 1.05, 1.06}};

Expression number(double a) { return constant(a); }

Expression distance_to(std::vector<Vec3> points, const Expression& x = X) {
  return call(distance_operation(std::make_shared<TestPoints>("dots", std::move(points))),
              {x, Y, Z});
}
Expression dots() { return distance_to({{0.31, -0.42, 0.17}, {-0.6, 0.2, 0.45}}); }

struct Made {
  FieldError error;
  std::vector<double> samples;  // the proven errors of the sampled functions
  double worst = 0;             // at random points
};

double worst_difference(const Expression& exact, const Expression& sampled, const BoundingBox& box,
                        int points) {
  std::mt19937 random(11);
  const std::array<Expression, 2> both{exact, sampled};
  const Evaluator evaluator(both);
  double worst = 0, values[2];
  for (int i = 0; i < points; ++i) {
    Vec3 p;
    for (size_t k = 0; k < 3; ++k) {
      p[k] = std::uniform_real_distribution<double>(box.lo[k], box.hi[k])(random);
    }
    evaluator.values(p, values);
    worst = std::max(worst, std::abs(values[0] - values[1]));
  }
  return worst;
}

Made made_of(const Expression& exact) {
  SamplingOptions options;
  options.most_samples = 20000;
  const std::vector<Expression> all{exact};
  const povray::Sampling sampling = povray::sample_operations(all, bounds, "part", options);
  Made out;
  out.error = povray::errors_of_fields(all, sampling.expressions, bounds).at(0);
  for (const auto& function : sampling.functions) out.samples.push_back(function->error().proven);
  out.worst = worst_difference(exact, sampling.expressions[0], bounds, 20000);
  EXPECT_LE(out.worst, out.error.proven);
  EXPECT_LE(out.worst, 2 * out.error.measured);
  EXPECT_GE(out.worst, 0.5 * out.error.measured);
  return out;
}

TEST(PovrayFieldErrors, OfSumsAndProductsWithNumbersAreThoseOfTheSamples) {
  const Expression u = dots();
  const Made one = made_of(u);
  ASSERT_EQ(one.samples.size(), 1u);
  EXPECT_NEAR(one.error.proven, one.samples[0], 1e-9);
  const Made twice = made_of(X + number(2) * u);
  EXPECT_NEAR(twice.error.proven, 2 * twice.samples[0], 1e-9);
  // What is used twice is the same both times: not 5 times.
  const Made difference = made_of(number(3) * u - number(2) * u);
  EXPECT_NEAR(difference.error.proven, difference.samples[0], 1e-9);
}

TEST(PovrayFieldErrors, OfFunctionsAreThoseOfTheirSlopes) {
  const Expression u = dots();
  // The largest slope of e^(-2 u) is 2, where u is 0; of u^2, 2 u at the farthest corner.
  const Made falling = made_of(exp(number(-2) * u));
  EXPECT_LE(falling.error.proven, 2.001 * falling.samples[0]);
  EXPECT_GE(falling.error.proven, 1.7 * falling.samples[0]);
  const double farthest = norm(Vec3{1.04 + 0.6, 1.05 + 1.02, 1.03 + 1.06});
  const Made squared = made_of(u * u);
  EXPECT_LE(squared.error.proven, 2 * (farthest + 0.1) * squared.samples[0]);
  EXPECT_GE(squared.error.proven, squared.samples[0]);
}

// Slope 3 below the kink and 1 above it. Over an interval with the kink in it both terms count, 4;
// but not all the way from exact to sampled values is within reach of it.
TEST(PovrayFieldErrors, OfAKinkAreThoseOfItsSteeperSide) {
  const Expression u = dots();
  const Expression below = max(number(0), number(0.5) - u), above = max(number(0), u - number(0.5));
  const Made made = made_of(number(3) * below - above);
  EXPECT_GE(made.error.proven, 2.99 * made.samples[0]);
  EXPECT_LE(made.error.proven, 3.4 * made.samples[0]);
}

// A ramp within less than the samples' error: its height counts, not its slope all the way.
TEST(PovrayFieldErrors, OfASteepRampAreLessThanItsSlopeTimesTheError) {
  const Expression ramp = min(number(1), max(number(0), number(40) * (dots() - number(0.5))));
  const Made made = made_of(X + number(0.01) * ramp);
  EXPECT_GE(made.error.proven, 0.0099);
  EXPECT_LE(made.error.proven, 0.8 * 0.01 * 40 * made.samples[0]);
}

TEST(PovrayFieldErrors, OfManySampledFunctionsAddUp) {
  Expression sum = X;
  for (double place : {-0.7, -0.3, 0.1, 0.5, 0.8}) sum = sum + distance_to({{place, 0.1, place}});
  const Made made = made_of(sum);
  ASSERT_EQ(made.samples.size(), 5u);
  double total = 0;
  for (double error : made.samples) total += error;
  EXPECT_NEAR(made.error.proven, total, 1e-8);
}

TEST(PovrayFieldErrors, GoThroughSamplesOfSamples) {
  const Expression wave = call(std::make_shared<TestWave>(2), {X, Y});
  const Made made = made_of(distance_to({{0.31, -0.42, 0.17}}, wave));
  ASSERT_EQ(made.samples.size(), 2u);
  // An interpolated distance is steeper than the distance, by less than the root of 3.
  EXPECT_GT(made.error.proven, made.samples[1]);
  EXPECT_LT(made.error.proven, made.samples[1] + std::sqrt(3.0) * made.samples[0] + 1e-9);
}

TEST(PovrayFieldErrors, AreZeroWithoutSamples) {
  const std::vector<Expression> all{X * Y};
  const FieldError error = povray::errors_of_fields(all, all, bounds).at(0);
  EXPECT_EQ(error.proven, 0);
  EXPECT_EQ(error.points, 0u);
}

TEST(PovrayFieldErrors, ThatCannotBeBoundedAreCalledSo) {
  const Made made = made_of(number(1) / dots());
  EXPECT_FALSE(made.error.says_something());
  const std::string sentence = povray::StatedError{"pole", made.error}.sentence();
  EXPECT_THAT(sentence, testing::StartsWith("pole: differs from the exact one by "));
  EXPECT_THAT(sentence, HasSubstr("; not bounded: "));
  EXPECT_THAT(sentence, testing::Not(HasSubstr("at most")));
}

// The samples of the height move the place of a jump, which the slopes of `below` do not show.
TEST(PovrayFieldErrors, OfAJumpAtASampledHeightAreNotBelieved) {
  Below below;
  below.height = 0.5;
  const OperationPointer step = make_operation(below);
  const Made moved = made_of(call(step, {dots(), number(0), number(1)}));
  EXPECT_EQ(moved.worst, 1);
  EXPECT_FALSE(moved.error.says_something());
  const Made fixed = made_of(call(step, {Z, dots(), dots() + number(1)}));
  // Whichever of the two counts, it is off by no more than the samples that both share.
  EXPECT_NEAR(fixed.error.proven, fixed.samples[0], 1e-9);
}

TEST(PovrayFieldErrors, CanBeCancelled) {
  SamplingOptions options;
  options.most_samples = 1000;
  const std::vector<Expression> all{number(1) / dots()};
  const povray::Sampling sampling = povray::sample_operations(all, bounds, "part", options);
  int calls = 0;
  EXPECT_THROW(povray::errors_of_fields(all, sampling.expressions, bounds,
                                        [&](double) { return ++calls < 5; }),
               Cancelled);
  EXPECT_EQ(calls, 5);
}

// A scene file's picture with few samples.
struct ShippedScene {
  explicit ShippedScene(const std::string& name)
      : scene(read_scene(source_folder() / "scenes" / (name + ".json"))) {
    exact.title = name;
    exact.solid = scene.drawn();
    exact.bounds = scene.bounds();
    exact.color = scene.base_color();
    for (const NamedField& field : scene.fields()) {
      exact.fields.push_back({field.name, field.field.expression()});
    }
    for (size_t i = 0; i < scene.fractions().size(); ++i) {
      exact.fractions.push_back({scene.material_names()[i], scene.fractions()[i]});
    }
    SamplingOptions options;
    options.most_samples = 64.0 * 64 * 64;
    options.all_fields = false;
    samples = povray::sample_scene(exact, "part", options);
  }

  // Points within the bounds by more than their padding: where the samples are all inside.
  double worst(const std::string& name, const Expression& before) const {
    const auto& after = samples.scene;
    Expression sampled;
    if (name == "solid") sampled = after.solid;
    for (size_t i = 0; i < 3; ++i) {
      if (name == std::array{"red", "green", "blue"}[i]) sampled = after.color[i];
    }
    for (const auto& field : after.fields) {
      if (field.name == name) sampled = field.expression;
    }
    for (const auto& fraction : after.fractions) {
      if ("fraction of " + fraction.name == name) sampled = fraction.expression;
    }
    BoundingBox inner = exact.bounds;
    const double by = 2e-4 * inner.diagonal();
    inner.lo = inner.lo + Vec3{by, by, by};
    inner.hi = inner.hi - Vec3{by, by, by};
    return worst_difference(before, sampled, inner, 20000);
  }

  std::map<std::string, Expression> expressions() const {
    std::map<std::string, Expression> out{{"solid", exact.solid},
                                          {"red", exact.color[0]},
                                          {"green", exact.color[1]},
                                          {"blue", exact.color[2]}};
    for (const auto& field : exact.fields) out[field.name] = field.expression;
    for (const auto& part : exact.fractions) out["fraction of " + part.name] = part.expression;
    return out;
  }

  Scene scene;
  povray::PovrayScene exact;
  povray::SceneSamples samples;
};

// All stated bounds hold; returns the largest ratio of a bound that says something to what is
// found at other points than those of the statement.
double largest_ratio(const ShippedScene& shipped, size_t stated, size_t bounded) {
  const auto expressions = shipped.expressions();
  double ratio = 0;
  size_t found = 0;
  EXPECT_EQ(shipped.samples.errors.size(), stated);
  for (const povray::StatedError& error : shipped.samples.errors) {
    const double worst = shipped.worst(error.name, expressions.at(error.name));
    EXPECT_LE(worst, error.error.proven) << error.name;
    EXPECT_LE(worst, 1.5 * error.error.measured) << error.name;
    EXPECT_GT(worst, 0) << error.name;
    if (!error.error.says_something()) continue;
    ++found;
    ratio = std::max(ratio, error.error.proven / worst);
  }
  EXPECT_EQ(found, bounded);
  return ratio;
}

// u, share, three channels, two fractions.
TEST(PovrayFieldErrors, OfTheGradedPlateAreBounded) {
  EXPECT_LT(largest_ratio(ShippedScene("s_curve"), 7, 7), 2.5);
}

// height, u, three channels, two fractions: of smooth samples, much below a thousandth.
TEST(PovrayFieldErrorsSlow, OfASplineSurfaceAreBounded) {
  const ShippedScene shipped("spline_surface");
  for (const auto& function : shipped.samples.functions) {
    EXPECT_LT(function->error().proven, 1e-4);
    EXPECT_LT(function->error().proven, 1.5 * function->error().measured);
  }
  EXPECT_LT(largest_ratio(shipped, 7, 7), 1500);
}

// blade, skin, solid, three channels, three fractions; of few samples, those that change within
// less than the samples' error are not bounded.
TEST(PovrayFieldErrorsSlow, OfAMeshAreBoundedForWhatIsNoSteeperThanTheDistance) {
  EXPECT_LT(largest_ratio(ShippedScene("turbine_blade"), 9, 4), 3);
}

TEST(PovrayFieldErrors, HoldInPovray) {
  const ShippedScene shipped("s_curve");
  SamplingOptions options;
  options.most_samples = 64.0 * 64 * 64;
  options.all_fields = false;
  const povray::SceneText text = povray::scene_text(shipped.exact, "part.inc", options);
  std::mt19937 random(3);
  std::vector<FunctionCall> calls;
  std::vector<Vec3> points;
  const BoundingBox& box = shipped.exact.bounds;
  for (int i = 0; i < 2000; ++i) {
    Vec3 p;
    for (size_t k = 0; k < 3; ++k) {
      p[k] = std::uniform_real_distribution<double>(box.lo[k], box.hi[k])(random);
    }
    points.push_back(p);
    calls.push_back({"s_curve_share", {p[0], p[1], p[2]}});
  }
  const std::vector<double> values =
      evaluate_in_povray(text.include, calls, nullptr, [&](const TestFolder& folder) {
        for (const auto& sampled : text.sampled) {
          OutputFile file(folder / sampled->file());
          sampled->samples().write_to(file);
          file.commit();
        }
      });
  const Evaluator exact(shipped.expressions().at("share"));
  double worst = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    worst = std::max(worst, std::abs(values[i] - exact.value(points[i])));
  }
  for (const povray::StatedError& stated : text.errors) {
    if (stated.name != "share") continue;
    EXPECT_LE(worst, stated.error.proven);
    EXPECT_GE(worst, 0.2 * stated.error.proven);
    const std::string lines = povray::comment_lines(stated.sentence() + ".");
    EXPECT_NE(text.include.find(lines + "#declare s_curve_share = "), std::string::npos) << lines;
  }
  EXPECT_EQ(text.errors.size(), 7u);
}

}  // namespace
}  // namespace sardf

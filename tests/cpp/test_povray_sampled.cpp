// What has no formula, sampled for POV-Ray: the error that is stated holds there, and solids made
// of samples have no holes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "error_of.hpp"
#include "povray_gen/scene_text.hpp"
#include "povray_harness.hpp"
#include "sampled_shapes.hpp"
#include "sardf/arithmetic.hpp"
#include "sardf/curve_set.hpp"
#include "sardf/derivative.hpp"
#include "sardf/error.hpp"
#include "sardf/operation_of.hpp"
#include "sardf/ops.hpp"
#include "sardf/spline_operation.hpp"

namespace sardf {
namespace {

using povray::PovrayScene;
using povray::SampledPointer;
using povray::SamplingOptions;
using povray::SceneText;
using testing::HasSubstr;
using testing::Not;

const Expression X = coordinate(0), Y = coordinate(1), Z = coordinate(2);
const std::vector<Vec3> three_points{{0.31, -0.42, 0.17}, {-0.6, 0.2, 0.45}, {0.1, 0.7, -0.53}};

OperationPointer points_distance() {
  return distance_operation(std::make_shared<TestPoints>("dots", three_points));
}
Expression distance_to_points() { return call(points_distance(), {X, Y, Z}); }

// Rotated about z by 30 degrees, then about x by 50, and moved.
std::array<Expression, 3> moved_axes() {
  const double a = std::numbers::pi / 6, b = std::numbers::pi / 3.6;
  const Expression x = constant(std::cos(a)) * X + constant(std::sin(a)) * Y;
  const Expression y = constant(std::cos(a)) * Y - constant(std::sin(a)) * X;
  return {x + constant(0.4), constant(std::cos(b)) * y + constant(std::sin(b)) * Z,
          constant(std::cos(b)) * Z - constant(std::sin(b)) * y - constant(0.2)};
}

PovrayScene scene_with(std::vector<povray::NamedExpression> fields) {
  PovrayScene scene;
  scene.title = "part";
  scene.solid = call(make_operation(Sphere()), {X, Y, Z});
  scene.bounds = {{-1.01, -1.02, -1.03}, {1.04, 1.05, 1.06}};
  scene.fields = std::move(fields);
  scene.camera = frame_camera(scene.bounds, 64, 48);
  return scene;
}

// Fewer than by default, so that the tests are quick.
SamplingOptions coarse(double most_samples = 40000) {
  SamplingOptions options;
  options.most_samples = most_samples;
  return options;
}

void write_samples(const SceneText& text, const TestFolder& folder) {
  for (const SampledPointer& sampled : text.sampled) {
    OutputFile file(folder / sampled->file());
    sampled->samples().write_to(file);
    file.commit();
  }
}

std::vector<Vec3> random_points(const BoundingBox& box, int n) {
  std::mt19937 random(7);
  std::vector<Vec3> out(n);
  for (Vec3& p : out) {
    for (size_t k = 0; k < 3; ++k) {
      p[k] = std::uniform_real_distribution<double>(box.lo[k], box.hi[k])(random);
    }
  }
  return out;
}

std::vector<double> in_povray(const SceneText& text, const std::string& function,
                              const std::vector<Vec3>& points) {
  std::vector<FunctionCall> calls;
  for (const Vec3& p : points) calls.push_back({function, {p[0], p[1], p[2]}});
  std::string messages;
  const std::vector<double> out =
      evaluate_in_povray(text.include, calls, &messages,
                         [&](const TestFolder& folder) { write_samples(text, folder); });
  EXPECT_EQ(povray::complaint_in(messages), "");
  return out;
}

double largest_difference(const Expression& exact, const std::vector<Vec3>& points,
                          const std::vector<double>& values) {
  const Evaluator evaluator(exact);
  double worst = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    worst = std::max(worst, std::abs(values[i] - evaluator.value(points[i])));
  }
  return worst;
}

// POV-Ray's values differ from the exact ones by no more than is stated, which is no exaggeration.
void expect_stated_error(const Expression& exact, const SamplingOptions& options = coarse()) {
  const PovrayScene scene = scene_with({{"near", exact}});
  const SceneText text = povray::scene_text(scene, "part.inc", options);
  ASSERT_EQ(text.sampled.size(), 1u);
  std::vector<Vec3> points = random_points(scene.bounds, 6000);
  // Where distances to points have their kinks.
  for (const Vec3& p : three_points) {
    for (const Vec3& q : random_points({p - Vec3{.05, .05, .05}, p + Vec3{.05, .05, .05}}, 500)) {
      points.push_back(q);
    }
  }
  const povray::SampleError& error = text.sampled[0]->error();
  const double worst = largest_difference(exact, points, in_povray(text, "part_near", points));
  EXPECT_LE(worst, error.proven);
  EXPECT_LE(worst, 1.1 * error.measured);
  EXPECT_GE(worst, 0.5 * error.measured);
  EXPECT_LE(error.measured, error.proven);
  EXPECT_GT(error.points, 10000u);
}

TEST(PovraySamples, HoldTheErrorThatIsStatedForADistance) {
  expect_stated_error(distance_to_points());
}

TEST(PovraySamples, HoldTheErrorInATurnedAndMovedFrame) {
  const auto [x, y, z] = moved_axes();
  expect_stated_error(call(points_distance(), {x, y, z}));
}

TEST(PovraySamples, HoldTheErrorForASmoothFunctionAndReachTheOneAimedAt) {
  const Expression wave = call(std::make_shared<TestWave>(3), {X, Y, Z});
  SamplingOptions options;
  options.error_share = 1.0 / 300;
  expect_stated_error(wave, options);
  const SceneText text = povray::scene_text(scene_with({{"wave", wave}}), "part.inc", options);
  const povray::SampledFunction& sampled = *text.sampled[0];
  EXPECT_LE(sampled.error().measured, sampled.error().aimed);
  EXPECT_THAT(sampled.description(), Not(HasSubstr("aimed")));
  EXPECT_LT(sampled.samples().grid().size(), 300000u) << "finer than necessary";
}

TEST(PovraySamples, NeedOneLayerOnlyWhereAnInputDoesNotVary) {
  const Expression plane = call(std::make_shared<TestWave>(2), {X, Y});
  const Expression slice = call(points_distance(), {Z, X, constant(0.3)});
  const Expression rounded = constant(0.3) + constant(1e-12) * Y;
  const Expression nearly_slice = call(points_distance(), {Z, X, rounded});
  for (const Expression& exact : {plane, slice, nearly_slice}) {
    expect_stated_error(exact);
    const SceneText text = povray::scene_text(scene_with({{"a", exact}}), "a.inc", coarse());
    const povray::SampleGrid& grid = text.sampled[0]->samples().grid();
    EXPECT_EQ(grid.counts[2], 1);
    EXPECT_GT(grid.counts[0], 30);
    EXPECT_LT(text.sampled[0]->samples().over(text.sampled[0]->samples().grid().box).length, 2.5);
  }
}

TEST(PovraySamples, AreWhatPovrayInterpolates) {
  const auto [x, y, z] = moved_axes();
  const PovrayScene scene = scene_with({{"near", call(points_distance(), {x, y, z})}});
  const SceneText text = povray::scene_text(scene, "part.inc", coarse());
  const Expression here = call(text.sampled[0], {x, y, z});
  const std::vector<Vec3> points = random_points({{-9, -9, -9}, {9, 9, 9}}, 1000);
  EXPECT_LT(largest_difference(here, points, in_povray(text, "part_near", points)), 1e-13);
  const std::vector<Vec3> inside = random_points(scene.bounds, 1000);
  EXPECT_LT(largest_difference(here, inside, in_povray(text, "part_near", inside)), 1e-13);
}

TEST(PovraySamples, GoOnOutsideTheBoundsAsAtTheirEdge) {
  const SceneText text =
      povray::scene_text(scene_with({{"near", distance_to_points()}}), "part.inc", coarse());
  const std::array<Interval, 3> box = text.sampled[0]->samples().grid().box;
  std::vector<Vec3> points = random_points({{-9, -9, -9}, {9, 9, 9}}, 1000), inside;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 p;
    for (int k = 0; k < 3; ++k) p[k] = corner >> k & 1 ? box[size_t(k)].hi : box[size_t(k)].lo;
    points.push_back(p);
  }
  for (Vec3 p : points) {
    for (size_t k = 0; k < 3; ++k) p[k] = std::clamp(p[k], box[k].lo, box[k].hi);
    inside.push_back(p);
  }
  const std::vector<double> values = in_povray(text, "part_near", points);
  EXPECT_LE(largest_difference(distance_to_points(), inside, values),
            text.sampled[0]->error().proven);
  EXPECT_GT(*std::min_element(values.begin(), values.end()), 0.1);
}

TEST(PovraySamples, OfOneOperationAreTakenOnce) {
  const auto [x, y, z] = moved_axes();
  const Expression here = distance_to_points(), there = call(points_distance(), {x, y, z});
  const Expression other = call(
      distance_operation(std::make_shared<TestPoints>("dots", std::vector<Vec3>{{0, 0.2, 0.1}})),
      {X, Y, Z});
  const PovrayScene scene = scene_with(
      {{"here", here}, {"there", there}, {"other", other}, {"dots", here + there * other}});
  const SceneText text = povray::scene_text(scene, "my part.inc", coarse());
  ASSERT_EQ(text.sampled.size(), 2u);
  EXPECT_EQ(text.sampled[0]->file(), "my part_sampled_1.df3");
  EXPECT_EQ(text.sampled[1]->file(), "my part_sampled_2.df3");
  for (const SampledPointer& sampled : text.sampled) {
    const std::string read = "df3 \"" + sampled->file() + "\"";
    ASSERT_THAT(text.include, HasSubstr(read));
    EXPECT_EQ(text.include.find(read), text.include.rfind(read));
  }
  const std::vector<Vec3> points = random_points(scene.bounds, 500);
  const double error = text.sampled[0]->error().proven + text.sampled[1]->error().proven;
  for (const povray::NamedExpression& field : scene.fields) {
    const std::vector<double> values = in_povray(text, "part_" + field.name, points);
    // Distances here are below 4: so much does the product enlarge the errors.
    EXPECT_LE(largest_difference(field.expression, points, values), 4 * error) << field.name;
  }
}

TEST(PovraySamples, OfNearestPointsAreRightAwayFromWhereTheyJump) {
  const auto set = std::make_shared<TestPoints>("dots", three_points);
  for (int axis = 0; axis < 3; ++axis) {
    const Expression exact = call(nearest_operation(set, axis), {X, Y, Z});
    const PovrayScene scene = scene_with({{"near", exact}});
    const SceneText text = povray::scene_text(scene, "part.inc", coarse());
    const povray::SampledFunction& sampled = *text.sampled.at(0);
    EXPECT_EQ(sampled.error().proven, infinity);
    EXPECT_THAT(text.include, Not(HasSubstr("(proven)")));
    EXPECT_GT(sampled.error().measured, 0.1) << "it jumps by more";
    const povray::SampleGrid& grid = sampled.samples().grid();
    const double diagonal = norm(Vec3{grid.step(0), grid.step(1), grid.step(2)});
    std::vector<Vec3> points;
    for (const Vec3& p : random_points(scene.bounds, 1000)) {
      std::vector<double> distances;
      for (const Vec3& q : three_points) distances.push_back(norm(p - q));
      std::sort(distances.begin(), distances.end());
      if (distances[1] - distances[0] > 2 * diagonal) points.push_back(p);
    }
    EXPECT_GT(points.size(), 500u);
    EXPECT_LT(largest_difference(exact, points, in_povray(text, "part_near", points)), 1e-8);
  }
}

// Of a line through the whole scene: distance, nearest point and its derivatives are samples.
TEST(PovraySamples, OfSecondDerivativesAreNear) {
  CurveData data;
  data.control_points = {{-5, 0.2, 0}, {5, 0.2, 0}};
  data.degree = 1;
  const Expression u =
      call(distance_operation(std::make_shared<CurveSet>("c", "", data)), {X, Y, Z});
  const Expression bend = derivative(derivative(u, 1), 1);
  const PovrayScene scene = scene_with({{"bend", bend}});
  const SceneText text = povray::scene_text(scene, "part.inc", coarse());
  EXPECT_EQ(text.sampled.size(), 3u);
  std::vector<Vec3> points;
  for (const Vec3& p : random_points(scene.bounds, 1000)) {
    if (std::hypot(p[1] - 0.2, p[2]) > 0.3) points.push_back(p);
  }
  const std::vector<double> found = in_povray(text, "part_bend", points);
  for (size_t i = 0; i < points.size(); ++i) {
    const double y = points[i][1] - 0.2, z = points[i][2], d = std::hypot(y, z);
    // The distance's samples are off by some 1e-3, which is divided by its square.
    EXPECT_NEAR(found[i], z * z / (d * d * d), 0.05);
  }
}

TEST(PovraySamplesSlow, OfJumpsAreNotRefinedInVain) {
  const auto set = std::make_shared<TestPoints>("dots", three_points);
  const Expression exact = call(nearest_operation(set, 0), {X, Y, Z});
  const SceneText text = povray::scene_text(scene_with({{"near", exact}}), "part.inc");
  const size_t samples = text.sampled.at(0)->samples().grid().size();
  EXPECT_LT(samples, 2200000u);
  EXPECT_GT(samples, 1900000u) << "a jump lies within 1/125 of the box";
}

// Cubic, on [-half, half] along x and y.
Expression spline(double half) {
  const SplineGrid grid = spline_grid({-half, -half, 0}, {half, half, 0}, {5, 4}, 3);
  std::vector<double> coefficients;
  for (size_t i = 0; i < grid.size(); ++i) coefficients.push_back(std::sin(double(3 * i)));
  const std::array<Expression, 2> xy{X, Y};
  return call(spline_operation(grid, coefficients), xy);
}

// Second derivatives prove an error that shrinks with the square of the step.
TEST(PovraySamples, OfSmoothSplinesAreProvenAboutAsExactAsTheyAre) {
  for (double most : {4000.0, 40000.0}) {
    const SceneText text =
        povray::scene_text(scene_with({{"a", spline(1.2)}}), "a.inc", coarse(most));
    const povray::SampleError& error = text.sampled.at(0)->error();
    EXPECT_GE(error.proven, error.measured);
    EXPECT_LE(error.proven, 2 * error.measured);
  }
  expect_stated_error(spline(1.2));
}

// The derivative of a spline jumps to 0 beyond its box: that must not spoil the samples along the
// faces of a part that fills the box but for the padding of its bounds.
TEST(PovraySamples, OfSplinesKeepToTheirBoxes) {
  const Expression value = spline(1);
  const Expression slope = value->operation->derivative(0, value->arguments());
  PovrayScene scene = scene_with({{"height", spline(1)}, {"slope", slope}});
  scene.bounds = {{-1.0002, -1.0002, -1.0002}, {1.0002, 1.0002, 1.0002}};
  const SceneText text = povray::scene_text(scene, "part.inc", coarse());
  ASSERT_EQ(text.sampled.size(), 2u);
  for (const SampledPointer& sampled : text.sampled) {
    EXPECT_LT(sampled->error().proven, 0.002) << sampled->description();
    for (size_t k : {0u, 1u}) {
      EXPECT_EQ(sampled->samples().grid().box[k].lo, -1);
      EXPECT_EQ(sampled->samples().grid().box[k].hi, 1);
    }
  }
  // Beyond the box the spline goes on as its samples do.
  const std::vector<Vec3> beyond = random_points({{-1.5, -1.5, -1}, {1.5, 1.5, 1}}, 1000);
  EXPECT_LE(largest_difference(spline(1), beyond, in_povray(text, "part_height", beyond)),
            text.sampled[0]->error().proven);
  const std::vector<Vec3> inside = random_points({{-1, -1, -1}, {1, 1, 1}}, 1000);
  EXPECT_LE(largest_difference(slope, inside, in_povray(text, "part_slope", inside)),
            text.sampled[1]->error().proven);
}

TEST(PovraySamples, OfADerivativeShowItsJumpInsideAPartThatIsLargerThanItsBox) {
  const Expression value = spline(0.7);
  const Expression slope = value->operation->derivative(0, value->arguments());
  const SceneText text = povray::scene_text(scene_with({{"slope", slope}}), "part.inc", coarse());
  EXPECT_EQ(text.sampled.at(0)->error().proven, infinity);
  std::vector<Vec3> beyond = random_points({{0.75, -0.6, -1}, {1, 0.6, 1}}, 100);
  EXPECT_LT(largest_difference(constant(0), beyond, in_povray(text, "part_slope", beyond)), 1e-9);
}

TEST(PovraySamples, MayBeTheInputsOfOthers) {
  const Expression wave = call(std::make_shared<TestWave>(2), {X, Y});
  const Expression exact = call(points_distance(), {X, wave, Z});
  const PovrayScene scene = scene_with({{"near", exact}});
  const SceneText text = povray::scene_text(scene, "part.inc", coarse());
  ASSERT_EQ(text.sampled.size(), 2u);
  const std::vector<Vec3> points = random_points(scene.bounds, 1000);
  // A distance hands its inputs' errors on as they are.
  EXPECT_LE(largest_difference(exact, points, in_povray(text, "part_near", points)),
            text.sampled[0]->error().proven + text.sampled[1]->error().proven);
}

// Two samples along x, 0 and another, for which rounding makes less than 0 of the first.
std::shared_ptr<const povray::Samples> samples_from_zero() {
  const povray::SampleGrid grid{{Interval{0, 1}, Interval{0}, Interval{0}}, {2, 1, 1}};
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(1, 2);
  const Progress none;
  Work work(none);
  for (;;) {
    const std::array<double, 2> values{0, uniform(random)};
    const auto samples = std::make_shared<povray::Samples>(grid, values, work);
    if (samples->offset() + samples->factor() * (1 / 4294967295.0) < 0) return samples;
  }
}

TEST(PovraySamples, AreNotNegativeByRounding) {
  const auto sampled = std::make_shared<povray::SampledFunction>(
      std::make_shared<TestWave>(2), samples_from_zero(), povray::SampleError(), "a.df3");
  povray::Names names("part");
  povray::FunctionWriter writer(names);
  const Expression value = call(sampled, {X, Y});
  const std::string large = writer.declare({"large", constant(1e30) * value});
  SceneText text;
  text.include = writer.text();
  text.sampled = {sampled};
  EXPECT_EQ(in_povray(text, large, {{0, 0, 0}})[0], 0);
}

TEST(PovraySamples, AreDescribedInTheIncludeFile) {
  const SceneText text =
      povray::scene_text(scene_with({{"near", distance_to_points()}}), "part.inc", coarse());
  std::string flat;
  for (size_t i = 0; i < text.include.size(); ++i) {
    const bool wraps = text.include.compare(i, 4, "\n// ") == 0;
    flat += wraps ? ' ' : text.include[i];
    if (wraps) i += 3;
  }
  const std::string description = text.sampled[0]->description();
  EXPECT_THAT(flat, HasSubstr(" " + description + ". That holds for inputs -1.01"));
  EXPECT_THAT(description,
              testing::MatchesRegex("dots: [0-9]+ x [0-9]+ x [0-9]+ samples in part_sampled_1.df3; "
                                    "differs from the exact function by at most 0.[0-9]+ "
                                    "\\(proven\\), 0.[0-9]+ \\(measured at [0-9]+ points; "
                                    "0.0018[0-9]* was aimed at\\)"));
}

TEST(PovraySamples, ThatCannotBeTakenAreAnErrorThatNamesTheOperation) {
  const auto complaint = [](const Expression& field) {
    return error_of([&] {
      povray::scene_text(scene_with({{"near", field}}), "part.inc", coarse());
    });
  };
  const Expression far = constant(1) / X;
  EXPECT_THAT(complaint(call(points_distance(), {Y, far, Z})),
              testing::AllOf(HasSubstr("'dots' has no formula"), HasSubstr("its input 2")));
  class Undefined final : public TestWave {
   public:
    Undefined() : TestWave(2) {}
    using TestWave::evaluate;
    void evaluate(const double* const* in, double* out, size_t n) const override {
      for (size_t i = 0; i < n; ++i) out[i] = std::sqrt(in[0][i]);
    }
  };
  EXPECT_THAT(complaint(call(std::make_shared<Undefined>(), {X, Y})),
              testing::AllOf(HasSubstr("'wave'"), HasSubstr("no finite value"),
                             HasSubstr("x = -1.0"), HasSubstr("y = ")));
  EXPECT_THAT(complaint(call(std::make_shared<TestWave>(4), {X, Y, Z, X})),
              testing::AllOf(HasSubstr("'wave'"), HasSubstr("4 inputs")));
}

TEST(PovraySamples, ReportProgressAndStopWhenCancelled) {
  const PovrayScene scene =
      scene_with({{"a", distance_to_points()}, {"w", call(std::make_shared<TestWave>(2), {X, Y})}});
  SamplingOptions options = coarse();
  std::vector<double> shares;
  options.progress = [&](double share) {
    shares.push_back(share);
    return true;
  };
  povray::scene_text(scene, "part.inc", options);
  EXPECT_GT(shares.size(), 10u);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_EQ(shares.back(), 1);
  for (double limit : {0.0, 0.2, 0.9}) {
    options.progress = [&](double share) { return share < limit; };
    EXPECT_THROW(povray::scene_text(scene, "part.inc", options), Cancelled) << limit;
  }
}

TEST(PovraySamples, BoundValuesAndSlopesOfWhatIsInterpolated) {
  const auto [x, y, z] = moved_axes();
  const PovrayScene scene = scene_with({{"near", call(points_distance(), {x, y, z})}});
  const SceneText text = povray::scene_text(scene, "part.inc", coarse(5000));
  const Evaluator evaluator(call(text.sampled[0], {x, y, z}));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  double steepest = 0;
  for (const Vec3& low : random_points({{-1.2, -1.2, -1.2}, {1, 1, 1}}, 300)) {
    BoundingBox box{low, low};
    for (size_t k = 0; k < 3; ++k) box.hi[k] += 0.3 * uniform(random);
    const Slope slope = evaluator.slope(box);
    const Interval values = evaluator.interval(box);
    for (const Vec3& p : random_points(box, 30)) {
      Vec3 gradient;
      double value;
      evaluator.gradients(p.data(), 1, &value, gradient.data());
      EXPECT_TRUE(values.contains(value));
      EXPECT_LE(norm(gradient), slope.length);
      for (int k = 0; k < 3; ++k) {
        EXPECT_TRUE(slope.partial[size_t(k)].contains(gradient[size_t(k)]));
        const double h = 1e-7;
        Vec3 q = p;
        q[size_t(k)] += h;
        EXPECT_LE(std::abs(evaluator.value(q) - value) / h, slope.length * (1 + 1e-6));
      }
      steepest = std::max(steepest, norm(gradient));
    }
    EXPECT_LE(slope.length, std::sqrt(3.0) + 1e-9) << "a distance's quotients are at most 1";
  }
  EXPECT_GT(steepest, 0.9);
}

}  // namespace
}  // namespace sardf

// Every operation's POV-Ray text, evaluated by POV-Ray, equals C++.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <set>

#include "povray_gen/function_printer.hpp"
#include "povray_harness.hpp"
#include "sardf/operation_of.hpp"
#include "sardf/ops.hpp"

namespace sardf {
namespace {

struct Sample {
  OperationPointer operation;
  std::vector<std::vector<double>> points;
};

class Samples {
 public:
  // Points in which each coordinate lies in [low, high].
  void add(const OperationPointer& operation, double low = -3, double high = 3) {
    std::uniform_real_distribution<double> uniform(low, high);
    Sample sample{operation, {}};
    for (int i = 0; i < 200; ++i) {
      std::vector<double> point;
      for (int k = 0; k < operation->info().arity; ++k) point.push_back(uniform(random_));
      sample.points.push_back(point);
    }
    names_.insert(operation->info().name);
    samples_.push_back(sample);
  }

  // Arguments where a comparison decides or a square root vanishes: equal, zero, opposite, and one
  // radius apart.
  void add_kinks(const OperationPointer& operation) {
    const double values[] = {-2, -1.5, -1, -0.75, -0.5, -0.25, -0.0, 0, 0.25, 0.5, 0.75, 1, 1.5, 2};
    Sample sample{operation, {}};
    for (double a : values) {
      for (double b : values) sample.points.push_back({a, b});
    }
    samples_.push_back(sample);
  }

  bool has(const std::string& name) const { return names_.contains(name); }
  const std::vector<Sample>& all() const { return samples_; }

 private:
  std::mt19937 random_{20040601};
  std::set<std::string> names_;
  std::vector<Sample> samples_;
};

template <class Op>
OperationPointer make(const std::function<void(Op&)>& set) {
  Op op;
  set(op);
  return make_operation(op);
}

void add_solids(Samples& samples) {
  samples.add(make<Sphere>([](Sphere& s) { s.center = {0.3, -0.2, 0.1}, s.radius = 1.7; }));
  samples.add(make<HalfSpace>([](HalfSpace& s) { s.point = {0, 1, 0}, s.normal = {{1, 2, -3}}; }));
  samples.add(make<Box>([](Box& s) { s.center = {0.5, 0, 0}, s.size = {3, 2, 1}; }));
  samples.add(make<RoundedBox>([](RoundedBox& s) { s.size = {3, 2, 2.5}, s.radius = 0.5; }));
  samples.add(make<Cylinder>([](Cylinder& s) { s.axis = {{1, 1, 0.5}}, s.height = 2; }));
  samples.add(make<Torus>([](Torus& s) { s.axis = {{0, 1, 0}}, s.minor_radius = 0.5; }));
  samples.add(make<Capsule>([](Capsule& s) { s.b = {1, 2, 0}, s.radius = 0.4; }));
  samples.add(make<Cone>([](Cone& s) { s.radius_bottom = 1.5, s.radius_top = 0.5, s.height = 2; }));
  samples.add(make<Ellipsoid>([](Ellipsoid& s) { s.center = {0.1, 0, 0}, s.radii = {2, 1, 0.5}; }));
  samples.add(make<Ellipsoid>([](Ellipsoid& s) { s.radii = {3, 3, 0.03}; }));
  samples.add(make<Ellipse>([](Ellipse& s) { s.radii = {0.5, 2}; }));
  samples.add(make<Disc>([](Disc& s) { s.center = {1, 0}; }));
  samples.add(make<Box2d>([](Box2d& s) { s.size = {3, 1}; }));
  samples.add(make<Polygon>([](Polygon& s) {
    s.vertices = {{-2, -2}, {2, -2}, {2, 0}, {0.5, 0}, {0.5, 2}, {-1, 2}, {-1, 0.5}, {-2, 0.5}};
  }));
}

void add_features(Samples& samples) {
  samples.add(make<Point>([](Point& s) { s.at = {1, 2, 3}; }));
  samples.add(make<Points>([](Points& s) { s.at = {{1, 0, 0}, {0, 1, 0}, {-1, -1, 1}}; }));
  samples.add(make<Segment>([](Segment& s) { s.a = {-1, 0, 0}, s.b = {1, 2, 1}; }));
  samples.add(make<Polyline>([](Polyline& s) {
    s.vertices = {{-2, 0, 0}, {0, 1, 0}, {2, 0, 1}, {1, -2, 0}};
    s.closed = true;
  }));
  samples.add(make<Circle>([](Circle& s) { s.radius = 1.5, s.axis = {{1, 0, 1}}; }));
  samples.add(make<Arc>([](Arc& s) { s.radius = 2, s.start = 20, s.end = 200; }));
  samples.add(make<Affine>([](Affine& s) { s.row = {0.6, 0.8, -1}, s.offset = 2; }));
}

template <class Blend>
void add_blend(Samples& samples, const Blend& blend) {
  for (const auto& operation :
       {make_operation(IntersectionOf<Blend>(blend)), make_operation(UnionOf<Blend>(blend)),
        make_operation(DifferenceOf<Blend>(blend))}) {
    samples.add(operation, -2, 2);
    samples.add_kinks(operation);
  }
}

void add_functions_of_domains(Samples& samples) {
  samples.add(make_operation(Power()), 0.1, 3);
  samples.add(make_operation(Logarithm()), 1e-3, 5);
  samples.add(make_operation(ArcSine()), -1, 1);
  samples.add(make_operation(ArcCosine()), -1, 1);
  for (int exponent : {0, 1, 2, 7}) {
    samples.add(make<IntegerPower>([&](IntegerPower& f) { f.exponent = exponent; }));
  }
  for (const auto& operation : {make_operation(Equal()), make_operation(Less()),
                                make_operation(LessEqual()), make_operation(Step())}) {
    samples.add(operation);
    samples.add_kinks(operation);
  }
}

Samples all_samples() {
  Samples samples;
  add_solids(samples);
  add_features(samples);
  add_blend(samples, Sardf{.radius = 0.5});
  add_blend(samples, SardfC1{.radius = 0.5});
  add_blend(samples, MinMax());
  add_blend(samples, RFunction());
  add_blend(samples, Smooth{.k = 0.5});
  add_functions_of_domains(samples);
  // Whatever is left has no parameters.
  Ops::for_each([&]<class Op>(std::type_identity<Op>) {
    if (!samples.has(Op::name)) samples.add(make_operation(Op()));
  });
  return samples;
}

TEST(PovrayOperations, EvaluatedByPovrayEqualCppAt200PointsEach) {
  const Samples samples = all_samples();
  povray::Names names("every operation");
  povray::FunctionPrinter printer(names);
  std::vector<FunctionCall> calls;
  for (const Sample& sample : samples.all()) {
    const int arity = sample.operation->info().arity;
    povray::Terms terms;
    std::vector<int> inputs;
    for (int i = 0; i < arity; ++i) inputs.push_back(terms.input(i));
    Trace trace(arity);
    sample.operation->record(trace);
    const int root = terms.append(trace, inputs);
    const std::string name = names.numbered(sample.operation->info().name);
    printer.declare(name, terms, root, arity, povray::InputNames::parameters);
    for (const auto& point : sample.points) calls.push_back({name, point});
  }
  const std::vector<double> values = evaluate_in_povray(printer.text(), calls);
  size_t next = 0;
  for (const Sample& sample : samples.all()) {
    double worst = 0;
    std::vector<double> worst_at;
    for (const auto& point : sample.points) {
      const double expected = sample.operation->evaluate(point.data()), found = values[next++];
      double scale = std::max(1.0, std::abs(expected));
      for (double a : point) scale = std::max(scale, std::abs(a));
      const double error = std::abs(found - expected) / scale;
      if (error > worst || std::isnan(error)) {
        worst = error;
        worst_at = point;
      }
    }
    EXPECT_LE(worst, 1e-9) << sample.operation->info().name << " at "
                           << testing::PrintToString(worst_at);
  }
}

}  // namespace
}  // namespace sardf

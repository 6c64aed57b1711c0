// The conflict rules of a partition, computed by hand from distances along x.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error_of.hpp"
#include "sardf/constructor.hpp"
#include "sardf/evaluate.hpp"
#include "sardf/scene_file.hpp"

namespace sardf {
namespace {

using testing::HasSubstr;

const std::vector<std::string> three{"a", "b", "c"};

Fractions of(const char* material) { return Fractions::material(material); }

/// A box on the x axis, so wide that its field near the axis is the distance along it.
Field block(double center, double length) {
  return make_field("box", {Vec3{center, 0, 0}, Vec3{length, 200, 200}});
}

std::vector<double> at(const std::vector<Expression>& outputs, const Vec3& p) {
  std::vector<double> out(outputs.size());
  Evaluator(outputs).values(p, out.data());
  return out;
}

std::string problem(const char* rule, const std::vector<RuleValue>& arguments) {
  return error_of([&] { make_fractions(rule, arguments); });
}

// Slabs along x, -3 to 1, -1 to 3 and 0 to 6, whose fields are distances along x; at its middle
// 1/2 the point is inside all three.
std::vector<Record> slabs() {
  const auto slab = [](double from, double to) { return block((from + to) / 2, to - from); };
  return {{{slab(-3, 1), of("a")}}, {{slab(-1, 3), of("b")}}, {{slab(0, 6), of("c")}}};
}

struct Conflict {
  const char* rule;
  double x;
  std::vector<double> expected;
};

void check_conflicts(double width, const std::vector<Conflict>& cases) {
  for (const Conflict& c : cases) {
    const Fractions rule = make_fractions("partition", {slabs(), width, std::string(c.rule)});
    const Evaluator evaluator(lower(rule, three, 1e-6));
    double w[3];
    evaluator.values(Vec3{c.x, 0.5, -0.5}, w);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(w[i], c.expected[size_t(i)], 1e-11) << c.rule << " at " << c.x << ", " << i;
    }
    EXPECT_NEAR(w[0] + w[1] + w[2], 1, 1e-14) << c.rule << " at " << c.x;
    const float point[3] = {float(c.x), 0.5f, -0.5f};
    float v[3];
    evaluator.values(point, 1, v);
    EXPECT_NEAR(v[0] + v[1] + v[2], 1, 1e-6) << c.rule << " at " << c.x;
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(v[i], w[i], 1e-5) << c.rule << " at " << c.x;
  }
}

TEST(PartitionConflict, AreDecidedAtSharpBorders) {
  check_conflicts(0, {// In one part.
                      {"first", -2, {1, 0, 0}},
                      {"last", -2, {1, 0, 0}},
                      {"mean", -2, {1, 0, 0}},
                      {"max", -2, {1, 0, 0}},
                      {"first", 5, {0, 0, 1}},
                      {"last", 5, {0, 0, 1}},
                      {"mean", 5, {0, 0, 1}},
                      {"max", 5, {0, 0, 1}},
                      // In two: the depths are 1.25 and 0.25; then 0.75 and 2.25.
                      {"first", -0.75, {1, 0, 0}},
                      {"last", -0.75, {0, 1, 0}},
                      {"mean", -0.75, {0.5, 0.5, 0}},
                      {"max", -0.75, {1, 0, 0}},
                      {"first", 2.25, {0, 1, 0}},
                      {"last", 2.25, {0, 0, 1}},
                      {"mean", 2.25, {0, 0.5, 0.5}},
                      {"max", 2.25, {0, 0, 1}},
                      // In three: 0.5, 1.5, 0.5; 0.75, 1.25, 0.25.
                      {"first", 0.5, {1, 0, 0}},
                      {"last", 0.5, {0, 0, 1}},
                      {"mean", 0.5, {1 / 3.0, 1 / 3.0, 1 / 3.0}},
                      {"max", 0.5, {0, 1, 0}},
                      {"max", 0.25, {0, 1, 0}},
                      // In none: the nearest.
                      {"first", -4, {1, 0, 0}},
                      {"last", -4, {1, 0, 0}},
                      {"mean", -4, {1, 0, 0}},
                      {"max", -4, {1, 0, 0}},
                      {"first", 9, {0, 0, 1}},
                      {"last", 9, {0, 0, 1}},
                      {"mean", 9, {0, 0, 1}},
                      {"max", 9, {0, 0, 1}}});
}

// With a width of 1 a part fades from 1 at its surface to 0 at a distance of 1 outside.
TEST(PartitionConflict, FadeOverAWidth) {
  check_conflicts(1, {// a is 1, b 0.25 outside.
                      {"first", -1.25, {1, 0, 0}},
                      {"last", -1.25, {0.25, 0.75, 0}},
                      {"mean", -1.25, {1 / 1.75, 0.75 / 1.75, 0}},
                      // Fields 1.75, -0.25, -1.25.
                      {"max", -1.25, {1, 0, 0}},
                      // a and b are 1, c 0.4 outside: 0.6.
                      {"first", -0.4, {1, 0, 0}},
                      {"last", -0.4, {0, 0.4, 0.6}},
                      {"mean", -0.4, {1 / 2.6, 1 / 2.6, 0.6 / 2.6}},
                      // Fields 1.4, 0.6, -0.4: 1, 0.2, 0.
                      {"max", -0.4, {1 / 1.2, 0.2 / 1.2, 0}},
                      // a 0.25 outside: 0.75, b and c 1.
                      {"first", 1.25, {0.75, 0.25, 0}},
                      {"last", 1.25, {0, 0, 1}},
                      {"mean", 1.25, {0.75 / 2.75, 1 / 2.75, 1 / 2.75}},
                      // Fields -0.25, 1.75, 1.25: 0, 1, 0.5.
                      {"max", 1.25, {0, 1 / 1.5, 0.5 / 1.5}},
                      // In all: fields 0.5, 1.5, 0.5 and 0.75, 1.25, 0.25.
                      {"first", 0.5, {1, 0, 0}},
                      {"last", 0.5, {0, 0, 1}},
                      {"mean", 0.5, {1 / 3.0, 1 / 3.0, 1 / 3.0}},
                      {"max", 0.5, {0, 1, 0}},
                      {"max", 0.25, {0.5 / 1.5, 1 / 1.5, 0}},
                      // In none, but near to c; then far from all.
                      {"first", 6.5, {0, 0, 1}},
                      {"mean", 6.5, {0, 0, 1}},
                      {"last", -3.75, {1, 0, 0}},
                      {"first", 12, {0, 0, 1}},
                      {"last", 12, {0, 0, 1}},
                      {"mean", -12, {1, 0, 0}},
                      {"max", -12, {1, 0, 0}}});
}

// In a gap between two parts both are near: what they leave over goes to them in proportion.
TEST(PartitionConflict, ShareAGap) {
  const std::vector<Record> apart{{{block(-3, 4), of("a")}}, {{block(3, 5), of("b")}}};
  // At 0 a is 1 away, b 0.5: with a width of 2 there is 0.5 of a and 0.75 of b.
  const std::pair<const char*, std::pair<double, double>> cases[] = {
      {"first", {0.5, 0.5 * 0.75}}, {"last", {0.25 * 0.5, 0.75}}, {"mean", {0.5, 0.75}}};
  for (const auto& [name, weights] : cases) {
    const auto lowered =
        lower(make_fractions("partition", {apart, 2.0, std::string(name)}), three, 1e-6);
    const double sum = weights.first + weights.second;
    EXPECT_NEAR(at(lowered, {})[0], weights.first / sum, 1e-11) << name;
    EXPECT_NEAR(at(lowered, {})[1], weights.second / sum, 1e-11) << name;
  }
  // Depths -1 and -0.5 differ by a quarter of the width: 0.75 and 1.
  const auto deepest =
      lower(make_fractions("partition", {apart, 2.0, std::string("max")}), three, 1e-6);
  EXPECT_NEAR(at(deepest, {})[0], 0.75 / 1.75, 1e-14);
}

TEST(PartitionConflict, AreFirstUnlessTold) {
  const auto unsaid = lower(make_fractions("partition", {slabs()}), three, 1.0);
  const auto said =
      lower(make_fractions("partition", {slabs(), 0.0, std::string("first")}), three, 1.0);
  EXPECT_EQ(unsaid, said);
  EXPECT_THAT(problem("partition", {slabs(), 0.0, std::string("frist")}),
              HasSubstr("conflict is 'frist'; accepted are 'first', 'last', 'mean' and 'max'; did "
                        "you mean 'first'?"));
  EXPECT_THAT(problem("partition", {slabs(), 0.0, std::string("maxx")}),
              HasSubstr("did you mean 'max'?"));
  EXPECT_THAT(problem("partition", {slabs(), -1.0}), HasSubstr("blend_width"));
}

TEST(PartitionConflict, AreWrittenAndRead) {
  for (const char* conflict : {"first", "last", "mean", "max"}) {
    SceneDescription scene;
    scene.solid = make_field("sphere", {Vec3{}, 2.0});
    for (const std::string& name : three) {
      scene.materials.emplace_back();
      scene.materials.back().name = name;
    }
    scene.fractions = make_fractions("partition", {slabs(), 0.25, std::string(conflict)});
    const SceneDescription read = parse_scene(scene_text(scene), "written.json");
    EXPECT_EQ(lower(read.fractions, three, 1.0), lower(scene.fractions, three, 1.0)) << conflict;
  }
}

}  // namespace
}  // namespace sardf

// One blend for a whole tree or scene: every boolean switches, formulas stay, and what blending
// moves is measured.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "error_of.hpp"
#include "laws.hpp"
#include "sardf/certify.hpp"
#include "sardf/formula.hpp"
#include "sardf/scene_file.hpp"

namespace sardf {
namespace {

using laws::Random;
using testing::HasSubstr;

std::vector<BlendPointer> all_blends() {
  return {make_blend("min_max", {}), make_blend("sardf", {0.4}), make_blend("sardf_c1", {0.3}),
          make_blend("r_function", {}), make_blend("smooth", {0.5})};
}

Field ball(const Vec3& center, double radius) { return make_field("sphere", {center, radius}); }
Field block(const Vec3& center, const Vec3& size) { return make_field("box", {center, size}); }
Field join(const char* how, std::vector<Field> of, const BlendPointer& blend) {
  return make_field(how, {std::move(of), blend});
}
Field with_blend(const Field& field, const BlendPointer& blend) {
  return make_field("with_blend", {field, blend});
}
Field blend_error(const Field& field) { return make_field("blend_error", {field}); }
double value(const Field& field, const Vec3& p) { return Evaluator(field.expression()).value(p); }

Vec3 random_point(Random& r) { return {r.uniform(-4, 4), r.uniform(-4, 4), r.uniform(-3, 3)}; }

// Of each constructor that takes fields at least one is above or below a boolean.
Field nested(const BlendPointer& blend) {
  const auto moved = [](const Field& field, const Vec3& by) {
    return make_field("translate", {field, by});
  };
  const Field profile =
      join("union",
           {make_field("disc", {Vec2{}, 1.0}), make_field("box2d", {Vec2{1, 0}, Vec2{2, 0.8}}),
            make_field("disc", {Vec2{2, 0.5}, 0.7})},
           blend);
  const Field bar = moved(make_field("extrude", {profile, 2.0}), {-1, 0, 0});
  const Field ring = make_field("revolve", {moved(profile, {1, 1, 0})});
  const Field drilled = join("difference", {bar, ball({}, 0.5), ball({1, 0, 0}, 0.6)}, blend);
  const Field arrow =
      make_field("implicit_polygon", {std::vector<Vec2>{{-2, -2}, {2, -1}, {0, 0}, {1, 2}}, blend});
  const std::vector<PlaneSection> sections{{profile, -1}, {arrow, 0}, {profile, 2}};
  const Field lofted = make_field("loft", {sections, std::string("smooth")});
  const Field inner = join("intersection", {drilled, lofted, block({}, {3, 3, 3})}, blend);
  const Field hollow = make_field("shell", {inner, 0.2, std::string("inside")});
  const Field twisted = make_field("twist", {hollow, 20.0, Vec3{0, 0, 1}, Vec3{}});
  const Field two = join("union", {ball({}, 0.5), block({}, {1.2, 0.5, 0.5})}, blend);
  const Field pair = make_field("repeat", {two, Vec3{2, 0, 0}, Vec3{2, 1, 1}});
  const Field mixed =
      parse_formula("max(u, 0.3*x) - min(v, y)*0.1", {{"u", twisted}, {"v", ring}}, {});
  const Field outer = make_field("offset", {join("union", {mixed, ring, pair}, blend), 0.1});
  return join("difference", {outer, make_field("complement", {make_field("bend", {bar, 5.0})})},
              blend);
}

TEST(WithBlend, SwitchesEveryBoolean) {
  std::vector<Field> made;
  for (const BlendPointer& blend : all_blends()) made.push_back(nested(blend));
  for (size_t from = 0; from < made.size(); ++from) {
    for (size_t to = 0; to < made.size(); ++to) {
      const Field switched = with_blend(made[from], all_blends()[to]);
      EXPECT_EQ(switched.expression(), made[to].expression()) << from << " " << to;
      EXPECT_EQ(switched.expression() == made[from].expression(), from == to);
    }
  }
}

TEST(WithBlend, GivesTheValuesOfTheOtherBlend) {
  const Field first = ball({}, 1), second = block({1, 0, 0}, {2, 1, 1});
  const Field made =
      make_field("scale", {join("union", {first, second}, all_blends()[1]), 2.0, Vec3{}});
  const Field hard = with_blend(made, make_blend("min_max", {}));
  const Field round = with_blend(made, make_blend("r_function", {}));
  Random r(1);
  bool differs = false;
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = random_point(r);
    const double a = value(first, 0.5 * p), b = value(second, 0.5 * p);
    EXPECT_NEAR(value(hard, p), 2 * std::max(a, b), 1e-14);
    EXPECT_NEAR(value(round, p), 2 * (a + b + std::sqrt(a * a + b * b)), 1e-13);
    differs = differs || std::abs(value(made, p) - value(hard, p)) > 0.01;
  }
  EXPECT_TRUE(differs);
}

TEST(WithBlend, LeavesFormulasAsTheyStand) {
  for (const char* text : {"min(x, y)", "max(x, min(y, z), 0.5)", "clamp(x, y, z) + abs(z)"}) {
    const Field formula = parse_formula(text, {}, {});
    for (const BlendPointer& blend : all_blends()) {
      EXPECT_EQ(with_blend(formula, blend).expression(), formula.expression()) << text;
    }
  }
  // A formula's own minimum stays below a union that switches.
  const Field corner = parse_formula("min(x, y)", {}, {});
  const Field made = join("union", {corner, ball({}, 1)}, make_blend("min_max", {}));
  const Field switched = with_blend(made, make_blend("r_function", {}));
  Random r(2);
  for (int i = 0; i < 100; ++i) {
    const Vec3 p = random_point(r);
    const double a = std::min(p[0], p[1]), b = 1 - norm(p);
    EXPECT_NEAR(value(switched, p), a + b + std::sqrt(a * a + b * b), 1e-13);
  }
}

TEST(WithBlend, IsOverruledFromOutside) {
  const std::vector<BlendPointer> blends = all_blends();
  const Field twice = with_blend(with_blend(nested(blends[0]), blends[1]), blends[2]);
  EXPECT_EQ(twice.expression(), nested(blends[2]).expression());
  // Only the part within.
  const Field part =
      with_blend(join("union", {ball({}, 1), ball({1, 0, 0}, 1)}, blends[1]), blends[3]);
  const Field whole = join("intersection", {part, ball({0, 1, 0}, 1)}, blends[2]);
  const Field expected = join(
      "intersection",
      {join("union", {ball({}, 1), ball({1, 0, 0}, 1)}, blends[3]), ball({0, 1, 0}, 1)}, blends[2]);
  EXPECT_EQ(whole.expression(), expected.expression());
}

TEST(WithBlend, KnowsWhatItsValueIs) {
  const BlendPointer hard = make_blend("min_max", {}), round = make_blend("sardf", {0.4});
  const Field pair = join("union", {ball({}, 1), ball({1, 0, 0}, 1)}, hard);
  EXPECT_EQ(with_blend(ball({}, 1), round).quality().inside, Exactness::exact);
  EXPECT_EQ(with_blend(pair, hard).quality().outside, Exactness::exact);
  EXPECT_EQ(with_blend(pair, hard).quality().inside, Exactness::bound);
  EXPECT_EQ(with_blend(pair, round).quality().outside, Exactness::estimate);
  EXPECT_EQ(with_blend(pair, round).quality().inside, Exactness::estimate);
}

// A feature joined otherwise is still a feature, and a formula a formula.
TEST(WithBlend, KeepsAFeatureAFeature) {
  const BlendPointer hard = make_blend("min_max", {}), round = make_blend("sardf", {0.4});
  const Field pair = join("union", {ball({}, 1), ball({1, 0, 0}, 1)}, hard);
  const auto distance = [](const Field& field, const Vec3& p) {
    return Evaluator(feature_distance(field)).value(p);
  };
  EXPECT_NEAR(distance(with_blend(make_field("boundary", {pair}), round), {-4, 0, 0}), 3, 1e-15);
  EXPECT_NEAR(distance(with_blend(make_field("point", {Vec3{}}), round), {3, 0, 0}), 3, 1e-15);
  EXPECT_NEAR(distance(with_blend(Field::coordinate(0), round), {3, 0, 0}), 3, 1e-15);
  EXPECT_NEAR(distance(with_blend(pair, round), {-4, 0, 0}), 3, 1e-15);
}

TEST(BlendError, IsTheDifferenceFromMinimaAndMaxima) {
  const Evaluator hard(nested(make_blend("min_max", {})).expression());
  for (const BlendPointer& blend : all_blends()) {
    const Field made = nested(blend), difference = blend_error(made);
    EXPECT_EQ(difference.quality().inside, Exactness::estimate);
    const Evaluator error(difference.expression()), joined(made.expression());
    Random r(3);
    double most = 0;
    for (int i = 0; i < 300; ++i) {
      const Vec3 p = random_point(r);
      EXPECT_NEAR(error.value(p), joined.value(p) - hard.value(p), 1e-12) << blend->name;
      most = std::max(most, std::abs(error.value(p)));
    }
    EXPECT_EQ(most > 0, blend->name != "min_max") << blend->name;
  }
}

TEST(BlendError, StaysBelowItsCertifiedBound) {
  const auto two = [](const BlendPointer& blend) {
    const Field pair = join("union", {ball({}, 1), block({1, 0, 0}, {2, 1, 1})}, blend);
    return join("difference", {pair, ball({0.5, 0.5, 0}, 0.7)}, blend);
  };
  const double corner = 1 - 1 / std::sqrt(2.0);
  // Two operations deep: at most corner · R, corner · R and k / 4 for each.
  const std::pair<BlendPointer, double> bounds[] = {{make_blend("sardf", {0.4}), 0.8 * corner},
                                                    {make_blend("sardf_c1", {0.3}), 0.6 * corner},
                                                    {make_blend("smooth", {0.5}), 0.25}};
  for (const auto& [blend, bound] : bounds) {
    const Field made = two(blend);
    const Evaluator error(blend_error(made).expression());
    EXPECT_NEAR(error_bound(made.expression()), bound, 1e-12) << blend->name;
    Random r(4);
    double most = 0;
    for (int i = 0; i < 5000; ++i) {
      const double at = std::abs(error.value({r.uniform(-1, 2), r.uniform(-1, 1), 0}));
      EXPECT_LE(at, bound);
      most = std::max(most, at);
    }
    EXPECT_GT(most, 0.25 * bound) << blend->name;
    EXPECT_EQ(value(blend_error(with_blend(made, min_max_blend())), {0.5, 0.4, 0}), 0);
  }
}

/// A scene that joins fields with `blend` in every place that takes one.
SceneDescription scene_of(const BlendPointer& blend) {
  const Field pair = join("union", {ball({}, 1), block({1, 0, 0}, {2, 1, 1})}, blend);
  const Field lens = join("intersection", {ball({}, 1), ball({0.5, 0, 0}, 1)}, blend);
  const Field hole = join("difference", {block({0, 1, 0}, {1, 1, 1}), ball({}, 0.8)}, blend);
  SceneDescription scene;
  scene.fields = {{"pair", pair}, {"lens", lens}};
  scene.solid = join("difference", {pair, make_field("translate", {hole, Vec3{0, 0, 1}})}, blend);
  scene.materials.resize(2);
  scene.materials[0].name = "a";
  scene.materials[1].name = "b";
  const Fractions a = Fractions::material("a"), b = Fractions::material("b");
  const Fractions parts = make_fractions(
      "partition", {std::vector<Record>{{{lens, a}}, {{pair, b}}}, 0.3, std::string("mean")});
  const RuleValue influence = parse_formula("0.1 + w*w", {{"w", hole}}, {});
  const std::vector<Record> features{{{make_field("boundary", {pair}), parts, 1.0, RuleValue{}}},
                                     {{lens, b, 2.0, influence}}};
  scene.fractions = make_fractions("inverse_distance", {features});
  scene.attributes.resize(2);
  scene.attributes[0].name = "depth";
  scene.attributes[0].components = {parse_formula("u*u", {{"u", pair}}, {}), lens};
  scene.attributes[1].name = "heat";
  const std::vector<Record> stops{{{0.0, Fractions::value({pair})}},
                                  {{1.0, Fractions::value({Field::number(3)})}}};
  scene.attributes[1].rule = make_fractions("ramp", {lens, stops});
  scene.sections = {{hole, {lens}}, {join("union", {hole, ball({3, 0, 0}, 1)}, blend), {}}};
  return scene;
}

void expect_same(const Scene& a, const Scene& b) {
  EXPECT_EQ(a.solid(), b.solid());
  EXPECT_EQ(a.drawn(), b.drawn());
  EXPECT_EQ(a.removed(), b.removed());
  EXPECT_EQ(a.fractions(), b.fractions());
  EXPECT_EQ(a.bounds().lo, b.bounds().lo);
  EXPECT_EQ(a.bounds().hi, b.bounds().hi);
  ASSERT_EQ(a.fields().size(), b.fields().size());
  for (size_t i = 0; i < a.fields().size(); ++i) {
    EXPECT_EQ(a.fields()[i].field.expression(), b.fields()[i].field.expression());
  }
  const std::vector<Attribute>&x = a.description().attributes, &y = b.description().attributes;
  ASSERT_EQ(x.size(), y.size());
  for (size_t i = 0; i < x.size(); ++i) {
    ASSERT_EQ(x[i].components.size(), y[i].components.size());
    for (size_t k = 0; k < x[i].components.size(); ++k) {
      EXPECT_EQ(x[i].components[k].expression(), y[i].components[k].expression()) << x[i].name;
    }
  }
}

TEST(SceneBlend, SwitchesEverythingInTheScene) {
  for (const BlendPointer& blend : all_blends()) {
    SCOPED_TRACE(blend->name);
    SceneDescription switched = scene_of(make_blend("sardf", {0.7}));
    const Scene before(switched);
    switched.blend = blend;
    const Scene after(switched), made(scene_of(blend));
    expect_same(after, made);
    EXPECT_NE(after.solid(), before.solid());
    EXPECT_NE(after.drawn(), before.drawn());
    EXPECT_NE(after.removed(), before.removed());
    EXPECT_NE(after.fractions(), before.fractions());
    for (size_t i = 0; i < 2; ++i) {
      EXPECT_NE(after.description().attributes[i].components[0].expression(),
                before.description().attributes[i].components[0].expression());
    }
  }
}

TEST(SceneBlend, IsWhatABlendErrorInTheSceneMeasures) {
  const auto error_of_scene = [](const BlendPointer& blend) {
    SceneDescription description = scene_of(make_blend("r_function", {}));
    description.attributes.resize(1);
    description.attributes[0].components = {blend_error(description.solid)};
    description.blend = blend;
    const Scene scene(description);
    return Evaluator(scene.description().attributes[0].components[0].expression());
  };
  Random r(5);
  const Evaluator hard(scene_of(make_blend("min_max", {})).solid.expression());
  for (const BlendPointer& blend : all_blends()) {
    const Evaluator error = error_of_scene(blend);
    const Evaluator made(scene_of(blend).solid.expression());
    double most = 0;
    for (int i = 0; i < 500; ++i) {
      const Vec3 p = random_point(r);
      EXPECT_NEAR(error.value(p), made.value(p) - hard.value(p), 1e-13) << blend->name;
      most = std::max(most, std::abs(error.value(p)));
    }
    EXPECT_EQ(most > 0, blend->name != "min_max") << blend->name;
  }
}

TEST(SceneBlend, IsWrittenAndRead) {
  for (const BlendPointer& blend : all_blends()) {
    SCOPED_TRACE(blend->name);
    SceneDescription scene = scene_of(make_blend("sardf", {0.7}));
    scene.fields.push_back({"error", blend_error(scene.solid)});
    scene.fields.push_back({"hard", with_blend(scene.solid, make_blend("smooth", {0.2}))});
    scene.blend = blend;
    const SceneDescription read = parse_scene(scene_text(scene), "written.json");
    ASSERT_TRUE(read.blend);
    EXPECT_EQ(read.blend->name, blend->name);
    EXPECT_EQ(read.blend->parameters, blend->parameters);
    EXPECT_EQ(read.solid.expression(), scene.solid.expression());
    // Fields that are used twice get names of their own when they are written.
    for (const NamedField& named : scene.fields) {
      const auto same_name = [&](const NamedField& other) { return other.name == named.name; };
      const auto found = std::find_if(read.fields.begin(), read.fields.end(), same_name);
      ASSERT_NE(found, read.fields.end()) << named.name;
      EXPECT_EQ(found->field.expression(), named.field.expression()) << named.name;
    }
    const Scene again(read), first(scene);
    EXPECT_EQ(again.solid(), first.solid());
    EXPECT_EQ(again.drawn(), first.drawn());
    EXPECT_EQ(again.fractions(), first.fractions());
    EXPECT_EQ(scene_text(read), scene_text(scene));
  }
  EXPECT_FALSE(parse_scene(scene_text(scene_of(make_blend("min_max", {}))), "none.json").blend);
}

TEST(SceneBlend, IsReadFromAFile) {
  const std::string start =
      R"({"sardf": 1, "fields": {"pair": {"union": {"of": [{"sphere": {"radius": 1}},
      {"box": {"size": [1, 1, 4]}}], "blend": {"sardf": 0.5}}}}, "solid": "pair")";
  const auto solid = [&](const std::string& end) {
    return Scene(parse_scene(start + end, "s.json")).solid();
  };
  const std::vector<Field> of{ball({}, 1), block({}, {1, 1, 4})};
  EXPECT_EQ(solid("}"), join("union", of, make_blend("sardf", {0.5})).expression());
  EXPECT_EQ(solid(R"(, "blend": "r_function"})"),
            join("union", of, make_blend("r_function", {})).expression());
  EXPECT_EQ(solid(R"(, "blend": {"smooth": 0.3}})"),
            join("union", of, make_blend("smooth", {0.3})).expression());
  const auto said = [&](const std::string& end) {
    return error_of([&] { parse_scene(start + end, "s.json"); });
  };
  EXPECT_THAT(said(R"(, "blend": {"sardff": 1}})"),
              testing::AllOf(HasSubstr("/blend"), HasSubstr("did you mean 'sardf'?")));
  EXPECT_THAT(said(R"(, "blend": {"sardf": -1}})"),
              testing::AllOf(HasSubstr("/blend"), HasSubstr("radius")));
}

// What is known of the tree that is made with min and max is known of the switched one, too.
TEST(WithBlend, HasTheLabelsOfTheTreeItIs) {
  const Field a = make_field("sphere", {Vec3{}, 2.0}),
              b = make_field("sphere", {Vec3{3, 0, 0}, 2.0});
  const BlendPointer sardf = make_blend("sardf", {0.5}), hard = make_blend("min_max", {});
  const Field soft = make_field("union", {std::vector<Field>{a, b}, sardf});
  const Field moved = make_field("translate", {soft, Vec3{1, 2, 3}});
  const Quality switched = make_field("with_blend", {moved, hard}).quality();
  EXPECT_EQ(switched.outside, Exactness::exact);
  EXPECT_EQ(switched.inside, Exactness::bound);
  EXPECT_EQ(make_field("with_blend", {moved, sardf}).quality().outside, Exactness::estimate);
  EXPECT_EQ(make_field("with_blend", {a, sardf}).quality().inside, Exactness::exact);
}

}  // namespace
}  // namespace sardf

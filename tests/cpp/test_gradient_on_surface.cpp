// Gradients exactly on the surface, at edges and corners too: one branch's, of length 1, never NaN.
#include <gtest/gtest.h>

#include <numbers>

#include "feature_checks.hpp"
#include "povray_gen/function_text.hpp"
#include "povray_harness.hpp"
#include "sardf/derivative.hpp"
#include "sardf/formula.hpp"

namespace sardf {
namespace {

using features::Draw;
using features::feature;

/// A field, points where it is 0 but for rounding, and unit vectors, of which the gradient at a
/// point has to be one; none: any.
struct Case {
  std::string name;
  Field field;
  std::vector<Vec3> points;
  std::vector<Vec3> normals{};
};

const std::vector<Vec2> ell{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 4}, {0, 4}};
const std::vector<Vec3> ell_normals{{0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {1, 0, 0}};

std::vector<Vec3> outline(const std::vector<Vec2>& corners, double z) {
  std::vector<Vec3> all;
  for (size_t i = 0; i < corners.size(); ++i) {
    const Vec2 &a = corners[i], &b = corners[(i + 1) % corners.size()];
    for (const double t : {0.0, 0.25, 0.5, 0.7}) {
      all.push_back({a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), z});
    }
  }
  return all;
}

std::vector<Vec2> star(Draw& draw, int n) {
  std::vector<Vec2> all;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n, r = draw.uniform(0.5, 2);
    all.push_back({r * std::cos(angle), r * std::sin(angle)});
  }
  if (draw.below(2)) std::reverse(all.begin(), all.end());
  return all;
}

std::vector<Vec3> rims(double bottom, double top, double height) {
  std::vector<Vec3> all;
  for (const double part : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const double r = bottom + part * (top - bottom), z = (part - 0.5) * height;
    if (r > 0) all.insert(all.end(), {{r, 0, z}, {0, -r, z}, {0.6 * r, 0.8 * r, z}});
  }
  return all;
}

std::vector<Case> cases() {
  std::vector<Case> all;
  const Field outlined = feature("polygon", {{"vertices", ell}});
  all.push_back({"polygon", outlined, outline(ell, 0.3), ell_normals});
  all.push_back({"extrude", feature("extrude", {{"field", outlined}, {"height", 2.0}}),
                 outline(ell, 0.5), ell_normals});
  std::vector<Vec3> with_ends = ell_normals;
  with_ends.push_back({0, 0, -1});
  all.push_back({"end of extrude", feature("extrude", {{"field", outlined}, {"height", 2.0}}),
                 outline(ell, 1), with_ends});
  Draw draw(61);
  for (int i = 0; i < 20; ++i) {
    const std::vector<Vec2> corners = star(draw, 3 + draw.below(9));
    const Field field = feature("polygon", {{"vertices", corners}});
    std::vector<Vec3> at;
    for (const Vec2& corner : corners) at.push_back({corner[0], corner[1], 0});
    all.push_back({"star", field, at});
    all.push_back({"prism", feature("extrude", {{"field", field}, {"height", 1.0}}), at});
    const double bottom = draw.uniform(0.2, 2), top = i % 4 ? draw.uniform(0, 2) : 0.0;
    const double height = draw.uniform(0.5, 3);
    all.push_back(
        {"cone",
         feature("cone", {{"radius_bottom", bottom}, {"radius_top", top}, {"height", height}}),
         rims(bottom, top, height)});
  }
  all.push_back({"box2d", feature("box2d", {{"center", Vec2{1.5, 2}}, {"size", Vec2{3, 4}}}),
                 outline({{0, 0}, {3, 0}, {3, 4}, {0, 4}}, 1), ell_normals});
  const std::vector<Vec2> side{{-1.5, -2}, {1.5, -2}, {1.5, 2}, {-1.5, 2}};
  for (const double z : {-2.5, 0.7, 2.5}) {
    all.push_back({"box", feature("box", {{"size", Vec3{3, 4, 5}}}), outline(side, z)});
    all.push_back({"rounded_box",
                   feature("rounded_box", {{"size", Vec3{3, 4, 5}}, {"radius", 0.5}}),
                   {{1.5, 0, 0}, {0.5, 2, 0.5}, {1, 1.5, 2.5}}});
  }
  all.push_back(
      {"cylinder", feature("cylinder", {{"radius", 1.3}, {"height", 2.2}}), rims(1.3, 1.3, 2.2)});
  all.push_back({"capsule",
                 feature("capsule", {{"a", Vec3{}}, {"b", Vec3{0, 0, 2}}, {"radius", 0.5}}),
                 {{0.5, 0, 0}, {0.5, 0, 2}, {0, 0.5, 1}, {0, 0, -0.5}}});
  all.push_back({"revolve",
                 feature("revolve", {{"field", outlined}}),
                 {{3, 0, 0}, {0, 3, 1}, {-1, 0, 1}, {0, -1, 4}, {1.8, 2.4, 0.5}}});
  return all;
}

// |gradient| is 1, but for floats.
void expect_gradient(const Case& c, const Vec3& at, const Vec3& gradient, const char* how,
                     double within = 1e-9) {
  EXPECT_NEAR(norm(gradient), 1, within)
      << c.name << ' ' << how << " at " << testing::PrintToString(at);
  if (c.normals.empty()) return;
  double best = infinity;
  for (const Vec3& n : c.normals) best = std::min(best, norm(gradient - n));
  EXPECT_LT(best, within) << c.name << ' ' << how << " at " << testing::PrintToString(at);
}

TEST(GradientOnSurface, IsThatOfOneFace) {
  for (const Case& c : cases()) {
    const Evaluator f(c.field.expression()), slopes(gradient(c.field.expression()));
    for (const Vec3& at : c.points) {
      EXPECT_NEAR(f.value(at), 0, 1e-14) << c.name << testing::PrintToString(at);
      expect_gradient(c, at, features::gradient(f, at), "in double");
      Vec3 found;
      slopes.values(at, found.data());
      expect_gradient(c, at, found, "as expressions");
    }
  }
}

TEST(GradientOnSurface, InFloatsToo) {
  for (const Case& c : cases()) {
    const Evaluator f(c.field.expression()), slopes(gradient(c.field.expression()));
    // All at once, and a block of 16 of each alone: shortcuts differ.
    std::vector<float> all;
    for (const Vec3& at : c.points) {
      for (const double a : at) all.push_back(float(a));
    }
    const size_t n = c.points.size();
    std::vector<float> values(n), together(3 * n), found(3 * n);
    f.gradients(all.data(), n, values.data(), together.data());
    slopes.values(all.data(), n, found.data());
    for (size_t i = 0; i < n; ++i) {
      float alone[3], value;
      f.gradients(&all[3 * i], 1, &value, alone);
      const auto vector = [](const float* a) { return Vec3{a[0], a[1], a[2]}; };
      // A float beside an edge may be nearest to the corner in rounding: any direction then.
      Case any = c;
      if (c.name == "star" || c.name == "prism") any.normals.clear();
      expect_gradient(any, c.points[i], vector(alone), "in a float", 1e-3);
      expect_gradient(any, c.points[i], vector(&together[3 * i]), "in floats", 1e-3);
      expect_gradient(any, c.points[i], vector(&found[3 * i]), "as float expressions", 1e-3);
    }
  }
}

TEST(GradientOnSurface, LiesWithinItsBounds) {
  for (const Case& c : cases()) {
    const Evaluator f(c.field.expression()), slopes(gradient(c.field.expression()));
    for (const Vec3& at : c.points) {
      for (const double half : {0.0, 1e-9, 0.1}) {
        const Vec3 corner{half, half, half};
        const BoundingBox box{at - corner, at + corner};
        const Slope slope = f.slope(box);
        EXPECT_GE(slope.length, 1 - 1e-9) << c.name;
        EXPECT_TRUE(slope.value.contains(f.value(at))) << c.name;
        std::array<Interval, 3> bounds;
        slopes.intervals(box, bounds.data());
        Vec3 found;
        slopes.values(at, found.data());
        const Vec3 g = features::gradient(f, at);
        for (size_t k = 0; k < 3; ++k) {
          EXPECT_TRUE(bounds[k].contains(found[k])) << c.name << ' ' << half;
          const Interval rounded{slope.partial[k].lo - 1e-12, slope.partial[k].hi + 1e-12};
          EXPECT_TRUE(rounded.contains(g[k])) << c.name << ' ' << half;
        }
      }
    }
  }
}

TEST(GradientOnSurface, InPovRayToo) {
  std::vector<povray::NamedExpression> fields;
  std::vector<Case> all = cases();
  for (size_t i = 0; i < all.size(); ++i) {
    const std::array<Expression, 3> slopes = gradient(all[i].field.expression());
    for (size_t k = 0; k < 3; ++k) {
      const std::string name = "f" + std::to_string(i) + "xyz"[k];
      fields.push_back({name, slopes[k]});
    }
  }
  povray::Names names("test");
  povray::FunctionWriter writer(names);
  const std::vector<std::string> functions = writer.declare(fields);
  std::vector<FunctionCall> calls;
  for (size_t i = 0; i < all.size(); ++i) {
    for (const Vec3& at : all[i].points) {
      for (size_t k = 0; k < 3; ++k) {
        calls.push_back({functions[3 * i + k], {at[0], at[1], at[2]}});
      }
    }
  }
  const std::vector<double> found = evaluate_in_povray(writer.text(), calls);
  size_t next = 0;
  for (const Case& c : all) {
    for (const Vec3& at : c.points) {
      expect_gradient(c, at, {found[next], found[next + 1], found[next + 2]}, "in POV-Ray");
      next += 3;
    }
  }
}

// The second derivatives at points whose nearest is on an edge and at a corner, in closed form.
TEST(GradientOnSurface, LeavesSecondDerivativesOfPolygonsAlone) {
  const Expression f = feature("polygon", {{"vertices", ell}}).expression();
  const auto second = [&](int i, int k, const Vec3& at) {
    return Evaluator(derivative(derivative(f, i), k)).value(at);
  };
  for (const Vec3& beside : {Vec3{0.3, -2, 0}, Vec3{5, 0.4, 0}, Vec3{0.4, 2, 0}}) {
    EXPECT_NEAR(second(0, 0, beside), 0, 1e-15);
    EXPECT_NEAR(second(0, 1, beside), 0, 1e-15);
    EXPECT_NEAR(second(1, 1, beside), 0, 1e-15);
  }
  // (6, -4) is 5 from the corner (3, 0), in the direction (0.6, -0.8).
  EXPECT_NEAR(second(0, 0, {6, -4, 0}), -(1 - 0.36) / 5, 1e-15);
  EXPECT_NEAR(second(0, 1, {6, -4, 0}), -0.48 / 5, 1e-15);
  EXPECT_NEAR(second(1, 1, {6, -4, 0}), -(1 - 0.64) / 5, 1e-15);
}

}  // namespace
}  // namespace sardf

// Second derivatives of distances found by a search: against differences of gradients, and against
// what is known of lines, circles, spheres, faces, edges and corners.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error_of.hpp"
#include "feature_checks.hpp"
#include "sardf/arithmetic.hpp"
#include "sardf/certify.hpp"
#include "sardf/curve_set.hpp"
#include "sardf/derivative.hpp"
#include "sardf/formula.hpp"
#include "sardf/mesh_set.hpp"
#include "sardf/segment_set.hpp"
#include "sardf/surface_set.hpp"
#include "triangle_meshes.hpp"

namespace sardf {
namespace {

using features::Draw;
using testing::HasSubstr;
using Matrix = std::array<Vec3, 3>;

const Expression X = coordinate(0), Y = coordinate(1), Z = coordinate(2);

Expression distance_to(PointSetPointer set) { return call(distance_operation(set), {X, Y, Z}); }

/// All nine, row after row.
std::vector<Expression> second_derivatives(const Expression& f) {
  std::vector<Expression> all;
  for (const auto& row : gradients(gradient(f))) all.insert(all.end(), row.begin(), row.end());
  return all;
}

Matrix matrix_at(const Evaluator& nine, const Vec3& at) {
  Matrix m;
  nine.values(at, m[0].data());
  return m;
}

Matrix outer(const Vec3& a) { return {a[0] * a, a[1] * a, a[2] * a}; }

/// (1 - Σ kept outer(direction)) / u.
Matrix bent(double u, const std::vector<std::pair<double, Vec3>>& directions) {
  Matrix m{Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const auto& [share, direction] : directions) {
    for (size_t k = 0; k < 3; ++k) m[k] = m[k] - share * outer(direction)[k];
  }
  for (Vec3& row : m) row = (1 / u) * row;
  return m;
}

void expect_matrix(const Matrix& found, const Matrix& expected, double within) {
  for (size_t i = 0; i < 3; ++i) {
    for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(found[i][k], expected[i][k], within) << i << k;
  }
}

/// Differences that do not settle are a kink's.
void expect_differences(const Expression& f, Draw& draw, double size, int count) {
  const Evaluator slope(f), nine(second_derivatives(f));
  int compared = 0;
  for (int i = 0; i < count; ++i) {
    const Vec3 p = draw.point(size);
    if (std::abs(slope.value(p)) < 0.05 * size) continue;
    const Matrix found = matrix_at(nine, p);
    for (size_t k = 0; k < 3; ++k) {
      const auto difference = [&](double h) {
        Vec3 before = p, after = p;
        before[k] -= h;
        after[k] += h;
        return (0.5 / h) * (features::gradient(slope, after) - features::gradient(slope, before));
      };
      const Vec3 wide = difference(2e-4 * size), expected = difference(1e-4 * size);
      const double doubt = norm(wide - expected), most = 1 + norm(expected);
      if (!(doubt < 1e-4 * most)) continue;
      ++compared;
      for (size_t row = 0; row < 3; ++row) {
        EXPECT_NEAR(found[row][k], expected[row], 2 * doubt + 1e-7 * most) << i;
      }
    }
  }
  EXPECT_GT(compared, 3 * count / 2);
}

CurveData random_curve(Draw& draw, bool rational, bool closed) {
  CurveData data;
  data.control_points = draw.points(9, 3);
  data.degree = 3;
  data.closed = closed;
  for (int i = 0; rational && i < 9; ++i) data.weights.push_back(draw.uniform(0.5, 2));
  return data;
}

SurfaceData random_surface(Draw& draw, bool rational) {
  SurfaceData data;
  data.degree_u = 3;
  data.degree_v = 2;
  for (int i = 0; i < 5; ++i) {
    std::vector<Vec3> row;
    for (int k = 0; k < 4; ++k) row.push_back(Vec3{i - 2.0, k - 1.5, 0} + draw.point(0.7));
    data.control_points.push_back(row);
  }
  for (int i = 0; rational && i < 20; ++i) data.weights.push_back(draw.uniform(0.5, 2));
  return data;
}

std::shared_ptr<const SegmentSet> random_segments(Draw& draw) {
  std::vector<SegmentSet::Ends> all;
  for (int i = 0; i < 40; ++i) {
    const Vec3 a = draw.point(3);
    all.push_back({a, i % 3 ? a + draw.point(1) : a});
  }
  const std::vector<double> data{51};
  return std::make_shared<SegmentSet>("s", "", data, all);
}

MeshDataPointer data_of(TriangleMesh mesh) { return std::make_shared<MeshData>(std::move(mesh)); }

PointSetPointer unit_cube(const char* sign) {
  return solid_of_mesh(data_of(box_mesh({0, 0, 0}, {1, 1, 1})), sign).set;
}

TEST(SecondDerivatives, AreDifferencesOfGradients) {
  Draw draw(51);
  for (const bool rational : {false, true}) {
    for (const bool closed : {false, true}) {
      const CurveData data = random_curve(draw, rational, closed);
      expect_differences(distance_to(std::make_shared<CurveSet>("c", "", data)), draw, 4, 60);
    }
    const SurfaceData data = random_surface(draw, rational);
    expect_differences(distance_to(std::make_shared<SurfaceSet>("s", "", data)), draw, 3, 60);
  }
  expect_differences(distance_to(random_segments(draw)), draw, 4, 200);
  expect_differences(distance_to(unit_cube("normals")), draw, 2, 200);
  expect_differences(distance_to(unit_cube("winding")), draw, 2, 200);
  expect_differences(distance_to(surface_of_mesh(data_of(icosphere(1)), {})), draw, 2, 200);
}

// A quarter of the circle of radius 2, rational: seen from within its sector it is the circle.
TEST(SecondDerivatives, OfAnArcAreTheCircles) {
  CurveData data;
  data.control_points = {{2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
  data.weights = {1, std::sqrt(0.5), 1};
  data.degree = 2;
  const Evaluator nine(second_derivatives(distance_to(std::make_shared<CurveSet>("c", "", data))));
  Draw draw(52);
  for (int i = 0; i < 100; ++i) {
    const double angle = draw.uniform(0.05, 1.5), radius = draw.uniform(0.3, 5);
    const double z = draw.uniform(0.2, 2), u = std::hypot(radius - 2, z);
    const Vec3 out{std::cos(angle), std::sin(angle), 0}, around{-out[1], out[0], 0};
    const Vec3 g = (1 / u) * ((radius - 2) * out + Vec3{0, 0, z});
    // The foot moves along the circle by 2 / radius of what the point moves around.
    expect_matrix(matrix_at(nine, radius * out + Vec3{0, 0, z}),
                  bent(u, {{1, g}, {2 / radius, around}}), 1e-9);
  }
  // Before its start it is a point.
  const Vec3 p{3, -1, 1};
  const double u = norm(p - Vec3{2, 0, 0});
  expect_matrix(matrix_at(nine, p), bent(u, {{1, (1 / u) * (p - Vec3{2, 0, 0})}}), 1e-12);
}

TEST(SecondDerivatives, OfALineAndItsEnds) {
  CurveData data;
  data.control_points = {{-1, 0, 0}, {1, 0, 0}};
  data.degree = 1;
  const std::vector<SegmentSet::Ends> one{{{-1, 0, 0}, {1, 0, 0}}};
  const std::vector<double> identity{52};
  const PointSetPointer both[] = {std::make_shared<CurveSet>("c", "", data),
                                  std::make_shared<SegmentSet>("s", "", identity, one)};
  for (const PointSetPointer& set : both) {
    const Evaluator nine(second_derivatives(distance_to(set)));
    const Vec3 along{1, 0, 0}, g{0, 0.6, 0.8};
    expect_matrix(matrix_at(nine, {0.3, 1.2, 1.6}), bent(2, {{1, g}, {1, along}}), 1e-15);
    const Vec3 beyond{2.0 / 3, 1.0 / 3, -2.0 / 3};
    expect_matrix(matrix_at(nine, Vec3{1, 0, 0} + 3 * beyond), bent(3, {{1, beyond}}), 1e-15);
  }
}

// The patch of the unit sphere that x = y = 1 spans stereographically, from the south pole:
// (2s, 2t, 1 - s² - t²) / (1 + s² + t²) for s, t in [0, 1], biquadratic.
std::shared_ptr<const SurfaceSet> sphere_patch() {
  SurfaceData data;
  data.degree_u = data.degree_v = 2;
  const auto square = [](int i) { return i == 2 ? 1.0 : 0.0; };
  for (int i = 0; i < 3; ++i) {
    std::vector<Vec3> row;
    for (int k = 0; k < 3; ++k) {
      const double squares = square(i) + square(k), w = 1 + squares;
      row.push_back((1 / w) * Vec3{double(i), double(k), 1 - squares});
      data.weights.push_back(w);
    }
    data.control_points.push_back(row);
  }
  return std::make_shared<SurfaceSet>("s", "", data);
}

TEST(SecondDerivatives, OfASpherePatchAreTheSpheres) {
  const PointSetPointer patch = sphere_patch();
  const Evaluator nine(second_derivatives(distance_to(patch)));
  Draw draw(53);
  for (int i = 0; i < 100; ++i) {
    const double s = draw.uniform(0.05, 0.95), t = draw.uniform(0.05, 0.95);
    const double radius = i % 2 ? draw.uniform(1.2, 4) : draw.uniform(0.4, 0.8);
    const Vec3 out = (1 / (1 + s * s + t * t)) * Vec3{2 * s, 2 * t, 1 - s * s - t * t};
    ASSERT_NEAR(norm(out), 1, 1e-15);
    ASSERT_NEAR(patch->nearest(radius * out).distance, std::abs(radius - 1), 1e-12);
    Matrix expected = bent(radius, {{1, out}});
    for (Vec3& row : expected) row = (radius > 1 ? 1.0 : -1.0) * row;
    expect_matrix(matrix_at(nine, radius * out), expected, 1e-8);
  }
  // Off the edge t = 0, the arc (2s, 0, 1 - s²) / (1 + s²) in the plane y = 0, it is a curve's.
  const Vec3 arc{0.8, 0, 0.6}, around{0.6, 0, -0.8}, p = 2 * arc - Vec3{0, 1, 0};
  const double u = std::sqrt(2.0);
  expect_matrix(matrix_at(nine, p), bent(u, {{1, (1 / u) * (p - arc)}, {0.5, around}}), 1e-9);
  // Off the corner s = t = 0, the pole, it is a point's.
  const Vec3 q{-1, -2, 3};
  const double v = norm(q - Vec3{0, 0, 1});
  expect_matrix(matrix_at(nine, q), bent(v, {{1, (1 / v) * (q - Vec3{0, 0, 1})}}), 1e-12);
}

TEST(SecondDerivatives, OfACubesFacesEdgesAndCorners) {
  for (const char* sign : {"normals", "winding"}) {
    const Evaluator nine(second_derivatives(distance_to(unit_cube(sign))));
    expect_matrix(matrix_at(nine, {0.4, 0.5, 0.9}), {}, 1e-14);  // inside
    expect_matrix(matrix_at(nine, {0.4, 0.7, 3}), {}, 1e-14);
    const auto outside = [&](const Vec3& at, double u,
                             const std::vector<std::pair<double, Vec3>>& directions) {
      Matrix expected = bent(u, directions);
      for (Vec3& row : expected) row = -1.0 * row;
      expect_matrix(matrix_at(nine, at), expected, 1e-14);
    };
    outside({0.3, 4, 5}, 5, {{1, {0, 0.6, 0.8}}, {1, {1, 0, 0}}});
    outside({2, 3, -2}, 3, {{1, (1.0 / 3) * Vec3{1, 2, -2}}});
  }
}

TEST(SecondDerivatives, HaveBoundsThatEncloseThem) {
  Draw draw(54);
  const PointSetPointer sets[] = {
      std::make_shared<CurveSet>("c", "", random_curve(draw, true, true)),
      std::make_shared<SurfaceSet>("s", "", random_surface(draw, true)), random_segments(draw),
      unit_cube("winding")};
  for (const PointSetPointer& set : sets) {
    const Evaluator nine(second_derivatives(distance_to(set)));
    for (int i = 0; i < 60; ++i) {
      const double half = std::pow(10, draw.uniform(-5, 0.5));
      const Vec3 centre = draw.point(3), corner{half, half, half};
      const BoundingBox box{centre - corner, centre + corner};
      std::array<Interval, 9> bounds;
      nine.intervals(box, bounds.data());
      for (int k = 0; k < 10; ++k) {
        const Vec3 at = centre + half * draw.point(1);
        const Matrix found = matrix_at(nine, at);
        for (size_t n = 0; n < 9; ++n) {
          ASSERT_FALSE(std::isnan(bounds[n].lo) || std::isnan(bounds[n].hi));
          if (!std::isnan(found[n / 3][n % 3])) {
            EXPECT_TRUE(bounds[n].contains(found[n / 3][n % 3])) << i << ' ' << n;
          }
        }
      }
    }
  }
}

// Between two points the distance has a ridge: it bends by nothing that is finite.
TEST(SecondDerivatives, AreUnboundedDownwardsAcrossARidge) {
  const std::vector<SegmentSet::Ends> two{{{-1, 0, 0}, {-1, 0, 0}}, {{1, 0, 0}, {1, 0, 0}}};
  const std::vector<double> identity{53};
  const Expression u = distance_to(std::make_shared<SegmentSet>("s", "", identity, two));
  const Expression bend = derivative(derivative(u, 0), 0);
  const Interval across = Evaluator(bend).interval({{-0.1, 0.9, -0.1}, {0.1, 1.1, 0.1}});
  EXPECT_EQ(across.lo, -infinity);
  EXPECT_EQ(Evaluator(derivative(u, 0)).slope({{-0.1, 0.9, -0.1}, {0.1, 1.1, 0.1}}).length,
            infinity);
  // No distance bends upwards by more than that to a point does; bounds give twice that.
  EXPECT_LE(across.hi, 2 / (std::hypot(0.9, 0.9) - 0.2));
  EXPECT_FALSE(std::isnan(Evaluator(bend).value({0, 1, 0})));
}

/// Counts its searches.
class CountedPoint final : public PointSet {
 public:
  CountedPoint() : PointSet("counted", "A point.", Vec3{}) {}
  Nearest nearest(const Vec3& p) const override {
    ++searches;
    return {{}, norm(p), (1 / norm(p)) * p, 0, {}};
  }
  std::array<Vec3, 3> jacobian(const Vec3&, const Nearest&) const override {
    ++jacobians;
    return {};
  }
  std::array<Interval, 3> bounds() const override { return {}; }
  mutable int searches = 0, jacobians = 0;
};

TEST(SecondDerivatives, ShareTheSearch) {
  const auto set = std::make_shared<CountedPoint>();
  std::vector<Expression> all = second_derivatives(distance_to(set));
  all.push_back(distance_to(set));
  Draw draw(55);
  const std::vector<Vec3> points = draw.points(16, 2);
  std::vector<double> out(16 * all.size());
  Evaluator(all).values(points[0].data(), 16, out.data());
  EXPECT_EQ(set->searches, 16);
  EXPECT_EQ(set->jacobians, 16);
}

TEST(SecondDerivatives, InFloatAreTheDoubleOnes) {
  Draw draw(56);
  const Evaluator nine(second_derivatives(
      distance_to(std::make_shared<CurveSet>("c", "", random_curve(draw, false, false)))));
  for (int i = 0; i < 100; ++i) {
    const Vec3 p = draw.point(4);
    const std::array<float, 3> at{float(p[0]), float(p[1]), float(p[2])};
    std::array<float, 9> found;
    nine.values(at.data(), 1, found.data());
    const Matrix expected = matrix_at(nine, {at[0], at[1], at[2]});
    for (size_t n = 0; n < 9; ++n) {
      const double there = expected[n / 3][n % 3];
      EXPECT_NEAR(found[n], there, 2e-4 * (1 + std::abs(there))) << i;
    }
  }
}

TEST(SecondDerivatives, TakeAnyNumbers) {
  Draw draw(57);
  const PointSetPointer sets[] = {
      std::make_shared<CurveSet>("c", "", random_curve(draw, true, true)),
      std::make_shared<SurfaceSet>("s", "", random_surface(draw, true)), random_segments(draw),
      unit_cube("normals")};
  const double nan = std::nan("");
  for (const PointSetPointer& set : sets) {
    const Evaluator nine(second_derivatives(distance_to(set)));
    EXPECT_TRUE(std::isnan(matrix_at(nine, {nan, 0, 1})[0][0]));
    matrix_at(nine, {infinity, 0, -infinity});
    expect_matrix(matrix_at(nine, {1e200, 0, 0}), {}, 1e-100);
  }
}

TEST(ThirdDerivatives, AreAnErrorThatNamesTheField) {
  Draw draw(58);
  const Field curve = features::feature("bspline_curve", {{"control_points", draw.points(6, 3)}});
  const std::string message =
      "third derivatives of a distance found by a search ('bspline_curve') are not known";
  const std::string thrice = error_of([&] {
    parse_formula("dx(dy(dx(curve)))", {{"curve", curve}}, {}).expression();
  });
  EXPECT_THAT(thrice, HasSubstr(message));
  const Expression& f = curve.expression();
  EXPECT_EQ(error_of([&] {
              directional_series(f, {constant(1), constant(0), constant(0)}, 3);
            }),
            message);
  EXPECT_EQ(directional_series(f, {constant(1), constant(0), constant(0)}, 2).size(), 3u);
  // The same where numbers are asked for.
  const Evaluator bend(derivative(derivative(f, 0), 1));
  EXPECT_EQ(error_of([&] { features::gradient(bend, {1, 2, 3}); }), message);
  // Bounds ask for none.
  const BoundingBox box{{4, 4, 4}, {5, 5, 5}};
  EXPECT_EQ(certified_lipschitz(bend, box).value, infinity);
  // What does not vary has all derivatives.
  EXPECT_EQ(
      derivative(
          substitute(derivative(derivative(f, 0), 1), {constant(1), constant(2), constant(3)}), 0),
      constant(0));
}

// Functions of a searched distance, derived as those of the same distance by a formula.
TEST(SecondDerivatives, OfMaterialFunctionsAreTheFormulas) {
  CurveData data;
  data.control_points = {{-1, 0.5, 0}, {1, 0, 2}};
  data.degree = 1;
  const Field found(distance_to(std::make_shared<CurveSet>("c", "", data)), {}, nullptr);
  const Field known =
      features::feature("segment", {{"a", data.control_points[0]}, {"b", data.control_points[1]}});
  const Field wave = parse_formula("sin(x) * y + z * z", {}, {});
  const auto functions_of = [&](const Field& u) {
    const auto made = [](const char* name, std::map<std::string, Value> given) {
      return features::feature(name, given);
    };
    return std::vector<Field>{
        made("gradient_length", {{"field", parse_formula("exp(-u)", {{"u", u}}, {})}}),
        made("gradient_length", {{"field", parse_formula("dx(u) * dy(u) + u", {{"u", u}}, {})}}),
        made("normal_derivative", {{"field", wave}, {"distance", u}}),
        made("normal_derivative", {{"field", parse_formula("dx(u)", {{"u", u}}, {})},
                                   {"distance", parse_formula("u", {{"u", u}}, {})}}),
        made("conditioned", {{"field", wave}, {"distance", u}}),
        made("canonical_form", {{"distance", u},
                                {"coefficients", std::vector<Field>{wave, wave}},
                                {"remainder", wave}}),
        made("taylor", {{"formula", std::string("exp(-1.5*u)")}, {"distance", u}, {"terms", 4.0}}),
        made("normalized",
             {{"field", parse_formula("u * (2 + x)", {{"u", u}}, {})}, {"order", 1.0}}),
        made("normalized",
             {{"field", parse_formula("u * (2 + x)", {{"u", u}}, {})}, {"order", 3.0}})};
  };
  const std::vector<Field> searched = functions_of(found), formulas = functions_of(known);
  Draw draw(59);
  for (size_t n = 0; n < searched.size(); ++n) {
    // Where the function's own value takes second derivatives, its gradient would take third ones.
    const bool is_second = n == 1 || n == 3;
    const auto all = [&](const Field& f) {
      std::vector<Expression> list{f.expression()};
      if (is_second) return list;
      for (const Expression& d : gradient(f.expression())) list.push_back(d);
      return list;
    };
    const Evaluator left(all(searched[n])), right(all(formulas[n]));
    for (int i = 0; i < 50; ++i) {
      const Vec3 p = draw.point(3);
      std::vector<double> a(left.outputs()), b(right.outputs());
      left.values(p, a.data());
      right.values(p, b.data());
      for (size_t k = 0; k < a.size(); ++k) {
        EXPECT_NEAR(a[k], b[k], 1e-9 * (1 + std::abs(b[k]))) << n << ' ' << k;
      }
      if (is_second) continue;
      const Vec3 g = features::gradient(Evaluator(searched[n].expression()), p);
      for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(g[k], a[k + 1], 1e-8 * (1 + norm(g))) << n;
    }
  }
}

}  // namespace
}  // namespace sardf

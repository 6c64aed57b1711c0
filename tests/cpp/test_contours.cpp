// Solids from closed contours: the implicit polygon against even-odd counting, what contours are
// refused, and lofts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "error_of.hpp"
#include "laws.hpp"
#include "sardf/certify.hpp"
#include "sardf/contour.hpp"
#include "sardf/formula.hpp"

namespace sardf {
namespace {

using laws::Random;
using testing::HasSubstr;

/// The blends whose sign is that of minimum and maximum.
std::vector<BlendPointer> sharp_blends() {
  return {make_blend("min_max", {}), make_blend("sardf", {0.5}), make_blend("sardf_c1", {0.5}),
          make_blend("r_function", {})};
}

Field polygon(const Contour& contour) { return make_field("polygon", {contour}); }
Field implicit(const Contour& contour, const BlendPointer& blend = min_max_blend()) {
  return make_field("implicit_polygon", {contour, blend});
}

double value(const Field& field, const Vec3& p) { return Evaluator(field.expression()).value(p); }

bool even_odd(const Contour& contour, const Vec2& p) {
  bool inside = false;
  for (size_t i = 0; i < contour.size(); ++i) {
    const Vec2 &a = contour[i], &b = contour[(i + 1) % contour.size()];
    if ((a[1] > p[1]) == (b[1] > p[1])) continue;
    const double x = a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
    if (p[0] < x) inside = !inside;
  }
  return inside;
}

double distance_to_edges(const Contour& contour, const Vec2& p) {
  double least = infinity;
  for (size_t i = 0; i < contour.size(); ++i) {
    const Vec2 &a = contour[i], &b = contour[(i + 1) % contour.size()];
    const Vec2 e{b[0] - a[0], b[1] - a[1]}, q{p[0] - a[0], p[1] - a[1]};
    const double t =
        std::clamp((e[0] * q[0] + e[1] * q[1]) / (e[0] * e[0] + e[1] * e[1]), 0.0, 1.0);
    least = std::min(least, std::hypot(q[0] - t * e[0], q[1] - t * e[1]));
  }
  return least;
}

/// Random points of the contour's box and around it, none on an edge.
std::vector<double> points_around(const Contour& contour, int count, Random& r) {
  Vec2 lo = contour[0], hi = lo;
  for (const Vec2& c : contour) {
    for (int axis = 0; axis < 2; ++axis) {
      lo[axis] = std::min(lo[axis], c[axis]);
      hi[axis] = std::max(hi[axis], c[axis]);
    }
  }
  std::vector<double> points;
  while (int(points.size()) < 3 * count) {
    const Vec2 p{r.uniform(lo[0] - 1, hi[0] + 1), r.uniform(lo[1] - 1, hi[1] + 1)};
    if (distance_to_edges(contour, p) < 1e-6) continue;
    points.insert(points.end(), {p[0], p[1], r.uniform(-9, 9)});
  }
  return points;
}

void check_sign(const Contour& contour, int count, Random& r) {
  const std::vector<double> points = points_around(contour, count, r);
  std::vector<double> out(points.size() / 3);
  int inside = 0;
  const auto compare = [&](const Field& field, const std::string& what) {
    Evaluator(field.expression()).values(points.data(), out.size(), out.data());
    for (size_t i = 0; i < out.size(); ++i) {
      const bool is_in = even_odd(contour, {points[3 * i], points[3 * i + 1]});
      inside += is_in;
      ASSERT_NE(out[i], 0) << what << " at " << points[3 * i] << " " << points[3 * i + 1];
      ASSERT_EQ(out[i] > 0, is_in) << what << " at " << points[3 * i] << " " << points[3 * i + 1];
    }
  };
  compare(polygon(contour), "polygon");
  for (const BlendPointer& blend : sharp_blends()) compare(implicit(contour, blend), blend->name);
  EXPECT_GT(inside, 0);
  EXPECT_LT(inside, 5 * count);
}

Contour reversed(const Contour& contour) { return {contour.rbegin(), contour.rend()}; }

/// A bar wound up: its outer side from outside in, then its inner side back.
Contour spiral(int turns, int corners_per_turn) {
  const auto at = [](double turn, double radius) {
    const double angle = 2 * std::numbers::pi * turn;
    return Vec2{radius * std::cos(angle), radius * std::sin(angle)};
  };
  Contour out;
  const int n = turns * corners_per_turn;
  for (int i = 0; i <= n; ++i) {
    const double turn = double(i) / corners_per_turn;
    out.push_back(at(turn, 1 + turn));
  }
  for (int i = n; i >= 0; --i) {
    const double turn = double(i) / corners_per_turn;
    out.push_back(at(turn, 0.5 + turn));
  }
  return out;
}

/// How often unions and intersections alternate along the deepest path.
int alternations(const Expression& expression) {
  std::map<const Node*, int> depth;
  for (const Node* node : topological_order({&expression, 1})) {
    int most = 0;
    for (const Expression& input : node->arguments()) {
      const bool other = input->operation && input->operation->join() != node->operation->join();
      most = std::max(most, depth.at(input.get()) + other);
    }
    depth[node] = most;
  }
  return depth.at(expression.get());
}

TEST(ImplicitPolygon, HasTheSignOfRandomStars) {
  Random r(1);
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    check_sign(r.contour(3 + r.below(22)), laws::effort(300), r);
  }
}

TEST(ImplicitPolygon, HasTheSignEitherWayRound) {
  Random r(2);
  for (int i = 0; i < 10; ++i) {
    const Contour contour = r.contour(12), turned = reversed(contour);
    ASSERT_LT(doubled_area(contour) * doubled_area(turned), 0);
    check_sign(contour, 200, r);
    check_sign(turned, 200, r);
  }
}

TEST(ImplicitPolygon, HasTheSignOfADeepSpiral) {
  Random r(3);
  const Contour wound = spiral(18, 8);
  EXPECT_GE(alternations(implicit(wound).expression()), 30);
  check_sign(wound, laws::effort(3000), r);
  check_sign(reversed(wound), laws::effort(3000), r);
}

TEST(ImplicitPolygon, MayHaveCornersOnStraightEdges) {
  // An L, with corners added on edges of its hull and of its pocket.
  const Contour plain{{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 3}, {0, 3}};
  const Contour more{{0, 0}, {1, 0}, {3, 0}, {4, 0},   {4, 0.5}, {4, 1}, {3, 1}, {2, 1},
                     {1, 1}, {1, 2}, {1, 3}, {0.5, 3}, {0, 3},   {0, 2}, {0, 1}};
  Random r(4);
  check_sign(more, 2000, r);
  check_sign(reversed(more), 2000, r);
  // By hand: within the outer lines, below y = 1 or left of x = 1. A line twice changes no minimum.
  for (int i = 0; i < 500; ++i) {
    const double x = r.uniform(-1, 5), y = r.uniform(-1, 4);
    const double pocket = std::max(1 - y, 1 - x);
    const double expected = std::min({y, 4 - x, pocket, 3 - y, x});
    EXPECT_NEAR(value(implicit(plain), {x, y, 0}), expected, 1e-14);
    EXPECT_NEAR(value(implicit(more), {x, y, 7}), expected, 1e-14);
  }
}

TEST(ImplicitPolygon, IsThatOfItsLinesByHand) {
  // A square with a notch from above: min of the sides and of the notch, whose edges rise from
  // (2, 1) to (1, 4) and (3, 4).
  const Contour contour{{0, 0}, {4, 0}, {4, 4}, {3, 4}, {2, 1}, {1, 4}, {0, 4}};
  const auto left_of = [](const Vec2& a, const Vec2& b, const Vec2& p) {
    const double ex = b[0] - a[0], ey = b[1] - a[1];
    return (ex * (p[1] - a[1]) - ey * (p[0] - a[0])) / std::hypot(ex, ey);
  };
  Random r(5);
  const Field field = implicit(contour);
  for (int i = 0; i < 500; ++i) {
    const Vec2 p{r.uniform(-2, 6), r.uniform(-2, 6)};
    const double notch = std::max(left_of({3, 4}, {2, 1}, p), left_of({2, 1}, {1, 4}, p));
    const double sides = std::min({p[0], 4 - p[0], p[1], 4 - p[1]});
    EXPECT_NEAR(value(field, {p[0], p[1], 0}), std::min(sides, notch), 1e-14);
  }
  EXPECT_EQ(field.quality().inside, Exactness::estimate);
  EXPECT_EQ(field.quality().outside, Exactness::estimate);
}

std::string problem(const char* constructor, const Contour& contour) {
  std::vector<Value> arguments{contour};
  if (constructor == std::string("implicit_polygon")) arguments.push_back(min_max_blend());
  return error_of([&] { make_field(constructor, arguments); });
}

TEST(Contours, AreRefusedNamingTheEdges) {
  for (const auto& [constructor, what] :
       {std::pair{"polygon", "polygon"}, {"implicit_polygon", "implicit polygon"}}) {
    SCOPED_TRACE(what);
    const auto said = [&](const Contour& contour) { return problem(constructor, contour); };
    const std::string name = what;
    const Contour bow{{0, 0}, {2, 2}, {2, 0}, {0, 2}};
    EXPECT_THAT(said(bow), HasSubstr("the " + name + "'s edges 0-1 and 2-3 cross or touch"));
    const Contour once{{0, 0}, {4, 0}, {4, 4}, {5, 2}, {3, 2}, {0, 4}};
    EXPECT_THAT(said(once), HasSubstr("edges 1-2 and 3-4"));
    const Contour by_the_last{{4, 4}, {5, 2}, {3, 2}, {0, 4}, {0, 0}, {4, 0}};
    EXPECT_THAT(said(by_the_last), HasSubstr("edges 1-2 and 5-0"));
    const Contour corner_on_edge{{0, 0}, {4, 0}, {4, 4}, {2, 0}, {0, 4}};
    EXPECT_THAT(said(corner_on_edge), HasSubstr("edges 0-1 and 2-3"));
    const Contour overlapping{{0, 0}, {6, 0}, {6, 2}, {4, 2}, {4, 0}, {2, 0}, {2, 2}, {0, 2}};
    EXPECT_THAT(said(overlapping), HasSubstr("edges 0-1 and 3-4"));
    const Contour there_and_back{{0, 0}, {4, 0}, {2, 0}, {2, 3}};
    EXPECT_THAT(said(there_and_back), HasSubstr("edges 0-1 and 1-2"));
    const Contour corners_meet{{0, 0}, {2, 0}, {1, 1}, {2, 2}, {0, 2}, {1, 1}};
    EXPECT_THAT(said(corners_meet), HasSubstr("edges 1-2 and 4-5"));
    EXPECT_THAT(said({{0, 0}, {1, 0}, {1, 0}, {0, 1}}),
                HasSubstr("vertices 1-2 of the " + name + " are the same point"));
    const std::string closed = said({{0, 0}, {1, 0}, {0, 1}, {0, 0}});
    EXPECT_THAT(closed, HasSubstr("vertices 3-0"));
    EXPECT_THAT(closed, HasSubstr("joined to the first without repeating it"));
    EXPECT_THAT(said({{0, 0}, {1, 1}, {3, 3}}), HasSubstr("the " + name + " has no area"));
    EXPECT_THAT(said({{0, 0}, {1, 1}}), HasSubstr("vertices has 2"));
    EXPECT_EQ(said({{0, 0}, {1, 0}, {0, 1}}), "no error");
    // An edge may end next to another without touching it.
    EXPECT_EQ(said({{0, 0}, {4, 0}, {4, 4}, {2, 1e-9}, {0, 4}}), "no error");
  }
}

TEST(ImplicitPolygon, IsExtrudedAndRevolved) {
  // An arrow that points to +x.
  const Contour contour{{1, 0}, {3, 1}, {1, 2}, {1.5, 1}};
  const Field flat = implicit(contour), bar = make_field("extrude", {flat, 3.0});
  const Field ring = make_field("revolve", {flat});
  Random r(6);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p{r.uniform(-4, 4), r.uniform(-4, 4), r.uniform(-3, 3)};
    const double f = value(flat, p), height = 1.5 - std::abs(p[2]);
    // min inside, where one is negative that one, and the length where both are.
    const double expected = f < 0 && height < 0 ? -std::hypot(f, height) : std::min(f, height);
    EXPECT_NEAR(value(bar, p), expected, 1e-14);
    const double around = std::hypot(p[0], p[1]);
    EXPECT_NEAR(value(ring, p), value(flat, {around, p[2], 0}), 1e-14);
    const Vec2 in_half_plane{around, p[2]};
    if (distance_to_edges(contour, in_half_plane) < 1e-9) continue;
    EXPECT_EQ(value(ring, p) > 0, even_odd(contour, in_half_plane));
  }
  EXPECT_EQ(bar.quality().inside, Exactness::estimate);
  EXPECT_EQ(ring.quality().outside, Exactness::estimate);
}

Field disc(double x, double radius) { return make_field("disc", {Vec2{x, 0}, radius}); }
Field loft(const std::vector<PlaneSection>& sections, const char* interpolation) {
  return make_field("loft", {sections, std::string(interpolation)});
}

/// Four sections at uneven heights, two of them no distances.
std::vector<PlaneSection> vase() {
  const Field square = make_field("box2d", {Vec2{}, Vec2{4, 3}});
  return {{disc(0, 2), -1},
          {square, 0.5},
          {implicit({{1, 0}, {3, 1}, {-1, 2}, {0, 0.5}, {-2, -2}}), 2},
          {disc(1, 1.5), 4}};
}

TEST(Loft, IsItsSectionAtEachHeight) {
  Random r(7);
  const std::vector<PlaneSection> sections = vase();
  for (const char* how : {"linear", "smooth"}) {
    const Evaluator evaluator(loft(sections, how).expression());
    for (const PlaneSection& section : sections) {
      for (int i = 0; i < 200; ++i) {
        const Vec3 p{r.uniform(-4, 4), r.uniform(-4, 4), section.z};
        const double cap = std::min(section.z + 1, 4 - section.z);
        EXPECT_NEAR(evaluator.value(p), std::min(value(section.field, p), cap), 1e-13) << how;
      }
    }
  }
}

TEST(Loft, IsStraightBetweenSections) {
  const std::vector<PlaneSection> sections = vase();
  const Evaluator evaluator(loft(sections, "linear").expression());
  Random r(8);
  for (int i = 0; i < 200; ++i) {
    const double x = r.uniform(-4, 4), y = r.uniform(-4, 4);
    for (size_t k = 0; k + 1 < sections.size(); ++k) {
      for (const double t : {0.25, 0.5}) {
        const double z = (1 - t) * sections[k].z + t * sections[k + 1].z;
        const double a = value(sections[k].field, {x, y, 0});
        const double b = value(sections[k + 1].field, {x, y, 0});
        const double cap = std::min(z + 1, 4 - z);
        EXPECT_NEAR(evaluator.value({x, y, z}), std::min((1 - t) * a + t * b, cap), 1e-13);
      }
    }
  }
  // A cone: radius 3 at the bottom, 1 at the top, 2 halfway.
  const Field cone = loft({{disc(0, 3), 0}, {disc(0, 1), 8}}, "linear");
  EXPECT_NEAR(value(cone, {2, 0, 4}), 0, 1e-15);
  EXPECT_NEAR(value(cone, {0, 2.25, 4}), -0.25, 1e-15);
  EXPECT_NEAR(value(cone, {0, 1.5, 4}), 0.5, 1e-15);
  EXPECT_NEAR(value(cone, {0, 0, 4}), 2, 1e-15);
  // Two sections have no curvature to take from neighbours.
  const Field smooth = loft({{disc(0, 3), 0}, {disc(0, 1), 8}}, "smooth");
  EXPECT_NEAR(value(smooth, {0, 1.5, 2}), 1, 1e-15);
}

// The cubic of Hermite's four basis functions. Its slopes at the inner sections are those of the
// parabola through three sections, but at most twice those of the straight lines on either side,
// and 0 where these rise and fall.
TEST(Loft, IsACubicBetweenInnerSections) {
  const std::vector<PlaneSection> s = vase();
  const Evaluator evaluator(loft(s, "smooth").expression());
  const auto slope = [](const double* z, const double* f) {
    // Lagrange's polynomials, derived at the middle one.
    const double parabola = f[0] * (z[1] - z[2]) / ((z[0] - z[1]) * (z[0] - z[2])) +
                            f[1] * (2 * z[1] - z[0] - z[2]) / ((z[1] - z[0]) * (z[1] - z[2])) +
                            f[2] * (z[1] - z[0]) / ((z[2] - z[0]) * (z[2] - z[1]));
    const double before = (f[1] - f[0]) / (z[1] - z[0]), after = (f[2] - f[1]) / (z[2] - z[1]);
    if (before * after <= 0) return 0.0;
    return std::copysign(std::min({std::abs(parabola), 2 * std::abs(before), 2 * std::abs(after)}),
                         after);
  };
  Random r(9);
  int flat = 0;
  for (int i = 0; i < 500; ++i) {
    const double x = r.uniform(-3, 3), y = r.uniform(-3, 3), t = r.uniform(0, 1);
    double z[4], f[4];
    for (size_t k = 0; k < 4; ++k) {
      z[k] = s[k].z;
      f[k] = value(s[k].field, {x, y, 0});
    }
    const double h = z[2] - z[1], at = z[1] + t * h, m1 = slope(z, f), m2 = slope(z + 1, f + 1);
    const double expected = (2 * t * t * t - 3 * t * t + 1) * f[1] +
                            (t * t * t - 2 * t * t + t) * h * m1 +
                            (3 * t * t - 2 * t * t * t) * f[2] + (t * t * t - t * t) * h * m2;
    const double cap = std::min(at + 1, 4 - at);
    EXPECT_NEAR(evaluator.value({x, y, at}), std::min(expected, cap), 1e-12);
    flat += m1 == 0;
  }
  EXPECT_GT(flat, 20);
  EXPECT_LT(flat, 480);
}

TEST(Loft, StaysBetweenItsSections) {
  const std::vector<PlaneSection> s = vase();
  Random r(11);
  for (const char* how : {"linear", "smooth"}) {
    const Evaluator evaluator(loft(s, how).expression());
    for (int i = 0; i < 300; ++i) {
      const double x = r.uniform(-4, 4), y = r.uniform(-4, 4);
      for (size_t k = 0; k + 1 < s.size(); ++k) {
        const double a = value(s[k].field, {x, y, 0}), b = value(s[k + 1].field, {x, y, 0});
        const double z = r.uniform(s[k].z, s[k + 1].z), cap = std::min(z + 1, 4 - z);
        const double found = evaluator.value({x, y, z});
        EXPECT_LE(found, std::max(a, b) + 1e-14) << how;
        EXPECT_GE(found, std::min({a, b, cap}) - 1e-14) << how;
      }
    }
  }
}

TEST(Loft, HasACreaseAtSectionsOnlyWhenLinear) {
  const std::vector<PlaneSection> sections = vase();
  const double step = 1e-6;
  // How much the derivative by z differs between the two sides of a section, where no cap is.
  const auto jump = [&](const char* how, const Vec3& p) {
    const Evaluator f(loft(sections, how).expression());
    const double middle = f.value(p);
    const double above = f.value(p + Vec3{0, 0, step}), below = f.value(p - Vec3{0, 0, step});
    return std::abs((above - middle) - (middle - below)) / step;
  };
  for (const double z : {0.5, 2.0}) {
    for (const Vec3& p : {Vec3{-1.5, 2, z}, Vec3{2.5, -1, z}, Vec3{0.2, -2, z}}) {
      EXPECT_GT(jump("linear", p), 0.03);
      EXPECT_LT(jump("smooth", p), 1e-4);
    }
  }
}

TEST(Loft, IsCutOffAtBothEnds) {
  for (const char* how : {"linear", "smooth"}) {
    const Evaluator f(loft(vase(), how).expression());
    EXPECT_NEAR(f.value({0, 0, -1}), 0, 1e-15);
    EXPECT_NEAR(f.value({1, 0, 4}), 0, 1e-15);
    EXPECT_NEAR(f.value({0, 0, -1.25}), -0.25, 1e-15);
    EXPECT_NEAR(f.value({1, 0, 6}), -2, 1e-15);
    // Beyond the ends the last section goes on, below its cap.
    EXPECT_NEAR(f.value({6, 0, 5}), -3.5, 1e-14);
    EXPECT_NEAR(f.value({0, 9, -3}), -7, 1e-14);
  }
}

TEST(Loft, IsBoundedByCertifiedNumbers) {
  Random r(10);
  for (const char* how : {"linear", "smooth"}) {
    const Evaluator f(loft(vase(), how).expression());
    double steepest = 0;
    for (int k = 0; k < 60; ++k) {
      BoundingBox box;
      for (int axis = 0; axis < 3; ++axis) {
        box.lo[axis] = r.uniform(-4, 4);
        box.hi[axis] = box.lo[axis] + r.decades(-3, 0.5);
      }
      const Interval enclosing = f.interval(box);
      const double slope = lipschitz_bound(f, box, 8);
      const auto in_box = [&] {
        return Vec3{r.uniform(box.lo[0], box.hi[0]), r.uniform(box.lo[1], box.hi[1]),
                    r.uniform(box.lo[2], box.hi[2])};
      };
      for (int i = 0; i < 50; ++i) {
        const Vec3 p = in_box(), q = in_box();
        const double a = f.value(p), b = f.value(q);
        EXPECT_TRUE(enclosing.lo <= a && a <= enclosing.hi) << how << " at " << p[2];
        EXPECT_LE(std::abs(a - b), slope * norm(p - q) + 1e-12) << how << " at " << p[2];
        steepest = std::max(steepest, std::abs(a - b) / norm(p - q));
      }
    }
    // The bound of all of it is finite and of a size that gradients reach.
    const double whole = lipschitz_bound(f, {{-4, -4, -2}, {4, 4, 5}});
    EXPECT_GE(whole, steepest);
    for (int i = 0; i < 5000; ++i) {
      const Vec3 p{r.uniform(-4, 4), r.uniform(-4, 4), r.uniform(-2, 5)};
      Vec3 gradient;
      f.gradients(p.data(), 1, nullptr, gradient.data());
      EXPECT_LE(norm(gradient), whole * (1 + 1e-12));
      steepest = std::max(steepest, norm(gradient));
    }
    EXPECT_LT(whole, 8 * steepest) << how;
  }
  const Field made = loft(vase(), "smooth");
  EXPECT_EQ(made.quality().inside, Exactness::estimate);
  EXPECT_EQ(made.quality().outside, Exactness::estimate);
}

TEST(Loft, SaysWhatIsWrong) {
  const auto said = [](const std::vector<PlaneSection>& sections, const char* how) {
    return error_of([&] { loft(sections, how); });
  };
  EXPECT_THAT(said({{disc(0, 1), 0}, {disc(0, 2), 1}, {disc(0, 1), 1}}, "linear"),
              HasSubstr("section 3 is at z = 1, where section 2 is"));
  EXPECT_THAT(said({{disc(0, 1), 2}, {disc(0, 2), 1}}, "smooth"),
              HasSubstr("section 2 is at z = 1, below section 1"));
  EXPECT_THAT(said({{disc(0, 1), 0}, {make_field("sphere", {Vec3{}, 1.0}), 1}}, "linear"),
              HasSubstr("the field of section 2 depends on z"));
  EXPECT_THAT(said({{parse_formula("x + z", {}, {}), 0}, {disc(0, 1), 1}}, "linear"),
              HasSubstr("the field of section 1 depends on z"));
  EXPECT_THAT(said({{disc(0, 1), 0}, {disc(0, 2), 1}}, "smoth"),
              HasSubstr("interpolation is 'smoth'; accepted are 'smooth' and 'linear'; did you "
                        "mean 'smooth'?"));
  EXPECT_THAT(said({{disc(0, 1), 0}}, "linear"), HasSubstr("sections has 1"));
  EXPECT_EQ(said({{parse_formula("x*y", {}, {}), -3}, {disc(0, 2), 1}}, "linear"), "no error");
}

}  // namespace
}  // namespace sardf

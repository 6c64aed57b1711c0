// Numbered faces of a boundary against a search over the faces' points, and trimmed boundaries.
#include "sardf/faces.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "error_of.hpp"
#include "sardf/arithmetic.hpp"
#include "sardf/evaluate.hpp"
#include "sardf/scene_file.hpp"

namespace sardf {
namespace {

using testing::HasSubstr;

// A face by two parameters from 0 to 1.
using Patch = std::function<Vec3(double, double)>;

Patch parallelogram(const Vec3& corner, const Vec3& a, const Vec3& b) {
  return [=](double s, double t) { return corner + s * a + t * b; };
}

// The nearest point of the patch, by a grid that closes in on the best of its points.
double distance_by_search(const Patch& patch, const Vec3& p) {
  constexpr int cells = 48;
  double low[2] = {0, 0}, high[2] = {1, 1}, best = INFINITY;
  for (int round = 0; round < 12; ++round) {
    double at[2] = {0, 0};
    for (int i = 0; i <= cells; ++i) {
      for (int j = 0; j <= cells; ++j) {
        const double s = low[0] + (high[0] - low[0]) * i / cells;
        const double t = low[1] + (high[1] - low[1]) * j / cells;
        const double d = norm(patch(s, t) - p);
        if (d > best) continue;
        best = d;
        at[0] = s;
        at[1] = t;
      }
    }
    for (int k = 0; k < 2; ++k) {
      const double reach = 2 * (high[k] - low[k]) / cells;
      low[k] = std::max(0.0, at[k] - reach);
      high[k] = std::min(1.0, at[k] + reach);
    }
  }
  return best;
}

Field faces_of(const Field& solid, std::vector<double> faces) {
  return make_field("boundary", {solid, Value(), std::move(faces)});
}

std::vector<Vec3> random_points(uint64_t seed, int n, double reach) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> along(-reach, reach);
  std::vector<Vec3> all;
  for (int i = 0; i < n; ++i) {
    const double x = along(engine), y = along(engine), z = along(engine);
    all.push_back({x, y, z});
  }
  return all;
}

void expect_distances(const Field& face, const std::vector<Patch>& patches, uint64_t seed) {
  const Evaluator evaluator(face.expression());
  for (const Vec3& p : random_points(seed, 25, 5)) {
    double expected = INFINITY;
    for (const Patch& patch : patches) expected = std::min(expected, distance_by_search(patch, p));
    EXPECT_NEAR(evaluator.value(p), expected, 1e-6) << p[0] << " " << p[1] << " " << p[2];
  }
  EXPECT_EQ(face.quality().inside, Exactness::exact);
  EXPECT_EQ(face.quality().outside, Exactness::exact);
}

TEST(Faces, OfABoxAreRectangles) {
  const Vec3 center{0.5, -0.25, 1}, size{2, 3, 4};
  const Field box = make_field("box", {center, size});
  std::vector<Patch> all;
  for (size_t face = 0; face < 6; ++face) {
    const size_t axis = face / 2, b = (axis + 1) % 3, c = (axis + 2) % 3;
    Vec3 corner = center - 0.5 * size, along_b{}, along_c{};
    if (face % 2) corner[axis] += size[axis];
    along_b[b] = size[b];
    along_c[c] = size[c];
    all.push_back(parallelogram(corner, along_b, along_c));
    expect_distances(faces_of(box, {double(face)}), {all.back()}, face);
  }
  expect_distances(faces_of(box, {5, 0}), {all[0], all[5]}, 7);
  // All faces together are the boundary.
  const Evaluator whole(make_field("boundary", {box}).expression());
  const Evaluator parts(faces_of(box, {0, 1, 2, 3, 4, 5}).expression());
  for (const Vec3& p : random_points(8, 200, 4)) EXPECT_NEAR(whole.value(p), parts.value(p), 1e-12);
}

// Between the rounded edges: the box's rectangles without a margin of the radius.
TEST(Faces, OfARoundedBoxAreItsFlatParts) {
  const Vec3 center{0.5, -0.25, 1}, size{2, 3, 4};
  const Field box = make_field("rounded_box", {center, size, 0.4});
  std::vector<Patch> all;
  for (size_t face = 0; face < 6; ++face) {
    const size_t axis = face / 2, b = (axis + 1) % 3, c = (axis + 2) % 3;
    Vec3 corner = center, along_b{}, along_c{};
    corner[axis] += face % 2 ? 0.5 * size[axis] : -0.5 * size[axis];
    corner[b] -= 0.5 * size[b] - 0.4;
    corner[c] -= 0.5 * size[c] - 0.4;
    along_b[b] = size[b] - 0.8;
    along_c[c] = size[c] - 0.8;
    all.push_back(parallelogram(corner, along_b, along_c));
    expect_distances(faces_of(box, {double(face)}), {all.back()}, 90 + face);
  }
  expect_distances(faces_of(box, {1, 2, 4}), {all[1], all[2], all[4]}, 96);
  // Where the edges leave nothing flat, it is a point.
  const Evaluator top(
      faces_of(make_field("rounded_box", {Vec3{}, Vec3{2, 2, 2}, 1.0}), {5}).expression());
  EXPECT_NEAR(top.value({3, 4, 1}), 5, 1e-14);
  // On the flat parts the rounded box is 0, and beyond them it is not.
  const Evaluator solid(box.expression());
  EXPECT_NEAR(solid.value(all[1](0, 1)), 0, 1e-15);
  EXPECT_LT(solid.value(all[1](-0.1, 1)), -1e-3);
}

TEST(Faces, OfABox2dAreItsEdges) {
  const Vec2 center{0.5, -1}, size{3, 2};
  const Field rectangle = make_field("box2d", {center, size});
  const auto edges = [&](double low, double high) {
    const Vec3 up{0, 0, high - low};
    return std::vector<Patch>{
        parallelogram({-1, -2, low}, {0, 2, 0}, up), parallelogram({2, -2, low}, {0, 2, 0}, up),
        parallelogram({-1, -2, low}, {3, 0, 0}, up), parallelogram({-1, 0, low}, {3, 0, 0}, up)};
  };
  const std::vector<Patch> endless = edges(-50, 50);
  for (size_t edge = 0; edge < 4; ++edge) {
    expect_distances(faces_of(rectangle, {double(edge)}), {endless[edge]}, 100 + edge);
  }
  expect_distances(faces_of(rectangle, {3, 0}), {endless[0], endless[3]}, 104);
  // Extruded, its faces have the numbers of a box's.
  const Field block = make_field("extrude", {rectangle, 5.0});
  const Field box = make_field("box", {Vec3{0.5, -1, 0}, Vec3{3, 2, 5}});
  for (size_t face = 0; face < 6; ++face) {
    const Evaluator found(faces_of(block, {double(face)}).expression());
    const Evaluator expected(faces_of(box, {double(face)}).expression());
    for (const Vec3& p : random_points(105 + face, 50, 5)) {
      EXPECT_NEAR(found.value(p), expected.value(p), 1e-14) << face;
    }
  }
  EXPECT_EQ(error_of([&] { faces_of(rectangle, {4}); }),
            "there is no face 4: the solid has 4 faces, numbered from 0 to 3");
}

// A line turned about z, twice: where one begins and ends the other goes on.
std::vector<Patch> turned_line(double r0, double z0, double r1, double z1) {
  const auto from = [=](double start) {
    return Patch([=](double s, double t) {
      const double r = r0 + s * (r1 - r0), angle = start + 2 * std::numbers::pi * t;
      return Vec3{r * std::cos(angle), r * std::sin(angle), z0 + s * (z1 - z0)};
    });
  };
  return {from(0), from(2)};
}

TEST(Faces, OfACylinderAreTwoDiscsAndASide) {
  const Field bar = make_field("cylinder", {Vec3{}, Vec3{0, 0, 1}, 1.5, 4.0});
  const std::vector<Patch> patches[] = {turned_line(0, -2, 1.5, -2), turned_line(0, 2, 1.5, 2),
                                        turned_line(1.5, -2, 1.5, 2)};
  for (size_t i = 0; i < 3; ++i) expect_distances(faces_of(bar, {double(i)}), patches[i], 10 + i);
}

TEST(Faces, OfATiltedCylinderFollowItsAxis) {
  const Vec3 center{1, 0.5, -0.5}, axis{1, 0, 0};
  const Field bar = make_field("cylinder", {center, axis, 1.0, 3.0});
  const auto turned = [&](std::vector<Patch> upright) {
    for (Patch& patch : upright) {
      patch = [center, inner = patch](double s, double t) {
        const Vec3 p = inner(s, t);
        return center + Vec3{p[2], p[0], p[1]};
      };
    }
    return upright;
  };
  expect_distances(faces_of(bar, {0}), turned(turned_line(0, -1.5, 1, -1.5)), 20);
  expect_distances(faces_of(bar, {2}), turned(turned_line(1, -1.5, 1, 1.5)), 21);
}

TEST(Faces, OfAConeAreTwoDiscsAndASide) {
  const Field cone = make_field("cone", {Vec3{}, Vec3{0, 0, 1}, 2.0, 0.5, 3.0});
  const std::vector<Patch> patches[] = {
      turned_line(0, -1.5, 2, -1.5), turned_line(0, 1.5, 0.5, 1.5), turned_line(2, -1.5, 0.5, 1.5)};
  for (size_t i = 0; i < 3; ++i) expect_distances(faces_of(cone, {double(i)}), patches[i], 30 + i);
}

const std::vector<Vec2> arrow{{-2, -1}, {1, -1}, {0.5, 0}, {1, 1.5}, {-2, 1}};

Patch sheet(size_t edge, double low, double high) {
  const Vec2 a = arrow[edge], b = arrow[(edge + 1) % arrow.size()];
  return parallelogram({a[0], a[1], low}, {b[0] - a[0], b[1] - a[1], 0}, {0, 0, high - low});
}

TEST(Faces, OfAPolygonAreItsEdges) {
  const Field polygon = make_field("polygon", {arrow});
  for (size_t edge = 0; edge < arrow.size(); ++edge) {
    expect_distances(faces_of(polygon, {double(edge)}), {sheet(edge, -50, 50)}, 40 + edge);
  }
  expect_distances(faces_of(polygon, {4, 0, 2}),
                   {sheet(0, -50, 50), sheet(2, -50, 50), sheet(4, -50, 50)}, 46);
}

TEST(Faces, OfAnExtrudedPolygonAreSheetsAndCaps) {
  const Field solid = make_field("extrude", {make_field("polygon", {arrow}), 2.0});
  for (size_t edge = 0; edge < arrow.size(); ++edge) {
    expect_distances(faces_of(solid, {double(edge)}), {sheet(edge, -1, 1)}, 50 + edge);
  }
  // The arrow is two quadrilaterals, each by its corners.
  const auto flat = [](const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d, double z) {
    return Patch([=](double s, double t) {
      const auto mix = [&](size_t k) {
        return (1 - t) * ((1 - s) * a[k] + s * b[k]) + t * ((1 - s) * d[k] + s * c[k]);
      };
      return Vec3{mix(0), mix(1), z};
    });
  };
  const Vec2 middle{-2, 0};
  for (const int top : {0, 1}) {
    const double z = top ? 1 : -1;
    expect_distances(faces_of(solid, {5.0 + top}),
                     {flat(arrow[0], arrow[1], arrow[2], middle, z),
                      flat(middle, arrow[2], arrow[3], arrow[4], z)},
                     60 + top);
  }
  expect_distances(faces_of(solid, {6, 1}),
                   {sheet(1, -1, 1), flat(arrow[0], arrow[1], arrow[2], middle, 1),
                    flat(middle, arrow[2], arrow[3], arrow[4], 1)},
                   63);
}

TEST(Faces, GoWithWhatIsMoved) {
  const Field box = make_field("box", {Vec3{}, Vec3{2, 3, 4}});
  const Field moved = make_field("translate", {box, Vec3{1, 0, -1}});
  // Turned by 90 degrees about z, x becomes y and y becomes -x.
  const Field turned = make_field("rotate", {moved, Vec3{0, 0, 1}, 90.0, Value(), Value(), Vec3{}});
  const Field scaled = make_field("scale", {turned, 0.5, Vec3{}});
  const Field mirrored = make_field("mirror", {scaled, Vec3{}, Vec3{0, 1, 0}});
  // Face 1, +x at x = 2: then y = 2, y = 1, y = -1.
  expect_distances(faces_of(mirrored, {1}),
                   {parallelogram({-0.75, -1, -1.5}, {1.5, 0, 0}, {0, 0, 2})}, 70);
  const Field profile =
      make_field("translate", {make_field("polygon", {arrow}), Vec3{0.5, 0.5, 0}});
  const Patch edge = sheet(1, -1, 1);
  expect_distances(faces_of(make_field("extrude", {profile, 2.0}), {1}),
                   {[edge](double s, double t) {
                     return edge(s, t) + Vec3{0.5, 0.5, 0};
                   }},
                   71);
}

TEST(Faces, ThatThereAreNotAreErrors) {
  const Field box = make_field("box", {Vec3{}, Vec3{1, 1, 1}});
  const auto problem = [](const Field& solid, std::vector<double> faces) {
    return error_of([&] { faces_of(solid, std::move(faces)); });
  };
  EXPECT_EQ(problem(box, {2, 6}),
            "there is no face 6: the solid has 6 faces, numbered from 0 to 5");
  EXPECT_THAT(problem(box, {-1}), HasSubstr("there is no face -1"));
  EXPECT_THAT(problem(box, {0.5}), HasSubstr("there is no face 0.5"));
  EXPECT_THAT(problem(make_field("extrude", {make_field("polygon", {arrow}), 1.0}), {7}),
              HasSubstr("the solid has 7 faces, numbered from 0 to 6"));
  EXPECT_THAT(problem(make_field("sphere", {Vec3{}, 1.0}), {0}),
              HasSubstr("the solid is 'sphere', whose faces have no numbers; they are counted for "
                        "box, rounded_box, cylinder with a height, cone, box2d, polygon"));
  EXPECT_THAT(problem(make_field("cylinder", {Vec3{}, Vec3{0, 0, 1}, 1.0, Value()}), {0}),
              HasSubstr("the solid is 'cylinder'"));
  EXPECT_THAT(problem(Field::coordinate(0), {0}), HasSubstr("the solid is a formula"));
  EXPECT_THAT(problem(make_field("union", {std::vector<Field>{box}, min_max_blend()}), {0}),
              HasSubstr("the solid is 'union'"));
}

TEST(Faces, ErrorsHaveTheirPlaceInAFile) {
  const std::string text = error_of([] {
    parse_scene(
        "{\"sardf\": 1, \"fields\": {\"part\": {\"box\": {\"size\": [1, 1, 1]}},\n\"end\": "
        "{\"boundary\": "
        "{\"solid\": \"part\", \"faces\": [9]}}},\n\"solid\": \"part\"}",
        "t.json");
  });
  EXPECT_EQ(text,
            "t.json:2: /fields/end/boundary: there is no face 9: the solid has 6 faces, numbered "
            "from 0 to 5");
}

TEST(Boundary, OfAWholeSolidIsWhatItWas) {
  const auto scene = parse_scene(R"({"sardf": 1, "fields": {"bore": {"cylinder": {"radius": 3}},
      "short": {"boundary": "bore"}, "long": {"boundary": {"solid": "bore", "faces": []}}},
      "solid": {"sphere": {"radius": 1}}})",
                                 "");
  const Expression expected = abs(scene.fields[0].field.expression());
  EXPECT_EQ(scene.fields[1].field.expression(), expected);
  EXPECT_EQ(scene.fields[2].field.expression(), expected);
  EXPECT_THAT(scene_text(scene), HasSubstr(R"("short": {"boundary": {"solid": "bore"}})"));
}

TEST(Boundary, IsWrittenWithItsPart) {
  const auto scene = parse_scene(R"({"sardf": 1, "fields": {"part": {"box": {"size": [1, 2, 3]}},
      "some": {"boundary": {"solid": "part", "where": "=z - 0.1", "faces": [1, 4]}}},
      "solid": "part"})",
                                 "");
  const std::string text = scene_text(scene);
  const auto again = parse_scene(text, "");
  EXPECT_EQ(again.fields[1].field.expression(), scene.fields[1].field.expression());
  EXPECT_THAT(text, HasSubstr("\"faces\": [1, 4]"));
}

// The zero set is the part; beside it the field is the distance, to first order.
TEST(Boundary, IsCutDownToWhereAFieldIsNotNegative) {
  const Field ball = make_field("sphere", {Vec3{}, 2.0}), where = Field::coordinate(2);
  const Field cap = make_field("boundary", {ball, where, std::vector<double>{}});
  EXPECT_EQ(cap.quality().inside, Exactness::estimate);
  const Evaluator u(cap.expression());
  for (const double angle : {0.05, 0.4, 1.0, 1.5}) {
    const Vec3 up{2 * std::cos(angle), 0, 2 * std::sin(angle)};
    EXPECT_NEAR(u.value(up), 0, 1e-15);
    EXPECT_NEAR(u.value((1 + 1e-4) * up), 2e-4, 1e-7);
    // Where the field is negative, it is how far that is.
    const double below = 2 * std::sin(angle);
    EXPECT_NEAR(u.value({2 * std::cos(angle), 0, -below}), below, 1e-14);
  }
  for (const Vec3& p : random_points(80, 500, 4)) {
    const double value = u.value(p);
    EXPECT_GE(value, std::abs(2 - norm(p)));
    EXPECT_FALSE(std::isnan(value));
  }
  EXPECT_FALSE(std::isnan(u.value({1e30, -1e30, 1e30})));
  EXPECT_FALSE(std::isnan(u.value({1e200, 0, 0})));
}

// A gear whose tooth faces are hard to a depth.
TEST(Boundary, HardensTheTeethOfAGear) {
  std::string corners, faces;
  for (int i = 0; i < 48; ++i) {
    const double r = i % 4 < 2 ? 10 : 8, angle = 2 * std::numbers::pi * i / 48;
    corners += (i ? ", [" : "[") + std::to_string(r * std::cos(angle)) + ", " +
               std::to_string(r * std::sin(angle)) + "]";
    if (i % 4 != 3) faces += (faces.empty() ? "" : ", ") + std::to_string(i);
  }
  const Scene scene(parse_scene(
      R"({"sardf": 1, "fields": {"gear": {"extrude": {"field": {"polygon": {"vertices": [)" +
          corners + R"(]}}, "height": 5}},
          "flanks": {"boundary": {"solid": "gear", "faces": [)" +
          faces + R"(]}}}, "solid": "gear", "materials": {"hard": {}, "tough": {}},
          "fractions": {"ramp": {"field": "flanks", "stops": [
            {"at": 0, "material": "hard"}, {"at": 0.5, "material": "tough"}]}}})",
      ""));
  double at[2];
  // In the middle of a tooth's top, of the root between teeth, and of the upper cap.
  const double tooth = std::numbers::pi / 48, root = 5 * std::numbers::pi / 48;
  const double outer = 10 * std::cos(tooth) - 0.1;
  scene.fractions_at(Vec3{outer * std::cos(tooth), outer * std::sin(tooth), 0}.data(), 1, at);
  EXPECT_NEAR(at[0], 0.8, 1e-6);
  const double inner = 8 * std::cos(tooth) - 1;
  scene.fractions_at(Vec3{inner * std::cos(root), inner * std::sin(root), 0}.data(), 1, at);
  EXPECT_EQ(at[0], 0);
  scene.fractions_at(Vec3{0, 0, 2.5}.data(), 1, at);
  EXPECT_EQ(at[1], 1);
}

}  // namespace
}  // namespace sardf

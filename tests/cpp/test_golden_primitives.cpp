// Primitives against golden values: signed distance and gradient in double, distance in float.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "golden.hpp"
#include "sardf/constructor.hpp"
#include "sardf/evaluate.hpp"

namespace sardf {
namespace {

using golden::Table;
using nlohmann::json;

Vec3 in_space(const json& numbers) {
  return {numbers.at(0), numbers.at(1), numbers.size() > 2 ? double(numbers.at(2)) : 0.0};
}
Vec2 in_plane(const json& numbers) { return {numbers.at(0), numbers.at(1)}; }

/// One parameter of a constructor and where the file's header has it.
struct Source {
  const char* parameter;
  const char* key;
  /// The file's unit in ours: half sizes are doubled, radians become degrees.
  double factor = 1;
};

struct Primitive {
  const char* file;
  const char* constructor;
  std::vector<Source> sources;
  /// Allowed float error relative to the largest argument or parameter.
  double float_tolerance = 2e-6;
};

Value value_of(ParameterType type, const json& given, double factor) {
  switch (type) {
    case ParameterType::vector2: {
      const Vec2 v = in_plane(given);
      return Vec2{factor * v[0], factor * v[1]};
    }
    case ParameterType::vector3:
    case ParameterType::axis:
      return factor * in_space(given);
    case ParameterType::points2: {
      std::vector<Vec2> points;
      for (const json& at : given) points.push_back(in_plane(at));
      return points;
    }
    case ParameterType::points3: {
      std::vector<Vec3> points;
      for (const json& at : given) points.push_back(in_space(at));
      return points;
    }
    default:
      return factor * given.get<double>();
  }
}

std::vector<Value> arguments_of(const Primitive& primitive, const Table& table) {
  const Constructor& constructor = *find_constructor(primitive.constructor);
  std::vector<Value> arguments;
  for (const ParameterInfo& info : constructor.parameters) {
    arguments.push_back(info.default_value);
    for (const Source& source : primitive.sources) {
      // A missing key (a centre that the file leaves at the origin) keeps the default.
      if (info.name != source.parameter || !table.header["params"].contains(source.key)) continue;
      arguments.back() = value_of(info.type, table.parameter(source.key), source.factor);
    }
  }
  return arguments;
}

double largest(const json& numbers) {
  if (numbers.is_number()) return std::abs(numbers.get<double>());
  double most = 0;
  if (numbers.is_structured()) {
    for (const json& each : numbers) most = std::max(most, largest(each));
  }
  return most;
}

struct Samples {
  std::vector<double> points, expected;
  std::vector<Vec3> gradients;

  explicit Samples(const Table& table) {
    const int z = table.find("z"), gz = table.find("gz");
    for (const std::vector<double>& row : table.rows) {
      points.insert(points.end(),
                    {row[table.column("x")], row[table.column("y")], z < 0 ? 0.0 : row[z]});
      expected.push_back(row[table.column("f")]);
      gradients.push_back(
          {row[table.column("gx")], row[table.column("gy")], gz < 0 ? 0.0 : row[gz]});
    }
  }
  size_t size() const { return expected.size(); }
};

class GoldenPrimitive : public golden::EachFolderWith<Primitive> {
 protected:
  GoldenPrimitive()
      : table_(read(std::string("prim_") + this_case().file)),
        samples_(table_),
        field_(make_field(this_case().constructor, arguments_of(this_case(), table_))),
        evaluator_(field_.expression()) {}

  Table table_;
  Samples samples_;
  Field field_;
  Evaluator evaluator_;
};

TEST_P(GoldenPrimitive, ValuesInDouble) {
  std::vector<double> out(samples_.size());
  evaluator_.values(samples_.points.data(), out.size(), out.data());
  for (size_t i = 0; i < out.size(); ++i) {
    const double* p = &samples_.points[3 * i];
    EXPECT_NEAR(out[i], samples_.expected[i], table_.tolerance()) << "row " << i;
    EXPECT_EQ(out[i], evaluator_.value({p[0], p[1], p[2]})) << "row " << i;
  }
}

TEST_P(GoldenPrimitive, GradientsInDouble) {
  std::vector<double> out(samples_.size()), gradient(3 * samples_.size());
  evaluator_.gradients(samples_.points.data(), out.size(), out.data(), gradient.data());
  size_t compared = 0;
  for (size_t i = 0; i < out.size(); ++i) {
    const Vec3& expected = samples_.gradients[i];
    if (std::isnan(dot(expected, expected))) continue;
    ++compared;
    EXPECT_NEAR(out[i], samples_.expected[i], table_.tolerance()) << "row " << i;
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(gradient[3 * i + axis], expected[axis], table_.tolerance())
          << "row " << i << ", axis " << axis;
    }
  }
  EXPECT_GT(compared, samples_.size() * 9 / 10);
}

TEST_P(GoldenPrimitive, ValuesInFloat) {
  const std::vector<float> points(samples_.points.begin(), samples_.points.end());
  std::vector<float> out(samples_.size());
  evaluator_.values(points.data(), out.size(), out.data());
  for (size_t i = 0; i < out.size(); ++i) {
    double most = largest(table_.header["params"]);
    for (int axis = 0; axis < 3; ++axis) most = std::max(most, abs(samples_.points[3 * i + axis]));
    EXPECT_NEAR(out[i], samples_.expected[i], this_case().float_tolerance * most) << "row " << i;
  }
}

constexpr double degrees = 180 / std::numbers::pi;

INSTANTIATE_TEST_SUITE_P(
    All, GoldenPrimitive,
    testing::Combine(
        golden::each_folder(),
        testing::Values(
            Primitive{"sphere", "sphere", {{"center", "c"}, {"radius", "r"}}},
            Primitive{"halfspace", "half_space", {{"point", "p0"}, {"normal", "n"}}},
            Primitive{"cylinder_infinite",
                      "cylinder",
                      {{"center", "c"}, {"axis", "axis"}, {"radius", "r"}}},
            Primitive{
                "cylinder_capped",
                "cylinder",
                {{"center", "c"}, {"axis", "axis"}, {"radius", "r"}, {"height", "half_height", 2}}},
            Primitive{"block", "box", {{"center", "c"}, {"size", "half", 2}}},
            Primitive{"block2d", "box2d", {{"center", "c"}, {"size", "half", 2}}},
            Primitive{"disc", "disc", {{"center", "c"}, {"radius", "r"}}},
            Primitive{"torus",
                      "torus",
                      {{"center", "c"},
                       {"axis", "axis"},
                       {"major_radius", "R_major"},
                       {"minor_radius", "r_minor"}}},
            Primitive{
                "ellipsoid_triaxial", "ellipsoid", {{"center", "c"}, {"radii", "radii"}}, 1e-5},
            Primitive{"ellipsoid_5_2_2", "ellipsoid", {{"center", "c"}, {"radii", "radii"}}, 1e-5},
            Primitive{"ellipsoid_2_2_5", "ellipsoid", {{"center", "c"}, {"radii", "radii"}}, 1e-5},
            Primitive{"ellipsoid_flat", "ellipsoid", {{"radii", "radii"}}, 1e-5},
            Primitive{"ellipse2d", "ellipse", {{"center", "c"}, {"radii", "radii"}}, 1e-5},
            Primitive{"segment2d", "segment", {{"a", "a"}, {"b", "b"}}},
            Primitive{"segment3d", "segment", {{"a", "a"}, {"b", "b"}}},
            Primitive{"polyline2d", "polyline", {{"vertices", "verts"}}},
            Primitive{"polyline3d", "polyline", {{"vertices", "verts"}}},
            Primitive{"polygon", "polygon", {{"vertices", "verts"}}},
            Primitive{"polygon_tooth_outer", "polygon", {{"vertices", "verts"}}},
            Primitive{"circle", "circle", {{"center", "c"}, {"radius", "r"}}},
            Primitive{"arc",
                      "arc",
                      {{"center", "c"},
                       {"radius", "r"},
                       {"start", "t0", degrees},
                       {"end", "t1", degrees}}})),
    [](const auto& of) {
      return golden::test_name(std::get<0>(of.param)) + "_" + std::get<1>(of.param).file;
    });

}  // namespace
}  // namespace sardf

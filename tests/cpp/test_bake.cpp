// A baked texture against the volume it was baked from, on meshed solids with our atlas.
#include <gtest/gtest.h>

#include <map>

#include "bake_scenes.hpp"

namespace sardf::test {
namespace {

constexpr int size = 2048;
constexpr size_t samples = 20000;

struct Sample {
  const char* name;
  Expression (*solid)();
  BoundingBox bounds;
};

void PrintTo(const Sample& sample, std::ostream* out) { *out << sample.name; }

const std::vector<Sample>& all_samples() {
  static const std::vector<Sample> list{
      {"sphere",
       [] {
         return sphere({0, 0, 0}, 3);
       },
       {{-3.1, -3.1, -3.1}, {3.1, 3.1, 3.1}}},
      {"box",
       [] {
         return box({0, 0, 0}, {6, 4, 3});
       },
       {{-3.1, -2.1, -1.6}, {3.1, 2.1, 1.6}}},
      {"torus", [] { return torus(3, 1); }, {{-4.1, -4.1, -1.1}, {4.1, 4.1, 1.1}}},
      {"cylinder", [] { return capped_cylinder(2, 5); }, {{-2.1, -2.1, -2.6}, {2.1, 2.1, 2.6}}},
      {"block", [] { return block_with_bores(); }, block_bounds()}};
  return list;
}

const Part& part(const Sample& sample) {
  static std::map<std::string, Part> made;
  const auto found = made.find(sample.name);
  if (found != made.end()) return found->second;
  return made.try_emplace(sample.name, sample.solid(), sample.bounds, 96, size).first->second;
}

/// The nearest point of the true surface, by Newton's method in double.
Vec3 on_surface(const Evaluator& solid, Vec3 p) {
  for (int step = 0; step < 8; ++step) {
    double f;
    Vec3 g;
    solid.gradients(p.data(), 1, &f, g.data());
    p = p - (f / dot(g, g)) * g;
  }
  return p;
}

std::vector<Expression> fractions_of(const BoundingBox& bounds) {
  const Vec3 lo = bounds.lo, hi = bounds.hi;
  return inverse_distance(
      {distance_to(hi), distance_to({lo[0], hi[1], lo[2]}), abs(cylinder({0, 0, 0}, 0.9 * lo[1]))},
      2);
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[size_t(share * double(values.size() - 1))];
}

struct Baked {
  std::vector<Image> images;
  std::vector<unsigned char> covered;
  BakeReport report;
};

Baked bake_all(const Part& p, const std::vector<BakeChannel>& channels) {
  Baked baked;
  const TexelMap texels(p.mesh, size, p.atlas.gutter);
  baked.report = bake(texels, p.solid, channels,
                      [&](size_t, Image&& image, const std::vector<unsigned char>& covered) {
                        baked.images.push_back(std::move(image));
                        baked.covered = covered;
                      });
  return baked;
}

bool all_covered(const std::vector<unsigned char>& covered, const Lookup& lookup) {
  for (size_t k = 0; k < 4; ++k)
    if (lookup.weight[k] > 0 && !covered[size_t(lookup.texel[k][1]) * size + lookup.texel[k][0]])
      return false;
  return true;
}

/// The same edge seen from two faces that lie apart in the texture though no crease is between.
struct Cut {
  std::array<Vec2, 2> one, other;
};

std::vector<Cut> smooth_cuts(const Mesh& mesh) {
  using Edge = std::array<uint32_t, 2>;
  std::map<Edge, std::array<Vec2, 2>> seen;
  std::vector<Cut> cuts;
  for (size_t corner = 0; corner < mesh.corner_uv.size(); ++corner) {
    const size_t next = corner / 4 * 4 + (corner + 1) % 4;
    const uint32_t a = mesh.faces[corner / 4][corner % 4], b = mesh.faces[next / 4][next % 4];
    const Edge edge{std::min(a, b), std::max(a, b)};
    if (std::binary_search(mesh.creases.begin(), mesh.creases.end(), edge)) continue;
    std::array<Vec2, 2> uv{mesh.corner_uv[corner], mesh.corner_uv[next]};
    if (a > b) std::swap(uv[0], uv[1]);
    const auto [other, is_new] = seen.try_emplace(edge, uv);
    if (!is_new && other->second != uv) cuts.push_back({other->second, uv});
  }
  return cuts;
}

class BakeOf : public testing::TestWithParam<Sample> {};
INSTANTIATE_TEST_SUITE_P(Bake, BakeOf, testing::ValuesIn(all_samples()),
                         [](const auto& each) { return std::string(each.param.name); });

TEST_P(BakeOf, EveryLookupGivesTheSurfacePoint) {
  const Part& p = part(GetParam());
  const auto [x, y, z] = xyz();
  const Baked baked = bake_all(p, {{"xyz", {x, y, z}}});
  const Evaluator solid(p.solid);
  const double texel = 1 / p.atlas.texels_per_unit;
  std::vector<double> distances;
  for (const SurfacePoint& at : random_points(p.mesh, samples, 1)) {
    const Lookup lookup(at.uv, size);
    ASSERT_TRUE(all_covered(baked.covered, lookup)) << "at u, v = " << at.uv[0] << ", " << at.uv[1];
    const Vec3 found{lookup.of(baked.images[0], 0), lookup.of(baked.images[0], 1),
                     lookup.of(baked.images[0], 2)};
    distances.push_back(norm(found - on_surface(solid, at.position)) / texel);
  }
  EXPECT_LT(quantile(distances, 0.99), 0.01) << "texels";
  EXPECT_LT(quantile(distances, 1), 0.5) << "texels";
  RecordProperty("p99", std::to_string(quantile(distances, 0.99)));
  RecordProperty("max", std::to_string(quantile(distances, 1)));
}

TEST_P(BakeOf, LookupsGiveTheFractionsOfTheVolume) {
  const Part& p = part(GetParam());
  const std::vector<Expression> fractions = fractions_of(GetParam().bounds);
  const Baked baked = bake_all(p, {{"fractions_1", fractions}});
  const Evaluator solid(p.solid), exact(fractions);
  std::vector<double> errors;
  for (const SurfacePoint& at : random_points(p.mesh, samples, 2)) {
    const Lookup lookup(at.uv, size);
    double expected[3], error = 0;
    exact.values(on_surface(solid, at.position), expected);
    for (int c = 0; c < 3; ++c)
      error = std::max(error, std::abs(lookup.of(baked.images[0], c) - expected[c]));
    errors.push_back(error);
  }
  EXPECT_LT(quantile(errors, 0.99), 1e-5);
  EXPECT_LT(quantile(errors, 1), 0.004);
  RecordProperty("p99", std::to_string(quantile(errors, 0.99)));
  RecordProperty("max", std::to_string(quantile(errors, 1)));
}

TEST_P(BakeOf, BothSidesOfACutAgree) {
  const Part& p = part(GetParam());
  const std::vector<Cut> cuts = smooth_cuts(p.mesh);
  if (std::string(GetParam().name) == "box") {
    EXPECT_TRUE(cuts.empty());
    return;
  }
  ASSERT_FALSE(cuts.empty());
  const Baked baked = bake_all(p, {{"fractions_1", fractions_of(GetParam().bounds)}});
  std::vector<double> differences;
  for (const Cut& cut : cuts)
    for (const double t : {0.1, 0.35, 0.6, 0.85}) {
      const auto at = [t](const std::array<Vec2, 2>& edge) {
        return Lookup({edge[0][0] + t * (edge[1][0] - edge[0][0]),
                       edge[0][1] + t * (edge[1][1] - edge[0][1])},
                      size);
      };
      const Lookup one = at(cut.one), other = at(cut.other);
      ASSERT_TRUE(all_covered(baked.covered, one) && all_covered(baked.covered, other));
      for (int c = 0; c < 3; ++c)
        differences.push_back(std::abs(one.of(baked.images[0], c) - other.of(baked.images[0], c)));
    }
  EXPECT_LT(quantile(differences, 0.99), 1e-4);
  EXPECT_LT(quantile(differences, 1), 0.004);
  RecordProperty("max", std::to_string(quantile(differences, 1)));
}

/// 1 in the ordered partition's first part, 0 in its second: "in" means field >= -1e-6 of the
/// diagonal, and where neither contains the point the larger field wins.
Expression first_part(const Expression& first, const Expression& second, double diagonal) {
  const Expression tolerance = constant(-1e-6 * diagonal), one = constant(1), none = constant(0);
  return select(
      less_equal(tolerance, first), one,
      select(less_equal(tolerance, second), none, select(less_equal(second, first), one, none)));
}

TEST_P(BakeOf, PartsThatShareTheOuterFaceLeaveNoStrayTexel) {
  const Part& p = part(GetParam());
  const double at = 0.37;
  const Expression first = min(p.solid, constant(at) - coordinate(0));
  const Baked baked =
      bake_all(p, {{"part", {first_part(first, p.solid, GetParam().bounds.diagonal())}}});
  const double texel = 1 / p.atlas.texels_per_unit;
  size_t looked_at = 0;
  for (const SurfacePoint& point : random_points(p.mesh, samples, 3)) {
    const double beyond = point.position[0] - at;
    if (std::abs(beyond) < 3 * texel) continue;
    ++looked_at;
    ASSERT_NEAR(Lookup(point.uv, size).of(baked.images[0], 0), beyond < 0 ? 1 : 0, 1e-9)
        << "at x, y, z = " << point.position[0] << ", " << point.position[1] << ", "
        << point.position[2];
  }
  EXPECT_GT(looked_at, samples / 2);
}

}  // namespace
}  // namespace sardf::test

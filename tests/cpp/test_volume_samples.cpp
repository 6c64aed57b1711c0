// Grids of samples against the evaluator, sample by sample.
#include "sardf/volume_samples.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <chrono>
#include <cstring>
#include <random>

#include "error_of.hpp"
#include "sanitized.hpp"
#include "sardf/scene_file.hpp"

namespace sardf {
namespace {

using testing::HasSubstr;

Scene scene_of(const std::string& rest) {
  return Scene(parse_scene("{\"sardf\": 1, " + rest + "}", ""));
}

// A drilled block with blended edges, cut open, of three materials.
Scene drilled_block() {
  return scene_of(R"(
    "fields": {
      "block": {"box": {"size": [20, 12, 8]}},
      "bore": {"cylinder": {"radius": 3}},
      "hole": {"cylinder": {"center": [8, 4, 0], "radius": 1}},
      "part": {"difference": {"of": ["block", "bore", "hole"], "blend": {"sardf": 0.5}}}},
    "solid": "part",
    "materials": {"steel": {"color": "#8a8f98"}, "carbide": {"color": "#2b3a67"},
                  "brass": {"color": "#c0a030"}},
    "fractions": {"inverse_distance": {"features": [
      {"at": {"boundary": {"solid": "bore"}}, "material": "carbide", "exponent": 2},
      {"at": {"boundary": {"solid": "hole"}}, "material": "brass"},
      {"at": {"segment": {"a": [10, -6, 0], "b": [10, 6, 0]}}, "material": "steel"}]}},
    "sections": [{"remove": {"half_space": {"point": [0, 1, 0], "normal": [0, -1, 0]}}}])");
}

VolumeSampling sampling_of(const Scene& scene, std::array<int, 3> counts) {
  VolumeSampling sampling;
  const Vec3 room = 0.05 * scene.bounds().size();
  sampling.grid = {{scene.bounds().lo - room, scene.bounds().hi + room}, counts};
  return sampling;
}

// The samples' places, as floats.
std::vector<float> places(const TexelGrid& grid) {
  std::vector<float> points;
  for (int k = 0; k < grid.counts[2]; ++k) {
    for (int j = 0; j < grid.counts[1]; ++j) {
      for (int i = 0; i < grid.counts[0]; ++i) {
        for (const auto& [axis, n] : {std::pair(0, i), std::pair(1, j), std::pair(2, k)}) {
          points.push_back(float(grid.at(axis, n)));
        }
      }
    }
  }
  return points;
}

// Whether a corner of a cube of eight samples that has to be coloured, found one by one.
bool is_colored(const VolumeSamples& samples, const TexelGrid& grid, const std::array<int, 3>& at,
                Colored colored) {
  const auto inside = [&](int x, int y, int z) {
    if (std::min({x, y, z}) < 0) return false;
    if (x >= grid.counts[0] || y >= grid.counts[1] || z >= grid.counts[2]) return false;
    return samples.field[size_t(x) + size_t(grid.counts[0]) *
                                         (size_t(y) + size_t(grid.counts[1]) * size_t(z))] >= 0;
  };
  for (int cube = 0; cube < 8; ++cube) {
    int found = 0;
    for (int corner = 0; corner < 8; ++corner) {
      found +=
          inside(at[0] - (cube & 1) + (corner & 1), at[1] - (cube >> 1 & 1) + (corner >> 1 & 1),
                 at[2] - (cube >> 2) + (corner >> 2));
    }
    if (found > 0 && (found < 8 || colored == Colored::inside)) return true;
  }
  return false;
}

struct GridCase {
  std::array<int, 3> counts;
  Colored colored;
  bool sections;
};

class VolumeSamplesOf : public testing::TestWithParam<GridCase> {};

// Bit by bit those of the program that is not shortened, and near the ones in double.
TEST_P(VolumeSamplesOf, AreTheEvaluators) {
  const Scene scene = drilled_block();
  VolumeSampling sampling = sampling_of(scene, GetParam().counts);
  sampling.colored = GetParam().colored;
  sampling.sections = GetParam().sections;
  const VolumeSamples samples = sample_volume(scene, sampling);
  const size_t n = sampling.grid.size();
  const std::vector<float> points = places(sampling.grid);
  const Expression solid = sampling.sections ? scene.drawn() : scene.solid();
  std::vector<float> field(n), color(3 * n);
  Evaluator(solid).values(points.data(), n, field.data());
  EXPECT_EQ(std::memcmp(field.data(), samples.field.get(), n * sizeof(float)), 0);
  const auto base = scene.base_color();
  const Evaluator color_of(base);
  color_of.values(points.data(), n, color.data());
  size_t colored = 0;
  Interval range{infinity, -infinity};
  for (size_t i = 0; i < n; ++i) {
    const auto [nx, ny, nz] = sampling.grid.counts;
    const std::array<int, 3> at{int(i) % nx, int(i) / nx % ny, int(i) / nx / ny};
    const float* found = &samples.colors[4 * i];
    if (!is_colored(samples, sampling.grid, at, sampling.colored)) {
      for (int c = 0; c < 4; ++c) ASSERT_EQ(found[c], 0) << i;
      continue;
    }
    ++colored;
    for (size_t c = 0; c < 3; ++c) ASSERT_EQ(found[c], color[3 * i + c]) << i;
    ASSERT_EQ(found[3], 1);
    range = {std::min(range.lo, double(found[0])), std::max(range.hi, double(found[0]))};
    const Vec3 point{points[3 * i], points[3 * i + 1], points[3 * i + 2]};
    double exact[3];
    color_of.values(point, exact);
    for (size_t c = 0; c < 3; ++c) ASSERT_NEAR(found[c], exact[c], 1e-5);
    ASSERT_NEAR(samples.field[i], Evaluator(solid).value(point), 1e-5);
  }
  EXPECT_GT(colored, n / 50);
  EXPECT_EQ(samples.range.lo, range.lo);
  EXPECT_EQ(samples.range.hi, range.hi);
}

INSTANTIATE_TEST_SUITE_P(Grids, VolumeSamplesOf,
                         testing::Values(GridCase{{40, 33, 17}, Colored::surface, true},
                                         GridCase{{40, 33, 17}, Colored::inside, true},
                                         GridCase{{70, 20, 24}, Colored::surface, false},
                                         GridCase{{16, 16, 16}, Colored::inside, false},
                                         GridCase{{5, 80, 3}, Colored::surface, true}));

// A hundred balls: programs are shortened on every level.
TEST(VolumeSamples, AreTheEvaluatorsOfLongPrograms) {
  std::string balls;
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> in_cube(-4, 4);
  for (int i = 0; i < 100; ++i) {
    balls += (i ? ", " : "") + std::string(R"({"sphere": {"center": [)") +
             std::to_string(in_cube(engine)) + ", " + std::to_string(in_cube(engine)) + ", " +
             std::to_string(in_cube(engine)) + R"(], "radius": 0.7}})";
  }
  for (const char* blend : {R"({"sardf": 0.4})", R"("min_max")"}) {
    const Scene scene =
        scene_of(R"("solid": {"union": {"of": [)" + balls + R"(], "blend": )" + blend + "}}");
    const VolumeSampling sampling = sampling_of(scene, {72, 72, 40});
    const VolumeSamples samples = sample_volume(scene, sampling);
    const size_t n = sampling.grid.size();
    std::vector<float> field(n);
    Evaluator(scene.drawn()).values(places(sampling.grid).data(), n, field.data());
    EXPECT_EQ(std::memcmp(field.data(), samples.field.get(), n * sizeof(float)), 0) << blend;
  }
}

TEST(VolumeSamples, DoNotDependOnThreads) {
  const Scene scene = drilled_block();
  const VolumeSampling sampling = sampling_of(scene, {50, 40, 30});
  const VolumeSamples several = sample_volume(scene, sampling);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const VolumeSamples alone = sample_volume(scene, sampling);
  const size_t n = sampling.grid.size();
  EXPECT_EQ(std::memcmp(several.field.get(), alone.field.get(), n * sizeof(float)), 0);
  EXPECT_EQ(std::memcmp(several.colors.get(), alone.colors.get(), 4 * n * sizeof(float)), 0);
  EXPECT_EQ(several.steepness, alone.steepness);
  EXPECT_EQ(several.range.lo, alone.range.lo);
}

// Of a plane, whose interpolation it is, steepness is the gradient's length.
TEST(VolumeSamples, KnowHowSteepTheyAre) {
  const Scene scene = scene_of(
      R"("solid": {"intersection": {"of": ["= 3*x - 4*z + 1", {"sphere": {"radius": 90}}]}})");
  VolumeSampling sampling;
  sampling.grid = {{{-1, -2, -1}, {1, 2, 2}}, {20, 30, 25}};
  EXPECT_NEAR(sample_volume(scene, sampling).steepness, 5, 1e-5);
}

// Steps of |field| / steepness stay on their side, wherever they start.
TEST(VolumeSamples, AreNoSteeperThanTheySay) {
  const Scene scene = drilled_block();
  const VolumeSampling sampling = sampling_of(scene, {24, 20, 16});
  const TexelGrid& grid = sampling.grid;
  const VolumeSamples samples = sample_volume(scene, sampling);
  const auto interpolated = [&](const Vec3& p) {
    size_t low[3];
    double share[3];
    for (int axis = 0; axis < 3; ++axis) {
      const double t = (p[axis] - grid.at(axis, 0)) / grid.cell(axis);
      low[axis] = size_t(std::clamp(t, 0.0, grid.counts[axis] - 1.001));
      share[axis] = std::clamp(t - double(low[axis]), 0.0, 1.0);
    }
    double sum = 0;
    for (size_t corner = 0; corner < 8; ++corner) {
      double weight = 1;
      size_t at[3];
      for (size_t axis = 0; axis < 3; ++axis) {
        const bool high = corner >> axis & 1;
        weight *= high ? share[axis] : 1 - share[axis];
        at[axis] = low[axis] + high;
      }
      sum +=
          weight *
          samples.field[at[0] + size_t(grid.counts[0]) * (at[1] + size_t(grid.counts[1]) * at[2])];
    }
    return sum;
  };
  std::mt19937 engine(6);
  std::uniform_real_distribution<double> any(0, 1), step(-0.5, 0.5);
  for (int i = 0; i < 20000; ++i) {
    Vec3 a, b;
    for (int axis = 0; axis < 3; ++axis) {
      a[axis] = grid.box.lo[axis] + any(engine) * grid.box.size()[axis];
      b[axis] = a[axis] + step(engine);
    }
    const double difference = std::abs(interpolated(a) - interpolated(b));
    ASSERT_LE(difference, samples.steepness * norm(a - b) * (1 + 1e-6) + 1e-9);
  }
}

TEST(VolumeSamples, CountNoNumbersAsOutsideAndKeepWithinTheDiagonal) {
  const Scene scene = scene_of(
      R"_("solid": {"intersection": {"of": ["= 1000*(3 - sqrt(x^2 + y^2 + z^2))", {"sphere": {"radius": 3}}]}},
         "sections": [{"remove": "= -1000*log(x)"}],
         "materials": {"a": {"color": [0.5, 0.25, 0.125]}},
         "attributes": {"depth": {"value": "= 1/(y-y)"}})_");
  VolumeSampling sampling;
  sampling.grid = {{{-4, -4, -4}, {4, 4, 4}}, {16, 16, 16}};
  sampling.components = {scene.description().attributes[0].components[0].expression()};
  const VolumeSamples samples = sample_volume(scene, sampling);
  const double diagonal = sampling.grid.box.diagonal();
  for (size_t i = 0; i < sampling.grid.size(); ++i) {
    if (sampling.grid.at(0, int(i % 16)) < 0) {
      ASSERT_EQ(samples.field[i], -float(diagonal));
    }
    ASSERT_LE(std::abs(samples.field[i]), float(diagonal));
    for (size_t c = 0; c < 4; ++c) ASSERT_EQ(samples.colors[4 * i + c], 0);
  }
  EXPECT_TRUE(std::isfinite(samples.steepness));
  EXPECT_GT(samples.range.lo, samples.range.hi);
}

TEST(VolumeSamples, NeedNoColors) {
  const Scene scene = drilled_block();
  VolumeSampling sampling = sampling_of(scene, {20, 20, 20});
  sampling.colored = Colored::nothing;
  const VolumeSamples samples = sample_volume(scene, sampling);
  EXPECT_EQ(samples.colors, nullptr);
  EXPECT_GT(samples.steepness, 0);
}

TEST(VolumeSamples, RefuseBadGrids) {
  const Scene scene = drilled_block();
  const auto message = [&](const Vec3& lo, const Vec3& hi, std::array<int, 3> counts) {
    VolumeSampling sampling;
    sampling.grid = {{lo, hi}, counts};
    return error_of([&] { sample_volume(scene, sampling); });
  };
  EXPECT_THAT(message({0, 2, 0}, {1, 1, 1}, {8, 8, 8}), HasSubstr("reaches from y = 2 to 1"));
  EXPECT_THAT(message({0, 0, 0}, {1, 1, infinity}, {8, 8, 8}), HasSubstr("from z = 0 to inf"));
  EXPECT_THAT(message({0, 0, NAN}, {1, 1, 1}, {8, 8, 8}), HasSubstr("from z = nan"));
  EXPECT_THAT(message({0, 0, 0}, {1, 1, 1}, {0, 8, 8}), HasSubstr("0 samples along x; 1 to 2048"));
  EXPECT_THAT(message({0, 0, 0}, {1, 1, 1}, {8, 4096, 8}), HasSubstr("4096 samples along y"));
  EXPECT_THAT(message({0, 0, 0}, {1, 1, 1}, {1024, 1024, 1024}), HasSubstr("268435456 together"));
  EXPECT_THAT(error_of([] { colored_samples("insides"); }), HasSubstr("did you mean 'inside'?"));
  VolumeSampling sampling = sampling_of(scene, {8, 8, 8});
  sampling.components.assign(4, constant(1));
  EXPECT_THAT(error_of([&] { sample_volume(scene, sampling); }), HasSubstr("4 components"));
}

// From the moment of the refusal on, whenever it comes.
TEST(VolumeSamples, EndWithinATenthOfASecondOfACancel) {
  const Scene scene = drilled_block();
  VolumeSampling sampling = sampling_of(scene, {256, 256, 256});
  sampling.colored = Colored::inside;
  double last = 0;
  EXPECT_THROW(sample_volume(scene, sampling, [](double) { return false; }), Cancelled);
  for (const double until : {0.1, 0.6}) {
    std::chrono::steady_clock::time_point refused;
    EXPECT_THROW(sample_volume(scene, sampling,
                               [&](double share) {
                                 EXPECT_LE(share, 1);
                                 last = share;
                                 refused = std::chrono::steady_clock::now();
                                 return share < until;
                               }),
                 Cancelled);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - refused;
    EXPECT_LT(took.count(), at_once);
    EXPECT_GE(last, until);
  }
}

}  // namespace
}  // namespace sardf

// Volumes against closed forms.
#include "sardf/volume.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "sardf/scene_file.hpp"

namespace sardf {
namespace {

constexpr double pi = std::numbers::pi;

struct Case {
  const char* name;
  const char* solid;
  double volume;
};

class VolumeOf : public testing::TestWithParam<Case> {};

Scene scene_of(const std::string& rest) {
  return Scene(parse_scene("{\"sardf\": 1, " + rest + "}", ""));
}

TEST_P(VolumeOf, IsThatOfTheClosedForm) {
  const Scene scene = scene_of(std::string("\"solid\": ") + GetParam().solid);
  const MaterialVolumes volumes = measure_volumes(scene);
  const double exact = GetParam().volume;
  EXPECT_NEAR(volumes.total, exact, std::max(2e-3 * exact, volumes.error));
  EXPECT_LE(volumes.error, 0.02 * exact);
  EXPECT_EQ(volumes.materials, std::vector<double>{volumes.total});
}

INSTANTIATE_TEST_SUITE_P(
    Solids, VolumeOf,
    testing::Values(
        Case{"ball", R"({"sphere": {"center": [1, 2, 3], "radius": 2}})", 4.0 / 3 * pi * 8},
        Case{"torus", R"({"torus": {"major_radius": 3, "minor_radius": 0.5, "axis": [1, 2, 2]}})",
             2 * pi* pi * 3 * 0.25},
        Case{"plate", R"({"box": {"size": [100, 80, 0.05]}})", 400},
        Case{
            "turned_plate",
            R"({"rotate": {"field": {"box": {"size": [8, 6, 0.1]}}, "axis": [1, 1, 0.3], "angle": 40}})",
            4.8},
        Case{
            "thin_shell",
            R"({"shell": {"field": {"sphere": {"radius": 2}}, "thickness": 0.02, "side": "inside"}})",
            4.0 / 3 * pi * (8 - 1.98 * 1.98 * 1.98)},
        Case{"flat_ellipsoid", R"({"ellipsoid": {"radii": [10, 0.1, 5]}})", 4.0 / 3 * pi * 5}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(Volume, IsSharedByTheMaterials) {
  // Red grows linearly from 0 at x = -1 to 1 at x = 1 and is 1 beyond: half of all.
  const Scene scene = scene_of(R"("solid": {"box": {"size": [4, 1, 1]}},
    "materials": {"blue": {"color": "#0000ff"}, "red": {"color": "#ff0000"}},
    "fractions": {"ramp": {"field": "=x", "stops": [
      {"at": -1, "material": "blue"}, {"at": 1, "material": "red"}]}})");
  const MaterialVolumes volumes = measure_volumes(scene);
  EXPECT_NEAR(volumes.materials.at(0), 2, 4e-3);
  EXPECT_NEAR(volumes.materials.at(1), 2, 4e-3);
  EXPECT_DOUBLE_EQ(volumes.materials[0] + volumes.materials[1], volumes.total);
}

TEST(Volume, OfSectionsIsNotTakenAway) {
  const Scene scene = scene_of(R"("solid": {"box": {"size": [2, 2, 2]}},
    "sections": [{"remove": {"half_space": {"normal": "x"}}}])");
  EXPECT_NEAR(measure_volumes(scene).total, 8, 2e-2);
}

TEST(Volume, ReportsRisingSharesAndCancels) {
  const Scene scene = scene_of(R"("solid": {"sphere": {"radius": 2}})");
  double last = 0;
  measure_volumes(scene, 24, [&](double share) {
    EXPECT_GE(share, last);
    last = share;
    return true;
  });
  EXPECT_EQ(last, 1);
  EXPECT_THROW(measure_volumes(scene, 24, [](double share) { return share < 0.2; }), Cancelled);
}

}  // namespace
}  // namespace sardf

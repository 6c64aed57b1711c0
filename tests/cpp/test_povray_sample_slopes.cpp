// Bounds of interpolated samples over boxes: they hold everywhere, and are those of single cells
// where a box is as small.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "povray_gen/samples.hpp"

namespace sardf {
namespace {

using povray::SampleGrid;
using povray::Samples;

class SampleSlopesTest : public testing::TestWithParam<std::array<int, 3>> {
 protected:
  SampleSlopesTest() {
    grid_.counts = GetParam();
    for (size_t k = 0; k < 3; ++k) grid_.box[k] = {-1.0 - double(k), 2};
    std::vector<double> values(grid_.size());
    for (size_t i = 0; i < values.size(); ++i) {
      const Vec3 p = grid_.point(i);
      // Smooth, but for one cell in a hundred.
      values[i] = std::sin(3 * p[0]) * p[1] + p[2] * p[2] + (random_() % 100 ? 0 : uniform(-1, 1));
    }
    const Progress none;
    Work work(none);
    samples_ = std::make_unique<Samples>(grid_, values, work);
  }

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  std::array<Interval, 3> random_box() {
    std::array<Interval, 3> box;
    const double size = std::pow(10.0, uniform(-3, 1));
    for (Interval& side : box) {
      const double low = uniform(-4, 3);
      side = {low, low + size * uniform(0, 1)};
    }
    return box;
  }

  std::mt19937 random_{5};
  SampleGrid grid_;
  std::unique_ptr<Samples> samples_;
};

TEST_P(SampleSlopesTest, HoldValuesAndGradients) {
  for (int trial = 0; trial < 400; ++trial) {
    const std::array<Interval, 3> box = random_box();
    const Slope bound = samples_->over(box);
    for (int k = 0; k < 25; ++k) {
      Vec3 p, gradient;
      for (size_t axis = 0; axis < 3; ++axis) p[axis] = uniform(box[axis].lo, box[axis].hi);
      const double value = samples_->value(p, &gradient);
      EXPECT_TRUE(bound.value.contains(value));
      // The gradient here is a difference of values of up to 10, rounded, over steps of 0.05.
      constexpr double rounding = 1e-12;
      EXPECT_LE(norm(gradient), bound.length + rounding);
      for (size_t axis = 0; axis < 3; ++axis) {
        EXPECT_LE(bound.partial[axis].lo, gradient[axis] + rounding) << axis;
        EXPECT_GE(bound.partial[axis].hi, gradient[axis] - rounding) << axis;
      }
    }
  }
}

// The gradient is longest at a corner of the cell, from inside.
TEST_P(SampleSlopesTest, AreExactInACell) {
  for (int trial = 0; trial < 200; ++trial) {
    std::array<Interval, 3> box, cell;
    for (size_t axis = 0; axis < 3; ++axis) {
      const int k = int(axis);
      const double place = std::floor(uniform(0, std::max(1, grid_.counts[axis] - 1)));
      const double low = grid_.box[axis].lo + place * grid_.step(k), step = grid_.step(k);
      cell[axis] = {low + 1e-9 * step, low + (1 - 1e-9) * step};
      box[axis] = {low + 0.1 * step, low + 0.9 * step};
    }
    double longest = 0;
    for (size_t corner = 0; corner < 8; ++corner) {
      Vec3 p, gradient;
      for (size_t axis = 0; axis < 3; ++axis) {
        p[axis] = corner >> axis & 1 ? cell[axis].hi : cell[axis].lo;
      }
      samples_->value(p, &gradient);
      longest = std::max(longest, norm(gradient));
    }
    EXPECT_NEAR(samples_->over(box).length, longest, 1e-6 * (1 + longest));
  }
}

TEST_P(SampleSlopesTest, AreFlatOutside) {
  const Interval beyond{2.5, 3};
  const Slope bound = samples_->over({beyond, beyond, beyond});
  for (size_t axis = 0; axis < 3; ++axis) EXPECT_TRUE(bound.partial[axis].contains(0));
  const double corner = samples_->value({3, 3, 3}, nullptr);
  EXPECT_TRUE(bound.value.contains(corner));
  EXPECT_LE(samples_->over({Interval::all(), Interval::all(), Interval::all()}).length, infinity);
}

INSTANTIATE_TEST_SUITE_P(Grids, SampleSlopesTest,
                         testing::Values(std::array{40, 33, 21}, std::array{2, 2, 2},
                                         std::array{70, 1, 30}, std::array{1, 50, 1}));

}  // namespace
}  // namespace sardf

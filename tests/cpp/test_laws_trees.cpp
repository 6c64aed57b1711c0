// Certified numbers of random trees of primitives, transforms and blends over random boxes.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "laws.hpp"
#include "sardf/field_parts.hpp"

namespace sardf {
namespace {

using laws::Random;

BoundingBox random_box(Random& r) {
  BoundingBox box;
  for (int axis = 0; axis < 3; ++axis) {
    // Equal sides meet kinks on diagonals.
    const bool repeats = axis > 0 && r.chance(0.1);
    const Interval side = repeats ? Interval(box.lo[0], box.hi[0]) : laws::random_interval(r, 1e9);
    box.lo[axis] = side.lo;
    box.hi[axis] = side.hi;
  }
  return box;
}

Vec3 point_in(Random& r, const BoundingBox& box) {
  Vec3 at;
  for (int axis = 0; axis < 3; ++axis) {
    at[axis] = laws::number_in(r, {box.lo[axis], box.hi[axis]});
  }
  return at;
}

std::string text(const BoundingBox& box) {
  return testing::PrintToString(box.lo) + " to " + testing::PrintToString(box.hi) + ", seed " +
         std::to_string(laws::seed());
}

// "union of sphere, box": the constructors that the field was made by.
std::string constructors_of(const Field& field) {
  const Construction* made = field.construction();
  if (!made || !made->constructor) return "a formula";
  std::vector<Field> parts;
  for (const Value& value : made->arguments) append_fields(value, parts);
  std::string text = made->constructor->name;
  for (const Field& part : parts) {
    text += (&part == &parts[0] ? " of (" : ", ") + constructors_of(part);
  }
  return parts.empty() ? text : text + ")";
}

double largest(const Vec3& p) {
  return std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2]), 10.0});
}

/// Points of a box in pairs, with the field's values and gradients there, all evaluated at once: a
/// block of 16 costs as much as one point.
struct Samples {
  static constexpr size_t count = 16;
  std::array<Vec3, count> at;
  std::array<double, count> value;
  std::array<Vec3, count> gradient;

  Samples(Random& r, const Evaluator& evaluator, const BoundingBox& box) {
    std::array<std::array<double, count>, 3> xyz, by;
    for (size_t i = 0; i < count; ++i) {
      at[i] = point_in(r, box);
      // Kinks and jumps show between points that are close.
      if (i % 4 == 3) at[i] = beside(r, at[i - 1], box);
      for (size_t axis = 0; axis < 3; ++axis) xyz[axis][i] = at[i][axis];
    }
    double* to[] = {by[0].data(), by[1].data(), by[2].data()};
    evaluator.gradient_block(xyz[0].data(), xyz[1].data(), xyz[2].data(), count, value.data(), to);
    for (size_t i = 0; i < count; ++i) gradient[i] = {by[0][i], by[1][i], by[2][i]};
  }

 private:
  static Vec3 beside(Random& r, const Vec3& point, const BoundingBox& box) {
    const double most = r.decades(-9, 0);
    Vec3 to;
    for (size_t axis = 0; axis < 3; ++axis) {
      to[axis] = std::clamp(point[axis] + r.uniform(-most, most), box.lo[axis], box.hi[axis]);
    }
    return to;
  }
};

void expect_gradient_held(const Samples& s, size_t i, const Slope& slope, const BoundingBox& box) {
  const double steepness = norm(s.gradient[i]);
  if (std::isnan(steepness)) return;
  EXPECT_LE(steepness, slope.length * (1 + 1e-9) + 1e-9)
      << testing::PrintToString(s.at[i]) << " over " << text(box);
  for (size_t axis = 0; axis < 3; ++axis) {
    const Interval by = slope.partial[axis];
    const double slack = 1e-8 * (1 + steepness);
    EXPECT_TRUE(by.lo - slack <= s.gradient[i][axis] && s.gradient[i][axis] <= by.hi + slack)
        << s.gradient[i][axis] << " at " << testing::PrintToString(s.at[i]) << " not in [" << by.lo
        << ", " << by.hi << "] over " << text(box);
  }
}

// What the real values at two points differ by at least: the intervals of the points alone hold
// them, rounding included.
double proven_difference(const Evaluator& evaluator, const Vec3& p, const Vec3& q) {
  const Interval f = evaluator.interval({p, p}), g = evaluator.interval({q, q});
  return std::max(f.lo - g.hi, g.lo - f.hi);
}

void expect_difference_held(const Samples& s, size_t i, size_t j, double steepest,
                            const Evaluator& evaluator, const BoundingBox& box) {
  // Two infinite values differ by nothing that could be compared.
  if (!std::isfinite(s.value[i]) || !std::isfinite(s.value[j])) return;
  const double apart = norm(s.at[i] - s.at[j]);
  const double allowed = (apart == 0 ? 0 : steepest * apart) * (1 + 1e-9);
  const double rounding = 1e-13 * (largest(s.at[i]) + largest(s.at[j]) + std::abs(s.value[i]));
  const double difference = std::abs(s.value[i] - s.value[j]);
  if (difference <= allowed + rounding) return;
  // Far away, formulas that square coordinates are rounded by more.
  EXPECT_LE(proven_difference(evaluator, s.at[i], s.at[j]), allowed)
      << difference << " between " << testing::PrintToString(s.at[i]) << " and "
      << testing::PrintToString(s.at[j]) << " over " << text(box);
}

// The values of all steps of a field at a point.
std::vector<double> steps_at(const Expression& field, const Vec3& at) {
  std::vector<Expression> steps{field};
  for (const Node* node : topological_order(steps)) {
    for (const Expression& argument : node->arguments()) steps.push_back(argument);
  }
  std::vector<double> values(steps.size());
  Evaluator(steps).values(at, values.data());
  return values;
}

// Where a step is NaN, the formula has no value, and no bound is claimed (numbers/interval.hpp):
// min, max or select may still pass the other argument on.
bool is_defined(const Expression& field, const Vec3& at) {
  const std::vector<double> steps = steps_at(field, at);
  return std::none_of(steps.begin(), steps.end(), [](double a) { return std::isnan(a); });
}

// What single precision makes of a field's steps: nothing can be said where it cannot square them.
double float_rounding(const Expression& field, const Vec3& at) {
  double largest = 0;
  for (const double a : steps_at(field, at)) largest = std::max(largest, std::abs(a));
  return largest < 1e18 ? 1e-6 * largest : infinity;
}

// Float values, at points of the box that floats have. They are held to what single fields are held
// to near the origin; far away, formulas that square coordinates lose more.
void expect_floats_held(const Samples& s, const Expression& field, const Evaluator& evaluator,
                        const Slope& slope, const BoundingBox& box) {
  std::array<std::array<float, Samples::count>, 3> xyz;
  std::array<float, Samples::count> value;
  for (size_t i = 0; i < Samples::count; ++i) {
    for (size_t axis = 0; axis < 3; ++axis) xyz[axis][i] = float(s.at[i][axis]);
  }
  float* to = value.data();
  evaluator.block(xyz[0].data(), xyz[1].data(), xyz[2].data(), Samples::count, &to);
  const double slack = 1e-4 * std::max(slope.length, 1.0);
  for (size_t i = 0; i < Samples::count; ++i) {
    bool is_held = true;
    for (size_t axis = 0; axis < 3; ++axis) {
      const double at = xyz[axis][i];
      is_held = is_held && box.lo[axis] <= at && at <= box.hi[axis] && std::abs(at) <= 6;
    }
    if (!is_held || std::isnan(value[i])) continue;
    const bool is_in = slope.value.lo - slack <= value[i] && value[i] <= slope.value.hi + slack;
    const double beyond = std::max(slope.value.lo - value[i], value[i] - slope.value.hi);
    EXPECT_TRUE(is_in || beyond <= float_rounding(field, s.at[i]))
        << "float " << value[i] << " at " << testing::PrintToString(s.at[i]) << " not in ["
        << slope.value.lo << ", " << slope.value.hi << "] over " << text(box);
  }
}

/// Whether the box's slope is finite.
bool expect_bounds_hold(Random& r, const Expression& field, const Evaluator& evaluator,
                        const BoundingBox& box) {
  const Slope slope = evaluator.slope(box);
  const Interval& bound = slope.value;
  // Both compute the same; one in ten is enough to see it.
  if (r.chance(0.1)) {
    EXPECT_EQ(evaluator.interval(box), bound) << text(box);
  }
  EXPECT_TRUE(bound.lo <= bound.hi && slope.length >= 0) << text(box);
  const Samples s(r, evaluator, box);
  for (size_t i = 0; i < Samples::count; ++i) {
    if (std::isnan(s.value[i])) continue;
    if (!bound.contains(s.value[i]) && !is_defined(field, s.at[i])) continue;
    EXPECT_TRUE(bound.contains(s.value[i]))
        << s.value[i] << " at " << testing::PrintToString(s.at[i]) << " not in [" << bound.lo
        << ", " << bound.hi << "] over " << text(box);
    expect_gradient_held(s, i, slope, box);
    if (i > 0) expect_difference_held(s, i, i - 1, slope.length, evaluator, box);
  }
  expect_floats_held(s, field, evaluator, slope, box);
  return slope.length < infinity;
}

constexpr size_t pairs_of_a_part = 25000;

/// Pairs of a tree and a box, from the part's own random numbers.
void expect_bounds_hold_in_part(unsigned part) {
  constexpr size_t boxes = 20;
  const size_t pairs = size_t(laws::effort(int(pairs_of_a_part)));
  Random r(31000000 + part);
  size_t finite = 0;
  for (size_t i = 0; i < pairs / boxes && !testing::Test::HasFailure(); ++i) {
    const Field field = laws::random_field(r, r.chance(0.1) ? 3 : 1 + r.below(2));
    SCOPED_TRACE(testing::Message() << "part " << part << ", tree " << i << ", seed "
                                    << laws::seed() << ": " << constructors_of(field));
    const Evaluator evaluator(field.expression());
    for (size_t k = 0; k < boxes; ++k) {
      finite += expect_bounds_hold(r, field.expression(), evaluator, random_box(r));
    }
  }
  // Bounds that are all infinite would hold, too.
  EXPECT_TRUE(finite > pairs / 2 || testing::Test::HasFailure()) << finite;
}

class TreeLaws : public testing::TestWithParam<unsigned> {};

TEST_P(TreeLaws, BoundsHoldOverRandomBoxes) { expect_bounds_hold_in_part(GetParam()); }

// 10^5 pairs. In parts, so that test processes can share them.
INSTANTIATE_TEST_SUITE_P(Parts, TreeLaws, testing::Values(0u, 1u, 2u, 3u));

// With the four parts above, 10^7 pairs, in strides that test processes can share. $SARDF_PARTS, as
// in 17-20, runs these parts alone: to see a failure again.
class TreeLawsLong : public testing::TestWithParam<unsigned> {};
constexpr unsigned strides = 8;

TEST_P(TreeLawsLong, BoundsHoldOverTenMillionPairs) {
  unsigned first = 4, last = 399;
  if (const char* parts = std::getenv("SARDF_PARTS")) {
    ASSERT_EQ(std::sscanf(parts, "%u-%u", &first, &last), 2) << parts;
  }
  for (unsigned part = first; part <= last && !HasFailure(); ++part) {
    if (part % strides != GetParam()) continue;
    expect_bounds_hold_in_part(part);
    std::printf("part %u of %u to %u done, seed %s\n", part, first, last,
                std::to_string(laws::seed()).c_str());
    std::fflush(stdout);
  }
}

INSTANTIATE_TEST_SUITE_P(Strides, TreeLawsLong, testing::Range(0u, strides));

}  // namespace
}  // namespace sardf

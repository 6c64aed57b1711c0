// Certified numbers of random trees of primitives, transforms and blends over random boxes.
#include <gtest/gtest.h>

#include "laws.hpp"
#include "sardf/certify.hpp"
#include "sardf/field_parts.hpp"

namespace sardf {
namespace {

using laws::Random;

BoundingBox random_box(Random& r) {
  BoundingBox box;
  for (int axis = 0; axis < 3; ++axis) {
    const Interval side = laws::random_interval(r, 1e9);
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

void expect_bounds_hold(Random& r, const Evaluator& evaluator, const BoundingBox& box) {
  const Interval bound = evaluator.interval(box);
  const Slope slope = evaluator.slope(box);
  EXPECT_FALSE(std::isnan(bound.lo) || std::isnan(bound.hi) || std::isnan(slope.length))
      << text(box);
  Vec3 before = point_in(r, box);
  double value_before = evaluator.value(before);
  for (int i = 0; i < 4; ++i) {
    const Vec3 at = point_in(r, box);
    double value, gradient[3];
    evaluator.gradients(at.data(), 1, &value, gradient);
    if (std::isnan(value)) continue;
    EXPECT_TRUE(bound.contains(value))
        << value << " at " << testing::PrintToString(at) << " not in [" << bound.lo << ", "
        << bound.hi << "] over " << text(box);
    const double steepness = std::hypot(gradient[0], gradient[1], gradient[2]);
    if (!std::isnan(steepness)) {
      EXPECT_LE(steepness, slope.length * (1 + 1e-9) + 1e-9)
          << testing::PrintToString(at) << " over " << text(box);
      for (int axis = 0; axis < 3; ++axis) {
        const Interval by = slope.partial[axis];
        EXPECT_TRUE(by.lo - 1e-8 * (1 + steepness) <= gradient[axis] &&
                    gradient[axis] <= by.hi + 1e-8 * (1 + steepness))
            << gradient[axis] << " not in [" << by.lo << ", " << by.hi << "] over " << text(box);
      }
    }
    // Rounding grows with the scales and blends on the way.
    const double scale = largest(at) + largest(before);
    const double steep = slope.length < infinity ? 1e-15 * slope.length * scale : 0;
    const double rounding = 1e-11 * (scale + std::abs(value)) + steep;
    const double apart = norm(at - before);
    const double allowed = apart == 0 ? 0 : slope.length * apart;
    // Two infinite values differ by nothing that could be compared.
    if (std::isfinite(value) && std::isfinite(value_before)) {
      EXPECT_LE(std::abs(value - value_before), allowed * (1 + 1e-9) + rounding)
          << testing::PrintToString(at) << " and " << testing::PrintToString(before) << " over "
          << text(box);
    }
    before = at;
    value_before = value;
  }
}

TEST(TreeLaws, BoundsHoldOverRandomBoxes) {
  Random r(31);
  constexpr int boxes = 20;
  size_t pairs = 0, finite = 0;
  for (int i = 0; i < laws::effort(5000); ++i) {
    const Field field = laws::random_field(r, r.chance(0.1) ? 3 : 1 + r.below(2));
    SCOPED_TRACE(testing::Message() << "tree " << i << ", " << constructors_of(field));
    const Evaluator evaluator(field.expression());
    for (int k = 0; k < boxes; ++k, ++pairs) {
      const BoundingBox box = random_box(r);
      finite += evaluator.slope(box).length < infinity;
      expect_bounds_hold(r, evaluator, box);
    }
  }
  // Bounds that are all infinite would hold, too.
  EXPECT_GT(finite, pairs / 2);
}

}  // namespace
}  // namespace sardf

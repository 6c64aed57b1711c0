// Single precision in the ray caster: how far it is off, and that the widest lanes do what others
// do.
#include <gtest/gtest.h>

#include "laws.hpp"
#include "sardf/constructor.hpp"
#include "sardf/render_kernels.hpp"
#include "sardf/render_rounding.hpp"
#include "sardf/render_stages.hpp"

namespace sardf {
namespace {

using laws::Random;
using rendering::RayFrame;
using rendering::RayTable;

struct Place {
  Vec3 exact;
  std::array<float, 3> rounded;
};

// As rays make places: a rounded way from the box's rounded middle.
Place place_in(Random& r, const BoundingBox& box) {
  Place place;
  for (int axis = 0; axis < 3; ++axis) {
    const double way = r.uniform(-0.5, 0.5) * box.size()[axis];
    place.exact[axis] = box.center()[axis] + way;
    place.rounded[size_t(axis)] = float(box.center()[axis]) + float(way);
  }
  return place;
}

BoundingBox box_somewhere(Random& r) {
  BoundingBox box;
  const double away = r.chance(0.3) ? 30 : 2;
  for (int axis = 0; axis < 3; ++axis) {
    const double middle = r.uniform(-away, away), half = r.decades(-1, 0.7);
    box.lo[axis] = middle - half;
    box.hi[axis] = middle + half;
  }
  return box;
}

TEST(RenderSingle, ValuesAreOffByNoMoreThanTheBound) {
  int bounded = 0, all = 0;
  double largest_share = 0;
  for (int k = 0; k < laws::effort(400); ++k) {
    Random r{uint64_t(k)};
    const Field field = laws::random_field(r, 1 + r.below(2));
    const Evaluator evaluator(field.expression());
    const BoundingBox box = box_somewhere(r);
    const double bound = rendering::single_precision_error(evaluator, box);
    ++all;
    if (!(bound < 0.1 * box.diagonal())) continue;
    ++bounded;
    for (int i = 0; i < 100; ++i) {
      const auto [exact, rounded] = place_in(r, box);
      float value = 0;
      float* out = &value;
      evaluator.block(&rounded[0], &rounded[1], &rounded[2], 1, &out);
      const double expected = evaluator.value(exact);
      if (std::isnan(expected)) continue;
      const double off = std::abs(double(value) - expected);
      EXPECT_LE(off, bound) << "field " << k << ", seed " << laws::seed();
      largest_share = std::max(largest_share, off / bound);
    }
  }
  // A bound that is seldom there, or far too large, would hold as well.
  EXPECT_GT(bounded, all / 4);
  EXPECT_GT(largest_share, 0.02);
}

Camera camera_on(Random& r, const BoundingBox& box, int width, int height) {
  Camera camera = frame_camera(box, width, height, {r.ordinary(), r.ordinary(), r.ordinary()});
  if (r.chance(0.5)) camera.type = Camera::Type::orthographic;
  camera.ortho_scale = box.diagonal() * r.decades(-0.5, 1);
  camera.lens *= r.decades(-0.3, 1);
  camera.shift_x = r.uniform(-0.3, 0.3);
  return camera;
}

// The largest share of the bound by which places of a square's rays are off, where the true ones
// lie in the box.
double largest_share_off(Random& r, const rendering::Subject& subject, int width, int height) {
  constexpr int edge = rendering::smallest_edge;
  const rendering::Beam beam{edge * (r.below((width + edge - 1) / edge) + 0.5),
                             edge * (r.below((height + edge - 1) / edge) + 0.5), edge, 0};
  const auto table = std::make_unique<RayTable>();
  rendering::begin_rays(subject, beam, width, height, *table);
  double largest = 0;
  for (size_t i = 0; i < table->count; ++i) {
    const float depth = float(r.uniform(0, 1)) * subject.frame.range;
    const Vec3 exact = subject.rays.through(double(table->x[i]) + 0.5, double(table->y[i]) + 0.5)
                           .at(subject.frame.begin + double(depth)) -
                       subject.bounds.center();
    Vec3 off;
    bool inside = table->x[i] < float(width) && table->y[i] < float(height);
    for (int axis = 0; axis < 3; ++axis) {
      inside = inside && std::abs(exact[axis]) <= 0.5 * subject.bounds.size()[axis];
      const float place = table->from[size_t(axis)][i] + depth * table->along[size_t(axis)][i];
      off[axis] = double(place) - exact[axis];
    }
    if (inside) largest = std::max(largest, norm(off) / double(subject.frame.misplaced));
  }
  return largest;
}

TEST(RenderSingle, PlacesAreOffByNoMoreThanTheBound) {
  double largest_share = 0;
  const LocalEvaluator solid{Evaluator(make_field("sphere", {Vec3{}, 1.0}).expression()),
                             BoundingBox{{-1, -1, -1}, {1, 1, 1}}};
  for (int k = 0; k < laws::effort(400); ++k) {
    Random r{uint64_t(k)};
    const BoundingBox box = box_somewhere(r);
    const int width = 1 + r.below(r.chance(0.3) ? 8 : 1000), height = 1 + r.below(1000);
    rendering::Subject subject{solid,
                               box,
                               rendering::Rays(camera_on(r, box, width, height), width, height),
                               rendering::LocalSlopes(solid.whole(), box, 1, [] {}),
                               1e-3,
                               0};
    subject.frame = rendering::frame_of_places(subject.rays, box, width, height);
    for (int square = 0; square < 20; ++square) {
      const double share = largest_share_off(r, subject, width, height);
      EXPECT_LE(share, 1) << k << ": " << width << " x " << height;
      largest_share = std::max(largest_share, share);
    }
  }
  EXPECT_GT(largest_share, 0.05);
}

// Numbers as rays have them, ended ones and such as have no last sample among them.
void fill(Random& r, RayTable& table) {
  table.count = 64;
  for (size_t i = 0; i < table.count; ++i) {
    for (size_t axis = 0; axis < 3; ++axis) {
      table.from[axis][i] = float(r.uniform(-2, 2));
      table.along[axis][i] = r.chance(0.1) ? 0 : float(r.uniform(-1.5, 1.5));
    }
    table.per_length[i] = float(r.uniform(0.5, 1));
    table.clear[i] = float(r.uniform(0, 2));
    table.end[i] = table.clear[i] + float(r.decades(-4, 0));
    const double ahead = r.chance(0.5) ? r.decades(-5, -3) : r.uniform(0, 1);
    table.trial[i] = std::min(table.clear[i] + float(ahead), table.end[i]);
    table.before[i] = table.clear[i] - float(r.decades(-4, -1));
    table.before_value[i] = r.chance(0.2) ? 0 : -float(r.decades(-5, 0));
    table.beyond[i] = table.trial[i];
    table.beyond_value[i] = float(r.decades(-5, -2));
    table.state[i] = float(r.chance(0.8) ? RayTable::going : 1 + r.below(3));
  }
}

RayFrame frame() {
  RayFrame frame;
  frame.middle = {3, -2, 0.5f};
  frame.half = {1, 2, 0.7f};
  frame.range = 5;
  frame.error = 1e-5f;
  frame.misplaced = 1e-6f;
  frame.per_slope = 0.8f;
  frame.tolerance = 4e-4f;
  return frame;
}

bool same(const RayTable::Row& a, const RayTable::Row& b, size_t n) {
  for (size_t i = 0; i < n; ++i)
    if (!(a[i] == b[i] || (std::isnan(a[i]) && std::isnan(b[i])))) return false;
  return true;
}

TEST(RenderSingle, TheWidestLanesGiveTheSameBits) {
  const rendering::RayKernels& baseline = rendering::RayKernelsOf<Baseline>::all_kernels;
  const rendering::RayKernels& widest = rendering::ray_kernels();
  const auto one = std::make_unique<RayTable>(), other = std::make_unique<RayTable>();
  const auto block = std::make_unique<rendering::RayBlock>();
  const auto block_too = std::make_unique<rendering::RayBlock>();
  for (int k = 0; k < laws::effort(200); ++k) {
    Random r{uint64_t(k)};
    fill(r, *one);
    *other = *one;
    const size_t n = one->count;
    float value[64], reach[64];
    for (size_t i = 0; i < n; ++i) {
      value[i] = r.chance(0.05) ? float(std::nan("")) : float(r.sign() * r.decades(-6, 0));
      reach[i] = float(r.decades(-5, -1));
    }
    baseline.place(frame(), *one, 0, n, *block);
    widest.place(frame(), *other, 0, n, *block_too);
    for (size_t axis = 0; axis < 3; ++axis)
      for (size_t i = 0; i < n; ++i) EXPECT_EQ(block->xyz[axis][i], block_too->xyz[axis][i]);
    const float* const known = r.chance(0.5) ? reach : nullptr;
    EXPECT_EQ(baseline.use(frame(), *one, 0, n, value, known),
              widest.use(frame(), *other, 0, n, value, known));
    for (const auto row :
         {&RayTable::clear, &RayTable::trial, &RayTable::before, &RayTable::before_value,
          &RayTable::beyond, &RayTable::beyond_value, &RayTable::state})
      EXPECT_TRUE(same((*one).*row, (*other).*row, n));
    baseline.place_aside(frame(), *one, 0, n, 1e-4f, n, *block);
    widest.place_aside(frame(), *other, 0, n, 1e-4f, n, *block_too);
    EXPECT_TRUE(same(one->trial, other->trial, n));
  }
}

// One ray after the other.
void copy_one_by_one(const RayTable& from, RayTable::State which, RayTable& to) {
  size_t at = &from == &to ? 0 : to.count;
  for (size_t i = 0; i < from.count; ++i) {
    if (from.state_of(i) != which) continue;
    RayTable::for_rows(from, to, [&](const auto& row, auto& other) { other[at] = row[i]; });
    ++at;
  }
  to.count = at;
}

TEST(RenderSingle, RaysInAStateAreCopiedInTheirOrder) {
  const auto from = std::make_unique<RayTable>(), to = std::make_unique<RayTable>();
  const auto expected = std::make_unique<RayTable>();
  const auto expect_same = [&] {
    ASSERT_EQ(to->count, expected->count);
    RayTable::for_rows(*to, *expected, [&](const auto& row, auto& other) {
      EXPECT_TRUE(same(row, other, expected->count));
    });
  };
  for (const auto* kernels :
       {&rendering::RayKernelsOf<Baseline>::all_kernels, &rendering::ray_kernels()}) {
    for (int k = 0; k < laws::effort(200); ++k) {
      Random r{uint64_t(k)};
      fill(r, *from);
      for (size_t i = 0; i < from->count; ++i) from->x[i] = float(i), from->y[i] = float(k);
      *expected = *to = *from;
      from->count = 1 + r.below(64);
      const auto which = RayTable::State(r.below(4));
      kernels->copy(*from, which, *to);
      copy_one_by_one(*from, which, *expected);
      expect_same();
      *expected = *to = *from;
      kernels->copy(*to, which, *to);
      copy_one_by_one(*expected, which, *expected);
      expect_same();
    }
  }
}

}  // namespace
}  // namespace sardf

#include "povray_gen/guards.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "sardf/operation_of.hpp"
#include "sardf/ops_solids.hpp"

namespace sardf::povray {

namespace {

// The formula of a box, whose signed distance is the bound, takes about 20 steps.
constexpr size_t costly_steps = 150;

}  // namespace

Expression cheap_upper_bound(const Node& node) {
  if (node.type != Node::Type::operation) return nullptr;
  const Operation& operation = *node.operation;
  if (operation.info().kind != Kind::solid || !operation.is_distance() || node.arity != 3 ||
      !operation.has_formula()) {
    return nullptr;
  }
  Trace trace(3);
  operation.record(trace);
  if (trace.steps().size() < costly_steps) return nullptr;
  // Seen from afar along each axis, the exact distance tells where the solid begins: it lies
  // outside the ball around the far point. That ball is nearly flat; the margin covers how much it
  // bends across the solid, and rounding.
  double magnitude = 0;
  for (double a : operation.numbers()) magnitude = std::max(magnitude, std::abs(a));
  const double far = 1e5 * magnitude, margin = 1e-4 * magnitude, most = 4 * magnitude;
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    double end[2];
    for (int side : {0, 1}) {
      Vec3 point{};
      point[axis] = side ? far : -far;
      end[side] = far + operation.evaluate(point.data()) + margin;
      if (!(std::abs(end[side]) <= most)) return nullptr;
    }
    box.center[axis] = 0.5 * (end[1] - end[0]);
    box.size[axis] = end[1] + end[0];
    if (!(box.size[axis] > 0)) return nullptr;
  }
  return call(make_operation(box), node.arguments());
}

Keeps keeps_other(const Operation& operation, int small) {
  if (operation.info().arity != 2) return Keeps::nothing;
  for (double other : {-1e4, -3.7, -1.0, -0.01, 0.0, 0.01, 1.0, 3.7, 1e4}) {
    double in[max_arity] = {};
    in[small] = -1e12;
    in[1 - small] = other;
    if (operation.evaluate(in) != other) return Keeps::nothing;
  }
  // Its derivative over all values: along x, the slope of the small one is 1, of the other 0.
  std::array<Slope, max_arity> in;
  for (int i : {0, 1}) {
    const double along_x = i == small ? 1 : 0;
    in[i].value = {-1e12, 1e12};
    in[i].partial = {Interval(along_x), Interval(0.0), Interval(0.0)};
    in[i].length = along_x;
  }
  const Interval slope = operation.slope(in.data()).partial[0];
  constexpr double rounding = 1e-12;
  if (slope.lo >= -rounding) return Keeps::other_or_more;
  if (slope.hi <= rounding) return Keeps::other_or_less;
  return Keeps::nothing;
}

}  // namespace sardf::povray

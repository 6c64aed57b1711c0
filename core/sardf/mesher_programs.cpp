#include "sardf/mesher_programs.hpp"

#include <cmath>

namespace sardf::mesher {

Programs::Programs(const Vec3& origin, double cell, double room)
    : origin_(origin), edge_(least_cells * cell), room_(room) {}

BoundingBox Programs::box(const Index3& node, int level) const {
  const double edge = std::ldexp(edge_, level);
  BoundingBox result;
  for (int axis = 0; axis < 3; ++axis) {
    result.lo[axis] = origin_[axis] + node[axis] * edge;
    result.hi[axis] = result.lo[axis] + edge;
  }
  return result;
}

BoundingBox Programs::valid_box(const Index3& node, int level) const {
  const BoundingBox inner = box(node, level);
  const Vec3 room{room_, room_, room_};
  return {inner.lo - room, inner.hi + room};
}

void Programs::add(const Index3& node, int level, ProgramPointer program) {
  if (int(levels_.size()) <= level) levels_.resize(size_t(level) + 1);
  levels_[size_t(level)][key(node)] = std::move(program);
}

Programs::Found Programs::find(const Vec3& point) const {
  Index3 node;
  for (int axis = 0; axis < 3; ++axis) {
    const double at = std::floor((point[axis] - origin_[axis]) / edge_);
    // Far off the grid, or no number.
    if (!(at >= 0) || !(at < double(1 << 21))) return {};
    node[axis] = int32_t(at);
  }
  return find(node, 0);
}

Programs::Found Programs::find(Index3 node, int level) const {
  for (; level < int(levels_.size()); ++level) {
    const auto& nodes = levels_[size_t(level)];
    if (const auto found = nodes.find(key(node)); found != nodes.end()) {
      return {&found->second, valid_box(node, level)};
    }
    for (int32_t& i : node) i >>= 1;
  }
  return {};
}

}  // namespace sardf::mesher

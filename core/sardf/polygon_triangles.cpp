#include "sardf/polygon_triangles.hpp"

#include <algorithm>

namespace sardf {

namespace {

using Triple = std::array<uint32_t, 3>;

// Twice the area vector (Newell), relative to the first corner.
Vec3 area_vector(std::span<const Vec3> corners) {
  Vec3 sum{};
  for (size_t i = 1; i + 1 < corners.size(); ++i) {
    sum = sum + cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
  }
  return sum;
}

class EarCutter {
 public:
  explicit EarCutter(std::span<const Vec3> corners) {
    const Vec3 area = area_vector(corners);
    const auto size = [&](size_t axis) { return std::abs(area[axis]); };
    const size_t away =
        size(0) > size(1) ? (size(0) > size(2) ? 0 : 2) : (size(1) > size(2) ? 1 : 2);
    // Seen against the axis that the area vector is nearest to, counter-clockwise.
    size_t right = (away + 1) % 3, up = (away + 2) % 3;
    if (area[away] < 0) std::swap(right, up);
    for (const Vec3& corner : corners) at_.push_back({corner[right], corner[up]});
    for (uint32_t i = 0; i < corners.size(); ++i) left_.push_back(i);
  }

  bool is_convex() const {
    // All turns are left turns, and the directions go round once.
    int falls = 0;
    for (size_t i = 0; i < at_.size(); ++i) {
      if (!(turn(uint32_t(i), next(i), next(next(i))) > 0)) return false;
      const double now = at_[next(i)][0] - at_[i][0],
                   then = at_[next(next(i))][0] - at_[next(i)][0];
      falls += now > 0 && then <= 0;
    }
    return falls <= 1;
  }

  std::vector<Triple> cut(Pulse& pulse) {
    std::vector<Triple> triangles;
    size_t i = 0, tried = 0;
    while (left_.size() > 3) {
      // One of many polygons: how much of all is done, does not change here.
      pulse(0);
      const size_t n = left_.size(), before = (i + n - 1) % n, after = (i + 1) % n;
      const Triple ear{left_[before], left_[i], left_[after]};
      if (tried < n && !is_ear(ear)) {
        i = after;
        ++tried;
        continue;
      }
      triangles.push_back(ear);
      left_.erase(left_.begin() + long(i));
      if (i == left_.size()) i = 0;
      tried = 0;
    }
    triangles.push_back({left_[0], left_[1], left_[2]});
    return triangles;
  }

 private:
  uint32_t next(size_t i) const { return uint32_t(i + 1 == at_.size() ? 0 : i + 1); }

  double turn(uint32_t a, uint32_t b, uint32_t c) const {
    return (at_[b][0] - at_[a][0]) * (at_[c][1] - at_[a][1]) -
           (at_[b][1] - at_[a][1]) * (at_[c][0] - at_[a][0]);
  }

  bool is_ear(const Triple& t) const {
    if (!(turn(t[0], t[1], t[2]) > 0)) return false;
    return std::none_of(left_.begin(), left_.end(), [&](uint32_t i) {
      const Vec2& p = at_[i];
      if (p == at_[t[0]] || p == at_[t[1]] || p == at_[t[2]]) return false;
      return turn(t[0], t[1], i) >= 0 && turn(t[1], t[2], i) >= 0 && turn(t[2], t[0], i) >= 0;
    });
  }

  std::vector<Vec2> at_;
  std::vector<uint32_t> left_;
};

}  // namespace

std::vector<Triple> triangulated(std::span<const Vec3> corners, Pulse& pulse) {
  const uint32_t n = uint32_t(corners.size());
  if (n > 3) {
    EarCutter cutter(corners);
    if (!cutter.is_convex()) return cutter.cut(pulse);
  }
  std::vector<Triple> fan;
  for (uint32_t i = 1; i + 1 < n; ++i) fan.push_back({0, i, i + 1});
  return fan;
}

}  // namespace sardf

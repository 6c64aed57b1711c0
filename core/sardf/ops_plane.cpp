#include "sardf/ops_plane.hpp"

#include <string>

namespace sardf {

namespace {

double cross(const Vec2& o, const Vec2& a, const Vec2& b) {
  return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
}

bool in_box(const Vec2& a, const Vec2& b, const Vec2& p) {
  return std::min(a[0], b[0]) <= p[0] && p[0] <= std::max(a[0], b[0]) &&
         std::min(a[1], b[1]) <= p[1] && p[1] <= std::max(a[1], b[1]);
}

bool meet(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const double p = cross(a, b, c), q = cross(a, b, d), r = cross(c, d, a), s = cross(c, d, b);
  if (((p > 0 && q < 0) || (p < 0 && q > 0)) && ((r > 0 && s < 0) || (r < 0 && s > 0))) return true;
  return (p == 0 && in_box(a, b, c)) || (q == 0 && in_box(a, b, d)) ||
         (r == 0 && in_box(c, d, a)) || (s == 0 && in_box(c, d, b));
}

std::string edge(size_t i, size_t n) {
  return std::to_string(i) + "-" + std::to_string((i + 1) % n);
}

}  // namespace

void Polygon::prepare() {
  const size_t n = vertices.size();
  double area = 0;
  for (size_t i = 0; i < n; ++i) {
    const Vec2 &a = vertices[i], &b = vertices[(i + 1) % n];
    if (a == b) throw Error("vertices " + edge(i, n) + " of the polygon are the same point");
    area += a[0] * b[1] - a[1] * b[0];
    for (size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;
      if (meet(a, b, vertices[j], vertices[(j + 1) % n])) {
        throw Error("the polygon's edges " + edge(i, n) + " and " + edge(j, n) +
                    " cross or touch; a contour must not meet itself");
      }
    }
  }
  if (area == 0) throw Error("the polygon has no area");
  turn_ = area > 0 ? 1 : -1;
}

}  // namespace sardf

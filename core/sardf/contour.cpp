#include "sardf/contour.hpp"

#include <algorithm>

#include "sardf/error.hpp"

namespace sardf {

namespace {

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

// Two neighbouring edges that run back over each other.
bool folds_back(const Vec2& a, const Vec2& b, const Vec2& c) {
  return cross(a, b, c) == 0 && (a[0] - b[0]) * (c[0] - b[0]) + (a[1] - b[1]) * (c[1] - b[1]) > 0;
}

[[noreturn]] void fail_at_edges(const std::string& what, size_t i, size_t j, size_t n) {
  throw Error("the " + what + "'s edges " + edge(i, n) + " and " + edge(j, n) +
              " cross or touch; a contour must not meet itself");
}

}  // namespace

double doubled_area(const Contour& contour) {
  double area = 0;
  for (size_t i = 0; i < contour.size(); ++i) {
    const Vec2 &a = contour[i], &b = contour[(i + 1) % contour.size()];
    area += a[0] * b[1] - a[1] * b[0];
  }
  return area;
}

void check_contour(const Contour& contour, const std::string& what) {
  const size_t n = contour.size();
  for (size_t i = 0; i < n; ++i) {
    const Vec2 &a = contour[i], &b = contour[(i + 1) % n];
    if (a == b) {
      const bool closing = i + 1 == n;
      throw Error("vertices " + edge(i, n) + " of the " + what + " are the same point" +
                  (closing ? "; the last vertex is joined to the first without repeating it" : ""));
    }
  }
  for (size_t i = 0; i < n; ++i) {
    const Vec2 &a = contour[i], &b = contour[(i + 1) % n];
    if (n > 3 && folds_back(a, b, contour[(i + 2) % n])) fail_at_edges(what, i, (i + 1) % n, n);
    for (size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;
      if (meet(a, b, contour[j], contour[(j + 1) % n])) fail_at_edges(what, i, j, n);
    }
  }
  if (doubled_area(contour) == 0) throw Error("the " + what + " has no area");
}

}  // namespace sardf

#include "sardf/ops_plane.hpp"

#include "sardf/contour.hpp"

namespace sardf {

void HalfPlane::prepare() {
  const double size = std::hypot(normal[0], normal[1]);
  if (!(size > 0)) throw Error("normal is the zero vector; give a direction such as [1, 0]");
  unit_ = {normal[0] / size, normal[1] / size};
}

void Polygon::prepare() {
  if (!edges_.empty()) return;  // made by near()
  check_contour(vertices, "polygon");
  const double turn = doubled_area(vertices) > 0 ? 1 : -1;  // 1: counter-clockwise
  const size_t n = vertices.size();
  for (size_t i = 0; i < n; ++i) {
    const Vec2 &a = vertices[i], &b = vertices[i + 1 < n ? i + 1 : 0];
    Edge edge;
    edge.number = int(i);
    edge.from = a;
    edge.along = {b[0] - a[0], b[1] - a[1]};
    edge.squared = edge.along[0] * edge.along[0] + edge.along[1] * edge.along[1];
    const double length = std::sqrt(edge.squared);
    edge.line = {turn * edge.along[0] / length, turn * edge.along[1] / length};
    edge.lower = std::min(a[1], b[1]);
    edge.upper = std::max(a[1], b[1]);
    edge.up = b[1] > a[1] ? turn : -turn;
    edge.crosses = edge.lower < edge.upper;
    edges_.push_back(edge);
  }
}

std::optional<Polygon> Polygon::near(const Choice& x, const Choice& y) const {
  if (x.may_be_nan || y.may_be_nan) return {};
  std::vector<Foot<Choice>> feet;
  double nearest = infinity;
  for (const Edge& edge : edges_) {
    feet.push_back(foot_on(edge, x, y));
    if (edge.measures) nearest = min(nearest, feet.back().squared.range.hi);
  }
  Polygon out = *this;
  out.edges_.clear();
  out.has_corners_ = false;
  for (size_t i = 0; i < edges_.size(); ++i) {
    // Where an edge is not the nearest one, nothing of it counts.
    Edge edge = edges_[i];
    edge.measures = edge.measures && !(feet[i].squared.range.lo > nearest);
    out.edges_.push_back(edge);
    if (edge.measures && feet[i].corner.range.hi > 0) out.has_corners_ = has_corners_;
  }
  for (size_t i = 0; i < edges_.size(); ++i) {
    Edge& edge = out.edges_[i];
    if (!edge.crosses) continue;
    const IntervalMask crossed = is_crossed(edge, y, feet[i].line);
    edge.crosses = out.has_corners_ && crossed.can_hold && crossed.can_fail;
    if (!crossed.can_fail) out.parity_ = -out.parity_;
  }
  std::erase_if(out.edges_, [](const Edge& edge) { return !edge.measures && !edge.crosses; });
  if (4 * out.edges_.size() > 3 * edges_.size() && out.has_corners_ == has_corners_) return {};
  return out;
}

void Polygon::append_edges(std::vector<double>& numbers) const {
  if (edges_.size() == vertices.size() && has_corners_) return;
  // Numbers are taken for lengths where rounding is bounded: these must not be the largest.
  constexpr double tiny = 0x1p-200;
  for (const Edge& edge : edges_) {
    numbers.push_back(tiny * (4 * edge.number + 2 * edge.measures + edge.crosses));
  }
  numbers.push_back(tiny * (has_corners_ ? parity_ : 0));
}

}  // namespace sardf

#include "sardf/segment_set.hpp"

#include "sardf/ops_features.hpp"

namespace sardf {

namespace {

using Ends = SegmentSet::Ends;

// Fewer would make the tree deeper than it is worth, more would be searched in vain.
constexpr size_t segments_in_leaf = 4;

std::vector<Extent> extents(std::span<const Ends> segments) {
  std::vector<Extent> boxes(segments.size());
  for (size_t i = 0; i < boxes.size(); ++i) {
    boxes[i].add(segments[i].a);
    boxes[i].add(segments[i].b);
  }
  return boxes;
}

}  // namespace

SegmentSet::SegmentSet(std::string name, std::string doc, std::span<const double> data,
                       std::span<const Ends> segments)
    : PointSet(std::move(name), std::move(doc), data),
      tree_(extents(segments), segments_in_leaf),
      segments_(segments.size()) {
  for (size_t i = 0; i < segments_.size(); ++i) {
    const Ends& from = segments[tree_.order()[i]];
    const Vec3 along = from.b - from.a;
    const double squared = dot(along, along);
    // Where the square vanishes in rounding, so does the segment beside its ends' coordinates.
    segments_[i] = {from.a, along, squared > 1e-300 ? 1 / squared : 0};
  }
}

Nearest SegmentSet::nearest(const Vec3& point) const {
  if (is_out_of_range(point)) return nearest_out_of_range(point, segments_[0].a);
  double squared = infinity, best_at = 0;
  size_t best = 0;
  tree_.visit_near(point, squared, [&](size_t i) {
    const Stored& s = segments_[i];
    const Vec3 from = point - s.a;
    const double t = std::clamp(dot(from, s.along) * s.inverse, 0.0, 1.0);
    const Vec3 away = from - t * s.along;
    const double d = dot(away, away);
    if (d < squared) {
      squared = d;
      best = i;
      best_at = t;
    }
  });
  const Stored& s = segments_[best];
  Nearest found = nearest_at(point, best_at * s.along - (point - s.a), 0);
  found.part = best;
  found.parameters[0] = best_at;
  return found;
}

std::array<Vec3, 3> SegmentSet::jacobian(const Vec3&, const Nearest& at) const {
  const Stored& s = segments_[at.part];
  std::array<Vec3, 3> rows{};
  if (!(at.parameters[0] > 0 && at.parameters[0] < 1)) return rows;
  for (size_t k = 0; k < 3; ++k) rows[k] = s.along[k] * s.inverse * s.along;
  return rows;
}

PointSetPointer Points::as_set() const {
  if (at.size() <= most_in_formula) return nullptr;
  std::vector<Ends> all;
  std::vector<double> data;
  for (const Vec3& point : at) all.push_back({point, point});
  append_numbers(data, at);
  return std::make_shared<SegmentSet>(name, doc, data, all);
}

PointSetPointer Polyline::as_set() const {
  if (vertices.size() <= most_in_formula) return nullptr;
  std::vector<Ends> all;
  std::vector<double> data;
  for (size_t i = 0; i + 1 < vertices.size(); ++i) all.push_back({vertices[i], vertices[i + 1]});
  if (closed) all.push_back({vertices.back(), vertices.front()});
  append_numbers(data, vertices);
  append_numbers(data, closed);
  return std::make_shared<SegmentSet>(name, doc, data, all);
}

}  // namespace sardf

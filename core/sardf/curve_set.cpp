#include "sardf/curve_set.hpp"

#include "sardf/error.hpp"
#include "sardf/parameter.hpp"

namespace sardf {

namespace {

// Pieces are halved at most so often when the tree is made.
constexpr int most_halvings = 6;
constexpr size_t pieces_in_leaf = 1;
// CubicSearch proves more about straighter pieces: of 0.9, 0.95, 0.97 and 0.98 this was the fastest
// for an S of six spans.
constexpr double straight_cosine_of_cubics = 0.97;

std::vector<double> numbers_of(const CurveData& data) {
  std::vector<double> all;
  append_numbers(all, data.control_points);
  append_numbers(all, data.degree);
  append_numbers(all, data.knots);
  append_numbers(all, data.weights);
  append_numbers(all, data.closed);
  return all;
}

}  // namespace

double scale_of(const std::vector<Vec3>& points) {
  Extent all;
  for (const Vec3& p : points) all.add(p);
  return unit_scale(all.magnitude());
}

std::vector<Weighted> weighted_points(const std::vector<Vec3>& points,
                                      const std::vector<double>& weights, double scale) {
  if (!weights.empty() && weights.size() != points.size()) {
    throw Error("weights has " + std::to_string(weights.size()) + " elements; there are " +
                std::to_string(points.size()) + " control points");
  }
  for (size_t i = 0; i < weights.size(); ++i) {
    if (!(weights[i] > 0)) {
      throw Error("weights has " + std::to_string(weights[i]) + " as element " + std::to_string(i) +
                  "; positive weights are accepted");
    }
  }
  if (std::all_of(points.begin(), points.end(), [&](const Vec3& p) { return p == points[0]; })) {
    throw Error("all control points are equal, which leaves a single point; use 'point' for that");
  }
  std::vector<Weighted> all(points.size());
  for (size_t i = 0; i < all.size(); ++i) {
    const double w = weights.empty() ? 1 : weights[i];
    const Vec3 p = w * scale * points[i];
    all[i] = {p[0], p[1], p[2], w};
  }
  return all;
}

Extent extent_of(std::span<const Weighted> points) {
  Extent box;
  for (const Weighted& p : points) box.add(point_of(p));
  return box;
}

bool is_nearly_straight(const Weighted* points, int degree, size_t stride, double least_cosine) {
  constexpr double most_ratio = 1.5;
  const auto at = [&](int k) -> const Weighted& { return points[size_t(k) * stride]; };
  const Vec3 chord = point_of(at(degree)) - point_of(at(0));
  double least = at(0)[3], most = least;
  for (int k = 0; k < degree; ++k) {
    const Vec3 step = point_of(at(k + 1)) - point_of(at(k));
    if (dot(step, chord) < least_cosine * norm(step) * norm(chord)) return false;
    least = min(least, at(k + 1)[3]);
    most = max(most, at(k + 1)[3]);
  }
  return most <= most_ratio * least;
}

CurveSet::CurveSet(std::string name, std::string doc, const CurveData& data)
    : PointSet(std::move(name), std::move(doc), numbers_of(data)),
      rational_(!data.weights.empty()) {
  const size_t count = data.control_points.size();
  const std::vector<Span> spans = spans_of({data.degree, data.knots, data.closed, ""}, count);
  scale_ = scale_of(data.control_points);
  const std::vector<Weighted> control = weighted_points(data.control_points, data.weights, scale_);
  degree_ = int(data.degree);
  for (const Span& span : spans) {
    std::vector<Weighted> piece(size_t(degree_ + 1));
    for (int j = 0; j <= degree_; ++j) {
      for (int k = 0; k <= degree_; ++k) {
        piece[size_t(j)] =
            piece[size_t(j)] + span.weight(j, k) * control[(span.first + size_t(k)) % count];
      }
    }
    add_pieces(std::move(piece), 0);
  }
  sort_into_tree();
  rounding_ = 0x1p-51 * tree_->extent().magnitude();
  if (is_cubic()) cubic_.emplace(points_, *tree_);
}

void CurveSet::add_pieces(std::vector<Weighted> piece, int depth) {
  const double straight = is_cubic() ? straight_cosine_of_cubics : straight_cosine;
  if (depth == most_halvings || is_nearly_straight(piece.data(), degree_, 1, straight)) {
    points_.insert(points_.end(), piece.begin(), piece.end());
    return;
  }
  std::vector<Weighted> left(piece.size()), right(piece.size());
  split_bezier(piece.data(), degree_, 1, 0.5, left.data(), right.data());
  add_pieces(std::move(left), depth + 1);
  add_pieces(std::move(right), depth + 1);
}

void CurveSet::sort_into_tree() {
  const size_t each = size_t(degree_ + 1);
  std::vector<Extent> boxes;
  for (size_t i = 0; i < points_.size(); i += each) {
    boxes.push_back(extent_of({&points_[i], each}));
  }
  tree_ = std::make_unique<BoxTree>(boxes, pieces_in_leaf);
  std::vector<Weighted> sorted;
  for (const uint32_t piece : tree_->order()) {
    const auto first = points_.begin() + std::ptrdiff_t(piece * each);
    sorted.insert(sorted.end(), first, first + std::ptrdiff_t(each));
  }
  points_ = std::move(sorted);
}

std::array<Interval, 3> CurveSet::bounds() const {
  std::array<Interval, 3> sides = tree_->extent().intervals();
  for (Interval& side : sides) side = Interval{side.lo - rounding_, side.hi + rounding_} / scale_;
  return sides;
}

Nearest CurveSet::nearest(const Vec3& point) const {
  if (is_out_of_range(scale_ * point)) {
    return nearest_out_of_range(point, (1 / scale_) * point_of(points_[0]));
  }
  return cubic_ ? found_at(point, cubic_->nearest(scale_ * point)) : searched(point);
}

void CurveSet::nearest_points(const double* const* points, size_t n, Nearest* found) const {
  if (!cubic_) return PointSet::nearest_points(points, n, found);
  for (size_t i = 0; i < n; i += CubicSearch::most_points) {
    const double* const from[] = {points[0] + i, points[1] + i, points[2] + i};
    nearest_of_block(from, std::min(n - i, CubicSearch::most_points), found + i);
  }
}

void CurveSet::nearest_of_block(const double* const* points, size_t n, Nearest* found) const {
  std::array<std::array<double, CubicSearch::most_points>, 3> scaled;
  const size_t whole = (n + 7) / 8 * 8;
  bool is_in_range = true;
  for (size_t i = 0; i < whole; ++i) {
    for (size_t k = 0; k < 3; ++k) scaled[k][i] = scale_ * points[k][std::min(i, n - 1)];
    is_in_range = is_in_range && !is_out_of_range({scaled[0][i], scaled[1][i], scaled[2][i]});
  }
  if (!is_in_range) return PointSet::nearest_points(points, n, found);
  std::array<CubicFound, CubicSearch::most_points> all;
  cubic_->nearest({scaled[0].data(), scaled[1].data(), scaled[2].data()}, n, all.data());
  for (size_t i = 0; i < n; ++i) {
    found[i] = found_at({points[0][i], points[1][i], points[2][i]}, all[i]);
  }
}

Nearest CurveSet::found_at(const Vec3& point, const CubicFound& at) const {
  if (!at.is_proven) return searched(point);
  Nearest found = nearest_at(point, (1 / scale_) * at.toward, rounding_ / scale_);
  found.part = at.part;
  found.parameters[0] = at.parameter;
  return found;
}

Nearest CurveSet::searched(const Vec3& point) const {
  CurveSearch search;
  search.point = scale_ * point;
  search.rounding = rounding_;
  const size_t each = size_t(degree_ + 1);
  tree_->visit_near(search.point, search.squared, [&](size_t piece) {
    const Weighted* points = &points_[piece * each];
    rational_ ? search.visit<true>(points, degree_, piece)
              : search.visit<false>(points, degree_, piece);
  });
  search.polish(&points_[search.part * each], degree_);
  const CurvePoint at =
      curve_point(&points_[search.part * each], degree_, search.parameter, search.point);
  Nearest found = nearest_at(point, (1 / scale_) * at.at, rounding_ / scale_);
  found.part = search.part;
  found.parameters[0] = search.parameter;
  return found;
}

// The nearest point C(t) moves with the point p so that (C - p)·C' stays 0: dt = C'·dp / (|C'|² +
// (C - p)·C''). At a free end or a corner, where that product is not 0, it stays.
std::array<Vec3, 3> CurveSet::jacobian(const Vec3& point, const Nearest& found) const {
  const double t = found.parameters[0];
  const size_t each = size_t(degree_ + 1);
  const CurvePoint at = curve_point(&points_[found.part * each], degree_, t, scale_ * point);
  std::array<Vec3, 3> rows{};
  if ((t == 0 || t == 1) &&
      std::abs(dot(at.at, at.first)) > 1e-7 * norm(at.at) * norm(at.first) + rounding_) {
    return rows;
  }
  const double rise = dot(at.first, at.first) + dot(at.at, at.second);
  if (rise == 0) return rows;
  for (size_t k = 0; k < 3; ++k) rows[k] = at.first[k] / rise * at.first;
  return rows;
}

}  // namespace sardf

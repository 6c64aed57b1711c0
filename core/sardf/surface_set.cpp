#include "sardf/surface_set.hpp"

#include "sardf/curve_set.hpp"
#include "sardf/error.hpp"
#include "sardf/parameter.hpp"

namespace sardf {

namespace {

// Patches are halved at most so often when the tree is made.
constexpr int most_halvings = 6;
constexpr size_t patches_in_leaf = 1;

std::vector<double> numbers_of(const SurfaceData& data) {
  std::vector<double> all;
  append_numbers(all, data.control_points);
  for (const double degree : {data.degree_u, data.degree_v}) append_numbers(all, degree);
  for (const auto* list : {&data.knots_u, &data.knots_v, &data.weights}) append_numbers(all, *list);
  for (const bool closed : {data.closed_u, data.closed_v}) append_numbers(all, closed);
  return all;
}

std::vector<Vec3> flattened(const PointGrid& rows) {
  std::vector<Vec3> all;
  for (size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].size() != rows[0].size()) {
      throw Error("row " + std::to_string(i) + " of control_points has " +
                  std::to_string(rows[i].size()) + " points and row 0 has " +
                  std::to_string(rows[0].size()) + "; rows of one length are accepted");
    }
    all.insert(all.end(), rows[i].begin(), rows[i].end());
  }
  return all;
}

/// The Bezier points of one patch.
std::vector<Weighted> patch_of(const Span& u, const Span& v, const std::vector<Weighted>& control,
                               size_t rows, size_t columns) {
  std::vector<Weighted> patch;
  for (int i = 0; i <= u.degree; ++i) {
    for (int j = 0; j <= v.degree; ++j) {
      Weighted sum{};
      for (int k = 0; k <= u.degree; ++k) {
        for (int l = 0; l <= v.degree; ++l) {
          const size_t row = (u.first + size_t(k)) % rows, column = (v.first + size_t(l)) % columns;
          sum = sum + u.weight(i, k) * v.weight(j, l) * control[row * columns + column];
        }
      }
      patch.push_back(sum);
    }
  }
  return patch;
}

}  // namespace

SurfaceSet::SurfaceSet(std::string name, std::string doc, const SurfaceData& data)
    : PointSet(std::move(name), std::move(doc), numbers_of(data)) {
  const std::vector<Vec3> points = flattened(data.control_points);
  const size_t rows = data.control_points.size(), columns = data.control_points[0].size();
  const std::vector<Span> along_u =
      spans_of({data.degree_u, data.knots_u, data.closed_u, "_u"}, rows);
  const std::vector<Span> along_v =
      spans_of({data.degree_v, data.knots_v, data.closed_v, "_v"}, columns);
  scale_ = scale_of(points);
  const std::vector<Weighted> control = weighted_points(points, data.weights, scale_);
  degrees_ = {int(data.degree_u), int(data.degree_v)};
  for (const Span& u : along_u) {
    for (const Span& v : along_v) add_patches(patch_of(u, v, control, rows, columns), 0);
  }
  sort_into_tree();
  rounding_ = 0x1p-51 * tree_->extent().magnitude();
}

void SurfaceSet::add_patches(std::vector<Weighted> patch, int depth) {
  const size_t width = size_t(degrees_.v + 1);
  int axis = -1;
  for (size_t j = 0; j < width && axis < 0; ++j) {
    if (!is_nearly_straight(&patch[j], degrees_.u, width)) axis = 0;
  }
  const bool u_bends = axis == 0;
  for (size_t i = 0; i <= size_t(degrees_.u); ++i) {
    // Both directions in turn where both bend.
    if (!is_nearly_straight(&patch[i * width], degrees_.v, 1)) {
      axis = u_bends ? depth % 2 : 1;
      break;
    }
  }
  if (depth == most_halvings || axis < 0) {
    points_.insert(points_.end(), patch.begin(), patch.end());
    return;
  }
  std::vector<Weighted> left(patch.size()), right(patch.size());
  split_patch(patch.data(), degrees_, axis, 0.5, left.data(), right.data());
  add_patches(std::move(left), depth + 1);
  add_patches(std::move(right), depth + 1);
}

void SurfaceSet::sort_into_tree() {
  const size_t each = degrees_.points();
  std::vector<Extent> boxes;
  for (size_t i = 0; i < points_.size(); i += each) {
    boxes.push_back(extent_of({&points_[i], each}));
  }
  tree_ = std::make_unique<BoxTree>(boxes, patches_in_leaf);
  std::vector<Weighted> sorted;
  for (const uint32_t patch : tree_->order()) {
    const auto first = points_.begin() + std::ptrdiff_t(patch * each);
    sorted.insert(sorted.end(), first, first + std::ptrdiff_t(each));
  }
  points_ = std::move(sorted);
}

std::array<Interval, 3> SurfaceSet::bounds() const {
  std::array<Interval, 3> sides = tree_->extent().intervals();
  for (Interval& side : sides) side = Interval{side.lo - rounding_, side.hi + rounding_} / scale_;
  return sides;
}

Nearest SurfaceSet::nearest(const Vec3& point) const {
  if (is_out_of_range(scale_ * point)) {
    return nearest_out_of_range(point, (1 / scale_) * point_of(points_[0]));
  }
  SurfaceSearch search;
  search.point = scale_ * point;
  search.rounding = rounding_;
  const size_t each = degrees_.points();
  tree_->visit_near(search.point, search.squared,
                    [&](size_t patch) { search.visit(&points_[patch * each], degrees_, patch); });
  search.polish(&points_[search.part * each], degrees_);
  const SurfacePoint at =
      surface_point(&points_[search.part * each], degrees_, search.parameters, search.point);
  Nearest found = nearest_at(point, (1 / scale_) * at.at, rounding_ / scale_);
  found.part = search.part;
  found.parameters = search.parameters;
  return found;
}

// The nearest point S moves with the point p so that (S - p)·S_u and (S - p)·S_v stay 0, except
// for a parameter that is held by an edge of the surface or a crease.
std::array<Vec3, 3> SurfaceSet::jacobian(const Vec3& point, const Nearest& found) const {
  const Vec2& x = found.parameters;
  const SurfacePoint p =
      surface_point(&points_[found.part * degrees_.points()], degrees_, x, scale_ * point);
  const auto is_held = [&](double t, const Vec3& along) {
    return (t == 0 || t == 1) &&
           std::abs(dot(p.at, along)) > 1e-7 * norm(p.at) * norm(along) + rounding_;
  };
  const bool held_u = is_held(x[0], p.u), held_v = is_held(x[1], p.v);
  const double uu = dot(p.u, p.u) + dot(p.at, p.uu), vv = dot(p.v, p.v) + dot(p.at, p.vv);
  const double uv = dot(p.u, p.v) + dot(p.at, p.uv), determinant = uu * vv - uv * uv;
  std::array<Vec3, 3> rows{};
  for (size_t k = 0; k < 3; ++k) {
    if (!held_u && !held_v && determinant != 0) {
      rows[k] = (vv / determinant * p.u[k] - uv / determinant * p.v[k]) * p.u +
                (uu / determinant * p.v[k] - uv / determinant * p.u[k]) * p.v;
    } else if (!held_u && (held_v || vv == 0) && uu != 0) {
      rows[k] = p.u[k] / uu * p.u;
    } else if (!held_v && (held_u || uu == 0) && vv != 0) {
      rows[k] = p.v[k] / vv * p.v;
    }
  }
  return rows;
}

}  // namespace sardf

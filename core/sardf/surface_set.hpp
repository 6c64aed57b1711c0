// A B-spline surface as a set of points.
#pragma once

#include "sardf/box_tree.hpp"
#include "sardf/field.hpp"
#include "sardf/surface_search.hpp"

namespace sardf {

/// What a B-spline surface is made from: u counts the rows of control points, v goes along them;
/// weights row after row. No weights: all are 1.
struct SurfaceData {
  PointGrid control_points;
  double degree_u = 3, degree_v = 3;
  std::vector<double> knots_u, knots_v, weights;
  bool closed_u = false, closed_v = false;
};

/// The surface, cut into Bezier patches that bend by less than a right angle, in a tree.
class SurfaceSet final : public PointSet {
 public:
  /// Throws Error for what spans_of rejects in either direction, for rows of different lengths, for
  /// a wrong number of weights, for weights that are not positive, and for control points that are
  /// all equal.
  SurfaceSet(std::string name, std::string doc, const SurfaceData& data);

  Nearest nearest(const Vec3& point) const override;
  std::array<Vec3, 3> jacobian(const Vec3& point, const Nearest& at) const override;
  std::array<Interval, 3> bounds() const override;
  /// Number of patches searched.
  size_t pieces() const { return points_.size() / degrees_.points(); }

 private:
  void add_patches(std::vector<Weighted> patch, int depth);
  void sort_into_tree();

  PatchDegrees degrees_{};
  double scale_ = 1, rounding_ = 0;  // coordinates are stored times the scale, a power of two
  std::vector<Weighted> points_;     // rows of v, one for each u, in the tree's order
  std::unique_ptr<BoxTree> tree_;
};

}  // namespace sardf

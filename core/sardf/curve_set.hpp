// A B-spline curve as a set of points.
#pragma once

#include <optional>

#include "sardf/box_tree.hpp"
#include "sardf/cubic_search.hpp"
#include "sardf/curve_search.hpp"

namespace sardf {

/// What a B-spline curve is made from. No weights: all are 1.
struct CurveData {
  std::vector<Vec3> control_points;
  double degree = 3;
  std::vector<double> knots, weights;
  bool closed = false;
};

/// The curve, cut into Bezier pieces that turn by less than a right angle, in a tree. Cubic ones
/// without weights go through CubicSearch; what that does not prove, and all else, through
/// CurveSearch.
class CurveSet final : public PointSet {
 public:
  /// Throws Error for what spans_of rejects, for a wrong number of weights, for weights that are
  /// not positive, and for control points that are all equal.
  CurveSet(std::string name, std::string doc, const CurveData& data);

  Nearest nearest(const Vec3& point) const override;
  void nearest_points(const double* const* points, size_t n, Nearest* found) const override;
  std::array<Vec3, 3> jacobian(const Vec3& point, const Nearest& at) const override;
  std::array<Interval, 3> bounds() const override;
  /// Number of pieces searched.
  size_t pieces() const { return points_.size() / size_t(degree_ + 1); }

 private:
  bool is_cubic() const { return degree_ == 3 && !rational_; }
  void add_pieces(std::vector<Weighted> piece, int depth);
  void sort_into_tree();
  void nearest_of_block(const double* const* points, size_t n, Nearest* found) const;
  Nearest searched(const Vec3& point) const;
  Nearest found_at(const Vec3& point, const CubicFound& found) const;

  bool rational_;
  int degree_ = 0;
  double scale_ = 1, rounding_ = 0;  // coordinates are stored times the scale, a power of two
  std::vector<Weighted> points_;     // degree + 1 for each piece, in the tree's order
  std::unique_ptr<BoxTree> tree_;
  std::optional<CubicSearch> cubic_;  // if is_cubic()
};

/// Weighted control points times `scale`; throws Error as CurveSet and SurfaceSet say.
std::vector<Weighted> weighted_points(const std::vector<Vec3>& points,
                                      const std::vector<double>& weights, double scale);
/// 1 for points without extent.
double scale_of(const std::vector<Vec3>& points);
/// The extent of Bezier points.
Extent extent_of(std::span<const Weighted> points);
/// Pieces of curves and surfaces turn less than by this: less than a right angle.
constexpr double straight_cosine = 0.9;
/// Whether the steps along Bezier points turn little, to a cosine of `least_cosine` with the chord,
/// and their weights are alike.
bool is_nearly_straight(const Weighted* points, int degree, size_t stride,
                        double least_cosine = straight_cosine);

}  // namespace sardf

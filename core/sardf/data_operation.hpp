// Operations that carry data instead of a formula: distances found by a search, sampled or fitted
// functions. They evaluate in double whatever is asked for, so float results are the double ones
// rounded.
#pragma once

#include <atomic>
#include <span>
#include <string>
#include <vector>

#include "sardf/operation.hpp"
#include "sardf/vec.hpp"

namespace sardf {

/// Two numbers that tell data apart, for Operation::numbers(): equal for equal bytes, and with
/// near certainty different for others.
std::vector<double> fingerprint(std::span<const double> data);

class DataOperation : public Operation {
 public:
  /// `identity`: equal for operations of one name that compute the same.
  DataOperation(OperationInfo info, std::vector<double> identity);

  const OperationInfo& info() const override { return info_; }
  const std::vector<double>& numbers() const override { return identity_; }
  /// Of what its data are nothing is rounded to single precision but results.
  double scale() const override { return 0; }
  bool has_formula() const override { return false; }
  /// Never called: there is no formula.
  void record(Trace& trace) const override;

  double evaluate(const double* in) const override;
  void evaluate(const double* const* in, double* out, size_t n) const override = 0;
  const Kernels& kernels() const override;
  const void* object() const override { return this; }

  double blend_error() const override { return 0; }
  double gain(const Interval* in) const override;
  bool is_distance() const override { return false; }
  Join join() const override { return Join::none; }

  /// From bounds of the partial derivatives over the box; `steepest` bounds the gradient's length.
  Slope slope_from(const Slope* in, Interval value, std::span<const Interval> partials,
                   double steepest) const;

 private:
  OperationInfo info_;
  std::vector<double> identity_;
};

/// The point of a set that is nearest to another point.
struct Nearest {
  Vec3 point{};
  double distance = 0;  // to it; of a solid, negative outside and positive inside
  Vec3 gradient{};      // of the distance; NaN where it has no direction
  /// Where on the set, as the set counts its parts: what `jacobian` needs to know.
  uint64_t part = 0;
  Vec2 parameters{};
};

/// A closed set of points in space, with its exact distance.
class PointSet {
 public:
  /// `name`, `doc`: of the constructor; `data`: what the set is made of.
  PointSet(std::string name, std::string doc, std::span<const double> data);
  virtual ~PointSet() = default;

  /// Exact to 1e-9 of the distance, or 1e-12 of the set's size where that is more.
  virtual Nearest nearest(const Vec3& point) const = 0;
  /// The same, where the answer for a point `beside` it is known: that may save time, and changes
  /// nothing.
  virtual Nearest nearest_beside(const Vec3& point, const Vec3& beside, const Nearest& known) const;
  /// The same for n points, at least one, by coordinate. What stands beside a point changes
  /// nothing.
  virtual void nearest_points(const double* const* points, size_t n, Nearest* found) const;
  /// Whether, in this ball or its neighbourhood, the distance may change its sign where it is not
  /// 0: there it is no distance, and its slope is infinite. With an infinite radius: anywhere.
  virtual bool may_jump(const Vec3& centre, double radius) const;
  /// Derivatives of the nearest point by the point: row k is the gradient of its coordinate k.
  /// Symmetric and not negative definite; where the nearest point jumps, of the one found.
  virtual std::array<Vec3, 3> jacobian(const Vec3& point, const Nearest& at) const = 0;
  /// Encloses the set.
  virtual std::array<Interval, 3> bounds() const = 0;
  /// Bound of the error of `nearest(...).distance` for points of the box's size and distance.
  double accuracy(double distance) const;
  virtual Kind kind() const { return Kind::feature; }

  const std::string& name() const { return name_; }
  const std::string& doc() const { return doc_; }
  const std::vector<double>& identity() const { return identity_; }
  uint64_t serial() const { return serial_; }

 private:
  std::string name_, doc_;
  std::vector<double> identity_;
  uint64_t serial_;  // never reused, unlike addresses
};

using PointSetPointer = std::shared_ptr<const PointSet>;

/// The distance to a set, as an operation on a point's three coordinates. The searches of one block
/// of points are shared by all operations on it, the derivatives' included.
OperationPointer distance_operation(PointSetPointer set);
/// Coordinate 0, 1 or 2 of the nearest point. Its derivatives are operations of the same kind, by
/// PointSet::jacobian; those have none: Error.
OperationPointer nearest_operation(PointSetPointer set, int axis);

}  // namespace sardf

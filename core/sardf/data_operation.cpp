#include "sardf/data_operation.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>

#include "sardf/arithmetic.hpp"
#include "sardf/error.hpp"
#include "sardf/operation_of.hpp"

namespace sardf {

namespace {

// Float in, float out, through double.
class FloatBlock {
 public:
  FloatBlock(const float* const* in, int arity, size_t n) : values_((arity + 1) * n), n_(n) {
    for (int k = 0; k < arity; ++k) {
      std::copy_n(in[k], n, &values_[k * n]);
      in_[k] = &values_[k * n];
    }
    out_ = &values_[arity * n];
  }
  const double* const* in() const { return in_.data(); }
  double* out() { return out_; }
  void store(float* to) const {
    for (size_t i = 0; i < n_; ++i) to[i] = float(out_[i]);
  }

 private:
  std::vector<double> values_;
  std::array<const double*, max_arity> in_{};
  double* out_;
  size_t n_;
};

const DataOperation& operation_at(const void* object) {
  return *static_cast<const DataOperation*>(object);
}

void float_values(const void* object, const float* const* in, float* out, size_t n) {
  const DataOperation& operation = operation_at(object);
  FloatBlock block(in, operation.info().arity, n);
  operation.evaluate(block.in(), block.out(), n);
  block.store(out);
}

void float_partials(const void* object, const float* const* in, float* out, float* const* partial,
                    size_t n) {
  const DataOperation& operation = operation_at(object);
  const int arity = operation.info().arity;
  FloatBlock block(in, arity, n);
  std::vector<double> partials(arity * n);
  std::array<double*, max_arity> to{};
  for (int k = 0; k < arity; ++k) to[k] = &partials[k * n];
  operation.partials(block.in(), block.out(), to.data(), n);
  block.store(out);
  for (int k = 0; k < arity; ++k) {
    for (size_t i = 0; i < n; ++i) partial[k][i] = float(to[k][i]);
  }
}

}  // namespace

std::vector<double> fingerprint(std::span<const double> data) {
  // Two 64-bit mixes of the bytes with different multipliers; 52 bits of each are a whole number.
  uint64_t a = 0x9E3779B97F4A7C15ull + data.size(), b = 0xC2B2AE3D27D4EB4Full ^ data.size();
  for (const double number : data) {
    const uint64_t word = std::bit_cast<uint64_t>(number);
    a = std::rotl((a ^ word) * 0xBF58476D1CE4E5B9ull, 29);
    b = std::rotl((b + word) * 0x94D049BB133111EBull, 37) ^ a;
  }
  return {double(a >> 12), double(b >> 12)};
}

DataOperation::DataOperation(OperationInfo info, std::vector<double> identity)
    : info_(std::move(info)), identity_(std::move(identity)) {}

void DataOperation::record(Trace&) const { assert(false); }

double DataOperation::evaluate(const double* in) const {
  std::array<const double*, max_arity> at{};
  for (int k = 0; k < info_.arity; ++k) at[k] = in + k;
  double out;
  evaluate(at.data(), &out, 1);
  return out;
}

const Kernels& DataOperation::kernels() const {
  static const Kernels through_double{&float_values, &float_partials};
  return through_double;
}

double DataOperation::gain(const Interval* in) const {
  std::array<Slope, max_arity> unknown;
  double sum = 0;
  for (int k = 0; k < info_.arity; ++k) {
    for (int other = 0; other < info_.arity; ++other) {
      unknown[other] = {in[other], {}, other == k ? 1.0 : 0.0};
      if (other == k) unknown[other].partial[0] = 1;
    }
    sum = rounded_up(sum + slope(unknown.data()).partial[0].magnitude());
  }
  return sum;
}

Slope DataOperation::slope_from(const Slope* in, Interval value, std::span<const Interval> partials,
                                double steepest) const {
  Slope out;
  out.value = value;
  double sum = 0;
  for (size_t k = 0; k < partials.size(); ++k) {
    for (int axis = 0; axis < 3; ++axis) {
      out.partial[axis] = out.partial[axis] + partials[k] * in[k].partial[axis];
    }
    const double by = partials[k].magnitude();
    if (by > 0 && in[k].length > 0) sum = rounded_up(sum + rounded_up(by * in[k].length));
  }
  const Interval norm = length(out.partial[0], out.partial[1], out.partial[2]);
  out.length =
      min(min(norm.hi, sum), rounded_up(steepest * spectral_bound({in, size_t(info_.arity)})));
  return out;
}

PointSet::PointSet(std::string name, std::string doc, std::span<const double> data)
    : name_(std::move(name)), doc_(std::move(doc)), identity_(fingerprint(data)) {
  static std::atomic<uint64_t> made{0};
  serial_ = ++made;
}

Nearest PointSet::nearest_beside(const Vec3& point, const Vec3&, const Nearest&) const {
  return nearest(point);
}

void PointSet::nearest_points(const double* const* points, size_t n, Nearest* found) const {
  const auto at = [points](size_t i) { return Vec3{points[0][i], points[1][i], points[2][i]}; };
  found[0] = nearest(at(0));
  for (size_t i = 1; i < n; ++i) {
    const Vec3 point = at(i), before = at(i - 1);
    // Blocks are filled up with copies of their last point.
    found[i] = point == before ? found[i - 1] : nearest_beside(point, before, found[i - 1]);
  }
}

bool PointSet::may_jump(const Vec3&, double) const { return false; }

double PointSet::accuracy(double distance) const {
  double size = 0;
  for (const Interval& side : bounds()) size = max(size, side.magnitude());
  return 1e-9 * std::abs(distance) + 1e-12 * size;
}

namespace {

/// Row k: the gradient of coordinate k of the nearest point.
using Jacobian = std::array<Vec3, 3>;

/// The searches of the last few blocks of points on this thread.
class RecentSearches {
 public:
  const std::vector<Nearest>& of(const PointSet& set, const double* const* in, size_t n) {
    return block_of(set, in, n).found;
  }
  const std::vector<Jacobian>& jacobians(const PointSet& set, const double* const* in, size_t n) {
    return block_of(set, in, n).derived(set);
  }

 private:
  struct Block {
    uint64_t serial = 0;
    std::array<std::vector<double>, 3> at;
    std::vector<Nearest> found;
    std::vector<Jacobian> jacobians;  // empty until they are asked for

    bool is_of(const PointSet& set, const double* const* in, size_t n) const {
      if (serial != set.serial() || found.size() != n) return false;
      for (int k = 0; k < 3; ++k) {
        if (std::memcmp(at[k].data(), in[k], n * sizeof(double)) != 0) return false;
      }
      return true;
    }
    void fill(const PointSet& set, const double* const* in, size_t n) {
      serial = 0;
      jacobians.clear();
      for (int k = 0; k < 3; ++k) at[k].assign(in[k], in[k] + n);
      found.resize(n);
      if (n > 0) set.nearest_points(in, n, found.data());
      serial = set.serial();
    }
    const std::vector<Jacobian>& derived(const PointSet& set) {
      if (!jacobians.empty()) return jacobians;
      jacobians.resize(found.size());
      for (size_t i = 0; i < found.size(); ++i) {
        jacobians[i] = set.jacobian({at[0][i], at[1][i], at[2][i]}, found[i]);
      }
      return jacobians;
    }
  };

  Block& block_of(const PointSet& set, const double* const* in, size_t n) {
    for (Block& block : blocks_) {
      if (block.is_of(set, in, n)) return block;
    }
    Block& oldest = blocks_[next_++ % blocks_.size()];
    oldest.fill(set, in, n);
    return oldest;
  }

  std::array<Block, 8> blocks_;
  size_t next_ = 0;
};

RecentSearches& recent_searches() {
  thread_local RecentSearches recent;
  return recent;
}

const std::vector<Nearest>& searched(const PointSet& set, const double* const* in, size_t n) {
  return recent_searches().of(set, in, n);
}

struct Ball {
  Vec3 centre;
  double radius;
};

Ball ball_around(const Interval* in) {
  Ball ball{};
  double squared = 0;
  for (int k = 0; k < 3; ++k) {
    ball.centre[k] = in[k].lo + 0.5 * (in[k].hi - in[k].lo);
    const double half = max(in[k].hi - ball.centre[k], ball.centre[k] - in[k].lo);
    squared += half * half;
  }
  ball.radius = std::sqrt(squared) * (1 + 8 * 0x1p-52);
  return ball;
}

class DistanceOperation final : public DataOperation {
 public:
  explicit DistanceOperation(PointSetPointer set)
      : DataOperation({set->name(), set->kind(), 3, set->doc()}, set->identity()), set_(set) {}

  bool is_distance() const override { return !set_->may_jump({}, infinity); }

  void evaluate(const double* const* in, double* out, size_t n) const override {
    const std::vector<Nearest>& found = searched(*set_, in, n);
    for (size_t i = 0; i < n; ++i) out[i] = found[i].distance;
  }
  using DataOperation::evaluate;

  void partials(const double* const* in, double* out, double* const* partial,
                size_t n) const override {
    const std::vector<Nearest>& found = searched(*set_, in, n);
    for (size_t i = 0; i < n; ++i) {
      out[i] = found[i].distance;
      for (int k = 0; k < 3; ++k) partial[k][i] = found[i].gradient[k];
    }
  }

  Interval interval(const Interval* in) const override {
    const Ball ball = ball_around(in);
    if (!(ball.radius < infinity)) {
      return set_->kind() == Kind::feature ? Interval{0, infinity} : Interval::all();
    }
    const double d = set_->nearest(ball.centre).distance;
    if (std::isnan(d)) return Interval::all();
    // The value at any point of the box has the search's error, too.
    const double most = ball.radius + 2 * set_->accuracy(std::abs(d) + ball.radius);
    Interval value{rounded_down(d - most), rounded_up(d + most)};
    if (set_->may_jump(ball.centre, ball.radius)) {
      value.hi = rounded_up(std::abs(d) + most);
      value.lo = -value.hi;
    }
    if (set_->kind() == Kind::feature) value.lo = max(value.lo, 0.0);
    return value;
  }

  Slope slope(const Slope* in) const override {
    const std::array<Interval, 3> values{in[0].value, in[1].value, in[2].value};
    const Ball ball = ball_around(values.data());
    const bool jumps = set_->may_jump(ball.centre, ball.radius);
    const Interval partial = jumps ? Interval::all() : Interval{-1, 1};
    const std::array<Interval, 3> partials{partial, partial, partial};
    return slope_from(in, interval(values.data()), partials, jumps ? infinity : 1);
  }

  // The gradient of a distance points away from the nearest point.
  Expression derivative(int k, std::span<const Expression> inputs) const override {
    const Expression nearest = call(nearest_operation(set_, k), inputs);
    const Expression distance = call(std::make_shared<DistanceOperation>(set_), inputs);
    return (inputs[size_t(k)] - nearest) / distance;
  }

 private:
  PointSetPointer set_;
};

/// The derivative of a coordinate of the nearest point by a coordinate of the point.
///
/// Half the squared distance less half of |p|² is a minimum of linear functions, so concave, and
/// its second derivatives are those of the nearest point, negated: on the diagonal these are not
/// negative, also across the jumps. Towards a centre of curvature they grow beyond all bounds.
class JacobianOperation final : public DataOperation {
 public:
  /// The first axis is not after the second.
  JacobianOperation(PointSetPointer set, std::pair<int, int> axes)
      : DataOperation(
            {set->name() + "_nearest_" + char('x' + axes.first) + "_by_" + char('x' + axes.second),
             Kind::internal, 3, "A derivative of a coordinate of the nearest point."},
            set->identity()),
        set_(set),
        axes_(axes) {}

  void evaluate(const double* const* in, double* out, size_t n) const override {
    const std::vector<Nearest>& found = searched(*set_, in, n);
    const std::vector<Jacobian>& derived = recent_searches().jacobians(*set_, in, n);
    for (size_t i = 0; i < n; ++i) {
      const double value = derived[i][size_t(axes_.first)][size_t(axes_.second)];
      // Where rounding is all there is left, it may be of either sign, and overflow.
      const bool is_lost = !std::isfinite(value) || (axes_.first == axes_.second && value < 0);
      out[i] = std::isnan(found[i].distance) ? found[i].distance : is_lost ? 0 : value;
    }
  }
  using DataOperation::evaluate;

  std::string no_derivatives() const override {
    return "third derivatives of a distance found by a search ('" + set_->name() +
           "') are not known";
  }
  void partials(const double* const*, double*, double* const*, size_t) const override {
    throw Error(no_derivatives());
  }

  Interval interval(const Interval*) const override {
    return axes_.first == axes_.second ? Interval{0, infinity} : Interval::all();
  }

  Slope slope(const Slope* in) const override {
    const std::array<Interval, 3> values{in[0].value, in[1].value, in[2].value};
    const std::array<Interval, 3> partials{Interval::all(), Interval::all(), Interval::all()};
    return slope_from(in, interval(values.data()), partials, infinity);
  }

 private:
  PointSetPointer set_;
  std::pair<int, int> axes_;
};

class NearestOperation final : public DataOperation {
 public:
  NearestOperation(PointSetPointer set, int axis)
      : DataOperation({set->name() + "_nearest_" + char('x' + axis), Kind::internal, 3,
                       "A coordinate of the nearest point."},
                      set->identity()),
        set_(set),
        axis_(axis),
        whole_(set->bounds()[size_t(axis)]) {}

  void evaluate(const double* const* in, double* out, size_t n) const override {
    const std::vector<Nearest>& found = searched(*set_, in, n);
    for (size_t i = 0; i < n; ++i) out[i] = coordinate_of(found[i]);
  }
  using DataOperation::evaluate;

  void partials(const double* const* in, double* out, double* const* partial,
                size_t n) const override {
    evaluate(in, out, n);
    const std::vector<Jacobian>& derived = recent_searches().jacobians(*set_, in, n);
    for (size_t i = 0; i < n; ++i) {
      for (int k = 0; k < 3; ++k) partial[k][i] = derived[i][size_t(axis_)][k];
    }
  }

  // The nearest point is no farther from any point of the box than the distance there.
  Interval interval(const Interval* in) const override {
    const Ball ball = ball_around(in);
    if (!(ball.radius < infinity)) return whole_;
    const double d = std::abs(set_->nearest(ball.centre).distance);
    if (std::isnan(d)) return whole_;
    const double reach = d + ball.radius + 2 * set_->accuracy(d + ball.radius);
    const Interval near{rounded_down(in[axis_].lo - reach), rounded_up(in[axis_].hi + reach)};
    return intersect(whole_, near);
  }

  // It jumps where two points of the set are equally near.
  Slope slope(const Slope* in) const override {
    const std::array<Interval, 3> values{in[0].value, in[1].value, in[2].value};
    const std::array<Interval, 3> partials{Interval::all(), Interval::all(), Interval::all()};
    return slope_from(in, interval(values.data()), partials, infinity);
  }

  // Symmetric: p less the nearest point is the gradient of half the squared distance.
  Expression derivative(int k, std::span<const Expression> inputs) const override {
    return call(std::make_shared<JacobianOperation>(set_, std::minmax(axis_, k)), inputs);
  }

 private:
  // Seen from very far away, rounding would move the point out of the set's bounds.
  double coordinate_of(const Nearest& found) const {
    return std::clamp(found.point[axis_], whole_.lo, whole_.hi);
  }

  PointSetPointer set_;
  int axis_;
  Interval whole_;  // the set, along the axis
};

}  // namespace

OperationPointer distance_operation(PointSetPointer set) {
  return std::make_shared<DistanceOperation>(std::move(set));
}

OperationPointer nearest_operation(PointSetPointer set, int axis) {
  return std::make_shared<NearestOperation>(std::move(set), axis);
}

}  // namespace sardf

#include "sardf/spline_operation.hpp"

#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

#include "sardf/data_operation.hpp"
#include "sardf/graph.hpp"
#include "sardf/spline_bounds.hpp"

namespace sardf {

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

using Flags = std::array<bool, 3>;

std::vector<double> identity_of(const SplineGrid& grid, const std::vector<double>& coefficients,
                                const Flags& derived) {
  std::vector<double> numbers{double(grid.dimensions)};
  for (size_t k = 0; k < 3; ++k) {
    numbers.insert(numbers.end(), {grid.lower[k], grid.upper[k], double(grid.counts[k]),
                                   double(grid.degrees[k]), double(derived[k])});
  }
  const std::vector<double> data = fingerprint(coefficients);
  numbers.insert(numbers.end(), data.begin(), data.end());
  return numbers;
}

template <int N>
using Fixed = std::integral_constant<int, N>;

// Where a point lies, with the values of the functions there.
struct Weights {
  std::array<SplinePlace, 3> place;
  double value[3][most_spline_weights], slope[3][most_spline_weights];
};

class SplineOperation final : public DataOperation {
 public:
  SplineOperation(const SplineGrid& grid, std::vector<double> coefficients, Flags derived)
      : DataOperation({is_any(derived) ? "spline_field_derivative" : "spline_field", Kind::internal,
                       grid.dimensions, "A sum of tensor-product B-splines."},
                      identity_of(grid, coefficients, derived)),
        grid_(grid),
        coefficients_(std::move(coefficients)),
        derived_(derived),
        bounds_(grid_, coefficients_) {}

  bool is_quick() const override { return true; }

  using DataOperation::evaluate;
  void evaluate(const double* const* in, double* out, size_t n) const override {
    with_degrees([&](auto x, auto y, auto z) { values(in, out, n, x, y, z); });
  }

  void partials(const double* const* in, double* out, double* const* partial,
                size_t n) const override {
    for (size_t i = 0; i < n; ++i) {
      double slopes[3];
      const Vec3 at = point(in, i);
      out[i] = value_and_slopes(at, slopes);
      for (int k = 0; k < grid_.dimensions; ++k) partial[k][i] = slopes[k];
    }
  }

  Interval interval(const Interval* in) const override {
    std::array<Interval, 3> box;
    bool beyond = false;
    for (int k = 0; k < 3; ++k) {
      box[k] = k < grid_.dimensions ? in[k] : Interval{0, 1};
      if (!(box[k].lo <= box[k].hi)) return Interval::all();
      if (!derived_[k]) continue;
      if (box[k].lo > grid_.upper[k] || box[k].hi < grid_.lower[k]) return 0;
      beyond = beyond || reaches_out(box[k], k);
    }
    const Interval inside = bounds_.values(box);
    return beyond ? hull(inside, 0) : inside;
  }

  Slope slope(const Slope* in) const override {
    std::array<Interval, 3> box{Interval{0, 1}, Interval{0, 1}, Interval{0, 1}}, by;
    for (int k = 0; k < grid_.dimensions; ++k) box[k] = in[k].value;
    Interval squares = 0;
    for (int k = 0; k < grid_.dimensions; ++k) {
      by[k] = partial_over(box, k);
      squares = squares + square(by[k]);
    }
    return slope_from(in, interval(box.data()), {by.data(), size_t(grid_.dimensions)},
                      sqrt(squares).hi);
  }

  SplineReach reach() const {
    SplineReach out{{Interval::all(), Interval::all(), Interval::all()}, derived_};
    for (int k = 0; k < grid_.dimensions; ++k) out.box[k] = {grid_.lower[k], grid_.upper[k]};
    return out;
  }

  Expression derivative(int k, std::span<const Expression> inputs) const override {
    if (grid_.degrees[size_t(k)] == 0) return nullptr;
    SplineGrid less = grid_;
    --less.degrees[size_t(k)];
    --less.counts[size_t(k)];
    std::vector<double> differences(less.size());
    std::array<int, 3> step{};
    step[size_t(k)] = 1;
    size_t next = 0;
    for (int x = 0; x < less.counts[0]; ++x) {
      for (int y = 0; y < less.counts[1]; ++y) {
        for (int z = 0; z < less.counts[2]; ++z) {
          const double a = coefficients_[grid_.index(x, y, z)];
          const double b = coefficients_[grid_.index(x + step[0], y + step[1], z + step[2])];
          differences[next++] = (b - a) * grid_.per_length(k);
        }
      }
    }
    Flags derived = derived_;
    derived[size_t(k)] = true;
    return call(std::make_shared<SplineOperation>(less, std::move(differences), derived), inputs);
  }

 private:
  static bool is_any(const Flags& flags) { return flags[0] || flags[1] || flags[2]; }

  Vec3 point(const double* const* in, size_t i) const {
    return {in[0][i], in[1][i], grid_.dimensions == 3 ? in[2][i] : 0.5};
  }
  bool reaches_out(const Interval& side, int k) const {
    return side.lo < grid_.lower[k] || side.hi > grid_.upper[k];
  }
  bool is_outside(const Vec3& at, size_t k) const {
    return at[k] < grid_.lower[k] || at[k] > grid_.upper[k];
  }
  // A derivative is 0 where the function is continued without change.
  bool is_zero(const Vec3& at) const {
    for (size_t k = 0; k < 3; ++k) {
      if (derived_[k] && is_outside(at, k)) return true;
    }
    return false;
  }

  // action(degrees), as constants for what is common, so that loops are unrolled.
  template <class Action>
  void with_degrees(Action action) const {
    const auto& d = grid_.degrees;
    if (d == std::array<int, 3>{3, 3, 3}) return action(Fixed<3>{}, Fixed<3>{}, Fixed<3>{});
    if (d == std::array<int, 3>{3, 3, 0}) return action(Fixed<3>{}, Fixed<3>{}, Fixed<0>{});
    action(d[0], d[1], d[2]);
  }

  template <class X, class Y, class Z>
  void values(const double* const* in, double* out, size_t n, X dx, Y dy, Z dz) const {
    Weights w;
    for (size_t i = 0; i < n; ++i) {
      const Vec3 at = point(in, i);
      for (int k = 0; k < 3; ++k) w.place[k] = grid_.place(k, at[k]);
      spline_weights(dx, &w.place[0].t, 0, w.value[0]);
      spline_weights(dy, &w.place[1].t, 0, w.value[1]);
      spline_weights(dz, &w.place[2].t, 0, w.value[2]);
      double sum = 0;
      for (int a = 0; a <= dx; ++a) {
        double plane = 0;
        for (int b = 0; b <= dy; ++b) {
          const double* row = first_of_row(w, a, b);
          double line = 0;
          for (int c = 0; c <= dz; ++c) line += w.value[2][c] * row[c];
          plane += w.value[1][b] * line;
        }
        sum += w.value[0][a] * plane;
      }
      out[i] = std::isnan(at[0] + at[1] + at[2]) && is_unknown(at) ? not_a_number
               : is_zero(at)                                       ? 0
                                                                   : sum;
    }
  }

  // Infinities of both signs add up to NaN, too.
  static bool is_unknown(const Vec3& at) {
    return std::isnan(at[0]) || std::isnan(at[1]) || std::isnan(at[2]);
  }

  const double* first_of_row(const Weights& w, int a, int b) const {
    return &coefficients_[grid_.index(w.place[0].span + a, w.place[1].span + b, w.place[2].span)];
  }

  double value_and_slopes(const Vec3& at, double* slopes) const {
    Weights w;
    for (int k = 0; k < 3; ++k) {
      w.place[k] = grid_.place(k, at[k]);
      spline_weights_and_slopes(grid_.degrees[k], w.place[k].t, w.value[k], w.slope[k]);
    }
    double sum[4] = {};  // value, then by x, y, z
    for (int a = 0; a <= grid_.degrees[0]; ++a) {
      double plane[3] = {};  // value, by y, by z
      for (int b = 0; b <= grid_.degrees[1]; ++b) {
        const double* row = first_of_row(w, a, b);
        double line[2] = {};  // value, by z
        for (int c = 0; c <= grid_.degrees[2]; ++c) {
          line[0] += w.value[2][c] * row[c];
          line[1] += w.slope[2][c] * row[c];
        }
        plane[0] += w.value[1][b] * line[0];
        plane[1] += w.slope[1][b] * line[0];
        plane[2] += w.value[1][b] * line[1];
      }
      sum[0] += w.value[0][a] * plane[0];
      sum[1] += w.slope[0][a] * plane[0];
      sum[2] += w.value[0][a] * plane[1];
      sum[3] += w.value[0][a] * plane[2];
    }
    const bool unknown = is_unknown(at), zero = is_zero(at);
    for (int k = 0; k < 3; ++k) {
      const bool flat = zero || is_outside(at, size_t(k));
      slopes[k] = unknown ? not_a_number : flat ? 0 : sum[k + 1] * grid_.per_length(k);
    }
    return unknown ? not_a_number : zero ? 0 : sum[0];
  }

  // Of a function that jumps, in a span or to 0 outside the box, anything.
  Interval partial_over(const std::array<Interval, 3>& box, int k) const {
    for (const Interval& side : box) {
      if (!(side.lo <= side.hi)) return Interval::all();
    }
    const Interval side = box[k];
    if (side.lo > grid_.upper[k] || side.hi < grid_.lower[k]) return 0;
    if (derived_[k] && reaches_out(side, k)) return Interval::all();
    if (grid_.degrees[k] == 0) {
      const bool jumps = grid_.place(k, side.lo).span < grid_.place(k, side.hi).span;
      return jumps ? Interval::all() : Interval(0);
    }
    bool flat = reaches_out(side, k);
    for (int other = 0; other < grid_.dimensions; ++other) {
      flat = flat || (derived_[other] && reaches_out(box[other], other));
    }
    const Interval inside = bounds_.slopes(box, k);
    return flat ? hull(inside, 0) : inside;
  }

  SplineGrid grid_;
  std::vector<double> coefficients_;
  Flags derived_;  // by which inputs it is the derivative of a spline
  SplineBounds bounds_;
};

}  // namespace

OperationPointer spline_operation(const SplineGrid& grid, std::vector<double> coefficients) {
  assert(coefficients.size() == grid.size());
  return std::make_shared<SplineOperation>(grid, std::move(coefficients), Flags{});
}

std::optional<SplineReach> spline_reach(const Operation& operation) {
  const auto* spline = dynamic_cast<const SplineOperation*>(&operation);
  if (!spline) return std::nullopt;
  return spline->reach();
}

}  // namespace sardf

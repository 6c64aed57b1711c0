// How two fields are joined. A blend is one struct with its intersection; union and difference
// follow: union(x, y) = -intersection(-x, -y), difference(x, y) = intersection(x, -y).
//
// A blend's intersection never decreases in either argument. It may state
//   blend_error()        bound of |intersection - min|, infinite by default
//   gain(x, y)           bound of the sum of its partial derivatives over two intervals
//   steepness(x, y, longer, product)
//                        bound of its gradient's length where x and y have gradients of at most
//                        the length `longer` and this scalar product
//   unite(x, y)          the union, where there is a shorter form with equal results
//   selects              true where the intersection is one of the two, in every bit
//   keeps(x, y)          whether it is x, in every bit, with y and with all that is larger
#pragma once

#include "sardf/op_list.hpp"

namespace sardf {

/// Whether y lies above x by the width of a band, for `keeps`. By NaN nothing does: it stands for a
/// width that single precision takes for 0 or for infinite.
template <class T>
auto is_above_band(T x, T y, double width) {
  return y - x >= T(width > 1e-30 && width < 1e30 ? width : std::nan(""));
}

template <class Blend>
struct BlendOperation : Blend {
  static constexpr Kind kind = Kind::internal;
  static constexpr int arity = 2;
  BlendOperation() = default;
  explicit BlendOperation(const Blend& blend) : Blend(blend) {}
};

template <class Blend>
struct IntersectionOf : BlendOperation<Blend> {
  using BlendOperation<Blend>::BlendOperation;
  static constexpr Join join = Join::intersection;
  static inline const std::string name = std::string(Blend::name) + "_intersection";
  static inline const std::string doc = "Intersection. " + std::string(Blend::doc);
  static constexpr std::array<int, 2> monotone{1, 1};
  template <class T>
  T eval(T x, T y) const {
    return this->intersection(x, y);
  }
};

template <class Blend>
struct UnionOf : BlendOperation<Blend> {
  using BlendOperation<Blend>::BlendOperation;
  static constexpr Join join = Join::unite;
  static inline const std::string name = std::string(Blend::name) + "_union";
  static inline const std::string doc = "Union. " + std::string(Blend::doc);
  static constexpr std::array<int, 2> monotone{1, 1};
  template <class T>
  T eval(T x, T y) const {
    if constexpr (requires { this->unite(x, y); }) return this->unite(x, y);
    return -this->intersection(-x, -y);
  }
  double gain(Interval x, Interval y) const
    requires requires(const Blend& b) { b.gain(x, y); }
  {
    return Blend::gain(-x, -y);
  }
  double steepness(Interval x, Interval y, double longer, Interval product) const
    requires requires(const Blend& b) { b.steepness(x, y, longer, product); }
  {
    return Blend::steepness(-x, -y, longer, product);
  }
  template <class T>
  auto keeps(T x, T y) const
    requires requires(const Blend& b) { b.keeps(x, y); }
  {
    return Blend::keeps(-x, -y);
  }
};

template <class Blend>
struct DifferenceOf : BlendOperation<Blend> {
  using BlendOperation<Blend>::BlendOperation;
  static constexpr Join join = Join::difference;
  static inline const std::string name = std::string(Blend::name) + "_difference";
  static inline const std::string doc = "Difference. " + std::string(Blend::doc);
  static constexpr std::array<int, 2> monotone{1, -1};
  template <class T>
  T eval(T x, T y) const {
    return this->intersection(x, -y);
  }
  double gain(Interval x, Interval y) const
    requires requires(const Blend& b) { b.gain(x, y); }
  {
    return Blend::gain(x, -y);
  }
  double steepness(Interval x, Interval y, double longer, Interval product) const
    requires requires(const Blend& b) { b.steepness(x, y, longer, product); }
  {
    return Blend::steepness(x, -y, longer, -product);
  }
  template <class T>
  auto keeps(T x, T y) const
    requires requires(const Blend& b) { b.keeps(x, y); }
  {
    return Blend::keeps(x, -y);
  }
};

/// Hard minimum and maximum: sharp creases, exact on one side (sardf paper, 1.3.2).
struct MinMax {
  static constexpr const char *name = "min_max",
                              *doc = "The smaller field: creases, the distance error is 0.";
  static constexpr bool selects = true;
  template <class V>
  static void parameters(V&) {}
  double blend_error() const { return 0; }
  double gain(Interval, Interval) const { return 1; }
  template <class T>
  T intersection(T x, T y) const {
    return min(x, y);
  }
  template <class T>
  T unite(T x, T y) const {
    return max(x, y);
  }
};

/// Rvachev's R0 function (sardf paper, 5): smooth away from the origin, but no distance.
struct RFunction {
  static constexpr const char *name = "r_function",
                              *doc = "x + y - sqrt(x² + y²): smooth off the edge, no distance.";
  static constexpr bool cancels = true;
  template <class V>
  static void parameters(V&) {}
  double blend_error() const { return infinity; }
  template <class T>
  T intersection(T x, T y) const {
    return x + y - length(x, y);
  }
};

/// The quadratic polynomial blend. It removes (for a union, adds) material along the edge.
struct Smooth {
  static constexpr const char *name = "smooth",
                              *doc =
                                  "min - max(k - |x - y|, 0)²/(4k): it moves the surface by up "
                                  "to k/4 near an edge.";
  double k = 1;
  template <class V>
  static void parameters(V& v) {
    v(positive_length("k", "width of the band |x - y| < k that is blended"), &Smooth::k);
  }
  double blend_error() const { return k / 4; }
  double gain(Interval, Interval) const { return 1; }
  template <class T>
  auto keeps(T x, T y) const {
    return is_above_band(x, y, k);
  }
  template <class T>
  T intersection(T x, T y) const {
    const T overlap = max(T(k) - abs(x - y), T(0.0));
    return min(x, y) - square(overlap) * T(1 / (4 * k));
  }
};

/// R-equivalence of two distances: (a^-n + b^-n)^(-1/n), smooth away from their features; the
/// smaller one where it is not positive. It is associative. The partials (w/a)^(n+1) and
/// (w/b)^(n+1) of the result w add up to at most (w/a)^n + (w/b)^n = 1. Source: Biswas, Shapiro,
/// "Approximate distance fields with non-vanishing gradients", after Rvachev.
struct Equivalence {
  static constexpr const char *name = "equivalence",
                              *doc = "The distance to two features, smooth away from them.";
  static constexpr Kind kind = Kind::internal;
  static constexpr int arity = 2;
  double order = 1;
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"order", "n, the higher, the nearer to the smaller", Unit::ratio, Range::positive},
      &Equivalence::order);
  }
  void prepare() { whole_order_ = order <= most_factors && order == int(order) ? int(order) : 0; }
  double gain(Interval, Interval) const { return 1; }
  template <class T>
  T eval(T a, T b) const {
    const T lo = smaller(a, b), hi = larger(a, b);
    return shortcut(lo <= T(0.0), lo, [&] {
      // The ratio neither overflows nor vanishes. Its limits change no value, but bound it.
      const T ratio = max(T(0.0), min(T(1.0), lo / hi));
      const T power = whole_order_ > 0 ? whole_power(ratio, whole_order_) : pow(ratio, T(order));
      return lo * pow(T(1.0) + power, T(-1 / order));
    });
  }

 private:
  static constexpr int most_factors = 64;
  int whole_order_ = 1;  // 0: `order` is not whole, or large
};

template <class... Blends>
using OpsOfBlends = OpList<IntersectionOf<Blends>..., UnionOf<Blends>..., DifferenceOf<Blends>...>;

}  // namespace sardf

// Newton's iteration on a cubic piece for several points at once; one class for each instruction
// set, as in numbers/lanes.hpp.
#pragma once

#include <cstring>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "sardf/cubic_piece.hpp"

namespace sardf::cubic {

/// One double at a time.
struct One {
  static constexpr size_t width = 1;
  using Values = double;
  using Mask = bool;
  static bool any(bool mask) { return mask; }
};

struct Two {
  static constexpr size_t width = 2;
  typedef double Values __attribute__((vector_size(16)));
  typedef long long Mask __attribute__((vector_size(16)));
  static bool any(Mask mask) { return (mask[0] | mask[1]) != 0; }
};

#if defined(__AVX2__)
struct Four {
  static constexpr size_t width = 4;
  typedef double Values __attribute__((vector_size(32)));
  typedef long long Mask __attribute__((vector_size(32)));
  static bool any(Mask mask) { return _mm256_movemask_pd((__m256d)mask) != 0; }
};
#endif

#if defined(__AVX512F__)
struct Eight {
  static constexpr size_t width = 8;
  typedef double Values __attribute__((vector_size(64)));
  typedef long long Mask __attribute__((vector_size(64)));
  static bool any(Mask mask) { return _mm512_test_epi64_mask((__m512i)mask, (__m512i)mask) != 0; }
};
#endif

/// The lanes of one step through the arrays.
template <class Isa>
class Solver {
 public:
  using Values = typename Isa::Values;
  using Mask = typename Isa::Mask;

  static void solve(const CubicPiece& piece, double part, const CubicBests& bests, size_t n) {
    for (size_t i = 0; i < n; i += Isa::width) Solver(piece, bests, i).compare(part);
  }

 private:
  Solver(const CubicPiece& piece, const CubicBests& bests, size_t first)
      : piece_(piece), bests_(bests), first_(first) {
    for (size_t k = 0; k < 3; ++k) a_[k] = piece.start[k] - load(bests.point[k]);
    f_[0] = along(piece.by_1);
    f_[1] = piece.constant[1] + 2.0 * along(piece.by_2);
    f_[2] = piece.constant[2] + 3.0 * along(piece.by_3);
  }

  Values load(const double* from) const {
    Values v;
    std::memcpy(&v, from + first_, sizeof v);
    return v;
  }
  void store(double* to, const Values& v) const { std::memcpy(to + first_, &v, sizeof v); }
  static Values all(double a) { return a - Values{}; }

  Values along(const Vec3& by) const { return a_[0] * by[0] + a_[1] * by[1] + a_[2] * by[2]; }

  static constexpr int most_steps = 40;

  // Every lane stops by itself, so that what is beside it changes nothing. Halving ends it where
  // Newton's iteration does not.
  void find_zero() {
    const auto& c = piece_.constant;
    const double c3 = c[3], c4 = c[4], c5 = c[5], d3 = 3 * c3, d4 = 4 * c4, d5 = 5 * c5;
    const Values d2 = 2.0 * f_[2], none{}, one = all(1);
    const Values at_end = f_[0] + (f_[1] + (f_[2] + (c3 + (c4 + c5))));
    inside_ = (f_[0] < none) & (at_end > none);
    t_ = f_[0] < none ? one : none;
    rise_ = one;
    Mask going = inside_;
    if (!Isa::any(going)) return;
    t_ = inside_ ? f_[0] / (f_[0] - at_end) : t_;
    Values low = none, high = one;
    for (int step = 0; Isa::any(going); ++step) {
      const bool halve = step >= most_steps;
      const Values f = f_[0] + t_ * (f_[1] + t_ * (f_[2] + t_ * (c3 + t_ * (c4 + t_ * c5))));
      const Values rise = f_[1] + t_ * (d2 + t_ * (d3 + t_ * (d4 + t_ * d5)));
      low = f < none ? t_ : low;
      high = f < none ? high : t_;
      Values next = halve ? low - one : t_ - f / rise;
      next = ((rise > none) & (next >= low) & (next <= high)) ? next : 0.5 * (low + high);
      const Values moved = next - t_;
      rise_ = going ? rise : rise_;
      t_ = going ? next : t_;
      // The next of Newton's steps would move by about the square of this one.
      const double enough = halve ? 0x1p-48 : 0x1p-20, flat = halve ? -infinity : 0;
      going = going & ((moved >= enough) | (moved <= -enough) | (rise <= flat));
    }
  }

  // The last step from the point itself, whose rounding is less than the polynomial's.
  void move_to_zero() {
    Values tangent[3], product{};
    for (size_t k = 0; k < 3; ++k) {
      const double by_1 = piece_.by_1[k], by_2 = piece_.by_2[k], by_3 = piece_.by_3[k];
      a_[k] = a_[k] + t_ * (by_1 + t_ * (by_2 + t_ * by_3));
      tangent[k] = by_1 + t_ * (2 * by_2 + t_ * (3 * by_3));
      product = product + a_[k] * tangent[k];
    }
    Values next = (inside_ & (rise_ > Values{})) ? t_ - product / rise_ : t_;
    next = next < Values{} ? Values{} : next;
    next = next > all(1) ? all(1) : next;
    for (size_t k = 0; k < 3; ++k) a_[k] = a_[k] + (next - t_) * tangent[k];
    t_ = next;
  }

  void compare(double part) {
    find_zero();
    move_to_zero();
    const Values squared = a_[0] * a_[0] + a_[1] * a_[1] + a_[2] * a_[2];
    const Values key = inside_ ? squared : squared * (1 + 0x1p-50), before = load(bests_.key);
    const Mask better = (key < before) | ((key == before) & (all(part) < load(bests_.part)));
    if (!Isa::any(better)) return;
    store(bests_.key, better ? key : before);
    keep(bests_.squared, better, squared);
    keep(bests_.parameter, better, t_);
    keep(bests_.part, better, all(part));
    for (size_t k = 0; k < 3; ++k) keep(bests_.toward[k], better, a_[k]);
  }
  void keep(double* at, const Mask& better, const Values& value) const {
    store(at, better ? value : load(at));
  }

  const CubicPiece& piece_;
  const CubicBests& bests_;
  size_t first_;
  Values a_[3];  // from the point to the start; later to the nearest point of the piece
  Values f_[3];  // coefficients by powers; the others are the piece's
  Values t_, rise_;
  Mask inside_;  // whether the zero is between the ends
};

}  // namespace sardf::cubic

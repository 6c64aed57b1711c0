// The number type Series: the Taylor coefficients c_0, ..., c_N of a function of one variable.
//
// S is double, or Symbol (symbol.hpp) for coefficients that are graphs. Products, quotients, roots
// and elementary functions follow the recurrences of their differential equations (Griewank,
// Walther: Evaluating Derivatives, chapter 13), N² / 2 products each. At a kink the coefficients
// are those of the branch that gives c_0, as in gradient.hpp; floor has the slope 0. Where c_0 is a
// length or a root that vanishes, the others have no value: NaN or infinite.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "sardf/numbers/real.hpp"

namespace sardf {

/// Whether a coefficient is known to be 0, so that its products need not be added.
inline bool is_zero(double a) { return a == 0; }

template <class S>
class Series {
 public:
  Series() : Series(0.0) {}
  Series(double number) : c_{S(number)} {}
  /// The coefficients from c_0 on, at least one; what is missing up to `order` is 0.
  Series(std::vector<S> coefficients, int order) : c_(std::move(coefficients)), order_(order) {
    if (c_.size() > size_t(order) + 1) c_.resize(size_t(order) + 1);
    while (c_.size() > 1 && is_zero(c_.back())) c_.pop_back();
  }

  int order() const { return order_; }
  /// The highest coefficient that may differ from 0.
  int degree() const { return int(c_.size()) - 1; }
  S operator[](int k) const { return k <= degree() ? c_[size_t(k)] : S(0.0); }
  /// The same with another c_0: one that is known better.
  Series with_value(const S& value) const {
    Series out = *this;
    out.c_[0] = value;
    return out;
  }

  friend Series operator+(const Series& a, const Series& b) {
    return termwise(a, b, [](const S& p, const S& q) { return p + q; });
  }
  friend Series operator-(const Series& a, const Series& b) {
    return termwise(a, b, [](const S& p, const S& q) { return p - q; });
  }
  friend Series operator-(const Series& a) { return S(-1.0) * a; }
  friend Series operator*(const S& factor, const Series& a) {
    std::vector<S> c;
    for (const S& each : a.c_) c.push_back(is_zero(each) ? each : factor * each);
    return {std::move(c), a.order_};
  }
  friend Series operator*(const Series& a, const Series& b) {
    const int order = std::max(a.order_, b.order_);
    const int last = std::min(order, a.degree() + b.degree());
    std::vector<S> c;
    for (int n = 0; n <= last; ++n) c.push_back(convolved(a, b, n, 0, n));
    return {std::move(c), order};
  }
  friend Series square(const Series& a) {
    const int last = std::min(a.order_, 2 * a.degree());
    std::vector<S> c;
    for (int n = 0; n <= last; ++n) {
      S sum = S(2.0) * convolved(a, a, n, 0, (n - 1) / 2 - (n == 0));
      if (n % 2 == 0) sum = sum + square(a[n / 2]);
      c.push_back(sum);
    }
    return {std::move(c), a.order_};
  }
  friend Series operator/(const Series& a, const Series& b) {
    return solved(std::max(a.order_, b.order_), a[0] / b[0],
                  [&](const Series& q, int n) { return (a[n] - convolved(b, q, n, 1, n)) / b[0]; });
  }

  friend auto operator<(const Series& a, const Series& b) { return a[0] < b[0]; }
  friend auto operator<=(const Series& a, const Series& b) { return a[0] <= b[0]; }
  template <class Mask>
  friend Series select(const Mask& mask, const Series& a, const Series& b) {
    return termwise(a, b, [&](const S& p, const S& q) { return select(mask, p, q); });
  }
  friend Series min(const Series& a, const Series& b) {
    return select(a[0] < b[0], a, b).with_value(min(a[0], b[0]));
  }
  friend Series max(const Series& a, const Series& b) {
    return select(b[0] < a[0], a, b).with_value(max(a[0], b[0]));
  }
  friend Series smaller(const Series& a, const Series& b) {
    return select(a[0] < b[0], a, select(b[0] < a[0], b, S(0.5) * (a + b)));
  }
  friend Series larger(const Series& a, const Series& b) {
    return select(b[0] < a[0], a, select(a[0] < b[0], b, S(0.5) * (a + b)));
  }
  friend Series abs(const Series& a) { return select(a[0] < S(0.0), -a, a).with_value(abs(a[0])); }
  friend Series floor(const Series& a) { return Series(std::vector<S>{floor(a[0])}, a.order_); }
  /// Iterations stay live: one live step is right to the first order only.
  friend Series freeze(const Series& a) { return a; }

  friend Series sqrt(const Series& a) { return root_of(a, sqrt(a[0])); }
  friend Series length(const Series& a, const Series& b) {
    return root_of(square(a) + square(b), length(a[0], b[0]));
  }
  friend Series length(const Series& a, const Series& b, const Series& c) {
    return root_of(square(a) + square(b) + square(c), length(a[0], b[0], c[0]));
  }

  friend Series exp(const Series& a) {
    const Series slope = a.slope();
    return solved(a.order_, exp(a[0]), [&](const Series& e, int n) {
      return S(1.0 / n) * convolved(slope, e, n, 1, n);
    });
  }
  friend Series log(const Series& a) { return integral(log(a[0]), a.slope(), a); }
  friend Series sin(const Series& a) { return sine_cosine(a)[0]; }
  friend Series cos(const Series& a) { return sine_cosine(a)[1]; }
  friend Series tan(const Series& a) {
    const Series slope = a.slope();  // t' = (1 + t²) a'
    return solved(a.order_, tan(a[0]), [&](const Series& t, int n) {
      return S(1.0 / n) * convolved(slope, Series(1.0) + square(t), n, 1, n);
    });
  }
  friend Series asin(const Series& a) {
    return integral(asin(a[0]), a.slope(), sqrt(Series(1.0) - square(a)));
  }
  friend Series acos(const Series& a) {
    return integral(acos(a[0]), -a.slope(), sqrt(Series(1.0) - square(a)));
  }
  friend Series atan2(const Series& y, const Series& x) {
    return integral(atan2(y[0], x[0]), x * y.slope() - y * x.slope(), square(x) + square(y));
  }
  friend Series pow(const Series& a, const Series& b) {
    const Series whole = to_constant(a, b[0]);
    if (b.degree() == 0) return whole;
    // As for the gradient: the exponent's change counts where the base has a logarithm.
    return select(S(0.0) < a[0], exp(b * log(a)), whole).with_value(pow(a[0], b[0]));
  }

 private:
  // Σ a_k b_{n-k} for k from `first` to `last`.
  static S convolved(const Series& a, const Series& b, int n, int first, int last) {
    S sum(0.0);
    first = std::max(first, n - b.degree());
    last = std::min(last, a.degree());
    for (int k = first; k <= last; ++k) {
      const S &p = a.c_[size_t(k)], &q = b.c_[size_t(n - k)];
      if (!is_zero(p) && !is_zero(q)) sum = sum + p * q;
    }
    return sum;
  }

  // c_n from the coefficients before it, all the way up.
  template <class Next>
  static Series solved(int order, const S& value, Next next) {
    Series out({value}, order);
    for (int n = 1; n <= order; ++n) out.c_.push_back(next(out, n));
    return {std::move(out.c_), order};
  }

  template <class F>
  static Series termwise(const Series& a, const Series& b, F f) {
    std::vector<S> c;
    for (int k = 0; k <= std::max(a.degree(), b.degree()); ++k) c.push_back(f(a[k], b[k]));
    return {std::move(c), std::max(a.order_, b.order_)};
  }

  // The coefficients k c_k: s times the derivative by s.
  Series slope() const {
    std::vector<S> c;
    for (int k = 0; k <= degree(); ++k) c.push_back(S(double(k)) * c_[size_t(k)]);
    return {std::move(c), order_};
  }

  // y with s y' = numerator / denominator; the numerator starts at s.
  static Series integral(const S& value, const Series& numerator, const Series& denominator) {
    const int order = std::max(numerator.order_, denominator.order_);
    return solved(order, value, [&](const Series& y, int n) {
      const S rest = convolved(y.slope(), denominator, n, 1, n - 1);
      return S(1.0 / n) * ((numerator[n] - rest) / denominator[0]);
    });
  }

  static Series root_of(const Series& a, const S& root) {
    return solved(a.order_, root, [&](const Series& r, int n) {
      return (a[n] - convolved(r, r, n, 1, n - 1)) / (S(2.0) * root);
    });
  }

  static std::array<Series, 2> sine_cosine(const Series& a) {
    const Series slope = a.slope();
    Series sine({sin(a[0])}, a.order_), cosine({cos(a[0])}, a.order_);
    for (int n = 1; n <= a.order_; ++n) {
      const S next = S(1.0 / n) * convolved(slope, cosine, n, 1, n);
      cosine.c_.push_back(S(-1.0 / n) * convolved(slope, sine, n, 1, n));
      sine.c_.push_back(next);
    }
    return {Series(std::move(sine.c_), a.order_), Series(std::move(cosine.c_), a.order_)};
  }

  // a^b = Σ_k binomial(b, k) a_0^(b-k) (a - a_0)^k: it ends for a whole b, and a_0 may be 0.
  static Series to_constant(const Series& a, const S& b) {
    Series out({pow(a[0], b)}, a.order_), power(1.0);
    if (a.degree() == 0) return out;
    const Series change = a.with_value(S(0.0));
    S binomial(1.0);
    for (int k = 1; k <= a.order_; ++k) {
      binomial = binomial * (b - S(k - 1.0)) / S(double(k));
      if (is_zero(binomial)) break;
      power = k == 1 ? change : power * change;
      out = out + binomial * pow(a[0], b - S(double(k))) * power;
    }
    return out;
  }

  std::vector<S> c_;
  int order_ = 0;
};

}  // namespace sardf

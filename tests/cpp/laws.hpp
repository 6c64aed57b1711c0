// Random operations, fields, points and boxes for the law tests.
//
// $SARDF_SEED is the seed (default 1); $SARDF_EFFORT scales the number of cases (default 1, and a
// tenth of the cases under the address sanitizer).
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "sanitized.hpp"
#include "sardf/constructor.hpp"
#include "sardf/error.hpp"
#include "sardf/evaluate.hpp"
#include "sardf/parameter.hpp"

namespace sardf::laws {

inline uint64_t seed() {
  const char* text = std::getenv("SARDF_SEED");
  return text ? std::strtoull(text, nullptr, 10) : 1;
}

/// The number of cases to run where `count` is the full number.
inline int effort(int count) {
  double share = is_sanitized ? 0.1 : 1;
  if (const char* text = std::getenv("SARDF_EFFORT")) share *= std::strtod(text, nullptr);
  return std::max(1, int(count * share));
}

class Random {
 public:
  explicit Random(uint64_t stream = 0) : engine_(seed() * 1000003 + stream) {}

  double uniform(double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(engine_);
  }
  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(engine_); }
  bool chance(double probability) { return uniform(0, 1) < probability; }
  /// 10^lo to 10^hi, every decade as likely.
  double decades(double lo, double hi) { return std::pow(10, uniform(lo, hi)); }
  double sign() { return chance(0.5) ? -1 : 1; }
  template <class List>
  const auto& one_of(const List& list) {
    return list[size_t(below(int(std::size(list))))];
  }

  /// An ordinary coordinate or value.
  double ordinary() { return uniform(-6, 6); }
  /// Zeros, denormals, whole numbers, and magnitudes up to `most`.
  double spicy(double most = 1e100) {
    static constexpr double special[] = {0, -0.0, 1, -1, 0.5, -2, 3, 4.9e-324, -1e-310, 1e-40};
    if (chance(0.5)) return one_of(special);
    return sign() * decades(-std::log10(most), std::log10(most));
  }
  std::vector<double> values(int n, double spice, double most = 1e100) {
    std::vector<double> out;
    for (int i = 0; i < n; ++i) {
      const bool repeats = i > 0 && chance(0.1);
      out.push_back(repeats ? out[size_t(below(i))] : chance(spice) ? spicy(most) : ordinary());
    }
    return out;
  }

  double number(const Parameter& p) {
    if (p.range == Range::positive) return decades(-1, 0.7);
    // Few, since what is counted may be expensive.
    if (p.range == Range::count) return 1 + below(2);
    if (p.range == Range::non_negative) return chance(0.2) ? 0 : decades(-1, 0.7);
    return p.unit == Unit::angle ? uniform(-360, 360) : uniform(-4, 4);
  }
  Vec3 direction() {
    static constexpr Vec3 along[] = {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}, {0, 0, 1}};
    return chance(0.3) ? one_of(along) : Vec3{uniform(-1, 1), uniform(-1, 1), uniform(0.1, 1)};
  }
  /// Corners of a star-shaped contour, which never crosses itself.
  std::vector<Vec2> contour(int corners) {
    std::vector<Vec2> out;
    const Vec2 centre{uniform(-2, 2), uniform(-2, 2)};
    for (int i = 0; i < corners; ++i) {
      const double angle = 2 * 3.14159 * (i + uniform(0.1, 0.9)) / corners, r = uniform(0.5, 4);
      out.push_back({centre[0] + r * std::cos(angle), centre[1] + r * std::sin(angle)});
    }
    if (chance(0.5)) std::reverse(out.begin(), out.end());
    return out;
  }

 private:
  std::mt19937_64 engine_;
};

/// `make` until it accepts its random arguments.
template <class Make>
auto retried(Make make) {
  for (int tries = 1;; ++tries) {
    try {
      return make();
    } catch (const Error&) {
      if (tries == 500) throw;
    }
  }
}

/// An operation of the list. The types stay in laws.cpp: compiling all of them takes a minute.
struct ListedOperation {
  std::string name;
  OperationPointer (*random)(Random&);  // with random parameters
  std::vector<int> monotone;            // the sign of each partial derivative; empty: not monotone
  bool hides_jumps = false;             // only what it is built into is continuous
};
const std::vector<ListedOperation>& listed_operations();

/// law(a listed operation, an operation of it, Random&), `count` times for every operation of the
/// list, with new parameters every 20 times.
template <class Law>
void for_operations(int count, Law law) {
  uint64_t stream = 0;
  for (const ListedOperation& listed : listed_operations()) {
    Random r(++stream);
    SCOPED_TRACE("operation " + listed.name + ", seed " + std::to_string(seed()));
    OperationPointer op;
    for (int i = 0; i < count && !testing::Test::HasFatalFailure(); ++i) {
      if (i % 20 == 0) op = listed.random(r);
      law(listed, *op, r);
    }
  }
}

/// Largest magnitude among an operation's arguments, parameters and result.
inline double magnitude(const Operation& op, const std::vector<double>& in, double result) {
  double most = std::abs(result);
  for (double a : in) most = std::max(most, std::abs(a));
  for (double a : op.numbers()) most = std::max(most, std::abs(a));
  return most;
}

/// An operation's partial derivatives in double; the value that comes with them is checked.
std::vector<double> partials_at(const Operation& op, const std::vector<double>& in);

/// Degenerate, tiny, ordinary, huge, touching zero, or with infinite ends.
inline Interval random_interval(Random& r, double most = 1e100) {
  const double centre = r.chance(0.1) ? r.spicy(most) : r.ordinary();
  if (r.chance(0.1)) return centre;
  const double half = r.chance(0.5) ? r.decades(-12, 0) : r.decades(-1, r.chance(0.2) ? 30 : 1);
  Interval i{centre - half, centre + half};
  if (r.chance(0.1)) i.lo = std::min(0.0, i.hi);
  if (r.chance(0.1)) i.hi = std::max(0.0, i.lo);
  if (r.chance(0.03)) i.lo = -infinity;
  if (r.chance(0.03)) i.hi = infinity;
  return i;
}

/// A number of the interval: an end, the middle, or anywhere.
inline double number_in(Random& r, Interval i) {
  const double lo = i.lo == -infinity ? std::min(i.hi, 0.0) - r.decades(0, 9) : i.lo;
  const double hi = i.hi == infinity ? std::max(i.lo, 0.0) + r.decades(0, 9) : i.hi;
  switch (r.below(5)) {
    case 0:
      return lo;
    case 1:
      return hi;
    case 2:
      return std::clamp(0.0, lo, hi);
    default:
      return std::clamp(lo + r.uniform(0, 1) * (hi - lo), lo, hi);
  }
}

/// A field of any constructor: `depth` levels of constructors that take fields, at most.
Field random_field(Random& r, int depth);
/// A field of this constructor.
Field random_field(Random& r, const Constructor& constructor, int depth);
/// Whether random arguments exist: a text, a rule or a file that must be given has none, nor a list
/// of numbers, which are counts or as many as something else says.
bool can_be_random(const Constructor& constructor);

}  // namespace sardf::laws

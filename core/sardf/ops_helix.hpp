// Helix: exact distance in a bounded number of steps.
//
// In its frame the curve is (r cos t, r sin t, c t), c = pitch / 2π. For a point at distance rho
// from the axis, angle phi and height w, the squared distance to the curve point at t = phi + 2πk +
// tau is
//   (rho - r)² + 2 rho r (1 - cos tau) + c² (m - tau)²,   m = w / c - phi - 2πk.
// Mirroring makes m >= 0. Half of its derivative over c² is F(tau) = κ sin tau + tau - m with κ =
// rho r / c²: Kepler's equation. The nearest turn is that with |m| <= π, and there the minimum lies
// in [0, m]: F(0) <= 0 <= F(m), and F is concave on [0, π], so F has one root in [0, m], and
// Newton's iteration rises to it from any point below it, without leaving the part [0, acos(-1/κ)]
// on which F rises. Where the root is nearly triple (κ near 1, m near π: a focal line of the
// helix) the iteration is slow, so halvings come before it; the distance is stationary there, and
// what remains of the error is below 1e-14 of it.
//
// The derivatives come of the nearest point alone, since the distance is stationary in tau, or the
// point is a fixed end: the iteration runs on frozen values.
#pragma once

#include <numbers>

#include "sardf/ops_features.hpp"

namespace sardf {

struct Helix : Feature {
  static constexpr const char *name = "helix",
                              *doc =
                                  "The distance to a helical line, which passes the height of "
                                  "its center at angle 0. For the axis z, angle 0 is +x.";
  static constexpr double rounding = 64;
  Vec3 center{};
  Axis axis;
  double radius = 1, pitch = 1;
  std::optional<double> start, end;
  template <class V>
  static void parameters(V& v) {
    v(length_of("center", "a point of its axis"), &Helix::center);
    v(direction_of("axis", "direction of its axis"), &Helix::axis);
    v(positive_length("radius", "radius of its turns"), &Helix::radius);
    v(required_length("pitch",
                      "rise along the axis in one turn, at least a millionth of the radius; "
                      "negative: left-handed"),
      &Helix::pitch);
    v(Parameter{"start", "the angle where it starts; none: endless", Unit::angle}, &Helix::start);
    v(Parameter{"end", "the angle where it ends, larger than start; none: endless", Unit::angle},
      &Helix::end);
  }
  void prepare() {
    if (std::abs(pitch) < 1e-6 * radius) {
      throw Error("pitch is " + std::to_string(pitch) +
                  "; at least a millionth of the radius is accepted, or at most minus that");
    }
    if (start && end && !(*end > *start)) {
      throw Error("the helix goes from " + std::to_string(*start) + " to " + std::to_string(*end) +
                  " degrees; end must be larger than start");
    }
    frame_.set(center, axis);
    rise_ = pitch / turn;
    steepness_ = radius / rise_ / rise_;
    start_ = place_at(start.value_or(0) * degree);
    end_ = place_at(end.value_or(0) * degree);
  }

  template <class T>
  T eval(T x, T y, T z) const {
    const std::array<T, 3> at = frame_.local(x, y, z);
    const T u = freeze(at[0]), v = freeze(at[1]);
    const Place<T> place{atan2(v, u), freeze(at[2]) / T(rise_), T(steepness_) * length(u, v)};
    const T nearest = floor((place.height - place.angle) / T(turn) + T(0.5));
    const T found = nearest_in_turn(place, nearest);
    const T free = length_to(at, place, nearest, found);
    if (!start && !end) return free;

    // Where the nearest point lies beyond an end, the nearest that is left lies in the last turn
    // before that end: a turn farther away only moves off. The turn counted from the point's angle
    // that holds the end, and the one before it, have all minima in that turn, and each clamped to
    // the curve gives the ends.
    const T first = T(start.value_or(0) * degree) - place.angle;
    const T last = T(end.value_or(0) * degree) - place.angle;
    T at_end = floor(last / T(turn)), before = at_end - T(1.0);
    if (start) {
      const T at_start = T(0.0) - floor(T(0.0) - first / T(turn));
      const T total = found + T(turn) * nearest;
      if (!end) {
        at_end = at_start;
        before = at_start + T(1.0);
      } else {
        const auto is_low = total < first;
        before = select(is_low, at_start + T(1.0), before);
        at_end = select(is_low, at_start, at_end);
      }
    }
    // The ends themselves: counted from many turns away, their angle would be rounded too much.
    const auto clamped = [&](T turns, T tau) {
      const T whole = T(turn) * turns;
      T nearby = length_to(at, place, turns, tau);
      if (start) nearby = select(tau < first - whole, distance_between(at, start_), nearby);
      if (end) nearby = select(last - whole < tau, distance_between(at, end_), nearby);
      return nearby;
    };
    return min(clamped(nearest, found), min(clamped(at_end, nearest_in_turn(place, at_end)),
                                            clamped(before, nearest_in_turn(place, before))));
  }

 private:
  static constexpr double turn = 2 * std::numbers::pi, degree = std::numbers::pi / 180;
  static constexpr int halvings = 8, steps = 8;

  /// A point in the frame: its angle, the angle at which the curve has its height, and κ.
  template <class T>
  struct Place {
    T angle, height, kappa;
  };

  template <class T>
  T nearest_in_turn(const Place<T>& place, T turns) const {
    const T m = place.height - place.angle - T(turn) * turns;
    const T tau = root(place.kappa, abs(m));
    return select(m < T(0.0), -tau, tau);
  }

  /// The least root of F in the part where F rises; anything in it where there is none.
  template <class T>
  static T root(T kappa, T m) {
    T high = min(m, acos(T(-1.0) / max(kappa, T(1.0)))), low(0.0);
    for (int step = 0; step < halvings; ++step) {
      const T middle = T(0.5) * (low + high);
      const auto is_low = kappa * sin(middle) + middle < m;
      low = select(is_low, middle, low);
      high = select(is_low, high, middle);
    }
    T tau = low;
    for (int step = 0; step < steps; ++step) {
      const T below = max(m - tau - kappa * sin(tau), T(0.0));
      // The slope vanishes at the triple root alone.
      const T slope = max(kappa * cos(tau) + T(1.0), T(1e-30));
      const T former = tau;
      tau = min(tau + below / slope, high);
      if (is_at_rest(former, tau)) break;
    }
    return tau;
  }

  Vec3 place_at(double angle) const {
    return {radius * std::cos(angle), radius * std::sin(angle), rise_ * angle};
  }

  template <class T>
  static T distance_between(const std::array<T, 3>& at, const Vec3& place) {
    return length(at[0] - T(place[0]), at[1] - T(place[1]), at[2] - T(place[2]));
  }

  template <class T>
  T length_to(const std::array<T, 3>& at, const Place<T>& place, T turns, T tau) const {
    // Frozen once more: on the axis the angle's derivative is none even of a constant.
    const T angle = freeze(place.angle + tau);
    const T rise = freeze(T(rise_) * (angle + T(turn) * turns));
    return length(at[0] - T(radius) * cos(angle), at[1] - T(radius) * sin(angle), at[2] - rise);
  }

  Frame frame_;
  double rise_ = 1;       // along the axis for one radian
  double steepness_ = 1;  // radius / rise²
  Vec3 start_{}, end_{};  // in the frame
};

using HelixOps = OpList<Helix>;

}  // namespace sardf

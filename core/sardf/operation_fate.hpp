// What becomes of an operation over a box: derived from its formula run on Choice.
#pragma once

#include <algorithm>

#include "sardf/numbers/choice.hpp"
#include "sardf/operation.hpp"

namespace sardf {

inline Fate fate_of(const Choice& result) {
  Fate fate;
  if (result.origin == Choice::number) {
    fate.type = Fate::Type::number;
    fate.number = result.constant;
  } else if (result.origin >= 0) {
    fate.type = Fate::Type::copy;
    fate.input = result.origin;
    fate.negated = result.negated;
  }
  return fate;
}

/// More than any value that takes part in a decision.
inline constexpr double huge_value = 0x1p100;

/// An operation of two inputs that is monotone in both, such as a minimum or a blend. `signs`: of
/// its partial derivatives; `reach`: how far apart inputs may be and still be blended, as a guess;
/// `error`: bound of the rounding error of a result between them; `choose`: its formula on Choice;
/// `evaluate`: in double.
///
/// Write g for the operation with inputs times their signs, so that it never decreases, and take an
/// input a and the other one b.
/// 1. Results below the floor F do not matter. If g(a, b) is b for all b >= F, then b can stand for
///    it: where b < F, g(a, b) <= g(a, F) = F.
/// 2. If g(a, b) = b for all a <= A and all b that matter, a need not be known below A.
/// 3. If g(F, b) is F for a huge b, then g(a, b) <= F for all a <= F and any b: a need not be known
///    below F.
/// The same holds for the ceiling. Rounding can break "g never decreases" by `error`: the range
/// that matters is widened by it first.
template <class ChooseFormula, class EvaluateFormula>
class FateBetween {
 public:
  FateBetween(const Enclosure* in, const Demand& demand, const std::array<int, 2>& signs,
              double reach, double error, const ChooseFormula& choose,
              const EvaluateFormula& evaluate)
      : in_{in[0], in[1]},
        out_{demand.floor - error, demand.ceiling + error},
        signs_(signs),
        reach_(reach),
        choose_(choose),
        evaluate_(evaluate) {}

  Fate find() const {
    Fate fate;
    if (may_be_simple()) fate = fate_of(choose_(in_.data()));
    if (fate.type != Fate::Type::computed || in_[0].may_be_nan || in_[1].may_be_nan) return fate;
    for (int k = 0; k < 2; ++k) {
      const bool is_limited = out_.floor > -infinity || out_.ceiling < infinity;
      if (!is_limited || !may_be_copy(k, seen(k), in_[1 - k].value) ||
          !is_copy(k, seen(k), in_[1 - k].value))
        continue;
      fate.type = Fate::Type::copy;
      fate.input = k;
      fate.negated = signs_[k] < 0;
      return fate;
    }
    for (int k = 0; k < 2; ++k) {
      const Demand d{floor_of(k), ceiling_of(k)};
      fate.demand[k] = signs_[k] > 0 ? d : Demand{-d.ceiling, -d.floor};
    }
    return fate;
  }

 private:
  static Interval times(int sign, Interval a) { return sign > 0 ? a : -a; }

  // The range of input k that matters, times its sign.
  Interval matters(int k) const {
    const Interval a = times(signs_[k], in_[k].value);
    return {std::clamp(a.lo, out_.floor, out_.ceiling), std::clamp(a.hi, out_.floor, out_.ceiling)};
  }
  Interval seen(int k) const { return times(signs_[k], matters(k)); }

  static bool is_moderate(Interval a) { return a.magnitude() <= huge_value; }

  // The result where input k, times its sign, is a, and the other one b.
  double evaluated(int k, double a, double b) const {
    std::array<double, 2> at;
    at[k] = signs_[k] * a;
    at[1 - k] = signs_[1 - k] * b;
    return evaluate_(at.data());
  }

  // Whether the result may be input k, times its sign, for all values in these ranges: two values
  // tell so of most, for a part of what the formula on Choice takes. A minimum or maximum is the
  // least likely to be the input where that is greatest and the other one least, and the reverse.
  bool may_be_copy(int k, Interval of_k, Interval of_other) const {
    const Interval a = times(signs_[k], of_k), b = times(signs_[1 - k], of_other);
    if (!is_moderate(a) || !is_moderate(b)) return true;
    return evaluated(k, a.hi, b.lo) == a.hi && evaluated(k, a.lo, b.hi) == a.lo;
  }

  // The like for both inputs, or a number that is the same at all places.
  bool may_be_simple() const {
    if (in_[0].may_be_nan || in_[1].may_be_nan) return true;
    if (may_be_copy(0, in_[0].value, in_[1].value) || may_be_copy(1, in_[1].value, in_[0].value))
      return true;
    const Interval a = times(signs_[0], in_[0].value), b = times(signs_[1], in_[1].value);
    return evaluated(0, a.lo, b.lo) == evaluated(0, a.hi, b.hi);
  }

  // Whether the result is input k, times its sign, for values of both in these ranges.
  bool is_copy(int k, Interval of_k, Interval of_other) const {
    std::array<Enclosure, 2> ranges;
    ranges[k].value = of_k;
    ranges[1 - k].value = of_other;
    const Choice result = choose_(ranges.data());
    if (result.origin != k || result.origin < 0) return false;
    return result.negated == (signs_[k] < 0);
  }

  double floor_of(int k) const {
    const int other = 1 - k;
    const double low = matters(other).lo, from = low - reach_ - slack(low);
    double floor = -infinity;
    if (is_copy(other, seen(other), times(signs_[k], {-huge_value, from}))) floor = from;
    if (out_.floor > floor &&
        is_copy(k, times(signs_[k], out_.floor), signs_[other] * huge_value)) {
      floor = out_.floor;
    }
    return floor;
  }
  double ceiling_of(int k) const {
    const int other = 1 - k;
    const double high = matters(other).hi, from = high + reach_ + slack(high);
    double ceiling = infinity;
    if (is_copy(other, seen(other), times(signs_[k], {from, huge_value}))) ceiling = from;
    if (out_.ceiling < ceiling &&
        is_copy(k, times(signs_[k], out_.ceiling), -signs_[other] * huge_value)) {
      ceiling = out_.ceiling;
    }
    return ceiling;
  }
  double slack(double a) const { return 1e-6 * (std::abs(a) + reach_) + 1e-30; }

  std::array<Enclosure, 2> in_;
  Demand out_;
  std::array<int, 2> signs_;
  double reach_;
  const ChooseFormula& choose_;
  const EvaluateFormula& evaluate_;
};

template <class ChooseFormula, class EvaluateFormula>
Fate fate_between(const Enclosure* in, const Demand& demand, const std::array<int, 2>& signs,
                  double reach, double error, const ChooseFormula& choose,
                  const EvaluateFormula& evaluate) {
  return FateBetween(in, demand, signs, reach, error, choose, evaluate).find();
}

}  // namespace sardf

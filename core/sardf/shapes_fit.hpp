// Functions made of B-splines: given by their coefficients, or solved for.
#pragma once

#include <utility>

#include "sardf/constructor_of.hpp"
#include "sardf/fit.hpp"
#include "sardf/op_list.hpp"

namespace sardf {

/// Source: Biswas, Shapiro, Tsukanov, section 2.3: Phi in the remainder term.
struct SplineField {
  static constexpr const char *name = "spline_field", *group = "function",
                              *doc =
                                  "A smooth function on a box: a sum of uniform B-splines, each "
                                  "times a coefficient. Outside the box it has the value of the "
                                  "box's nearest point.";
  Vec3 lower{}, upper{};
  std::vector<double> counts, coefficients;
  double degree = 3;
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"lower", "the box's lowest corner", Unit::length, Range::any, true},
      &SplineField::lower);
    v(Parameter{"upper", "the box's highest corner", Unit::length, Range::any, true},
      &SplineField::upper);
    v(Parameter{"counts",
                "how many splines along x, y and z; two for a function of x and y; on count - "
                "degree equal spans",
                Unit::none, Range::positive, true, 2},
      &SplineField::counts);
    v(Parameter{"coefficients", "one for each spline; the last coordinate's number changes fastest",
                Unit::none, Range::any, true, 1},
      &SplineField::coefficients);
    v(Parameter{"degree", "degree of the polynomials, 1 to 5"}, &SplineField::degree);
  }
  Expression expression() const;
  Quality quality() const { return {}; }
};

/// Source: Biswas, Shapiro, Tsukanov, sections 2.3 (eq. 6, Fig. 9) and 3.3 (eq. 10, Fig. 14).
struct Fitted {
  static constexpr const char
      *name = "fitted",
      *group = "function",
      *doc =
          "start + factor * Phi, where Phi is a sum of uniform B-splines on "
          "a box that brings the function near to what is wanted: the sum "
          "of the weighted terms given is as small as can be.";
  static constexpr bool takes_progress = true;
  Field start;
  std::optional<Field> factor;
  Vec3 lower{}, upper{};
  std::vector<double> splines;
  double degree = 3;
  std::optional<Field> solid;
  double points = 4;
  std::optional<Field> values;
  double values_weight = 1;
  std::optional<Field> slope, along;
  double slope_weight = 1, smoothness = 0;
  std::optional<double> mean, at_least, at_most;
  std::vector<double> coefficients;
  std::string fingerprint;

  template <class V>
  static void parameters(V& v) {
    v(Parameter{"start", "what the function is where factor is 0", Unit::none, Range::any, true},
      &Fitted::start);
    v(Parameter{"factor",
                "what multiplies the splines: u^(m + 1) keeps the start's value and m derivatives "
                "where the distance u is 0; 1 where it is not given"},
      &Fitted::factor);
    v(Parameter{"lower", "the box's lowest corner", Unit::length, Range::any, true},
      &Fitted::lower);
    v(Parameter{"upper", "the box's highest corner", Unit::length, Range::any, true},
      &Fitted::upper);
    v(Parameter{"splines",
                "how many splines along x, y and z; two for a function of x and y, one for equal "
                "numbers along all three",
                Unit::none, Range::positive, true, 1},
      &Fitted::splines);
    v(Parameter{"degree", "degree of the splines, 1 to 5"}, &Fitted::degree);
    v(Parameter{"solid", "only where it is not negative do the terms count; else in all the box"},
      &Fitted::solid);
    v(Parameter{"points", "Gauss points for each span and axis, 1 to 16"}, &Fitted::points);
    v(Parameter{"values", "term: the square of the function minus this"}, &Fitted::values);
    v(Parameter{"values_weight", "weight of that term", Unit::none, Range::non_negative},
      &Fitted::values_weight);
    v(Parameter{"slope", "term: the square of (gradient . gradient of along) minus this"},
      &Fitted::slope);
    v(Parameter{"along", "whose gradient is the direction of slope; most often a distance"},
      &Fitted::along);
    v(Parameter{"slope_weight", "weight of that term", Unit::none, Range::non_negative},
      &Fitted::slope_weight);
    v(Parameter{"smoothness",
                "weight of the term: the gradient's squared length. Alone it makes the function "
                "harmonic",
                Unit::none, Range::non_negative},
      &Fitted::smoothness);
    v(Parameter{"mean", "the function's mean over the solid is this"}, &Fitted::mean);
    v(Parameter{"at_least", "the function is nowhere less"}, &Fitted::at_least);
    v(Parameter{"at_most", "the function is nowhere more"}, &Fitted::at_most);
    v(Parameter{"coefficients",
                "the solution, as `sardf solve` writes it; remove it after any change of the other "
                "parameters"},
      &Fitted::coefficients);
    v(Parameter{"fingerprint",
                "of the problem that the coefficients solve, as `sardf solve` writes it: another "
                "problem is an error; without one they are taken as they are"},
      &Fitted::fingerprint);
  }
  /// Throws Error.
  FitProblem problem() const;
  /// Solves where there are no coefficients; progress goes to the ProgressScope. Throws Error where
  /// there are some with the fingerprint of another problem.
  Expression expression() const;
  Quality quality() const { return {}; }
};

/// While there is one on this thread, fields are solved for whatever coefficients they carry.
class IgnoredCoefficients {
 public:
  IgnoredCoefficients() : outer_(std::exchange(active_, true)) {}
  ~IgnoredCoefficients() { active_ = outer_; }
  IgnoredCoefficients(const IgnoredCoefficients&) = delete;
  IgnoredCoefficients& operator=(const IgnoredCoefficients&) = delete;

  static bool active() { return active_; }

 private:
  static thread_local bool active_;
  bool outer_;
};

using FitShapes = OpList<SplineField, Fitted>;

}  // namespace sardf

// Roots, powers, exponentials and trigonometry of the formula language. Angles are in radians.
#pragma once

#include "sardf/ops_arithmetic.hpp"

namespace sardf {

struct SquareRoot : Function<1> {
  static constexpr const char *name = "sqrt", *doc = "the square root of a; 0 for negative a";
  static constexpr bool smooth = true;
  template <class T>
  T eval(T a) const {
    // The select keeps the derivative at and below 0 from being 0 times infinity.
    return select(a > T(0.0), sqrt(max(a, T(0.0))), T(0.0));
  }
};

struct Length2 : Function<2> {
  static constexpr const char *name = "length2", *doc = "the length of the vector (a, b)";
  static constexpr bool distance = true;  // from the origin
  template <class T>
  T eval(T a, T b) const {
    return length(a, b);
  }
};

struct Length3 : Function<3> {
  static constexpr const char *name = "length3", *doc = "the length of the vector (a, b, c)";
  static constexpr bool distance = true;  // from the origin
  template <class T>
  T eval(T a, T b, T c) const {
    return length(a, b, c);
  }
};

/// a to a whole power: products only, so negative a is as good as any.
struct IntegerPower {
  static constexpr const char *name = "integer_power", *doc = "a to a whole power";
  static constexpr Kind kind = Kind::internal;
  static constexpr int arity = 1;
  int exponent = 1;
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"exponent", "the power, from 0"}, &IntegerPower::exponent);
  }
  template <class T>
  T eval(T a) const {
    T power(1.0), base = a;
    for (int rest = exponent; rest > 0; rest /= 2) {
      if (rest % 2) power = power * base;
      base = square(base);
    }
    return power;
  }
};

struct Power : Function<2> {
  static constexpr const char *name = "pow",
                              *doc = "a to the power b; a must not be negative unless b is whole";
  template <class T>
  T eval(T a, T b) const {
    return pow(a, b);
  }
};

struct Exponential : Function<1> {
  static constexpr const char *name = "exp", *doc = "e to the power a";
  static constexpr bool smooth = true;
  template <class T>
  T eval(T a) const {
    return exp(a);
  }
};

struct Logarithm : Function<1> {
  static constexpr const char *name = "log", *doc = "the natural logarithm of a";
  static constexpr bool smooth = true;
  template <class T>
  T eval(T a) const {
    return log(a);
  }
};

struct Sine : Function<1> {
  static constexpr const char *name = "sin", *doc = "the sine of a";
  static constexpr bool smooth = true;
  template <class T>
  T eval(T a) const {
    return sin(a);
  }
};

struct Cosine : Function<1> {
  static constexpr const char *name = "cos", *doc = "the cosine of a";
  static constexpr bool smooth = true;
  template <class T>
  T eval(T a) const {
    return cos(a);
  }
};

struct Tangent : Function<1> {
  static constexpr const char *name = "tan", *doc = "the tangent of a";
  static constexpr bool smooth = true;
  template <class T>
  T eval(T a) const {
    return tan(a);
  }
};

struct ArcSine : Function<1> {
  static constexpr const char *name = "asin", *doc = "the angle whose sine is a";
  template <class T>
  T eval(T a) const {
    return asin(a);
  }
};

struct ArcCosine : Function<1> {
  static constexpr const char *name = "acos", *doc = "the angle whose cosine is a";
  template <class T>
  T eval(T a) const {
    return acos(a);
  }
};

struct ArcTangent2 : Function<2> {
  static constexpr const char *name = "atan2", *doc = "the angle of the vector (b, a)";
  template <class T>
  T eval(T a, T b) const {
    return atan2(a, b);
  }
};

struct Floor : Function<1> {
  static constexpr const char *name = "floor", *doc = "the largest whole number not above a";
  template <class T>
  T eval(T a) const {
    return floor(a);
  }
};

struct Fract : Function<1> {
  static constexpr const char *name = "fract", *doc = "a - floor(a)";
  template <class T>
  T eval(T a) const {
    return a - floor(a);
  }
};

struct Modulo : Function<2> {
  static constexpr const char *name = "mod", *doc = "a - b * floor(a / b)";
  template <class T>
  T eval(T a, T b) const {
    return a - b * floor(a / b);
  }
};

using FunctionOps =
    OpList<SquareRoot, Length2, Length3, IntegerPower, Power, Exponential, Logarithm, Sine, Cosine,
           Tangent, ArcSine, ArcCosine, ArcTangent2, Floor, Fract, Modulo>;

}  // namespace sardf

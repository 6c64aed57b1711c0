// Arithmetic, comparisons and elementary functions: the words of the formula language.
#pragma once

#include "sardf/op_list.hpp"

namespace sardf {

template <int Arity>
struct Function {
  static constexpr Kind kind = Kind::function;
  static constexpr int arity = Arity;
};

struct Add : Function<2> {
  static constexpr const char *name = "add", *doc = "a + b";
  static constexpr bool smooth = true;
  static constexpr std::array<int, 2> monotone{1, 1};
  static constexpr double rounding = 1;
  template <class T>
  T eval(T a, T b) const {
    return a + b;
  }
};

struct Subtract : Function<2> {
  static constexpr const char *name = "subtract", *doc = "a - b";
  static constexpr bool smooth = true;
  static constexpr std::array<int, 2> monotone{1, -1};
  static constexpr double rounding = 1;
  template <class T>
  T eval(T a, T b) const {
    return a - b;
  }
};

struct Multiply : Function<2> {
  static constexpr const char *name = "multiply", *doc = "a * b";
  static constexpr bool smooth = true;
  template <class T>
  T eval(T a, T b) const {
    return a * b;
  }
};

struct Divide : Function<2> {
  static constexpr const char *name = "divide", *doc = "a / b";
  static constexpr bool smooth = true;
  template <class T>
  T eval(T a, T b) const {
    return a / b;
  }
};

struct Negate : Function<1> {
  static constexpr const char *name = "negate", *doc = "-a";
  static constexpr bool smooth = true;
  static constexpr std::array<int, 1> monotone{-1};
  static constexpr double rounding = 0;
  template <class T>
  T eval(T a) const {
    return -a;
  }
};

struct Min : Function<2> {
  static constexpr const char *name = "min", *doc = "the smaller of a and b";
  static constexpr std::array<int, 2> monotone{1, 1};
  static constexpr double rounding = 0;
  double gain(Interval, Interval) const { return 1; }
  template <class T>
  T eval(T a, T b) const {
    return min(a, b);
  }
};

struct Max : Function<2> {
  static constexpr const char *name = "max", *doc = "the larger of a and b";
  static constexpr std::array<int, 2> monotone{1, 1};
  static constexpr double rounding = 0;
  double gain(Interval, Interval) const { return 1; }
  template <class T>
  T eval(T a, T b) const {
    return max(a, b);
  }
};

struct Abs : Function<1> {
  static constexpr const char *name = "abs", *doc = "the magnitude of a";
  template <class T>
  T eval(T a) const {
    return abs(a);
  }
};

struct Sign : Function<1> {
  static constexpr const char *name = "sign",
                              *doc = "-1, 0 or 1 as a is negative, zero or positive";
  template <class T>
  T eval(T a) const {
    return jump(a > T(0.0), T(1.0), jump(a < T(0.0), T(-1.0), T(0.0)));
  }
};

struct Square : Function<1> {
  static constexpr const char *name = "square", *doc = "a * a";
  static constexpr bool smooth = true;
  template <class T>
  T eval(T a) const {
    return square(a);
  }
};

/// A comparison is 1 where it holds and 0 elsewhere.
struct Less : Function<2> {
  static constexpr const char *name = "less", *doc = "1 where a < b, else 0";
  template <class T>
  T eval(T a, T b) const {
    return jump(a < b, T(1.0), T(0.0));
  }
};

struct LessEqual : Function<2> {
  static constexpr const char *name = "less_equal", *doc = "1 where a <= b, else 0";
  template <class T>
  T eval(T a, T b) const {
    return jump(a <= b, T(1.0), T(0.0));
  }
};

struct Equal : Function<2> {
  static constexpr const char *name = "equal", *doc = "1 where a = b, else 0";
  template <class T>
  T eval(T a, T b) const {
    return jump(a <= b && b <= a, T(1.0), T(0.0));
  }
};

struct Select : Function<3> {
  static constexpr const char *name = "select", *doc = "b where the condition a is not 0, else c";
  template <class T>
  T eval(T a, T b, T c) const {
    return jump(a < T(0.0) || a > T(0.0), b, c);
  }
};

struct Clamp : Function<3> {
  static constexpr const char *name = "clamp", *doc = "a limited to the range from b to c";
  static constexpr std::array<int, 3> monotone{1, 1, 1};
  static constexpr double rounding = 0;
  double gain(Interval, Interval, Interval) const { return 1; }
  template <class T>
  T eval(T a, T b, T c) const {
    return min(max(a, b), c);
  }
};

struct Mix : Function<3> {
  static constexpr const char *name = "mix", *doc = "a + (b - a) * c";
  static constexpr bool smooth = true;
  template <class T>
  T eval(T a, T b, T c) const {
    return a + (b - a) * c;
  }
};

struct Step : Function<2> {
  static constexpr const char *name = "step", *doc = "0 where b < a, else 1";
  template <class T>
  T eval(T a, T b) const {
    return jump(b < a, T(0.0), T(1.0));
  }
};

struct SmoothStep : Function<3> {
  static constexpr const char *name = "smoothstep",
                              *doc = "0 below a, 1 above b, a cubic in c between";
  template <class T>
  T eval(T a, T b, T c) const {
    const T t = min(max((c - a) / (b - a), T(0.0)), T(1.0));
    return square(t) * (T(3.0) - (t + t));
  }
};

using ArithmeticOps = OpList<Add, Subtract, Multiply, Divide, Negate, Min, Max, Abs, Sign, Square,
                             Less, LessEqual, Equal, Select, Clamp, Mix, Step, SmoothStep>;

}  // namespace sardf

// A solid and a function that sardf does not have: all that adding an operation takes.
#pragma once

#include "sardf/arithmetic.hpp"
#include "sardf/constructor.hpp"
#include "sardf/constructor_of.hpp"

namespace sardf {

/// A sphere whose radius shrinks along z.
struct Pear {
  static constexpr const char *name = "pear", *doc = "A sphere, thinner at the top.";
  static constexpr Kind kind = Kind::solid;
  static constexpr int arity = 3;
  Vec3 center{};
  double radius = 1, taper = 0.25;
  template <class V>
  static void parameters(V& v) {
    v(length_of("center", "its middle"), &Pear::center);
    v(positive_length("radius", "radius at the middle"), &Pear::radius);
    v(Parameter{"taper", "how fast it gets thinner"}, &Pear::taper);
  }
  template <class T>
  T eval(T x, T y, T z) const {
    const T along = z - T(center[2]);
    return T(radius) - T(taper) * along - length(x - T(center[0]), y - T(center[1]), along);
  }
};

struct Wobble {
  static constexpr const char *name = "wobble", *doc = "sin(a) * exp(-b * b)";
  static constexpr Kind kind = Kind::function;
  static constexpr int arity = 2;
  template <class T>
  T eval(T a, T b) const {
    return sin(a) * exp(-square(b));
  }
};

/// The solid's constructor; the first call adds both to the registries.
inline const Constructor& pear() {
  if (!find_constructor("pear")) {
    add_constructor(constructor_of_operation<Pear>());
    add_function(make_operation(Wobble{}));
  }
  return *find_constructor("pear");
}

}  // namespace sardf

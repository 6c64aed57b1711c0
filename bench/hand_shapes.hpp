// The three shapes over a vector type V of floats: arithmetic operators, and minimum, maximum,
// root, magnitude, any_less, choose_less. Include it in one source file for each V only.
#pragma once

#include "hand_loops.hpp"

namespace sardf::bench {

template <class V>
V sphere(V x, V y, V z, float cx, float cy, float radius) {
  const V dx = x - V(cx), dy = y - V(cy);
  return V(radius) - root(dx * dx + dy * dy + z * z);
}

template <class V>
V box(V x, V y, V z, float hx, float hy, float hz) {
  const V a = magnitude(x) - V(hx), b = magnitude(y) - V(hy), c = magnitude(z) - V(hz);
  const V p = maximum(a, V(0)), q = maximum(b, V(0)), r = maximum(c, V(0));
  return V(0) - minimum(maximum(maximum(a, b), c), V(0)) - root(p * p + q * q + r * r);
}

template <class V>
V cylinder(V x, V y, float cx, float cy, float radius) {
  const V dx = x - V(cx), dy = y - V(cy);
  return V(radius) - root(dx * dx + dy * dy);
}

template <class V>
V torus(V x, V y, V z, float major, float minor) {
  const V across = root(x * x + y * y) - V(major);
  return V(minor) - root(across * across + z * z);
}

struct Hard {
  template <class V>
  static V meet(V a, V b) {
    return minimum(a, b);
  }
  template <class V>
  static V join(V a, V b) {
    return maximum(a, b);
  }
};

/// SARDF of radius 0.5 with lo <= hi: its two roots only where a lane is in the band between equal
/// signs.
struct Rounded {
  static constexpr float radius = 0.5f;

  template <class V>
  static V arcs(V lo, V hi, V apart) {
    const V zero(0), R(radius), depth = maximum(maximum(lo, zero - hi), zero);
    const V side = minimum(apart, depth), band = minimum(apart, R),
            product = depth * (depth + side);
    const V under = choose_less(zero, lo, V(2) * product - V(3) * side * side, V(8) * product);
    const V r = root(maximum(under, zero));
    const V growing = choose_less(zero, lo, (V(2) * side - V(3) * depth + r) * V(1.f / 7),
                                  r - V(3) * depth - side);
    const V fixed = V(0.5f) * (band + root(V(2 * radius * radius) - band * band)) - R;
    return lo + maximum(growing, fixed);
  }
  template <class V>
  static V meet(V a, V b) {
    const V lo = minimum(a, b), hi = maximum(a, b), apart = hi - lo;
    // A lane counts when it is in the band and the signs agree.
    if (!any_less(choose_less(V(0), a * b, apart, V(radius)), V(radius))) return lo;
    return arcs(lo, hi, apart);
  }
  template <class V>
  static V join(V a, V b) {
    const V lo = minimum(a, b), hi = maximum(a, b), apart = hi - lo;
    if (!any_less(choose_less(V(0), a * b, apart, V(radius)), V(radius))) return hi;
    return V(0) - arcs(V(0) - hi, V(0) - lo, apart);
  }
};

struct Spheres {
  template <class V>
  static V at(V x, V y, V z) {
    V f = sphere(x, y, z, -0.75f, -0.75f, 0.3f);
#pragma GCC unroll 16
    for (int i = 1; i < 16; ++i) {
      f = maximum(f,
                  sphere(x, y, z, 0.5f * float(i / 4) - 0.75f, 0.5f * float(i % 4) - 0.75f, 0.3f));
    }
    return minimum(f, V(0) - box(x, y, z - V(0.25f), 0.9f, 0.25f, 0.25f));
  }
};

template <class Blend>
struct DrilledBlock {
  template <class V>
  static V at(V x, V y, V z) {
    V f = box(x, y, z, 10, 6, 4);
    f = Blend::meet(f, V(0) - cylinder(x, y, 0, 0, 3));
    f = Blend::meet(f, V(0) - cylinder(x, y, -8, -4, 1));
    f = Blend::meet(f, V(0) - cylinder(x, y, -8, 4, 1));
    f = Blend::meet(f, V(0) - cylinder(x, y, 8, -4, 1));
    f = Blend::meet(f, V(0) - cylinder(x, y, 8, 4, 1));
    return Blend::join(f, torus(x, y, z, 5, 1));
  }
};

template <class V, class Shape>
void run(const float* x, const float* y, const float* z, float* out, size_t n) {
  for (size_t i = 0; i < n; i += V::width) {
    Shape::at(V::load(x + i), V::load(y + i), V::load(z + i)).store(out + i);
  }
}

template <class V>
constexpr HandLoops loops_of{&run<V, Spheres>, &run<V, DrilledBlock<Hard>>,
                             &run<V, DrilledBlock<Rounded>>};

}  // namespace sardf::bench

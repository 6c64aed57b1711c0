// What constructors that transform space are built with.
#pragma once

#include "sardf/ops_solids.hpp"

namespace sardf {

/// a x + b y + c z + d.
struct Affine {
  static constexpr const char *name = "affine", *doc = "a x + b y + c z + d";
  static constexpr Kind kind = Kind::internal;
  static constexpr int arity = 3;
  Vec3 row{1, 0, 0};
  double offset = 0;
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"row", "a, b, c"}, &Affine::row);
    v(Parameter{"offset", "d"}, &Affine::offset);
  }
  template <class T>
  T eval(T x, T y, T z) const {
    return T(row[0]) * x + T(row[1]) * y + T(row[2]) * z + T(offset);
  }
};

/// The intersection of two fields that vary in perpendicular directions; exact when both are.
struct PerpendicularIntersection {
  static constexpr const char *name = "perpendicular_intersection",
                              *doc = "min inside, -length of the two outside";
  static constexpr Kind kind = Kind::internal;
  static constexpr int arity = 2;
  static constexpr bool distance = true;
  static constexpr std::array<int, 2> monotone{1, 1};
  template <class T>
  T eval(T a, T b) const {
    return perpendicular_intersection(a, b);
  }
};

using DomainOps = OpList<Affine, PerpendicularIntersection>;

}  // namespace sardf

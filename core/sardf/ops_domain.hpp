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

// Below and CopyCoordinate jump; the shapes that are built with them make sure that the whole field
// does not, so their slopes are those between the jumps.

/// One of two fields that agree where a coordinate is at some height.
struct Below {
  static constexpr const char *name = "below", *doc = "a where z is below the height, else b";
  static constexpr Kind kind = Kind::internal;
  static constexpr int arity = 3;
  static constexpr bool hides_jumps = true;
  double height = 0;
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"height", "where a and b agree"}, &Below::height);
  }
  double gain(Interval, Interval, Interval) const { return 1; }
  template <class T>
  T eval(T z, T a, T b) const {
    return select(z < T(height), a, b);
  }
};

/// A coordinate seen from the nearest copy of a row of equal copies at or below it, or from the
/// next one.
struct CopyCoordinate {
  static constexpr const char *name = "copy_coordinate",
                              *doc = "a coordinate from one of the two nearest copies in a row";
  static constexpr Kind kind = Kind::internal;
  static constexpr int arity = 1;
  static constexpr bool hides_jumps = true;
  double spacing = 1, center = 0;
  int upper = 0, last = -1;  // 1: the next copy; the last copy's number, -1: without end
  bool jumps = false;        // whether the slope must say that it jumps
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"spacing", "from copy to copy", Unit::length, Range::positive},
      &CopyCoordinate::spacing);
    v(length_of("center", "the middle of copy 0"), &CopyCoordinate::center);
    v(Parameter{"upper", "1: the next copy above"}, &CopyCoordinate::upper);
    v(Parameter{"last", "number of the last copy, -1: without end"}, &CopyCoordinate::last);
    v(Parameter{"jumps", "whether the slope says that it jumps"}, &CopyCoordinate::jumps);
  }
  template <class T>
  T eval(T x) const {
    T copy = floor((x - T(center)) * T(1 / spacing)) + T(double(upper));
    if (last >= 0) copy = min(max(copy, T(0.0)), T(double(last)));
    return x - T(spacing) * (jumps ? copy : freeze(copy));
  }
};

using DomainOps = OpList<Affine, PerpendicularIntersection, Below, CopyCoordinate>;

}  // namespace sardf

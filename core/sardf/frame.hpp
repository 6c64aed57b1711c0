// A right-handed orthonormal frame around an axis, as operations with an axis use it.
#pragma once

#include <array>

#include "sardf/error.hpp"
#include "sardf/parameter.hpp"
#include "sardf/vec.hpp"

namespace sardf {

/// Coordinates u, v, w about `origin` with w along the axis. For an axis along +z they are x, y, z.
class Frame {
 public:
  void set(const Vec3& origin, const Axis& axis) {
    const double size = norm(axis.direction);
    if (!(size > 0)) throw Error("axis is the zero vector; give a direction such as [0, 0, 1]");
    origin_ = origin;
    w_ = (1 / size) * axis.direction;
    upright_ = w_[2] == 1;
    // The coordinate axis farthest from w gives the best conditioned cross product.
    const bool along_x = std::abs(w_[0]) > 0.9;
    u_ = normalized(cross(along_x ? Vec3{0, 1, 0} : Vec3{1, 0, 0}, w_));
    v_ = cross(w_, u_);
  }

  /// Whether u, v, w are x, y, z less the origin's.
  bool is_upright() const { return upright_; }

  /// The unit vectors of u, v, w.
  std::array<Vec3, 3> rows() const {
    return upright_ ? std::array<Vec3, 3>{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}
                    : std::array<Vec3, 3>{u_, v_, w_};
  }

  template <class T>
  std::array<T, 3> local(T x, T y, T z) const {
    const T px = x - T(origin_[0]), py = y - T(origin_[1]), pz = z - T(origin_[2]);
    if (upright_) return {px, py, pz};
    return {along(u_, px, py, pz), along(v_, px, py, pz), along(w_, px, py, pz)};
  }

 private:
  template <class T>
  static T along(const Vec3& axis, T x, T y, T z) {
    return T(axis[0]) * x + T(axis[1]) * y + T(axis[2]) * z;
  }

  Vec3 origin_{}, u_{1, 0, 0}, v_{0, 1, 0}, w_{0, 0, 1};
  bool upright_ = true;
};

}  // namespace sardf

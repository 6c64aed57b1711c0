// The general quadric: a solid by the sign of a quadratic polynomial, which is no distance.
#pragma once

#include "sardf/op_list.hpp"

namespace sardf {

/// p · M p + v · p + c. Its gradient is (M + Mᵀ) p + v, so its bound over a box is attained at a
/// corner; the certified Lipschitz bound is that.
struct Quadric {
  static constexpr const char *name = "quadric",
                              *doc =
                                  "Where the quadratic polynomial p · M p + v · p + c is not "
                                  "negative: ellipsoids, cones, paraboloids, hyperboloids. Its "
                                  "value is no distance.";
  static constexpr Kind kind = Kind::solid;
  static constexpr int arity = 3;
  static constexpr bool mean_value = true;
  std::vector<Vec3> matrix{{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  Vec3 vector{};
  double constant = 1;
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"matrix", "M, three rows of three numbers", Unit::none, Range::any, true, 3},
      &Quadric::matrix);
    v(Parameter{"vector", "v"}, &Quadric::vector);
    v(Parameter{"constant", "c; with the unit ball's M, -1 on the diagonal, its radius squared"},
      &Quadric::constant);
  }
  void prepare() {
    if (matrix.size() != 3) {
      throw Error("matrix has " + std::to_string(matrix.size()) + " rows; 3 are accepted");
    }
  }

  template <class T>
  T eval(T x, T y, T z) const {
    const auto mixed = [this](int i, int j) { return T(matrix[i][j] + matrix[j][i]); };
    return T(matrix[0][0]) * square(x) + T(matrix[1][1]) * square(y) + T(matrix[2][2]) * square(z) +
           mixed(0, 1) * (x * y) + mixed(1, 2) * (y * z) + mixed(2, 0) * (z * x) +
           T(vector[0]) * x + T(vector[1]) * y + T(vector[2]) * z + T(constant);
  }
};

using QuadricOps = OpList<Quadric>;

}  // namespace sardf

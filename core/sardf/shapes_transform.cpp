#include "sardf/shapes_transform.hpp"

#include <numbers>

#include "sardf/arithmetic.hpp"
#include "sardf/evaluate.hpp"
#include "sardf/ops_domain.hpp"

namespace sardf {

namespace {

using Matrix = std::array<Vec3, 3>;  // rows

constexpr double degree = std::numbers::pi / 180;

std::array<Expression, 3> xyz() { return {coordinate(0), coordinate(1), coordinate(2)}; }

// The field moved by p -> rows p + offset, given the inverse map.
Expression moved(const Field& field, const Matrix& inverse, const Vec3& offset) {
  std::array<Expression, 3> at;
  for (int i = 0; i < 3; ++i) at[i] = affine(xyz(), inverse[i], offset[i]);
  return substitute(field.expression(), at);
}

Vec3 times(const Matrix& m, const Vec3& v) { return {dot(m[0], v), dot(m[1], v), dot(m[2], v)}; }

Matrix times(const Matrix& a, const Matrix& b) {
  Matrix out{};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) out[i][j] += a[i][k] * b[k][j];
    }
  }
  return out;
}

Matrix transposed(const Matrix& m) {
  return {{{m[0][0], m[1][0], m[2][0]}, {m[0][1], m[1][1], m[2][1]}, {m[0][2], m[1][2], m[2][2]}}};
}

Matrix rotation(std::array<double, 4> q) {
  const double size = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(size > 0)) throw Error("quaternion is zero; the identity is [1, 0, 0, 0]");
  const double w = q[0] / size, x = q[1] / size, y = q[2] / size, z = q[3] / size;
  return {{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
           {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
           {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
}

// Sine and cosine of an angle in degrees, exact at the quarter turns.
std::pair<double, double> sine_cosine(double angle) {
  const double turn = angle - 360 * std::floor(angle / 360);
  if (turn == 0) return {0, 1};
  if (turn == 90) return {1, 0};
  if (turn == 180) return {0, -1};
  if (turn == 270) return {-1, 0};
  return {std::sin(turn * degree), std::cos(turn * degree)};
}

// Rodrigues' formula.
Matrix rotation(const Vec3& axis, double angle) {
  if (!(norm(axis) > 0)) throw Error("axis is the zero vector; give a direction");
  const auto [s, c] = sine_cosine(angle);
  const auto [x, y, z] = normalized(axis);
  return {{{c + (1 - c) * x * x, (1 - c) * x * y - s * z, (1 - c) * x * z + s * y},
           {(1 - c) * x * y + s * z, c + (1 - c) * y * y, (1 - c) * y * z - s * x},
           {(1 - c) * x * z - s * y, (1 - c) * y * z + s * x, c + (1 - c) * z * z}}};
}

void need_plane_field(const Field& field) {
  if (field.expression()->coordinates & 4) {
    throw Error("field depends on z; a field of x and y alone is accepted here");
  }
}

}  // namespace

Expression Translate::expression() const {
  return moved(field, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, -1.0 * by);
}

Expression Rotate::expression() const {
  if (angle.has_value() + quaternion.has_value() + euler.has_value() != 1) {
    throw Error("give exactly one of angle, quaternion and euler");
  }
  Matrix m;
  if (angle) {
    m = rotation(axis.direction, *angle);
  } else if (quaternion) {
    m = rotation(*quaternion);
  } else {
    m = times(rotation({0, 0, 1}, (*euler)[2]),
              times(rotation({0, 1, 0}, (*euler)[1]), rotation({1, 0, 0}, (*euler)[0])));
  }
  const Matrix inverse = transposed(m);
  return moved(field, inverse, center - times(inverse, center));
}

Expression Scale::expression() const {
  const double s = 1 / factor;
  return constant(factor) * moved(field, {{{s, 0, 0}, {0, s, 0}, {0, 0, s}}}, (1 - s) * center);
}

Expression Mirror::expression() const {
  if (!(norm(normal.direction) > 0)) throw Error("normal is the zero vector; give a direction");
  const Vec3 n = normalized(normal.direction);
  Matrix m;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) m[i][j] = (i == j) - 2 * n[i] * n[j];
  }
  return moved(field, m, 2 * dot(point, n) * n);
}

Expression Extrude::expression() const {
  need_plane_field(field);
  const Expression slab = constant(0.5 * height) - abs(coordinate(2));
  return call(make_operation(PerpendicularIntersection{}), {field.expression(), slab});
}

Expression Revolve::expression() const {
  need_plane_field(field);
  return substitute(field.expression(),
                    {length(coordinate(0), coordinate(1)), coordinate(2), constant(0)});
}

// The plane field's nearest point may lie at x < 0, which the turned solid does not have, unless
// the profile is proven to stay on its side of the axis.
Quality Revolve::quality() const {
  const Evaluator profile(field.expression());
  const Interval behind = profile.interval({{-infinity, -infinity, 0}, {0, infinity, 0}});
  return behind.hi <= 0 ? field.quality() : Quality{};
}

}  // namespace sardf

// Solids, materials and textured meshes for the tests and benchmarks of the baker.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "sardf/arithmetic.hpp"
#include "sardf/atlas.hpp"
#include "sardf/bake.hpp"
#include "sardf/evaluate.hpp"
#include "sardf/mesher.hpp"
#include "sardf/operation_of.hpp"
#include "sardf/ops.hpp"

namespace sardf::test {

inline std::array<Expression, 3> xyz() { return {coordinate(0), coordinate(1), coordinate(2)}; }

template <class Op>
Expression solid(Op op) {
  return call(make_operation(op), {coordinate(0), coordinate(1), coordinate(2)});
}

inline Expression sphere(const Vec3& center, double radius) {
  Sphere op;
  op.center = center;
  op.radius = radius;
  return solid(op);
}
inline Expression box(const Vec3& center, const Vec3& size) {
  Box op;
  op.center = center;
  op.size = size;
  return solid(op);
}
inline Expression cylinder(const Vec3& center, double radius) {
  Cylinder op;
  op.center = center;
  op.radius = radius;
  return solid(op);
}
inline Expression torus(double major_radius, double minor_radius) {
  Torus op;
  op.major_radius = major_radius;
  op.minor_radius = minor_radius;
  return solid(op);
}
inline Expression capped_cylinder(double radius, double height) {
  return min(cylinder({0, 0, 0}, radius), box({0, 0, 0}, {1e3, 1e3, height}));
}

/// S3 of the benchmarks: a block with a bore and four bolt holes, a torus around it, joined by
/// sardf with R = 0.5.
inline Expression block_with_bores() {
  Sardf blend;
  blend.radius = 0.5;
  const OperationPointer cut = make_operation(DifferenceOf<Sardf>(blend));
  const OperationPointer join = make_operation(UnionOf<Sardf>(blend));
  Expression f = call(cut, {box({0, 0, 0}, {20, 12, 8}), cylinder({0, 0, 0}, 3)});
  for (const double x : {-8.0, 8.0})
    for (const double y : {-4.0, 4.0}) f = call(cut, {f, cylinder({x, y, 0}, 1)});
  return call(join, {f, torus(5, 1)});
}
inline BoundingBox block_bounds() { return {{-10.01, -6.011, -4.012}, {10.01, 6.011, 4.012}}; }

/// Fractions by inverse distances u to the features, weights u^-exponent, by way of logarithms.
inline std::vector<Expression> inverse_distance(const std::vector<Expression>& u, double exponent) {
  std::vector<Expression> a, weight;
  Expression top, sum;
  for (const Expression& each : u)
    a.push_back(constant(-exponent) * log(max(each, constant(1e-9))));
  for (const Expression& each : a) top = top ? max(top, each) : each;
  for (const Expression& each : a) {
    weight.push_back(exp(each - top));
    sum = sum ? sum + weight.back() : weight.back();
  }
  for (Expression& each : weight) each = each / sum;
  return weight;
}

/// The distance to a point.
inline Expression distance_to(const Vec3& at) { return -sphere(at, 1e-9); }

/// A meshed solid with its atlas.
struct Part {
  Expression solid;
  Mesh mesh;
  Atlas atlas;
  Part(Expression f, const BoundingBox& bounds, int resolution, int size = 2048) : solid(f) {
    MeshOptions options;
    options.resolution = resolution;
    mesh = make_mesh(Evaluator(f), bounds, options);
    atlas = make_atlas(mesh, size);
  }
};

/// A point of the mesh: where it lies in space and in the texture.
struct SurfacePoint {
  uint32_t face = 0;
  Vec3 position{};
  Vec2 uv{};
};

/// Points spread evenly over the area of the mesh.
inline std::vector<SurfacePoint> random_points(const Mesh& mesh, size_t count, unsigned seed) {
  std::vector<double> sums;
  double sum = 0;
  const auto corner = [&](size_t triangle, size_t k) -> const Vec3& {
    const size_t at = k == 0 ? 0 : k + triangle % 2;
    return mesh.vertices[mesh.faces[triangle / 2][at]];
  };
  for (size_t t = 0; t < 2 * mesh.faces.size(); ++t) {
    sum += norm(cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0)));
    sums.push_back(sum);
  }
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<SurfacePoint> points(count);
  for (SurfacePoint& p : points) {
    const auto at = std::upper_bound(sums.begin(), sums.end() - 1, sum * uniform(random));
    const size_t t = size_t(at - sums.begin());
    double b = uniform(random), c = uniform(random);
    if (b + c > 1) {
      b = 1 - b;
      c = 1 - c;
    }
    p.face = static_cast<uint32_t>(t / 2);
    p.position =
        corner(t, 0) + b * (corner(t, 1) - corner(t, 0)) + c * (corner(t, 2) - corner(t, 0));
    const Vec2* uv = &mesh.corner_uv[4 * (t / 2)];
    const Vec2 &u0 = uv[0], &u1 = uv[1 + t % 2], &u2 = uv[2 + t % 2];
    for (size_t i = 0; i < 2; ++i) p.uv[i] = u0[i] + b * (u1[i] - u0[i]) + c * (u2[i] - u0[i]);
  }
  return points;
}

/// The four texels and weights of a bilinear lookup that repeats the image's border texels.
struct Lookup {
  std::array<std::array<int, 2>, 4> texel;
  std::array<double, 4> weight;
  Lookup(const Vec2& uv, int size) {
    const double x = uv[0] * size - 0.5, y = (1 - uv[1]) * size - 0.5;
    const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
    const double s = x - i, t = y - j;
    const auto inside = [size](int a) { return std::clamp(a, 0, size - 1); };
    for (size_t k = 0; k < 4; ++k) {
      const int right = static_cast<int>(k % 2), down = static_cast<int>(k / 2);
      texel[k] = {inside(i + right), inside(j + down)};
      weight[k] = (right ? s : 1 - s) * (down ? t : 1 - t);
    }
  }
  double of(const Image& image, int channel) const {
    double sum = 0;
    for (size_t k = 0; k < 4; ++k) sum += weight[k] * image.at(texel[k][0], texel[k][1])[channel];
    return sum;
  }
};

}  // namespace sardf::test

// How the points of whole triangles are moved onto a curved surface: a few nodes of a triangle are
// moved by Newton's steps, and polynomials through them say how all its other points move.

#include <cmath>

#include "sardf/bake_stages.hpp"

namespace sardf::baking {
namespace {

using L = Lanes<Baseline>;

constexpr size_t block_size = Evaluator::block_size;
constexpr int degree = Bend::degree;
/// The nodes of a triangle: those where degree times the weights of its second and third corner are
/// whole numbers.
constexpr size_t nodes = (degree + 1) * (degree + 2) / 2;
constexpr size_t most_triangles = block_size / nodes;
/// The nodes of a smaller triangle would cost more than its texels.
constexpr uint32_t fewest_texels = 3 * nodes;
/// Smallest squared cosine between the gradient at a node and the face's normal: 30 degrees. With
/// the 45 degrees of single points this leaves room for those between the nodes.
constexpr float aligned = 0.75f;
/// Share of a triangle's limit by which nodes may move: the polynomial through them is nowhere
/// larger than 3.5 times the largest of them.
constexpr float share_of_limit = 0.25f;

using Values = std::array<float, block_size>;
using Node = std::array<double, 3>;

/// Of each node, in rows of equal weight of the third corner.
constexpr auto places = [] {
  std::array<std::array<int, 2>, nodes> all{};
  size_t k = 0;
  for (int q = 0; q <= degree; ++q)
    for (int p = 0; p + q <= degree; ++p) all[k++] = {p, q};
  return all;
}();

Vec3 position(const Triangle& on, size_t node) {
  const auto [p, q] = places[node];
  const double b = double(p) / degree, c = double(q) / degree;
  return on.corner[0] + b * (on.corner[1] - on.corner[0]) + c * (on.corner[2] - on.corner[0]);
}

/// The nodes of some triangles on their way onto the surface, in one block.
class Nodes {
 public:
  Nodes(const Evaluator& solid, float tolerance) : solid_(solid), tolerance_(tolerance) {}

  bool is_full() const { return count_ == most_triangles; }
  void add(uint32_t triangle, const Triangle& on) {
    triangle_[count_] = triangle;
    for (size_t k = 0; k < nodes; ++k) {
      const Vec3 from = position(on, k);
      for (size_t axis = 0; axis < 3; ++axis) at_[axis][count_ * nodes + k] = float(from[axis]);
    }
    ++count_;
  }

  /// Appends bends for the triangles that have one; none are left.
  void finish(const TilePoints& points, Bends& bends) {
    if (count_ == 0) return;
    take_step(points);
    if (count_ == 0) return;
    evaluate();
    for (size_t i = 0; i < count_; ++i) {
      if (!has_arrived(i, points)) continue;
      bends.of[triangle_[i]] = static_cast<uint32_t>(bends.bends.size());
      bends.bends.push_back(bend_of(points.triangles[triangle_[i]], i));
    }
    count_ = 0;
  }

 private:
  size_t size() const { return count_ * nodes; }
  void evaluate() {
    float* out = value_.data();
    solid_.block(at_[0].data(), at_[1].data(), at_[2].data(), size(), &out);
  }

  /// Newton's step of all nodes; triangles with a gradient that is not aligned are left out. One
  /// step is enough for what has_arrived: the other triangles' points are moved one by one.
  void take_step(const TilePoints& points) {
    float* const by[3] = {gradient_[0].data(), gradient_[1].data(), gradient_[2].data()};
    solid_.gradient_block(at_[0].data(), at_[1].data(), at_[2].data(), size(), value_.data(), by);
    size_t kept = 0;
    for (size_t i = 0; i < count_; ++i) {
      if (!is_aligned(i, points.surfaces[triangle_[i]].normal)) continue;
      triangle_[kept] = triangle_[i];
      for (size_t k = 0; k < nodes; ++k) step_to(kept * nodes + k, i * nodes + k);
      ++kept;
    }
    count_ = kept;
  }
  void step_to(size_t to, size_t from) {
    for (size_t axis = 0; axis < 3; ++axis) {
      at_[axis][to] = at_[axis][from] - step(axis, from);
      gradient_[axis][to] = gradient_[axis][from];
    }
  }
  bool is_aligned(size_t i, const std::array<float, 3>& normal) const {
    for (size_t k = i * nodes; k < (i + 1) * nodes; ++k) {
      float cosine = 0;
      for (size_t axis = 0; axis < 3; ++axis) cosine += gradient_[axis][k] * normal[axis];
      const float squared = squared_gradient(k);
      if (!(cosine * cosine >= aligned * squared) || !(squared > 0)) return false;
    }
    return true;
  }
  float squared_gradient(size_t k) const {
    return gradient_[0][k] * gradient_[0][k] + gradient_[1][k] * gradient_[1][k] +
           gradient_[2][k] * gradient_[2][k];
  }
  float step(size_t axis, size_t k) const {
    return value_[k] / squared_gradient(k) * gradient_[axis][k];
  }

  bool has_arrived(size_t i, const TilePoints& points) const {
    const float limit = share_of_limit * points.surfaces[triangle_[i]].limit;
    for (size_t k = 0; k < nodes; ++k) {
      if (!(std::abs(value_[i * nodes + k]) <= tolerance_)) return false;
      const Node by = movement(points.triangles[triangle_[i]], i, k);
      if (!(dot(by, by) <= double(limit) * double(limit))) return false;
    }
    return true;
  }
  /// How far node k of the i-th triangle moves. What rounding left is removed by the last gradient.
  Node movement(const Triangle& on, size_t i, size_t k) const {
    Node by = position(on, k);
    for (size_t axis = 0; axis < 3; ++axis)
      by[axis] = double(at_[axis][i * nodes + k]) - by[axis] - double(step(axis, i * nodes + k));
    return by;
  }

  using Factors = decltype(Bend::factor);

  /// Times (number - from) / (from + 1), which the next term of Newton's formula has more than the
  /// one before; the number is linear in texel coordinates.
  static void multiply(Factors& a, int of_degree, const Linear& number, int from) {
    const double scale = 1.0 / (from + 1);
    const L value(scale * (number.value - from)), by_x(scale * number.by_x),
        by_y(scale * number.by_y);
    for (size_t p = size_t(of_degree) + 2; p-- > 0;)
      for (size_t q = size_t(of_degree) + 2 - p; q-- > 0;) {
        L sum = value * a[p][q];
        if (p > 0) sum = sum + by_x * a[p - 1][q];
        if (q > 0) sum = sum + by_y * a[p][q - 1];
        a[p][q] = sum;
      }
  }

  /// Newton's formula: the differences of the nodes' movements times binomials of degree times the
  /// weights, here multiplied out.
  Bend bend_of(const Triangle& on, size_t i) const {
    const Factors difference = differences(on, i);
    const auto along = [](const Linear& a) {
      return Linear{degree * a.value, degree * a.by_x, degree * a.by_y};
    };
    const Linear s = along(on.b), t = along(on.c);
    Factors zeros;
    for (auto& row : zeros) row.fill(L(0.0));
    Factors sum = zeros;
    for (int p = degree; p >= 0; --p) {
      if (p < degree) multiply(sum, degree - p - 1, s, p);
      Factors term = zeros;
      for (int q = degree - p; q >= 0; --q) {
        if (p + q < degree) multiply(term, degree - p - q - 1, t, q);
        term[0][0] = term[0][0] + difference[size_t(p)][size_t(q)];
      }
      for (size_t j = 0; j + size_t(p) <= degree; ++j)
        for (size_t k = 0; j + k + size_t(p) <= degree; ++k) sum[j][k] = sum[j][k] + term[j][k];
    }
    return {sum};
  }

  Factors differences(const Triangle& on, size_t i) const {
    Factors a;
    for (size_t k = 0; k < nodes; ++k) {
      const Node by = movement(on, i, k);
      const float lanes[4] = {float(by[0]), float(by[1]), float(by[2]), 0};
      a[size_t(places[k][0])][size_t(places[k][1])] = L::load(lanes);
    }
    for (size_t order = 1; order <= degree; ++order)
      for (size_t q = 0; q + order <= degree; ++q)
        for (size_t p = degree - q; p >= order; --p) a[p][q] = a[p][q] - a[p - 1][q];
    for (size_t order = 1; order <= degree; ++order)
      for (size_t p = 0; p + order <= degree; ++p)
        for (size_t q = degree - p; q >= order; --q) a[p][q] = a[p][q] - a[p][q - 1];
    return a;
  }

  const Evaluator& solid_;
  float tolerance_;
  size_t count_ = 0;
  std::array<uint32_t, most_triangles> triangle_;
  std::array<Values, 3> at_, gradient_;
  Values value_;
};

/// The triangles large enough to have a bend that are not within the tolerance at the middles of
/// their edges.
void find_curved(const Evaluator& solid, const TilePoints& points, float tolerance,
                 std::vector<uint32_t>& curved) {
  std::array<Values, 3> at;
  Values value;
  std::array<uint32_t, block_size / 3> triangle;
  size_t count = 0;
  const auto finish = [&] {
    float* out = value.data();
    if (count > 0) solid.block(at[0].data(), at[1].data(), at[2].data(), 3 * count, &out);
    for (size_t i = 0; i < count; ++i)
      if (std::any_of(&value[3 * i], &value[3 * i] + 3,
                      [&](float each) { return std::abs(each) > tolerance; }))
        curved.push_back(triangle[i]);
    count = 0;
  };
  curved.clear();
  for (uint32_t i = 0; i < points.triangles.size(); ++i) {
    const Triangle& on = points.triangles[i];
    if (on.texels < fewest_texels || on.is_thin) continue;
    for (size_t k = 0; k < 3; ++k) {
      const Vec3 middle = 0.5 * (on.corner[k] + on.corner[(k + 1) % 3]);
      for (size_t axis = 0; axis < 3; ++axis) at[axis][3 * count + k] = float(middle[axis]);
    }
    triangle[count] = i;
    if (++count == triangle.size()) finish();
  }
  finish();
}

}  // namespace

void find_bends(const Evaluator& solid, const TilePoints& points, float tolerance, Bends& bends) {
  bends.of.assign(points.triangles.size(), Bends::none);
  bends.bends.clear();
  thread_local std::vector<uint32_t> curved;
  find_curved(solid, points, tolerance, curved);
  Nodes waiting(solid, tolerance);
  for (const uint32_t i : curved) {
    waiting.add(i, points.triangles[i]);
    if (waiting.is_full()) waiting.finish(points, bends);
  }
  waiting.finish(points, bends);
}

}  // namespace sardf::baking

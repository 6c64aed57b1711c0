// How the points of a curved triangle are moved onto the surface together.
//
// Gradients are taken at three points only: between them they are nearly linear. Along these a few
// nodes of a large triangle are moved, and polynomials through the nodes say how all its points
// move. Whether a point arrived is for its value there to say (bake_project.cpp).

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
constexpr int steps = 2;
/// Guides of smaller triangles would cost more than steps of each of their points.
constexpr uint32_t fewest_for_directions = 6, fewest_for_bend = 40;
/// Gradients are taken so far inside of a triangle's corners, as weights of the other two: at a
/// corner on an edge of the solid the gradient may be that of the other face.
constexpr double inside = 1. / 16;
/// Smallest squared cosine between the gradient at a node and the face's normal: 30 degrees. With
/// the 45 degrees of single points this leaves room for those between the nodes.
constexpr float aligned = 0.75f;
/// Smallest cosine between the gradients of a triangle: 18 degrees. Where it is less the triangle
/// may lie across an edge of the solid, and between its corners gradients are not linear.
constexpr float alike = 0.95f;
/// Share of a triangle's limit by which nodes may move: the polynomial through them is nowhere
/// larger than 3.5 times the largest of them.
constexpr float share_of_limit = 0.25f;

using Values = std::array<float, block_size>;

/// Of each node, in rows of equal weight of the third corner.
constexpr auto places = [] {
  std::array<std::array<int, 2>, nodes> all{};
  size_t k = 0;
  for (int q = 0; q <= degree; ++q)
    for (int p = 0; p + q <= degree; ++p) all[k++] = {p, q};
  return all;
}();

/// Of the three corners at a node.
std::array<float, 3> weights(size_t node) {
  const auto [p, q] = places[node];
  const float b = float(p) / degree, c = float(q) / degree;
  return {1 - b - c, b, c};
}

Vec3 position(const Triangle& on, size_t node) {
  const auto [a, b, c] = weights(node);
  return double(a) * on.corner[0] + double(b) * on.corner[1] + double(c) * on.corner[2];
}

float dot(const std::array<float, 3>& a, const std::array<float, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// The nodes of some triangles on their way onto the surface, in one block.
class Nodes {
 public:
  Nodes(const LocalEvaluator& solid, float tolerance) : solid_(solid), tolerance_(tolerance) {}

  bool is_full() const { return count_ == most_triangles; }
  void add(uint32_t triangle) { triangle_[count_++] = triangle; }

  /// Appends bends for the triangles that have one; none are left.
  void finish(const TilePoints& points, Guides& guides) {
    if (count_ > 0) take_steps(points, guides);
    for (size_t i = 0; i < count_; ++i) {
      if (!has_arrived(i, points.surfaces[triangle_[i]].limit)) continue;
      guides.bend_of[triangle_[i]] = static_cast<uint32_t>(guides.bends.size());
      guides.bends.push_back(bend_of(points.triangles[triangle_[i]], i));
    }
    count_ = 0;
  }

 private:
  /// Steps of all nodes along what the corners' gradients are between them: that is not quite their
  /// own, so that each step leaves a hundredth of the value.
  void take_steps(const TilePoints& points, const Guides& guides) {
    std::array<Values, 3> along;
    for (size_t i = 0; i < count_; ++i) {
      const Triangle& on = points.triangles[triangle_[i]];
      const auto& of = guides.directions[guides.directions_of[triangle_[i]]].corner;
      for (size_t k = 0; k < nodes; ++k) {
        const std::array<float, 3> weight = weights(k);
        const Vec3 from = position(on, k);
        for (size_t axis = 0; axis < 3; ++axis) {
          along[axis][i * nodes + k] =
              weight[0] * of[0][axis] + weight[1] * of[1][axis] + weight[2] * of[2][axis];
          start_[axis][i * nodes + k] = from[axis];
          at_[axis][i * nodes + k] = float(from[axis]);
        }
      }
    }
    evaluate();
    for (int step = 0; step < steps; ++step) {
      for (size_t axis = 0; axis < 3; ++axis)
        for (size_t k = 0; k < count_ * nodes; ++k) at_[axis][k] -= value_[k] * along[axis][k];
      evaluate();
    }
    // What rounding and the last step left is taken away unrounded.
    for (size_t axis = 0; axis < 3; ++axis)
      for (size_t k = 0; k < count_ * nodes; ++k)
        movement_[axis][k] =
            float(double(at_[axis][k]) - start_[axis][k]) - value_[k] * along[axis][k];
  }

  void evaluate() {
    float* out = value_.data();
    solid_.block(at_[0].data(), at_[1].data(), at_[2].data(), count_ * nodes, &out);
  }

  bool has_arrived(size_t i, float limit) const {
    const float most = share_of_limit * limit;
    for (size_t k = i * nodes; k < (i + 1) * nodes; ++k) {
      const std::array<float, 3> by{movement_[0][k], movement_[1][k], movement_[2][k]};
      if (!(std::abs(value_[k]) <= tolerance_) || !(dot(by, by) <= most * most)) return false;
    }
    return true;
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
    const Factors difference = differences(i);
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

  Factors differences(size_t i) const {
    Factors a;
    for (size_t k = 0; k < nodes; ++k) {
      const size_t at = i * nodes + k;
      const float lanes[4] = {movement_[0][at], movement_[1][at], movement_[2][at], 0};
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

  const LocalEvaluator& solid_;
  float tolerance_;
  size_t count_ = 0;
  std::array<uint32_t, most_triangles> triangle_;
  std::array<Values, 3> at_, movement_;
  std::array<std::array<double, block_size>, 3> start_;
  Values value_;
};

/// Three points of each of many triangles, in one block.
class ThreePoints {
 public:
  static constexpr size_t most = block_size / 3;
  size_t count = 0;
  std::array<uint32_t, most> triangle;
  std::array<Values, 3> at;

  /// The points where `own` is the weight of one corner and `others` that of the other two.
  void add(uint32_t number, const Triangle& on, double own, double others) {
    const Vec3 rest = others * (on.corner[0] + on.corner[1] + on.corner[2]);
    for (size_t k = 0; k < 3; ++k) {
      const Vec3 point = rest + (own - others) * on.corner[k];
      for (size_t axis = 0; axis < 3; ++axis) at[axis][3 * count + k] = float(point[axis]);
    }
    triangle[count++] = number;
  }
};

/// The triangles large enough to have guides that are not within the tolerance at the middles of
/// their edges.
void find_curved(const LocalEvaluator& solid, const TilePoints& points, float tolerance,
                 std::vector<uint32_t>& curved) {
  ThreePoints middles;
  const auto finish = [&] {
    Values value;
    float* out = value.data();
    const size_t n = 3 * middles.count;
    if (n > 0)
      solid.block(middles.at[0].data(), middles.at[1].data(), middles.at[2].data(), n, &out);
    for (size_t i = 0; i < middles.count; ++i)
      if (std::any_of(&value[3 * i], &value[3 * i] + 3,
                      [&](float each) { return std::abs(each) > tolerance; }))
        curved.push_back(middles.triangle[i]);
    middles.count = 0;
  };
  curved.clear();
  for (uint32_t i = 0; i < points.triangles.size(); ++i) {
    const Triangle& on = points.triangles[i];
    if (on.texels < fewest_for_directions || on.is_thin) continue;
    middles.add(i, on, 0, 0.5);
    if (middles.count == ThreePoints::most) finish();
  }
  finish();
}

/// Directions from the gradients inside of the corners; false where one is not aligned or they are
/// not alike.
bool find_directions(const std::array<std::array<float, 3>, 3>& gradient, const Triangle& on,
                     const std::array<float, 3>& normal, Directions& made) {
  std::array<std::array<float, 3>, 3> along;
  for (size_t k = 0; k < 3; ++k) {
    const float squared = dot(gradient[k], gradient[k]), cosine = dot(gradient[k], normal);
    if (!(cosine * cosine >= aligned * squared) || !(squared > 0)) return false;
    for (size_t axis = 0; axis < 3; ++axis) along[k][axis] = gradient[k][axis] / squared;
  }
  for (size_t k = 0; k < 3; ++k) {
    const auto &a = gradient[k], &b = gradient[(k + 1) % 3];
    const float product = dot(a, b);
    if (!(product > 0 && product * product >= alike * alike * dot(a, a) * dot(b, b))) return false;
  }
  const Vec3 e1 = on.corner[1] - on.corner[0], e2 = on.corner[2] - on.corner[0];
  const Vec3 across = cross(e1, e2);
  const double area = 1 / sardf::dot(across, across);
  const Vec3 to_b = area * cross(e2, across), to_c = area * cross(across, e1);
  for (size_t axis = 0; axis < 3; ++axis) {
    made.origin[axis] = float(on.corner[0][axis]);
    made.to_b[axis] = float(to_b[axis]);
    made.to_c[axis] = float(to_c[axis]);
    const float rest = float(inside) * (along[0][axis] + along[1][axis] + along[2][axis]);
    for (size_t k = 0; k < 3; ++k)
      made.corner[k][axis] = (along[k][axis] - rest) / float(1 - 3 * inside);
  }
  return true;
}

/// Of the curved triangles.
void find_directions(const LocalEvaluator& solid, const TilePoints& points,
                     std::span<const uint32_t> curved, Guides& guides) {
  ThreePoints corners;
  for (size_t first = 0; first < curved.size(); first += ThreePoints::most) {
    corners.count = 0;
    for (const uint32_t i :
         curved.subspan(first, std::min(ThreePoints::most, curved.size() - first)))
      corners.add(i, points.triangles[i], 1 - 2 * inside, inside);
    Values value;
    std::array<Values, 3> gradient;
    float* const by[3] = {gradient[0].data(), gradient[1].data(), gradient[2].data()};
    solid.gradient_block(corners.at[0].data(), corners.at[1].data(), corners.at[2].data(),
                         3 * corners.count, value.data(), by);
    for (size_t i = 0; i < corners.count; ++i) {
      const uint32_t number = corners.triangle[i];
      std::array<std::array<float, 3>, 3> of;
      for (size_t k = 0; k < 3; ++k)
        of[k] = {gradient[0][3 * i + k], gradient[1][3 * i + k], gradient[2][3 * i + k]};
      Directions made;
      if (!find_directions(of, points.triangles[number], points.surfaces[number].normal, made))
        continue;
      guides.directions_of[number] = static_cast<uint32_t>(guides.directions.size());
      guides.directions.push_back(made);
    }
  }
}

}  // namespace

void find_guides(const LocalEvaluator& solid, const TilePoints& points, float tolerance,
                 Guides& guides) {
  guides.bend_of.assign(points.triangles.size(), Guides::none);
  guides.directions_of.assign(points.triangles.size(), Guides::none);
  guides.bends.clear();
  guides.directions.clear();
  thread_local std::vector<uint32_t> curved;
  find_curved(solid, points, tolerance, curved);
  find_directions(solid, points, curved, guides);
  Nodes waiting(solid, tolerance);
  for (const uint32_t i : curved) {
    if (guides.directions_of[i] == Guides::none || points.triangles[i].texels < fewest_for_bend)
      continue;
    waiting.add(i);
    if (waiting.is_full()) waiting.finish(points, guides);
  }
  waiting.finish(points, guides);
}

}  // namespace sardf::baking

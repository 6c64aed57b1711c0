// Distance to B-spline surfaces: against other primitives, and a sampling with refinement that
// evaluates the surface by basis functions, which the product does not use.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "feature_checks.hpp"
#include "sardf/error.hpp"
#include "sardf/surface_set.hpp"

namespace sardf {
namespace {

using features::Draw;

/// One direction's basis functions by the Cox-de Boor recursion.
class Basis {
 public:
  Basis(int degree, std::vector<double> knots, int count, bool closed)
      : degree_(degree), count_(size_t(count)), knots_(std::move(knots)) {
    const int all = count + (closed ? degree : 0);
    if (knots_.empty()) {
      for (int i = 0; i <= all + degree; ++i) {
        knots_.push_back(closed ? i : std::clamp(i, degree, all));
      }
    }
    low_ = knots_[size_t(degree)];
    high_ = knots_[size_t(all)];
  }
  /// The weight of every control point at the share s of the parameter's range.
  std::vector<double> operator()(double s) const {
    const double t = low_ + s * (high_ - low_);
    size_t at = size_t(degree_);
    while (at + size_t(degree_) + 2 < knots_.size() && knots_[at + 1] <= t) ++at;
    while (!(knots_[at] < knots_[at + 1])) --at;
    std::vector<double> basis{1};
    for (size_t d = 1; d <= size_t(degree_); ++d) {
      std::vector<double> next(d + 1, 0.0);
      for (size_t k = 0; k < d; ++k) {
        const double left = knots_[at + k + 1 - d], right = knots_[at + k + 1];
        next[k] += basis[k] * (right - t) / (right - left);
        next[k + 1] += basis[k] * (t - left) / (right - left);
      }
      basis = next;
    }
    std::vector<double> all(count_, 0.0);
    for (size_t k = 0; k < basis.size(); ++k) {
      all[(at - size_t(degree_) + k) % count_] += basis[k];
    }
    return all;
  }

 private:
  int degree_;
  size_t count_;
  std::vector<double> knots_;
  double low_ = 0, high_ = 1;
};

class Reference {
 public:
  explicit Reference(const SurfaceData& data)
      : data_(data),
        u_(int(data.degree_u), data.knots_u, int(data.control_points.size()), data.closed_u),
        v_(int(data.degree_v), data.knots_v, int(data.control_points[0].size()), data.closed_v) {}

  Vec3 operator()(double s, double t) const { return at(u_(s), v_(t)); }

  void sample(int count) {
    std::vector<std::vector<double>> along_u, along_v;
    for (int i = 0; i <= count; ++i) {
      along_u.push_back(u_(double(i) / count));
      along_v.push_back(v_(double(i) / count));
    }
    count_ = count;
    for (const auto& u : along_u) {
      for (const auto& v : along_v) samples_.push_back(at(u, v));
    }
    for (int i = 0; i < count; ++i) {
      for (int j = 0; j < count; ++j) {
        apart_ = std::max(apart_, norm(sampled(i + 1, j + 1) - sampled(i, j)));
        apart_ = std::max(apart_, norm(sampled(i + 1, j) - sampled(i, j + 1)));
      }
    }
  }

  /// Every sample lower than its neighbours that may lie beside the nearest point is refined.
  double distance(const Vec3& p) const {
    std::vector<double> d;
    for (const Vec3& s : samples_) d.push_back(norm(s - p));
    double best = *std::min_element(d.begin(), d.end());
    const double within = best + apart_;
    for (int i = 0; i <= count_; ++i) {
      for (int j = 0; j <= count_; ++j) {
        const double here = d[place(i, j)];
        if (here > within || !is_low(d, i, j)) continue;
        best = std::min(best, refined(p, double(i) / count_, double(j) / count_));
      }
    }
    return best;
  }
  /// A search in eight directions with a shrinking step.
  double refined(const Vec3& p, double s, double t) const {
    double best = norm((*this)(s, t) - p);
    for (double step = 1.0 / count_; step > 1e-8; step *= 0.5) {
      for (bool moved = true; moved;) {
        moved = false;
        for (int k = 0; k < 9; ++k) {
          const double x = std::clamp(s + step * (k / 3 - 1), 0.0, 1.0);
          const double y = std::clamp(t + step * (k % 3 - 1), 0.0, 1.0);
          const double d = norm((*this)(x, y) - p);
          if (d < best) {
            best = d;
            s = x;
            t = y;
            moved = true;
          }
        }
      }
    }
    return best;
  }

 private:
  size_t place(int i, int j) const { return size_t(i * (count_ + 1) + j); }
  const Vec3& sampled(int i, int j) const { return samples_[place(i, j)]; }
  bool is_low(const std::vector<double>& d, int i, int j) const {
    for (int k = std::max(0, i - 1); k <= std::min(count_, i + 1); ++k) {
      for (int l = std::max(0, j - 1); l <= std::min(count_, j + 1); ++l) {
        if (d[place(k, l)] < d[place(i, j)]) return false;
      }
    }
    return true;
  }
  Vec3 at(const std::vector<double>& u, const std::vector<double>& v) const {
    Vec3 sum{};
    double weights = 0;
    for (size_t i = 0; i < u.size(); ++i) {
      for (size_t j = 0; j < v.size(); ++j) {
        const double w =
            u[i] * v[j] * (data_.weights.empty() ? 1 : data_.weights[i * v.size() + j]);
        sum = sum + w * data_.control_points[i][j];
        weights += w;
      }
    }
    return (1 / weights) * sum;
  }
  SurfaceData data_;
  Basis u_, v_;
  int count_ = 0;
  double apart_ = 0;
  std::vector<Vec3> samples_;
};

SurfaceData random_surface(Draw& draw, int kind) {
  SurfaceData data;
  const int degree_u = 1 + draw.below(kind % 4 == 3 ? 6 : 3), degree_v = 1 + draw.below(4);
  const int rows = degree_u + 1 + draw.below(4), columns = degree_v + 1 + draw.below(4);
  data.degree_u = degree_u;
  data.degree_v = degree_v;
  for (int i = 0; i < rows; ++i) {
    std::vector<Vec3> row;
    for (int j = 0; j < columns; ++j) {
      row.push_back(Vec3{1.5 * i, 1.5 * j, 0} - Vec3{3, 3, 0} + 0.7 * draw.point(kind % 3 + 0.2));
    }
    data.control_points.push_back(row);
  }
  // A side that is a point.
  if (kind % 5 == 1) data.control_points[0].assign(size_t(columns), Vec3{-3, 0, 1});
  if (kind % 2) {
    for (int i = 0; i < rows * columns; ++i)
      data.weights.push_back(std::pow(10, draw.uniform(-0.5, 0.5)));
  }
  data.closed_u = kind % 7 == 2;
  data.closed_v = kind % 7 == 3;
  if (kind % 7 == 4) {
    for (int i = 0; i < columns + degree_v + 1; ++i) data.knots_v.push_back(i + draw.uniform(0, 1));
  }
  return data;
}

TEST(BSplineSurfaceSlow, EqualsRefinedSampling) {
  Draw draw(21);
  for (int kind = 0; kind < 28; ++kind) {
    SCOPED_TRACE(kind);
    const SurfaceData data = random_surface(draw, kind);
    Reference reference(data);
    reference.sample(60);
    const SurfaceSet surface("s", "", data);
    for (int i = 0; i < 15; ++i) {
      const double s = draw.uniform(0, 1), t = draw.uniform(0, 1);
      const Vec3 on = reference(s, t);
      const Vec3 p = i % 3 == 0 ? draw.point(5) : on + (i % 3 == 1 ? 0.05 : 1e-6) * draw.point(1);
      const Nearest found = surface.nearest(p);
      // The reference's search may get stuck in a narrow valley that the samples do not show; near
      // the surface it also starts where the point comes from.
      const double expected = std::min(reference.distance(p), reference.refined(p, s, t));
      EXPECT_LE(found.distance, expected + 1e-13);
      EXPECT_NEAR(found.distance, expected, 2e-6);
      EXPECT_NEAR(norm(found.point - p), found.distance, 1e-14);
      EXPECT_LE(surface.nearest(on).distance, 1e-14);
    }
  }
}

TEST(BSplineSurface, IsADistance) {
  Draw draw(22);
  for (int kind = 0; kind < 8; ++kind) {
    SCOPED_TRACE(kind);
    const SurfaceData data = random_surface(draw, kind);
    const Field field =
        features::feature("bspline_surface", {{"control_points", data.control_points},
                                              {"degree_u", data.degree_u},
                                              {"degree_v", data.degree_v},
                                              {"knots_u", data.knots_u},
                                              {"knots_v", data.knots_v},
                                              {"weights", data.weights},
                                              {"closed_u", data.closed_u},
                                              {"closed_v", data.closed_v}});
    features::expect_distance_laws(field, draw, 5, 30);
    features::expect_jacobians(SurfaceSet("s", "", data), draw, 5, 30);
  }
}

TEST(BSplineSurface, BilinearRectangleIsTheFlatBox) {
  SurfaceData data;
  data.control_points = {{{-2, -1, 0}, {-2, 1, 0}}, {{2, -1, 0}, {2, 1, 0}}};
  data.degree_u = data.degree_v = 1;
  const SurfaceSet surface("s", "", data);
  Draw draw(23);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p = draw.point(4);
    const double x = std::max(std::abs(p[0]) - 2, 0.0), y = std::max(std::abs(p[1]) - 1, 0.0);
    EXPECT_NEAR(surface.nearest(p).distance, std::hypot(x, y, p[2]), 1e-14);
  }
}

// A quarter of a circle as a rational quadratic: its points and weights.
const std::vector<std::array<double, 3>> quarter{{1, 0, 1}, {1, 1, std::sqrt(0.5)}, {0, 1, 1}};

/// The full circle in four quarters, as (x, y, weight).
std::vector<std::array<double, 3>> full_circle() {
  std::vector<std::array<double, 3>> all;
  double c = 1, s = 0;
  for (int turn = 0; turn < 4; ++turn) {
    for (size_t k = 0; k < (turn == 3 ? 3u : 2u); ++k) {
      const auto& [x, y, w] = quarter[k];
      all.push_back({c * x - s * y, s * x + c * y, w});
    }
    std::tie(c, s) = std::make_pair(-s, c);
  }
  return all;
}
const std::vector<double> circle_knots{0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4};

TEST(BSplineSurface, RationalCylinderIsTheCylinder) {
  SurfaceData data;
  data.degree_u = 2;
  data.degree_v = 1;
  data.knots_u = circle_knots;
  for (const auto& [x, y, w] : full_circle()) {
    data.control_points.push_back({{2 * x, 2 * y, -3}, {2 * x, 2 * y, 3}});
    data.weights.insert(data.weights.end(), {w, w});
  }
  const SurfaceSet surface("s", "", data);
  Draw draw(24);
  for (int i = 0; i < 1000; ++i) {
    Vec3 p = draw.point(5);
    // On the axis a whole circle is nearest, beside it nearly.
    if (i % 4 == 0) p = {0, 0, p[2]};
    if (i % 4 == 1) p = {1e-8 * p[0], 1e-6 * p[1], p[2]};
    const double beyond = std::max(std::abs(p[2]) - 3, 0.0);
    EXPECT_NEAR(surface.nearest(p).distance, std::hypot(std::hypot(p[0], p[1]) - 2, beyond), 5e-12);
  }
}

/// A torus, or a sphere for a circle radius of 0, half a turn of the tube.
SurfaceData ring(double major, double minor) {
  SurfaceData data;
  data.degree_u = data.degree_v = 2;
  data.knots_u = circle_knots;
  const bool is_sphere = major == 0;
  data.knots_v = is_sphere ? std::vector<double>{0, 0, 0, 1, 1, 2, 2, 2} : circle_knots;
  for (const auto& [x, y, w] : full_circle()) {
    std::vector<Vec3> row;
    for (size_t k = 0; k < (is_sphere ? 5u : 9u); ++k) {
      // The tube's circle starts at its pole, so that half of it is the sphere's meridian.
      const auto [a, b, weight] = full_circle()[k];
      const double radius = major + minor * b;
      row.push_back({radius * x, radius * y, minor * a});
      data.weights.push_back(w * weight);
    }
    data.control_points.push_back(row);
  }
  return data;
}

TEST(BSplineSurface, RationalSphereIsTheSphere) {
  const SurfaceSet surface("s", "", ring(0, 2));
  Draw draw(25);
  for (int i = 0; i < 500; ++i) {
    Vec3 p = draw.point(4);
    // The centre, near it, and on the line through the poles, where sides of patches are points.
    if (i % 4 == 0) p = {};
    if (i % 4 == 1) p = 1e-6 * p;
    if (i % 4 == 2) p = {0, 0, p[2]};
    EXPECT_NEAR(surface.nearest(p).distance, std::abs(norm(p) - 2), 5e-12) << i;
  }
}

TEST(BSplineSurface, RationalTorusIsTheTorus) {
  const SurfaceSet surface("s", "", ring(3, 1));
  Draw draw(26);
  for (int i = 0; i < 500; ++i) {
    Vec3 p = draw.point(4);
    if (i % 3 == 0) p = {0, 0, p[2]};
    if (i % 3 == 1) p = 3 / std::hypot(p[0], p[1]) * Vec3{p[0], p[1], 0};
    const double expected = std::abs(std::hypot(std::hypot(p[0], p[1]) - 3, p[2]) - 1);
    EXPECT_NEAR(surface.nearest(p).distance, expected, 1e-11) << i;
  }
}

void expect_error(std::map<std::string, Value> changed, const std::string& message) {
  PointGrid grid(4, std::vector<Vec3>(5));
  for (size_t i = 0; i < 4; ++i) {
    for (size_t j = 0; j < 5; ++j) grid[i][j] = {double(i), double(j), 0};
  }
  std::map<std::string, Value> all{{"control_points", grid}};
  for (auto& [name, value] : changed) all[name] = value;
  try {
    features::feature("bspline_surface", all);
    ADD_FAILURE() << "no error: " << message;
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr(message));
  }
}

TEST(BSplineSurface, SaysWhatIsWrong) {
  PointGrid ragged(4, std::vector<Vec3>(5));
  ragged[2].pop_back();
  expect_error({{"control_points", ragged}}, "row 2 of control_points has 4 points");
  expect_error({{"degree_u", 4.0}}, "4 control points in direction u; degree 4");
  expect_error({{"degree_v", 0.0}}, "degree_v is 0");
  expect_error({{"knots_v", std::vector<double>{0, 1}}}, "knots_v has 2 elements");
  expect_error({{"weights", std::vector<double>{1}}}, "there are 20 control points");
  expect_error({{"control_points", PointGrid(4, std::vector<Vec3>(5))}},
               "all control points are equal");
}

}  // namespace
}  // namespace sardf

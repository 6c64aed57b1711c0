// Distance to B-spline curves: against golden values, other primitives, and a dense sampling with
// refinement that evaluates the curve by basis functions, which the product does not use.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "feature_checks.hpp"
#include "golden.hpp"
#include "sardf/curve_set.hpp"
#include "sardf/error.hpp"

namespace sardf {
namespace {

using features::Draw;

/// A curve by the Cox-de Boor recursion.
class Reference {
 public:
  explicit Reference(CurveData data) : data_(std::move(data)), degree_(int(data_.degree)) {
    const size_t n = data_.control_points.size();
    if (data_.weights.empty()) data_.weights.assign(n, 1);
    knots_ = data_.knots;
    const int all = int(n) + (data_.closed ? degree_ : 0);
    if (knots_.empty()) {
      for (int i = 0; i <= all + degree_; ++i) {
        knots_.push_back(data_.closed ? i : std::clamp(i, degree_, all));
      }
    }
    low_ = knots_[size_t(degree_)];
    high_ = knots_[size_t(all)];
  }
  double low() const { return low_; }
  double high() const { return high_; }

  Vec3 operator()(double t) const {
    // The span that holds t, the last one at the end.
    size_t at = size_t(degree_);
    while (at + size_t(degree_) + 2 < knots_.size() && knots_[at + 1] <= t) ++at;
    while (!(knots_[at] < knots_[at + 1])) --at;
    std::vector<double> basis{1};
    for (int d = 1; d <= degree_; ++d) {
      std::vector<double> next(size_t(d + 1), 0.0);
      for (int k = 0; k < d; ++k) {
        const double left = knots_[at + size_t(k + 1) - size_t(d)],
                     right = knots_[at + size_t(k + 1)];
        next[size_t(k)] += basis[size_t(k)] * (right - t) / (right - left);
        next[size_t(k + 1)] += basis[size_t(k)] * (t - left) / (right - left);
      }
      basis = next;
    }
    Vec3 sum{};
    double weights = 0;
    const size_t n = data_.control_points.size();
    for (int k = 0; k <= degree_; ++k) {
      const size_t point = (at - size_t(degree_) + size_t(k)) % n;
      const double w = basis[size_t(k)] * data_.weights[point];
      sum = sum + w * data_.control_points[point];
      weights += w;
    }
    return (1 / weights) * sum;
  }

  void sample(int count) {
    for (int i = 0; i <= count; ++i) {
      parameters_.push_back(low_ + (high_ - low_) * i / count);
      samples_.push_back((*this)(parameters_.back()));
      if (i > 0) apart_ = std::max(apart_, norm(samples_[size_t(i)] - samples_[size_t(i - 1)]));
    }
  }

  /// Every sample that may lie beside the nearest point is refined.
  double distance(const Vec3& p) const {
    std::vector<double> d;
    for (const Vec3& s : samples_) d.push_back(norm(s - p));
    double best = *std::min_element(d.begin(), d.end());
    const double within = best + 2 * apart_;
    for (size_t i = 0; i < d.size(); ++i) {
      const bool is_low = (i == 0 || d[i] <= d[i - 1]) && (i + 1 == d.size() || d[i] <= d[i + 1]);
      if (!is_low || d[i] > within) continue;
      best = std::min(
          best, refined(p, parameters_[i ? i - 1 : 0], parameters_[std::min(i + 1, d.size() - 1)]));
    }
    return best;
  }

 private:
  double refined(const Vec3& p, double a, double b) const {
    return std::min(zoomed(p, a, b, true), zoomed(p, a, b, false));
  }

  /// The curve may turn between two samples, or stand still: of equal samples the first or the
  /// last.
  double zoomed(const Vec3& p, double a, double b, bool first) const {
    double best = infinity;
    for (int zoom = 0; zoom < 8; ++zoom) {
      double low = a;
      const double step = (b - a) / 30;
      best = infinity;
      for (int i = 0; i <= 30; ++i) {
        const double d = norm((*this)(a + i * step) - p);
        if (first ? d < best : d <= best) {
          best = d;
          low = a + i * step;
        }
      }
      std::tie(a, b) = std::pair(std::max(a, low - step), std::min(b, low + step));
    }
    return best;
  }

  CurveData data_;
  int degree_;
  std::vector<double> knots_;
  double low_ = 0, high_ = 1, apart_ = 0;
  std::vector<double> parameters_;
  std::vector<Vec3> samples_;
};

CurveData random_curve(Draw& draw, int kind) {
  CurveData data;
  const int degree = 1 + draw.below(kind % 4 == 3 ? 12 : 5), count = degree + 1 + draw.below(8);
  data.degree = degree;
  data.control_points = draw.points(count, 3);
  if (kind % 3 == 1) {
    // Runs of equal control points: cusps, corners, and pieces of no length.
    for (int i = 1; i < count; ++i) {
      if (draw.below(2)) data.control_points[size_t(i)] = data.control_points[size_t(i - 1)];
    }
    data.control_points[0] = {3, 3, 3};
  }
  if (kind % 3 == 2) {
    for (Vec3& p : data.control_points) p[2] = 0;
  }
  if (kind % 2) {
    for (int i = 0; i < count; ++i) data.weights.push_back(std::pow(10, draw.uniform(-1, 1)));
  }
  if (kind % 5 == 1) data.closed = true;
  if (kind % 5 == 2) {
    double knot = 0;
    for (int i = 0; i < count + degree + 1; ++i) {
      data.knots.push_back(knot);
      // More equal knots than the degree would break the curve, which the reference cannot do.
      const bool is_run =
          i >= degree && data.knots[size_t(i)] == data.knots[size_t(i - degree + 1)];
      if (is_run || draw.below(3)) knot += draw.uniform(0.01, 1);
    }
    // The curve must have a length.
    for (size_t i = size_t(count); i < data.knots.size(); ++i) data.knots[i] += 1;
  }
  return data;
}

std::map<std::string, Value> given(const CurveData& data) {
  return {{"control_points", data.control_points},
          {"degree", data.degree},
          {"knots", data.knots},
          {"weights", data.weights},
          {"closed", data.closed}};
}

TEST(BSplineCurveSlow, EqualsRefinedSampling) {
  Draw draw(11);
  for (int kind = 0; kind < 60; ++kind) {
    SCOPED_TRACE(kind);
    const CurveData data = random_curve(draw, kind);
    Reference reference(data);
    reference.sample(3000);
    const CurveSet curve("bspline_curve", "", data);
    for (int i = 0; i < 18; ++i) {
      const double t = draw.uniform(reference.low(), reference.high());
      // Anywhere, near the curve, and on it.
      const Vec3 p =
          i % 3 == 0 ? draw.point(5) : reference(t) + (i % 3 == 1 ? 0.05 : 1e-7) * draw.point(1);
      const Nearest found = curve.nearest(p);
      EXPECT_NEAR(found.distance, reference.distance(p), 2e-8);
      EXPECT_LE(found.distance, reference.distance(p) + 1e-13);
      EXPECT_NEAR(norm(found.point - p), found.distance, 1e-14);
      EXPECT_LE(reference.distance(found.point), 2e-8);
      EXPECT_LE(curve.nearest(reference(t)).distance, 1e-14);
    }
  }
}

TEST(BSplineCurve, IsADistance) {
  Draw draw(12);
  for (int kind = 0; kind < 12; ++kind) {
    SCOPED_TRACE(kind);
    const CurveData data = random_curve(draw, kind);
    features::expect_distance_laws(features::feature("bspline_curve", given(data)), draw, 5, 40);
    features::expect_jacobians(CurveSet("c", "", data), draw, 5, 40);
  }
}

TEST(BSplineCurve, OfDegreeOneIsThePolyline) {
  Draw draw(13);
  for (const bool closed : {false, true}) {
    const std::vector<Vec3> corners = draw.points(9, 3);
    const Evaluator curve(
        features::feature("bspline_curve",
                          {{"control_points", corners}, {"degree", 1.0}, {"closed", closed}})
            .expression());
    const Evaluator line(
        features::feature("polyline", {{"vertices", corners}, {"closed", closed}}).expression());
    for (int i = 0; i < 500; ++i) {
      const Vec3 p = draw.point(5);
      EXPECT_NEAR(curve.value(p), line.value(p), 1e-14);
    }
  }
}

/// The full circle of radius r about the axis z, in four rational quadratic pieces.
CurveData circle(double r) {
  CurveData data;
  const double w = std::sqrt(0.5);
  data.control_points = {{r, 0, 0},   {r, r, 0},  {0, r, 0},  {-r, r, 0}, {-r, 0, 0},
                         {-r, -r, 0}, {0, -r, 0}, {r, -r, 0}, {r, 0, 0}};
  data.degree = 2;
  data.knots = {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4};
  data.weights = {1, w, 1, w, 1, w, 1, w, 1};
  return data;
}

TEST(BSplineCurve, RationalCircleIsTheCircle) {
  Draw draw(14);
  const CurveSet curve("c", "", circle(2));
  const Evaluator exact(features::feature("circle", {{"radius", 2.0}}).expression());
  for (int i = 0; i < 2000; ++i) {
    Vec3 p = draw.point(4);
    // On the axis, and beside it, all points are about as near.
    if (i % 4 == 0) p[0] = p[1] = 0;
    if (i % 4 == 1) p = {1e-7 * p[0], 1e-9 * p[1], p[2]};
    if (i == 0) p = {};
    EXPECT_NEAR(curve.nearest(p).distance, exact.value(p), 1e-12 * 4) << i;
    EXPECT_NEAR(norm(curve.nearest(p).gradient), 1, 1e-9);
  }
}

// y = x² as a Bezier curve: from (0, h) with h > 1/2 the nearest points are at x² = h - 1/2, and
// from (0, 1/2) the vertex is a fourfold one.
TEST(BSplineCurve, ParabolaHasItsKnownDistances) {
  CurveData data;
  data.control_points = {{-2, 4, 0}, {0, -4, 0}, {2, 4, 0}};
  data.degree = 2;
  const CurveSet curve("c", "", data);
  for (const double h : {-1.0, 0.1, 0.49999999, 0.5, 0.50000001, 0.6, 2.0}) {
    const double expected = h <= 0.5 ? std::abs(h) : std::sqrt(h - 0.25);
    EXPECT_NEAR(curve.nearest({0, h, 0}).distance, expected, 1e-13) << h;
    EXPECT_NEAR(curve.nearest({0, h, 3}).distance, std::hypot(expected, 3), 1e-12) << h;
  }
}

TEST(BSplineCurve, VanishesOnTheCurveWithoutDirection) {
  CurveData data;
  data.control_points = {{1, 2, 3}, {2, 0, 1}, {0, 0, 4}, {5, 1, 1}};
  const CurveSet curve("c", "", data);
  for (const Vec3& end : {Vec3{1, 2, 3}, Vec3{5, 1, 1}}) {
    const Nearest found = curve.nearest(end);
    EXPECT_EQ(found.distance, 0);
    EXPECT_TRUE(std::isnan(found.gradient[0]));
  }
}

TEST(BSplineCurve, ScalesFromTinyToHuge) {
  Draw draw(15);
  const CurveData data = random_curve(draw, 1);
  const CurveSet curve("c", "", data);
  for (const double scale : {0x1p-300, 0x1p-60, 0x1p60, 0x1p300}) {
    CurveData other = data;
    for (Vec3& p : other.control_points) p = scale * p;
    const CurveSet scaled("c", "", other);
    for (int i = 0; i < 50; ++i) {
      const Vec3 p = draw.point(5);
      EXPECT_EQ(scaled.nearest(scale * p).distance, scale * curve.nearest(p).distance);
    }
  }
}

TEST(BSplineCurve, TakesAnyNumbers) {
  Draw draw(16);
  const CurveSet curve("c", "", random_curve(draw, 1));
  const double nan = std::nan(""),
               numbers[] = {0, -1, 1e-300, 1e50, -1e139, 1e200, -infinity, infinity, nan};
  for (const double x : numbers) {
    for (const double y : numbers) {
      const double d = curve.nearest({x, y, 1}).distance;
      EXPECT_EQ(std::isnan(d), std::isnan(x) || std::isnan(y));
      if (std::isnan(d)) continue;
      EXPECT_GE(d * (1 + 1e-9), std::max(std::abs(x), std::abs(y)) - 10);
    }
  }
}

void expect_error(std::map<std::string, Value> changed, const std::string& message) {
  std::map<std::string, Value> all{
      {"control_points", std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 1}}}};
  for (auto& [name, value] : changed) all[name] = value;
  try {
    features::feature("bspline_curve", all);
    ADD_FAILURE() << "no error: " << message;
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr(message));
  }
}

TEST(BSplineCurve, SaysWhatIsWrong) {
  expect_error({{"degree", 4.0}}, "4 control points; degree 4 needs at least 5");
  expect_error({{"degree", 2.5}}, "degree is 2.5");
  expect_error({{"degree", 13.0}}, "from 1 to 12");
  expect_error({{"knots", std::vector<double>{0, 1}}}, "need 8");
  expect_error({{"knots", std::vector<double>{0, 0, 0, 1, 0.5, 2, 3, 4}}}, "falls from 1 to 0.5");
  expect_error({{"knots", std::vector<double>{0, 1, 2, 3, 3, 4, 5, 6}}}, "no length");
  expect_error({{"knots", std::vector<double>(8, 1.0)}, {"closed", true}}, "knots of its own");
  expect_error({{"weights", std::vector<double>{1, 1}}}, "there are 4 control points");
  expect_error({{"weights", std::vector<double>{1, 1, 0, 1}}}, "positive");
  expect_error({{"control_points", std::vector<Vec3>(5, Vec3{1, 2, 3})}},
               "all control points are equal");
}

class GoldenCurves : public golden::InEachFolder {};

TEST_P(GoldenCurves, EqualTheReference) {
  for (const char* name : {"prim_bspline2d", "prim_bspline3d"}) {
    const golden::Table table = read(name);
    CurveData data;
    for (const auto& p : table.parameter("control_points")) {
      data.control_points.push_back({p.at(0), p.at(1), p.size() > 2 ? double(p.at(2)) : 0.0});
    }
    const CurveSet curve("c", "", data);
    const int z = table.find("z");
    size_t directed = 0;
    for (const std::vector<double>& row : table.rows) {
      const Vec3 p{row[table.column("x")], row[table.column("y")], z < 0 ? 0 : row[size_t(z)]};
      const Nearest found = curve.nearest(p);
      EXPECT_NEAR(found.distance, row[table.column("f")], table.tolerance());
      const double gx = row[table.column("gx")], gy = row[table.column("gy")];
      // On the curve there is no direction, whatever rounding left of one.
      if (std::isnan(gx) || row[table.column("f")] < table.tolerance()) continue;
      ++directed;
      // The reference takes the root with the least distance, in which the parameter has only half
      // of the digits; ours is orthogonal to the last digit.
      EXPECT_NEAR(found.gradient[0], gx, 2e-7);
      EXPECT_NEAR(found.gradient[1], gy, 2e-7);
    }
    EXPECT_GT(directed, table.rows.size() * 9 / 10);
  }
}

INSTANTIATE_TEST_SUITE_P(Each, GoldenCurves, golden::each_folder(), golden::folder_name);

}  // namespace
}  // namespace sardf

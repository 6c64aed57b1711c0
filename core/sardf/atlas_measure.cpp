// Stretch and texel density of flat charts, by the singular values of each triangle's map.
#include <algorithm>
#include <cmath>

#include "sardf/atlas.hpp"
#include "sardf/atlas_stages.hpp"

namespace sardf::atlas {
namespace {

/// Of a triangle's own area: a thinner one may fold when it is turned into its place.
constexpr double least_area = 1e-3;
constexpr double worst = 1e6;  // stands for a folded triangle's stretch

struct Sample {
  double stretch;
  double density;
  double area;
};

/// A triangle of the given shape (see ChartMesh) drawn as p, q, r with all lengths `scale` larger.
Sample sample_of(const std::array<double, 3>& shape, const Vec2& p, const Vec2& q, const Vec2& r,
                 double scale) {
  const auto [x1, x2, y2] = shape;
  const double ux = (q[0] - p[0]) / x1, uy = (q[1] - p[1]) / x1;
  const double vx = (r[0] - p[0] - ux * x2) / y2, vy = (r[1] - p[1] - uy * x2) / y2;
  const double plus = std::sqrt((ux + vy) * (ux + vy) + (uy - vx) * (uy - vx));
  const double minus = std::sqrt((ux - vy) * (ux - vy) + (uy + vx) * (uy + vx));
  const double large = 0.5 * (plus + minus) / scale, small = 0.5 * (plus - minus) / scale;
  const double stretch = small > 1 / worst ? std::min(worst, std::max(large, 1 / small)) : worst;
  return {stretch, std::sqrt(std::max(0.0, ux * vy - uy * vx)), 0.5 * x1 * y2};
}

std::vector<Sample> samples_of(const ChartMesh& chart, double scale) {
  std::vector<Sample> samples;
  samples.reserve(chart.triangles.size());
  for (size_t t = 0; t < chart.triangles.size(); ++t) {
    const auto& [a, b, c] = chart.triangles[t];
    samples.push_back(
        sample_of(chart.shapes[t], chart.flat[a], chart.flat[b], chart.flat[c], scale));
  }
  return samples;
}

/// The value below which `share` of the area lies.
double quantile(std::vector<Sample>& samples, double Sample::*member, double share) {
  std::sort(samples.begin(), samples.end(),
            [&](const Sample& a, const Sample& b) { return a.*member < b.*member; });
  double total = 0, sum = 0;
  for (const Sample& s : samples) total += s.area;
  for (const Sample& s : samples) {
    sum += s.area;
    if (sum >= share * total) return s.*member;
  }
  return samples.back().*member;
}

double mean_stretch(const std::vector<Sample>& samples) {
  double sum = 0, total = 0;
  for (const Sample& s : samples) {
    sum += s.area * std::min(s.stretch, 100.0);
    total += s.area;
  }
  return sum / total;
}

}  // namespace

bool folds(const ChartMesh& chart, size_t triangle) {
  const auto& [a, b, c] = chart.triangles[triangle];
  const Vec2 &p = chart.flat[a], &q = chart.flat[b], &r = chart.flat[c];
  const double area = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
  return !(area > least_area * chart.shapes[triangle][0] * chart.shapes[triangle][2]);
}

Quality measure(const ChartMesh& chart) {
  Quality quality;
  if (chart.triangles.empty()) return quality;
  for (size_t t = 0; t < chart.triangles.size(); ++t) quality.folded += folds(chart, t);
  std::vector<Sample> samples = samples_of(chart, 1);
  quality.stretch_mean = mean_stretch(samples);
  quality.stretch_high = quantile(samples, &Sample::stretch, 0.997);
  return quality;
}

void describe(const ChartMesh& chart, double texels_per_unit, Chart& result) {
  std::vector<Sample> samples = samples_of(chart, texels_per_unit);
  if (samples.empty()) return;
  double texels = 0;
  for (const Sample& s : samples) {
    result.area += s.area;
    texels += s.area * s.density * s.density;
  }
  result.stretch_mean = mean_stretch(samples);
  result.stretch_max = quantile(samples, &Sample::stretch, 0.999);
  result.density_min = quantile(samples, &Sample::density, 0.001);
  result.density_max = quantile(samples, &Sample::density, 0.999);
  result.density_mean = std::sqrt(texels / result.area);
}

}  // namespace sardf::atlas

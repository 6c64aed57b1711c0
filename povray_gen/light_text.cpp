#include "povray_gen/light_text.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "povray_gen/vector_text.hpp"
#include "sardf/fit_quadrature.hpp"

namespace sardf::povray {

namespace {

constexpr double pi = std::numbers::pi;
// Fading of a point begins at this share of the scale; nearer to it the light is too weak.
constexpr double point_fade = 1e-4;
constexpr double sun_distance = 1000;  // in diagonals of what is lit: within 1e-3 parallel
constexpr double widest_sun = 10;      // of the tangent of half its angle: all of the sky but a rim

Vec3 column(const Light& light, int j) {
  const Matrix4& m = light.matrix_world;
  return {m[0][j], m[1][j], m[2][j]};
}

Vec3 place_of(const Light& light) { return column(light, 3); }
Vec3 shine_of(const Light& light) { return -1.0 * normalized(column(light, 2)); }

double degrees(double radians) { return radians * 180 / pi; }

std::string light_source(const Vec3& place, const Vec3& color, const std::string& more,
                         bool shadow) {
  return filled("light_source {\n  {}, rgb {}\n{}{}}\n",
                {vector_text(place), vector_text(color), more, shadow ? "" : "  shadowless\n"});
}

// The colour that fades to `strength` / (d² + f²).
std::string fade_text(double f) { return "  fade_power 2 fade_distance " + number_text(f) + "\n"; }
Vec3 faded(const Light& light, double strength, double f) {
  return (strength / (2 * f * f)) * light.color;
}

// Soft shadows of a disk that turns towards what it lights.
std::string disk_text(double diameter, int samples) {
  if (!(diameter > 0) || samples < 2) return "";
  const std::string n = std::to_string(samples);
  return filled("  area_light {}, {}, {}, {} adaptive 1 circular orient\n",
                {vector_text({diameter, 0, 0}), vector_text({0, diameter, 0}), n, n});
}

// Both are smooth steps in the cosine.
std::string cone_text(const Light& light) {
  const double half = light.spot_size / 2;
  const double inner = std::cos(half) + (1 - std::cos(half)) * light.spot_blend;
  return filled("  spotlight point_at {} radius {} falloff {} tightness {}\n",
                {vector_text(place_of(light) + shine_of(light)),
                 number_text(degrees(std::acos(std::clamp(inner, -1.0, 1.0)))),
                 number_text(degrees(half)), light.spot_cosine ? "1" : "0"});
}

std::string ball_text(const Light& light, double scale, int samples) {
  const double f = light.radius > 0 && light.soft_falloff ? light.radius : point_fade * scale;
  const std::string cone = light.type == Light::Type::spot ? cone_text(light) : "";
  return light_source(place_of(light), faded(light, light.power / (4 * pi * pi), f),
                      cone + fade_text(f) + disk_text(2 * light.radius, samples), light.shadow);
}

std::string sun_text(const Light& light, const BoundingBox& lit, int samples) {
  const double away = sun_distance * lit.diagonal();
  const std::string parallel = "  parallel point_at " + vector_text(lit.center()) + "\n";
  return light_source(
      lit.center() - away * shine_of(light), (light.power / pi) * light.color,
      parallel + disk_text(2 * away * std::min(std::tan(light.angle / 2), widest_sun), samples),
      light.shadow);
}

// A place on the shape from [-0.5, 0.5]², and its share of the light.
struct Sample {
  double x, y, share;
};

std::vector<Sample> rectangle_samples(int samples) {
  const GaussRule rule = gauss_rule(samples);
  std::vector<Sample> out;
  for (size_t i = 0; i < rule.at.size(); ++i) {
    for (size_t j = 0; j < rule.at.size(); ++j) {
      out.push_back({rule.at[i] - 0.5, rule.at[j] - 0.5, rule.weight[i] * rule.weight[j]});
    }
  }
  return out;
}

// Gauss points in the radius squared, in which area is uniform; rings stand between each other.
std::vector<Sample> ellipse_samples(int samples) {
  const GaussRule rule = gauss_rule(std::max(1, samples / 2));
  const int around = 2 * samples;
  std::vector<Sample> out;
  for (size_t i = 0; i < rule.at.size(); ++i) {
    for (int j = 0; j < around; ++j) {
      const double turn = 2 * pi * (j + 0.5 * double(i % 2)) / around;
      const double r = 0.5 * std::sqrt(rule.at[i]);
      out.push_back({r * std::cos(turn), r * std::sin(turn), rule.weight[i] / around});
    }
  }
  return out;
}

std::string area_text(const Light& light, double scale, int samples) {
  const Vec3 across = light.size_x * column(light, 0), along = light.size_y * column(light, 1);
  const double f = point_fade * scale;
  std::string out;
  for (const Sample& sample : light.shape == Light::Shape::ellipse ? ellipse_samples(samples)
                                                                   : rectangle_samples(samples)) {
    const Vec3 place = place_of(light) + sample.x * across + sample.y * along;
    const std::string half_space = "  spotlight point_at " + vector_text(place + shine_of(light)) +
                                   " radius 90 falloff 90 tightness 1\n";
    out += light_source(place, faded(light, sample.share * light.power / (pi * pi), f),
                        half_space + fade_text(f), light.shadow);
  }
  return out;
}

}  // namespace

std::string light_text(const Light& light, const BoundingBox& lit, int samples) {
  const std::string name = light.name.empty() ? "" : "// " + one_line(light.name) + "\n";
  // An unlit light is not worth the rays.
  if (light.power == 0 || norm(light.color) == 0) return "";
  switch (light.type) {
    case Light::Type::sun:
      return name + sun_text(light, lit, samples);
    case Light::Type::area:
      return name + area_text(light, lit.diagonal(), samples);
    default:
      return name + ball_text(light, lit.diagonal(), samples);
  }
}

}  // namespace sardf::povray

#include "sardf/edge_distance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace sardf {

namespace {

constexpr std::array<double, 5> binomial = {1 / 16.0, 4 / 16.0, 6 / 16.0, 4 / 16.0, 1 / 16.0};
constexpr double half_tangent = 0.75;  // px: longer than the gap between neighbouring elements

struct Plane {
  int width;
  int height;
  std::vector<double> values;
  // Outside the frame the picture goes on as at the frame.
  double at(int x, int y) const {
    return values[size_t(std::clamp(y, 0, height - 1)) * width + std::clamp(x, 0, width - 1)];
  }
};

Plane smoothed(const std::vector<unsigned char>& mask, int width, int height) {
  Plane hard{width, height, std::vector<double>(mask.size())};
  for (size_t i = 0; i < mask.size(); ++i) hard.values[i] = mask[i] ? 1 : 0;
  const auto filtered = [&](const Plane& from, int step_x, int step_y) {
    Plane to{width, height, std::vector<double>(mask.size())};
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        for (int k = -2; k <= 2; ++k)
          to.values[size_t(y) * width + x] +=
              binomial[size_t(k + 2)] * from.at(x + k * step_x, y + k * step_y);
    return to;
  };
  return filtered(filtered(hard, 1, 0), 0, 1);
}

// The side between pixel (x, y) and its right or lower neighbour, moved along the gradient of the
// smoothed mask to its 0.5 level, by 1 px at most.
EdgeElement located(const Plane& plane, int x, int y, int step_x, int step_y) {
  const int u = x + step_x, v = y + step_y;
  const auto central = [&](int dx, int dy) {
    return (plane.at(x + dx, y + dy) - plane.at(x - dx, y - dy) + plane.at(u + dx, v + dy) -
            plane.at(u - dx, v - dy)) /
           4;
  };
  const double gradient_x = central(1, 0), gradient_y = central(0, 1);
  const double slope = std::hypot(gradient_x, gradient_y);
  EdgeElement element{x + 0.5 * step_x, y + 0.5 * step_y, 0, 0};
  if (slope < 1e-9) return element;
  const double level = (plane.at(x, y) + plane.at(u, v)) / 2;
  const double move = std::clamp((0.5 - level) / slope, -1.0, 1.0);
  element.x += move * gradient_x / slope;
  element.y += move * gradient_y / slope;
  element.tangent_x = -gradient_y / slope;
  element.tangent_y = gradient_x / slope;
  return element;
}

double distance(const EdgeElement& from, const EdgeElement& to) {
  const double x = from.x - to.x, y = from.y - to.y;
  const double along = std::clamp(x * to.tangent_x + y * to.tangent_y, -half_tangent, half_tangent);
  return std::hypot(x - along * to.tangent_x, y - along * to.tangent_y);
}

// Elements by the pixel they lie in, for the search in growing squares.
class Buckets {
 public:
  Buckets(const std::vector<EdgeElement>& elements, int width, int height)
      : width_(width), height_(height), buckets_(size_t(width) * height) {
    for (const EdgeElement& element : elements)
      buckets_[index(column(element.x), row(element.y))].push_back(element);
  }

  double nearest(const EdgeElement& from) const {
    double best = std::hypot(width_, height_);
    const int x = column(from.x), y = row(from.y);
    for (int ring = 0; ring <= std::max(width_, height_); ++ring) {
      if (ring - 2 - half_tangent > best) break;  // nothing in this ring can be nearer
      for (int v = std::max(y - ring, 0); v <= std::min(y + ring, height_ - 1); ++v) {
        const bool whole_row = v == y - ring || v == y + ring;
        const int step = whole_row || ring == 0 ? 1 : 2 * ring;
        for (int u = x - ring; u <= x + ring; u += step) {
          if (u < 0 || u >= width_) continue;
          for (const EdgeElement& to : buckets_[index(u, v)])
            best = std::min(best, distance(from, to));
        }
      }
    }
    return best;
  }

 private:
  int column(double x) const { return std::clamp(int(std::lround(x)), 0, width_ - 1); }
  int row(double y) const { return std::clamp(int(std::lround(y)), 0, height_ - 1); }
  size_t index(int x, int y) const { return size_t(y) * width_ + x; }

  int width_;
  int height_;
  std::vector<std::vector<EdgeElement>> buckets_;
};

}  // namespace

std::vector<EdgeElement> edge_elements(const std::vector<unsigned char>& mask, int width,
                                       int height) {
  const Plane plane = smoothed(mask, width, height);
  const auto in = [&](int x, int y) { return mask[size_t(y) * width + x] != 0; };
  std::vector<EdgeElement> elements;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      if (x + 1 < width && in(x, y) != in(x + 1, y)) elements.push_back(located(plane, x, y, 1, 0));
      if (y + 1 < height && in(x, y) != in(x, y + 1))
        elements.push_back(located(plane, x, y, 0, 1));
    }
  return elements;
}

std::vector<double> edge_distances(const std::vector<EdgeElement>& from,
                                   const std::vector<EdgeElement>& to, int width, int height) {
  const Buckets buckets(to, width, height);
  std::vector<double> distances;
  distances.reserve(from.size());
  for (const EdgeElement& element : from) distances.push_back(buckets.nearest(element));
  return distances;
}

}  // namespace sardf

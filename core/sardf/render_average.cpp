#include "sardf/render_average.hpp"

#include <algorithm>

#include "sardf/vec.hpp"

namespace sardf::rendering {

namespace {

constexpr int color_channels = 4;

// The sums of a square's channels, and its least depth.
struct Square {
  double color[color_channels] = {};
  float depth = 0;
  Vec3 normal{};
};

Square square_at(const Image& fine, int edge, int x, int y, bool depth, bool normals) {
  Square square;
  square.depth = fine.at(x * edge, y * edge)[color_channels - 1 + (depth ? 1 : 0)];
  for (int k = 0; k < edge * edge; ++k) {
    const float* pixel = fine.at(x * edge + k % edge, y * edge + k / edge);
    for (double& sum : square.color) sum += *pixel++;
    if (depth) square.depth = std::min(square.depth, *pixel++);
    if (!normals) continue;
    for (double& sum : square.normal) sum += *pixel++;
  }
  return square;
}

}  // namespace

Image averaged(const Image& fine, int edge, bool depth, bool normals) {
  Image image{fine.width / edge, fine.height / edge, fine.channels, {}};
  image.samples.resize(size_t(image.width) * image.height * image.channels);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const Square square = square_at(fine, edge, x, y, depth, normals);
      float* pixel = image.at(x, y);
      for (const double sum : square.color) *pixel++ = float(sum / (edge * edge));
      if (depth) *pixel++ = square.depth;
      if (!normals) continue;
      const double length = norm(square.normal);
      for (const double sum : square.normal) *pixel++ = float(length > 0 ? sum / length : 0);
    }
  }
  return image;
}

}  // namespace sardf::rendering

// Moving points that are almost on a solid's surface onto it.

#include <cmath>

#include "sardf/bake_stages.hpp"

namespace sardf::baking {
namespace {

constexpr size_t block_size = Evaluator::block_size;
constexpr int steps = 3;
/// Smallest squared cosine between the gradient and the face's normal: 45 degrees. Beyond, the
/// nearest zero set is that of another face.
constexpr float aligned = 0.5f;

using Values = std::array<float, block_size>;

/// The points of a tile that are on their way, packed: most points are where they belong from the
/// start, or after one step.
class Movement {
 public:
  Movement(const Evaluator& solid, TilePoints& points, float tolerance)
      : solid_(solid), points_(points), tolerance_(tolerance) {}

  void run() {
    find_distant();
    for (int step = 0; step < steps && count_ > 0; ++step) {
      size_t kept = 0;
      for (size_t first = 0; first < count_; first += block_size)
        kept = take_step(first, std::min(block_size, count_ - first), kept);
      count_ = kept;
    }
    for (size_t k = 0; k < count_; ++k) settle(k);
  }

 private:
  void find_distant() {
    for (size_t first = 0; first < points_.count; first += block_size) {
      const size_t n = std::min(block_size, points_.count - first);
      Values value;
      float* out = value.data();
      solid_.block(&points_.point[0][first], &points_.point[1][first], &points_.point[2][first], n,
                   &out);
      for (size_t i = 0; i < n; ++i) {
        // Written so that a NaN stays where it is.
        if (!(std::abs(value[i]) > tolerance_)) continue;
        place_[count_] = static_cast<uint16_t>(first + i);
        for (size_t axis = 0; axis < 3; ++axis) at_[axis][count_] = points_.point[axis][first + i];
        start_[count_] = value_[count_] = value[i];
        ++count_;
      }
    }
  }

  /// Newton's step of moving points [first, first + n). Those that go on are packed at `kept`;
  /// the new `kept`.
  size_t take_step(size_t first, size_t n, size_t kept) {
    Values value;
    std::array<Values, 3> gradient;
    float* const by[3] = {gradient[0].data(), gradient[1].data(), gradient[2].data()};
    solid_.gradient_block(&at_[0][first], &at_[1][first], &at_[2][first], n, value.data(), by);
    const size_t begin = kept;
    for (size_t i = 0; i < n; ++i) {
      const size_t k = first + i;
      std::array<float, 3> to{gradient[0][i], gradient[1][i], gradient[2][i]};
      const Step step = find_step(k, to);
      if (step == Step::none) settle(k);
      if (step != Step::taken) continue;
      place_[kept] = place_[k];
      start_[kept] = start_[k];
      for (size_t axis = 0; axis < 3; ++axis) at_[axis][kept] = to[axis];
      ++kept;
    }
    float* out = &value_[begin];
    if (kept > begin)
      solid_.block(&at_[0][begin], &at_[1][begin], &at_[2][begin], kept - begin, &out);
    size_t going = begin;
    for (size_t k = begin; k < kept; ++k) {
      if (!(std::abs(value_[k]) > tolerance_)) {
        settle(k);
        continue;
      }
      place_[going] = place_[k];
      start_[going] = start_[k];
      value_[going] = value_[k];
      for (size_t axis = 0; axis < 3; ++axis) at_[axis][going] = at_[axis][k];
      ++going;
    }
    return going;
  }

  enum class Step { taken, none, too_far };
  /// Where a step along the gradient leads, in place of the gradient.
  Step find_step(size_t k, std::array<float, 3>& gradient) const {
    const size_t p = place_[k];
    const PointSurface& on = points_.surfaces[points_.on[p]];
    float squared = 0, cosine = 0;
    for (size_t axis = 0; axis < 3; ++axis) {
      squared += gradient[axis] * gradient[axis];
      cosine += gradient[axis] * on.normal[axis];
    }
    if (!(cosine * cosine >= aligned * squared) || !(squared > 0)) return Step::none;
    const float scale = value_[k] / squared;
    float moved = 0;
    for (size_t axis = 0; axis < 3; ++axis) {
      gradient[axis] = at_[axis][k] - scale * gradient[axis];
      const float d = gradient[axis] - points_.point[axis][p];
      moved += d * d;
    }
    return moved <= on.limit * on.limit ? Step::taken : Step::too_far;
  }

  /// A point stays where it came unless it was nearer before.
  void settle(size_t k) {
    if (!(std::abs(value_[k]) <= std::abs(start_[k]))) return;
    for (size_t axis = 0; axis < 3; ++axis) points_.point[axis][place_[k]] = at_[axis][k];
  }

  const Evaluator& solid_;
  TilePoints& points_;
  float tolerance_;
  size_t count_ = 0;
  std::array<uint16_t, tile_texels> place_;
  std::array<std::array<float, tile_texels>, 3> at_;
  std::array<float, tile_texels> value_, start_;  // of the field, here and at the start
};

}  // namespace

void project(const Evaluator& solid, TilePoints& points, float tolerance) {
  Movement(solid, points, tolerance).run();
}

}  // namespace sardf::baking

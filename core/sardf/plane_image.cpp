#include "sardf/plane_image.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <mutex>

#include "sardf/error.hpp"
#include "sardf/short_number.hpp"
#include "sardf/shorten.hpp"

namespace sardf {

namespace {

constexpr int most_pixels = 65'536;
// A tile of this edge is one block of points.
constexpr int smallest_tile = 16;
static_assert(smallest_tile * smallest_tile == Evaluator::block_size);
// Tiles of this edge and larger ones are divided on all threads.
constexpr int shared_tile = 128;
// A shorter program than this is not shortened further: it costs less than finding out.
constexpr size_t short_program = 6;

struct Tile {
  int x, y, edge;
};

class Painter {
 public:
  Painter(const Evaluator& field, const PlaneView& view, const Progress& progress)
      : view_(view), progress_(progress) {
    pixels_.resize(size_t(view.width) * view.height);
    const double range =
        Shortening(field, box({0, 0, std::max(view.width, view.height)})).range().magnitude();
    doubtful_ = float(range * 0x1p-13);
  }

  void paint(const Evaluator& field, const Tile& tile) {
    if (tile.x >= view_.width || tile.y >= view_.height || cancelled_) return;
    if (tile.edge > smallest_tile && field.tape().instructions().size() <= short_program) {
      divide(field, tile);
      return;
    }
    const Shortening here(field, box(tile));
    if (here.range().hi < 0 || (here.range().lo >= 0 && !here.may_be_nan())) {
      fill(tile, here.range().lo >= 0);
    } else if (tile.edge == smallest_tile) {
      sample(field, tile);
    } else {
      divide(here.shortened(Wanted::signs), tile);
    }
  }

  std::vector<uint8_t> result() {
    if (cancelled_) throw Cancelled();
    return std::move(pixels_);
  }

 private:
  // Around the middles of the tile's pixels, which floats round.
  BoundingBox box(const Tile& tile) const {
    const int right = std::min(tile.x + tile.edge, view_.width) - 1;
    const int bottom = std::min(tile.y + tile.edge, view_.height) - 1;
    BoundingBox box{{view_.x(tile.x), view_.y(bottom), view_.z},
                    {view_.x(right), view_.y(tile.y), view_.z}};
    for (int axis = 0; axis < 3; ++axis) {
      box.lo[axis] -= std::abs(box.lo[axis]) * 0x1p-23;
      box.hi[axis] += std::abs(box.hi[axis]) * 0x1p-23;
    }
    return box;
  }

  void divide(const Evaluator& field, const Tile& tile) {
    if (tile.edge == smallest_tile) {
      sample(field, tile);
      return;
    }
    const int half = tile.edge / 2;
    const auto part = [&](int k) {
      paint(field, {tile.x + (k & 1) * half, tile.y + (k >> 1) * half, half});
    };
    if (tile.edge < shared_tile) {
      for (int k = 0; k < 4; ++k) part(k);
      return;
    }
    tbb::parallel_for(0, 4, part);
    if (tile.edge == shared_tile) report(tile);
  }

  template <class Each>
  void for_pixels(const Tile& tile, Each each) {
    const int right = std::min(tile.x + tile.edge, view_.width);
    const int bottom = std::min(tile.y + tile.edge, view_.height);
    for (int y = tile.y; y < bottom; ++y) {
      for (int x = tile.x; x < right; ++x) each(x, y, pixels_[size_t(y) * view_.width + x]);
    }
  }

  void fill(const Tile& tile, bool inside) {
    for_pixels(tile, [&](int, int, uint8_t& pixel) { pixel = inside; });
    if (tile.edge >= shared_tile) report(tile);
  }

  void sample(const Evaluator& field, const Tile& tile) {
    constexpr size_t most = Evaluator::block_size;
    float x[most], y[most], z[most], value[most];
    size_t n = 0;
    for_pixels(tile, [&](int column, int row, uint8_t&) {
      x[n] = float(view_.x(column));
      y[n] = float(view_.y(row));
      z[n++] = float(view_.z);
    });
    float* out = value;
    field.block(x, y, z, n, &out);
    double exact_x[most], exact_y[most], exact_z[most], exact[most];
    uint8_t* doubtful[most];
    size_t i = 0, open = 0;
    for_pixels(tile, [&](int column, int row, uint8_t& pixel) {
      const float f = value[i++];
      pixel = f >= 0;
      if (std::abs(f) > doubtful_) return;
      exact_x[open] = view_.x(column);
      exact_y[open] = view_.y(row);
      exact_z[open] = view_.z;
      doubtful[open++] = &pixel;
    });
    if (open == 0) return;
    double* exact_out = exact;
    field.block(exact_x, exact_y, exact_z, open, &exact_out);
    for (size_t k = 0; k < open; ++k) *doubtful[k] = exact[k] >= 0;
  }

  void report(const Tile& tile) {
    if (!progress_) return;
    const std::scoped_lock lock(reporting_);
    done_ += double(tile.edge) * tile.edge;
    const double all = double(view_.width) * view_.height;
    if (!cancelled_ && !progress_(std::min(1.0, done_ / all))) cancelled_ = true;
  }

  const PlaneView& view_;
  const Progress& progress_;
  std::vector<uint8_t> pixels_;
  float doubtful_;
  std::atomic<bool> cancelled_{false};
  std::mutex reporting_;
  double done_ = 0;
};

void check(const PlaneView& view) {
  for (int axis = 0; axis < 2; ++axis) {
    const double from = view.lo[axis], to = view.hi[axis];
    if (!(from < to) || !std::isfinite(to - from)) {
      throw Error(std::string("the picture reaches from ") + "xy"[axis] + " = " +
                  short_number(from) + " to " + short_number(to) +
                  "; finite numbers, the smaller one first, are accepted");
    }
  }
  for (const int size : {view.width, view.height}) {
    if (size < 1 || size > most_pixels) {
      throw Error("the picture is " + std::to_string(size) + " pixels wide or high; 1 to " +
                  std::to_string(most_pixels) + " are accepted");
    }
  }
}

}  // namespace

std::vector<uint8_t> sign_image(const Evaluator& field, const PlaneView& view,
                                const Progress& progress) {
  check(view);
  Painter painter(field, view, progress);
  int edge = smallest_tile;
  while (edge < std::max(view.width, view.height)) edge *= 2;
  painter.paint(field, {0, 0, edge});
  return painter.result();
}

}  // namespace sardf

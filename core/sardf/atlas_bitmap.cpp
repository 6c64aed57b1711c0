#include "sardf/atlas_bitmap.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace sardf::atlas {

void Bitmap::fill(int row, double low, double high) {
  const int first = std::clamp(static_cast<int>(std::floor(low)), 0, width_ - 1);
  const int last = std::clamp(static_cast<int>(std::floor(high)), 0, width_ - 1);
  const auto start = cells_.begin() + static_cast<long>(row) * width_;
  std::fill(start + first, start + last + 1, char{1});
}

void Bitmap::add_triangle(const Vec2& a, const Vec2& b, const Vec2& c) {
  const std::array<Vec2, 3> points{a, b, c};
  const double bottom = std::min({a[1], b[1], c[1]}), top = std::max({a[1], b[1], c[1]});
  const int first = std::clamp(static_cast<int>(std::floor(bottom)), 0, height_ - 1);
  const int last = std::clamp(static_cast<int>(std::floor(top)), 0, height_ - 1);
  for (int row = first; row <= last; ++row) {
    double low = INFINITY, high = -INFINITY;
    const auto add = [&](double x) {
      low = std::min(low, x);
      high = std::max(high, x);
    };
    for (size_t k = 0; k < 3; ++k) {
      const Vec2 &p = points[k], &q = points[(k + 1) % 3];
      if (p[1] >= row && p[1] <= row + 1) add(p[0]);
      for (const double y : {row + 0.0, row + 1.0})
        if ((p[1] < y) != (q[1] < y)) add(p[0] + (q[0] - p[0]) * (y - p[1]) / (q[1] - p[1]));
    }
    if (low <= high) fill(row, low, high);
  }
}

Bitmap Bitmap::turned() const {
  Bitmap result(height_, width_);
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x)
      result.cells_[static_cast<size_t>(x) * height_ + (height_ - 1 - y)] =
          cells_[static_cast<size_t>(y) * width_ + x];
  return result;
}

std::vector<Run> Bitmap::runs() const {
  std::vector<Run> result;
  for (int y = 0; y < height_; ++y) {
    const char* row = &cells_[static_cast<size_t>(y) * width_];
    for (int x = 0; x < width_; ++x) {
      if (!row[x]) continue;
      const int first = x;
      while (x + 1 < width_ && row[x + 1]) ++x;
      result.push_back({y, first, x});
    }
  }
  return result;
}

std::vector<Run> Bitmap::runs_within(double distance) const {
  const int reach = static_cast<int>(std::ceil(distance));
  const int wide = width_ + 2 * reach + 1;
  // Beginnings minus ends of the widened runs, for each row.
  std::vector<int> steps(static_cast<size_t>(wide) * (height_ + 2 * reach), 0);
  for (const Run& run : runs())
    for (int dy = -reach; dy <= reach; ++dy) {
      // Cells of rows dy apart are |dy| - 1 apart at the least.
      const double rows_between = std::max(0, std::abs(dy) - 1);
      if (rows_between >= distance) continue;
      const double side = std::sqrt(distance * distance - rows_between * rows_between);
      const int columns = std::min(reach, static_cast<int>(std::ceil(side)));
      int* row = &steps[static_cast<size_t>(run.row + dy + reach) * wide];
      ++row[run.first - columns + reach];
      --row[run.last + columns + 1 + reach];
    }
  std::vector<Run> result;
  for (int y = 0; y < height_ + 2 * reach; ++y) {
    int depth = 0, first = 0;
    for (int x = 0; x < wide; ++x) {
      const int next = depth + steps[static_cast<size_t>(y) * wide + x];
      if (depth == 0 && next > 0) first = x;
      if (depth > 0 && next == 0) result.push_back({y - reach, first - reach, x - 1 - reach});
      depth = next;
    }
  }
  return result;
}

Sheet::Sheet(int side, int margin)
    : side_(side),
      margin_(margin),
      words_(static_cast<size_t>(side + 2 * margin + 63) / 64),
      bits_(words_ * static_cast<size_t>(side + 2 * margin), 0) {}

int Sheet::last_occupied(int row, int first, int last) const {
  const uint64_t* bits = &bits_[static_cast<size_t>(row + margin_) * words_];
  const int low = first + margin_, high = last + margin_;
  for (int word = high / 64; word >= low / 64; --word) {
    uint64_t value = bits[word];
    if (word == high / 64 && high % 64 != 63) value &= (uint64_t{1} << (high % 64 + 1)) - 1;
    if (word == low / 64) value &= ~uint64_t{0} << (low % 64);
    if (value) return word * 64 + 63 - std::countl_zero(value) - margin_;
  }
  return -1 - margin_;
}

bool Sheet::find_place(const std::vector<Run>& widened, int width, int height, int limit, int& x,
                       int& y) const {
  const size_t count = widened.size();
  size_t start = 0;  // the run that failed last will likely fail again
  for (y = 0; y + height <= std::min(side_, limit); ++y)
    for (x = 0; x + width <= side_;) {
      size_t tested = 0;
      for (; tested < count; ++tested) {
        const size_t at = start + tested < count ? start + tested : start + tested - count;
        const Run& run = widened[at];
        const int hit = last_occupied(y + run.row, x + run.first, x + run.last);
        if (hit < -margin_) continue;
        x = hit + 1 - run.first;  // every place before this one meets the same cell
        start = at;
        break;
      }
      if (tested == count) return true;
    }
  return false;
}

void Sheet::occupy(const std::vector<Run>& runs, int x, int y) {
  for (const Run& run : runs) {
    uint64_t* bits = &bits_[static_cast<size_t>(y + run.row + margin_) * words_];
    for (int i = x + run.first + margin_; i <= x + run.last + margin_; ++i)
      bits[i / 64] |= uint64_t{1} << (i % 64);
  }
}

}  // namespace sardf::atlas

// Bitmaps of charts and of the image that is filled with them. Private to the atlas's packing.
#pragma once

#include <cstdint>
#include <vector>

#include "sardf/vec.hpp"

namespace sardf::atlas {

/// Cells from first to last, both included, of one row.
struct Run {
  int row;
  int first;
  int last;
};

/// A chart's cells; every cell that a triangle touches is set.
class Bitmap {
 public:
  Bitmap(int width, int height)
      : width_(width), height_(height), cells_(static_cast<size_t>(width) * height, 0) {}
  int width() const { return width_; }
  int height() const { return height_; }
  /// Sets the cells [x, x + 1] × [y, y + 1] that the triangle touches.
  void add_triangle(const Vec2& a, const Vec2& b, const Vec2& c);
  /// Turned by 90 degrees: (x, y) goes to (height - y, x).
  Bitmap turned() const;
  std::vector<Run> runs() const;
  /// The runs of all cells nearer than `distance` to a set cell; may be negative or beyond.
  std::vector<Run> runs_within(double distance) const;

 private:
  void fill(int row, double low, double high);
  int width_, height_;
  std::vector<char> cells_;
};

/// A square image, partly occupied.
class Sheet {
 public:
  /// `margin`: cells around the sheet that runs may reach; they are never occupied.
  Sheet(int side, int margin);
  /// The lowest, then leftmost place for a chart of the given size whose widened runs meet no
  /// occupied cell; false when there is none with its top below `limit`.
  bool find_place(const std::vector<Run>& widened, int width, int height, int limit, int& x,
                  int& y) const;
  void occupy(const std::vector<Run>& runs, int x, int y);

 private:
  /// The last occupied cell of the row among [first, last], or -1 - margin when there is none.
  int last_occupied(int row, int first, int last) const;
  int side_, margin_;
  size_t words_;
  std::vector<uint64_t> bits_;
};

}  // namespace sardf::atlas

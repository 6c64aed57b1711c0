#include "sardf/render_slopes.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace sardf::rendering {

namespace {

// A field that is not steeper than a few distances gains less from finer cells than they cost.
constexpr double steep = 3;
// Of a field without a bound, cells with no bound or one with which steps are tiny are worth more.
constexpr double useless = 50;
constexpr int most_useless_cells = 32;

size_t index(int cells, const std::array<int, 3>& cell) {
  return (size_t(cell[2]) * cells + cell[1]) * cells + cell[0];
}

std::array<int, 3> place(int cells, size_t i) {
  const int all = int(i);
  return {all % cells, all / cells % cells, all / (cells * cells)};
}

// NaN is no bound.
double bound_of(double length) { return length >= 0 ? length : infinity; }

double largest_around(int cells, const std::vector<double>& of_cell, size_t i) {
  const std::array<int, 3> at = place(cells, i);
  double largest = 0;
  for (int k = 0; k < 27; ++k) {
    const std::array<int, 3> near{at[0] + k % 3 - 1, at[1] + k / 3 % 3 - 1, at[2] + k / 9 - 1};
    const bool in_box =
        std::all_of(near.begin(), near.end(), [&](int c) { return c >= 0 && c < cells; });
    if (in_box) largest = std::max(largest, of_cell[index(cells, near)]);
  }
  return largest;
}

}  // namespace

LocalSlopes::LocalSlopes(const Evaluator& field, const BoundingBox& box, int most_cells,
                         const std::function<void()>& check)
    : box_(box) {
  for (int axis = 0; axis < 3; ++axis) per_side_[axis] = 1 / (box.hi[axis] - box.lo[axis]);
  const double all = bound_of(field.slope(box).length);
  levels_.push_back({1, infinity, {all}, {all}, {0}});
  const auto is_wanting = [&](const Level& level) {
    for (size_t i = 0; i < level.of_cell.size(); ++i) {
      if (wants_more(level, i, most_cells)) return true;
    }
    return false;
  };
  walks_ = all == infinity;
  while (is_wanting(levels_.back())) {
    levels_.push_back(refined(field, levels_.back(), most_cells, check));
  }
}

bool LocalSlopes::wants_more(const Level& level, size_t cell, int most_cells) const {
  const double slope = level.of_cell[cell];
  if (level.empty[cell] || !(slope > steep)) return false;
  return level.cells < (walks_ && slope > useless ? most_useless_cells : most_cells);
}

BoundingBox LocalSlopes::cell_box(const Level& level, const std::array<int, 3>& cell) const {
  const Vec3 edge = 1.0 / level.cells * box_.size();
  BoundingBox out;
  for (int axis = 0; axis < 3; ++axis) {
    // Neighbours overlap by a rounding, so that no point is between them.
    const double slack = 1e-9 * edge[axis];
    out.lo[axis] = box_.lo[axis] + cell[axis] * edge[axis] - slack;
    out.hi[axis] = box_.lo[axis] + (cell[axis] + 1) * edge[axis] + slack;
  }
  return out;
}

LocalSlopes::Level LocalSlopes::refined(const Evaluator& field, const Level& coarse, int most_cells,
                                        const std::function<void()>& check) const {
  Level level{2 * coarse.cells, 0, {}, {}, {}};
  const Vec3 size = box_.size();
  level.reach = std::min({size[0], size[1], size[2]}) / level.cells;
  level.of_cell.resize(size_t(level.cells) * level.cells * level.cells);
  level.empty.resize(level.of_cell.size());
  tbb::parallel_for(size_t(0), level.of_cell.size(), [&](size_t i) {
    const std::array<int, 3> at = place(level.cells, i);
    const size_t parent = index(coarse.cells, {at[0] / 2, at[1] / 2, at[2] / 2});
    const double known = coarse.of_cell[parent];
    level.of_cell[i] = known;
    level.empty[i] = coarse.empty[parent];
    if (!wants_more(coarse, parent, most_cells)) return;
    check();
    // Far from the surface steps are long enough. Neighbours of cells with surface count as near.
    const BoundingBox box = cell_box(level, at);
    if (std::abs(field.value(box.center())) > 1.5 * known * box.diagonal()) return;
    level.of_cell[i] = std::min(known, bound_of(field.slope(box).length));
    if (walks_ && level.of_cell[i] > useless) level.empty[i] = field.interval(box).hi < 0;
  });
  level.around.resize(level.of_cell.size());
  for (size_t i = 0; i < level.around.size(); ++i) {
    level.around[i] = largest_around(level.cells, level.of_cell, i);
  }
  return level;
}

std::array<int, 3> LocalSlopes::cell_of(const Level& level, const Vec3& point) const {
  std::array<int, 3> cell;
  for (int axis = 0; axis < 3; ++axis) {
    const double share = (point[axis] - box_.lo[axis]) * per_side_[axis];
    cell[axis] = std::clamp(int(share * level.cells), 0, level.cells - 1);
  }
  return cell;
}

double LocalSlopes::clear_until(const Line& line, double t, double depth) const {
  if (!walks_) return t;
  const Level& finest = levels_.back();
  // A ray crosses at most this number of cells.
  for (int crossed = 0; crossed < 3 * finest.cells; ++crossed) {
    const std::array<int, 3> cell = cell_of(finest, line.at(t));
    const size_t i = index(finest.cells, cell);
    const double leaves = stretch_in(line, cell_box(finest, cell)).end;
    if (!(leaves > t)) return t;
    if (!finest.empty[i]) {
      const double reach = depth / (finest.of_cell[i] * std::sqrt(dot(line.along, line.along)));
      return reach > 0 ? std::min(leaves, t + reach * (1 - 1e-9)) : t;
    }
    t = leaves;
    depth = std::nan("");
  }
  return t;
}

double LocalSlopes::clear_radius(const Vec3& point, double depth) const {
  if (!(depth > 0)) return 0;
  double radius = depth / levels_[0].around[0];
  if (levels_.size() > 1) {
    // On the way to a point no farther than a cell's shortest side only the cell and its neighbours
    // are crossed. A level's cells are those of the next one in pairs.
    std::array<int, 3> cell = cell_of(levels_.back(), point);
    for (size_t k = levels_.size() - 1; k > 0; --k) {
      const Level& level = levels_[k];
      const double slope = level.around[index(level.cells, cell)];
      radius = std::max(radius, std::min(level.reach, depth / slope));
      for (int& at : cell) at >>= 1;
    }
  }
  return radius * (1 - 1e-9);
}

}  // namespace sardf::rendering

#include "sardf/fit_quadrature.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "sardf/error.hpp"
#include "sardf/work.hpp"

namespace sardf {

namespace {

constexpr int most_halvings_2d = 6, most_halvings_3d = 3;

struct Box {
  Vec3 lo, side;
  BoundingBox bounds() const { return {lo, lo + side}; }
};

// The share of the cube [-1/2, 1/2]^n where value + slope . p >= 0, exactly: the integral of the
// n-th divided difference of max(0, .)^n over the corners. Small slopes are raised a little, which
// keeps the differences apart.
double covered_share(double value, const double* slope, int n) {
  double steepest = 0;
  for (int k = 0; k < n; ++k) steepest = std::max(steepest, std::abs(slope[k]));
  if (!(steepest > 0)) return value >= 0;
  double rise[3], product = 1, lowest = value / steepest;
  for (int k = 0; k < n; ++k) {
    rise[k] = std::max(std::abs(slope[k]) / steepest, 1e-3);
    product *= rise[k] * (k + 1);
    lowest -= 0.5 * rise[k];
  }
  double sum = 0, whole = 0;
  for (int corner = 0; corner < 1 << n; ++corner) {
    double at = lowest, sign = n % 2 ? -1 : 1;
    for (int k = 0; k < n; ++k) {
      if (corner >> k & 1) {
        at += rise[k];
        sign = -sign;
      }
    }
    sum += at > 0 ? sign * std::pow(at, n) : 0;
    whole = std::max(whole, at);
  }
  if (whole <= 0) return 0;
  return lowest >= 0 ? 1 : std::clamp(sum / product, 0.0, 1.0);
}

/// Points of one cell at the boundary.
struct CutCell {
  std::vector<Vec3> at;
  std::vector<double> weight;
  double volume = 0, coarser = 0;  // by the last halving, and by the one before
};

class CellCutter {
 public:
  CellCutter(const SplineGrid& grid, const Expression& solid, int points)
      : dimensions_(grid.dimensions), solid_(solid) {
    most_ = dimensions_ == 2 ? most_halvings_2d : most_halvings_3d;
    for (int level = 0; level <= most_; ++level) {
      rules_.push_back(gauss_rule(std::max(2, points - level)));
    }
  }

  CutCell of(const Box& cell) const {
    CutCell made;
    add(cell, 0, made);
    return made;
  }

 private:
  void add(const Box& box, int level, CutCell& to) const {
    const Interval bound = solid_.interval(box.bounds());
    if (bound.hi < 0) return;
    if (bound.lo >= 0) {
      add_whole(box, level, to);
    } else if (level == most_) {
      add_share(box, to);
    } else {
      // The volume by halving once less, too, to see what the last one changes.
      if (level == most_ - 1) to.coarser += share_of(box) * volume_of(box);
      for (int i = 0; i < 1 << dimensions_; ++i) add(part(box, i), level + 1, to);
    }
  }

  double volume_of(const Box& box) const {
    return box.side[0] * box.side[1] * (dimensions_ == 3 ? box.side[2] : 1);
  }
  Vec3 centre_of(const Box& box) const {
    Vec3 centre = box.lo + 0.5 * box.side;
    if (dimensions_ == 2) centre[2] = 0;
    return centre;
  }
  Box part(const Box& box, int i) const {
    Box half{box.lo, 0.5 * box.side};
    for (int k = 0; k < dimensions_; ++k) {
      if (i >> k & 1) half.lo[size_t(k)] += half.side[size_t(k)];
    }
    return half;
  }

  void add_whole(const Box& box, int level, CutCell& to) const {
    const GaussRule& rule = rules_[size_t(level)];
    const size_t n = rule.at.size(), deep = dimensions_ == 3 ? n : 1;
    const double volume = volume_of(box);
    for (size_t i = 0; i < n * n * deep; ++i) {
      const size_t x = i / deep / n, y = i / deep % n, z = i % deep;
      to.at.push_back({box.lo[0] + rule.at[x] * box.side[0], box.lo[1] + rule.at[y] * box.side[1],
                       dimensions_ == 3 ? box.lo[2] + rule.at[z] * box.side[2] : 0});
      to.weight.push_back(volume * rule.weight[x] * rule.weight[y] *
                          (dimensions_ == 3 ? rule.weight[z] : 1));
    }
    to.volume += volume;
    if (level < most_) to.coarser += volume;
  }

  double share_of(const Box& box, Vec3* centre_of_share = nullptr) const {
    const Vec3 centre = centre_of(box);
    double value;
    Vec3 slope;
    solid_.gradients(centre.data(), 1, &value, slope.data());
    for (size_t k = 0; k < 3; ++k) slope[k] = std::isfinite(slope[k]) ? slope[k] * box.side[k] : 0;
    const double share = covered_share(value, slope.data(), dimensions_);
    if (centre_of_share) {
      // Exact where the boundary is along an axis.
      size_t steepest = 0;
      for (size_t k = 1; k < size_t(dimensions_); ++k) {
        if (std::abs(slope[k]) > std::abs(slope[steepest])) steepest = k;
      }
      *centre_of_share = centre;
      (*centre_of_share)[steepest] +=
          std::copysign(0.5 * (1 - share) * box.side[steepest], slope[steepest]);
    }
    return share;
  }

  void add_share(const Box& box, CutCell& to) const {
    Vec3 at;
    const double volume = share_of(box, &at) * volume_of(box);
    if (!(volume > 0)) return;
    to.at.push_back(at);
    to.weight.push_back(volume);
    to.volume += volume;
  }

  int dimensions_, most_;
  Evaluator solid_;
  std::vector<GaussRule> rules_;
};

Box box_of(const SplineGrid& grid, size_t cell) {
  const std::array<int, 3> at = grid.cell(cell);
  Box box;
  for (size_t k = 0; k < 3; ++k) {
    box.side[k] = (grid.upper[k] - grid.lower[k]) / grid.spans(int(k));
    box.lo[k] = grid.lower[k] + at[k] * box.side[k];
  }
  return box;
}

void append(const CutCell& from, size_t cell, Quadrature& to) {
  if (from.at.empty()) return;
  to.cut.push_back(cell);
  to.at.insert(to.at.end(), from.at.begin(), from.at.end());
  to.weight.insert(to.weight.end(), from.weight.begin(), from.weight.end());
  to.first.push_back(to.at.size());
}

}  // namespace

GaussRule gauss_rule(int points) {
  GaussRule rule{std::vector<double>(size_t(points)), std::vector<double>(size_t(points))};
  for (int i = 0; i < points; ++i) {
    // Newton's method for the roots of the Legendre polynomial.
    double x = -std::cos(std::numbers::pi * (i + 0.75) / (points + 0.5)), slope = 1;
    for (int step = 0; step < 100; ++step) {
      double before = 0, now = 1;
      for (int k = 1; k <= points; ++k) {
        before = std::exchange(now, ((2 * k - 1) * x * now - (k - 1) * before) / k);
      }
      slope = points * (x * now - before) / (x * x - 1);
      const double change = now / slope;
      x -= change;
      if (std::abs(change) < 1e-16) break;
    }
    rule.at[size_t(i)] = 0.5 * (1 + x);
    rule.weight[size_t(i)] = 1 / ((1 - x * x) * slope * slope);
  }
  return rule;
}

size_t Quadrature::points_of_rule(const SplineGrid& grid) const {
  const size_t n = size_t(points);
  return grid.dimensions == 3 ? n * n * n : n * n;
}

size_t Quadrature::size(const SplineGrid& grid) const {
  return full.size() * points_of_rule(grid) + at.size();
}

Quadrature quadrature_over(const SplineGrid& grid, const Expression& solid, int points,
                           const Progress& progress) {
  Quadrature made;
  made.points = points;
  const Box any = box_of(grid, 0);
  const double cell_volume = any.side[0] * any.side[1] * (grid.dimensions == 3 ? any.side[2] : 1);
  if (!solid) {
    made.full.resize(grid.cells());
    std::iota(made.full.begin(), made.full.end(), size_t(0));
    made.volume = cell_volume * double(grid.cells());
    return made;
  }
  const Evaluator inside(solid);
  const CellCutter cutter(grid, solid, points);
  std::vector<CutCell> cells(grid.cells());
  std::vector<unsigned char> is_full(grid.cells());
  Work work(progress);
  work.stage(1);
  work.run(grid.cells(), 1, [&](size_t cell, size_t) {
    const Box box = box_of(grid, cell);
    is_full[cell] = inside.interval(box.bounds()).lo >= 0;
    if (!is_full[cell]) cells[cell] = cutter.of(box);
  });
  for (size_t cell = 0; cell < cells.size(); ++cell) {
    if (is_full[cell]) made.full.push_back(cell);
    append(cells[cell], cell, made);
    made.volume += is_full[cell] ? cell_volume : cells[cell].volume;
    made.volume_error += std::abs(cells[cell].volume - cells[cell].coarser);
    cells[cell] = {};
  }
  if (!(made.volume > 0)) {
    throw Error("the solid is empty between lower and upper; a part of it must lie there");
  }
  return made;
}

Quadrature quadrature_of(const SplineGrid& grid, const std::vector<Vec3>& at,
                         const std::vector<double>& weight) {
  std::vector<size_t> cell(at.size()), order(at.size());
  for (size_t i = 0; i < at.size(); ++i) {
    std::array<int, 3> spans;
    for (int k = 0; k < 3; ++k) spans[size_t(k)] = grid.place(k, at[i][size_t(k)]).span;
    cell[i] = grid.cell_number(spans);
  }
  std::iota(order.begin(), order.end(), size_t(0));
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return cell[a] < cell[b]; });
  Quadrature made;
  for (const size_t i : order) {
    if (made.cut.empty() || made.cut.back() != cell[i]) {
      made.cut.push_back(cell[i]);
      made.first.push_back(made.at.size());
    }
    made.at.push_back(at[i]);
    made.weight.push_back(weight[i]);
    made.first.back() = made.at.size();
    made.volume += weight[i];
  }
  return made;
}

}  // namespace sardf

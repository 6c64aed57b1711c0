#include "povray_gen/pieces.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "povray_gen/expression_of.hpp"
#include "sardf/shorten.hpp"
#include "sardf/smooth_formula.hpp"

namespace sardf::povray {

namespace {

// Cells along the longest side of the bounds, a power of two.
constexpr int finest = 64;
// Halvings of the bounds: at most so many pieces.
constexpr int most_halvings = 7;
// What a ray costs that meets a piece, in steps of a formula: POV-Ray's own work, and the calls
// that find that nothing is there.
constexpr double work_per_box = 20;
constexpr double calls_per_box = 2;
// What of the time a split has to save to be worth the text.
constexpr double worthwhile = 0.97;
// Boxes for the bounds of the gradient: of all pieces, and of each.
constexpr int all_boxes = 120'000, fewest_boxes = 500, most_boxes = 20'000;
// Values beyond this share of a piece's diagonal are cut off where that makes the bound so much
// smaller that it outweighs the longer steps.
constexpr double band_share = 0.05;
constexpr double steeper_off_surface = 1.05;

using Index = std::array<int, 3>;

/// A range of cells of the grid: lo <= cell < hi.
struct CellRange {
  Index lo{}, hi{};
  int size(int axis) const { return hi[axis] - lo[axis]; }
};

/// What is known of a part of space on the way from all of it to a piece.
struct Region {
  std::vector<Index> cells;  // those that the surface may pass through
  CellRange range;           // around them
  std::shared_ptr<const Evaluator> field;
};

BoundingBox grown(const BoundingBox& box, double by) {
  const Vec3 around{by, by, by};
  return {box.lo - around, box.hi + around};
}

class Splitter {
 public:
  Splitter(const Expression& solid, const BoundingBox& bounds, const PieceOptions& options)
      : bounds_(bounds), options_(options), demand_{-options.exact_within, options.exact_within} {
    const Vec3 size = bounds.size();
    const double longest = std::max({size[0], size[1], size[2]});
    for (int axis = 0; axis < 3; ++axis) {
      count_[axis] = finest;
      while (count_[axis] > 1 && size[axis] / count_[axis] < 0.7 * longest / finest) {
        count_[axis] /= 2;
      }
    }
    whole_.field = std::make_shared<const Evaluator>(solid);
    find_cells({{}, count_}, whole_.field);
    std::sort(whole_.cells.begin(), whole_.cells.end());
    whole_.range = range_of(whole_.cells);
  }

  /// The regions that the pieces are made of; the only one if splitting does not pay.
  std::vector<Region> regions() {
    std::vector<Region> out;
    if (!whole_.cells.empty()) split(whole_, most_halvings, out);
    if (out.empty()) out.push_back(whole_);
    return out;
  }

  /// How many elementary steps a formula takes; of an operation without one, a guess.
  double steps_of(const Evaluator& field) {
    double steps = 1;
    for (const Instruction& i : field.tape().instructions()) {
      const auto [known, added] =
          steps_.try_emplace({i.operation->info().name, i.operation->numbers()}, 20);
      if (added && i.operation->has_formula()) {
        Trace trace(i.operation->info().arity);
        i.operation->record(trace);
        known->second = double(trace.steps().size());
      }
      steps += known->second;
    }
    return steps;
  }

  BoundingBox box_of(const CellRange& range) const {
    BoundingBox box;
    for (int axis = 0; axis < 3; ++axis) {
      box.lo[axis] = place(axis, range.lo[axis]);
      box.hi[axis] = place(axis, range.hi[axis]);
    }
    return box;
  }

 private:
  // The outermost planes are the bounds, in every bit.
  double place(int axis, int plane) const {
    if (plane == 0) return bounds_.lo[axis];
    if (plane == count_[axis]) return bounds_.hi[axis];
    return bounds_.lo[axis] + plane * ((bounds_.hi[axis] - bounds_.lo[axis]) / count_[axis]);
  }

  void report() const {
    if (options_.progress && !options_.progress(0)) throw Cancelled();
  }

  // Halves a range until it holds no surface or is a single cell.
  void find_cells(const CellRange& range, const std::shared_ptr<const Evaluator>& field) {
    report();
    const Shortening here(*field, grown(box_of(range), options_.overlap));
    const Interval values = here.range();
    if (!here.may_be_nan() && (values.lo > 0 || values.hi < 0)) return;
    int longest = 0;
    for (int axis = 1; axis < 3; ++axis) {
      if (range.size(axis) > range.size(longest)) longest = axis;
    }
    if (range.size(longest) == 1) {
      whole_.cells.push_back(range.lo);
      return;
    }
    const auto shorter = std::make_shared<const Evaluator>(here.shortened(demand_));
    CellRange low = range, high = range;
    low.hi[longest] = high.lo[longest] = (range.lo[longest] + range.hi[longest]) / 2;
    find_cells(low, shorter);
    find_cells(high, shorter);
  }

  static CellRange range_of(const std::vector<Index>& cells) {
    CellRange range{cells[0], cells[0]};
    for (const Index& cell : cells) {
      for (int axis = 0; axis < 3; ++axis) {
        range.lo[axis] = std::min(range.lo[axis], cell[axis]);
        range.hi[axis] = std::max(range.hi[axis], cell[axis] + 1);
      }
    }
    return range;
  }

  static double area(const BoundingBox& box) {
    const Vec3 s = box.size();
    return 2 * (s[0] * s[1] + s[1] * s[2] + s[2] * s[0]);
  }

  // The time of all rays that meet the region: of each that meets its box, and the halvings of
  // those that meet its surface.
  double time_of(const Region& region) {
    const BoundingBox box = box_of(region.range);
    const double steps = steps_of(*region.field);
    double cell = 1;
    for (int axis = 0; axis < 3; ++axis) cell *= bounds_.size()[axis] / count_[axis];
    const double surface = double(region.cells.size()) * std::pow(cell, 2.0 / 3);
    const double halvings = std::max(1.0, std::log2(box.diagonal() / options_.accuracy));
    return area(box) * (work_per_box + calls_per_box * steps) +
           std::min(surface, area(box)) * steps * halvings;
  }

  // The part of the region on one side of a plane.
  Region part(const Region& region, int axis, int plane, bool upper) const {
    Region out;
    for (const Index& cell : region.cells) {
      if ((cell[axis] >= plane) == upper) out.cells.push_back(cell);
    }
    if (out.cells.empty()) return out;
    out.range = range_of(out.cells);
    const BoundingBox box = grown(box_of(out.range), options_.overlap + options_.reach);
    out.field =
        std::make_shared<const Evaluator>(Shortening(*region.field, box).shortened(demand_));
    return out;
  }

  // Appends the best parts of the region; returns their time.
  double split(const Region& region, int halvings, std::vector<Region>& out) {
    report();
    const double own = time_of(region);
    std::pair<Region, Region> best;
    double least = infinity;
    if (halvings > 0) {
      for (int axis = 0; axis < 3; ++axis) {
        for (int plane : planes(region, axis)) {
          std::pair<Region, Region> parts(part(region, axis, plane, false),
                                          part(region, axis, plane, true));
          if (parts.first.cells.empty() || parts.second.cells.empty()) continue;
          const double time = time_of(parts.first) + time_of(parts.second);
          if (time >= least) continue;
          least = time;
          best = std::move(parts);
        }
      }
    }
    const size_t before = out.size();
    if (least < infinity) {
      const double time =
          split(best.first, halvings - 1, out) + split(best.second, halvings - 1, out);
      if (time < worthwhile * own) return time;
    }
    out.resize(before);
    out.push_back(region);
    return own;
  }

  // Where a region might be split along an axis.
  static std::vector<int> planes(const Region& region, int axis) {
    const int lo = region.range.lo[axis], n = region.range.size(axis);
    std::vector<int> out;
    for (int k : {n / 4, n / 2, n - n / 4}) {
      if (k > 0 && k < n && (out.empty() || out.back() != lo + k)) out.push_back(lo + k);
    }
    return out;
  }

  BoundingBox bounds_;
  const PieceOptions& options_;
  Demand demand_;
  Index count_{};
  Region whole_;
  // Not by address: operations that are made for a part do not live as long as this.
  std::map<std::pair<std::string, std::vector<double>>, double> steps_;
};

}  // namespace

namespace {

// Bounds the gradient, and cuts off what is steep far from the surface where that makes the bound
// much smaller. False: the piece has no surface at all.
bool bound_gradient(Piece& piece, BoundEffort effort) {
  const Evaluator bounded(with_smooth_bounds(piece.solid));
  const double band = band_share * piece.box.diagonal();
  const auto near = band_lipschitz_bound(bounded, piece.box, band, effort);
  if (!near) return false;
  effort.enough = steeper_off_surface * *near;
  effort.boxes /= 4;
  piece.gradient = *band_lipschitz_bound(bounded, piece.box, infinity, effort);
  if (piece.gradient > effort.enough) {
    piece.gradient = *near;
    piece.band = band;
  }
  return true;
}

}  // namespace

std::vector<Piece> pieces_of(const Expression& solid, const BoundingBox& bounds,
                             const PieceOptions& options) {
  Splitter splitter(solid, bounds, options);
  const std::vector<Region> regions = splitter.regions();
  BoundEffort effort;
  effort.boxes = std::clamp(all_boxes / int(regions.size()), fewest_boxes, most_boxes);
  effort.progress = options.progress;
  std::vector<Piece> out;
  for (const Region& region : regions) {
    if (options.progress && !options.progress(0)) throw Cancelled();
    Piece piece{bounds, solid};
    if (regions.size() > 1) {
      piece.box = grown(splitter.box_of(region.range), options.overlap);
      piece.solid = expression_of(*region.field);
    }
    if (bound_gradient(piece, effort) || regions.size() == 1) out.push_back(std::move(piece));
  }
  if (out.empty()) out.push_back({bounds, solid});
  if (options.progress && !options.progress(1)) throw Cancelled();
  return out;
}

}  // namespace sardf::povray

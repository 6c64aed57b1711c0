// How steep a field is, place by place; private to core/sardf/render*.cpp.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "sardf/evaluate.hpp"
#include "sardf/render_rays.hpp"

namespace sardf::rendering {

/// Lipschitz bounds of a field's first output over the cells of grids of 1, 2, 4, ... cells along
/// each side of a box. A finer grid is made only where the coarser one's bounds are large, and
/// where the solid (field >= 0) may be near. If the whole box has no bound, cells without one that
/// helps are proven empty of the solid instead, where they can be.
class LocalSlopes {
 public:
  /// `most_cells`: along each side. `check` is called between cells and may throw to end the work.
  LocalSlopes(const Evaluator& field, const BoundingBox& box, int most_cells,
              const std::function<void()>& check);

  /// A field with the value -`depth` at a point of the box has no zero within this distance of it,
  /// as far as the box reaches. 0 where no bound is known.
  double clear_radius(const Vec3& point, double depth) const;
  /// A ray whose field has the value -`depth` at t is clear of the solid from there to the t that
  /// is returned; t itself where nothing is known. NaN as depth: no value is known.
  double clear_until(const Line& line, double t, double depth) const;
  /// Whether all radii are depths by the largest slope.
  bool is_uniform() const { return levels_.size() == 1; }
  /// Over the whole box.
  double largest() const { return levels_[0].around[0]; }

 private:
  struct Level {
    int cells;
    double reach;  // the shortest side of a cell
    std::vector<double> of_cell;
    std::vector<double> around;  // the largest of the cell and its up to 26 neighbours
    std::vector<uint8_t> empty;
  };
  bool wants_more(const Level& level, size_t cell, int most_cells) const;
  Level refined(const Evaluator& field, const Level& coarse, int most_cells,
                const std::function<void()>& check) const;
  BoundingBox cell_box(const Level& level, const std::array<int, 3>& cell) const;
  std::array<int, 3> cell_of(const Level& level, const Vec3& point) const;

  BoundingBox box_;
  Vec3 per_side_{};  // one by its sides
  std::vector<Level> levels_;
  bool walks_ = false;  // the box has no bound: cells by themselves tell more than balls
};

}  // namespace sardf::rendering

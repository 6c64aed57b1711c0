// How steep a field is, place by place; private to core/sardf/render*.cpp.
#pragma once

#include <functional>
#include <vector>

#include "sardf/evaluate.hpp"

namespace sardf::rendering {

/// Lipschitz bounds of a field's first output over the cells of grids of 1, 2, 4 and 8 cells along
/// each side of a box. Finer grids are made only for fields that are steep somewhere, and in them
/// only near the surface.
class LocalSlopes {
 public:
  /// `go_on` is asked between cells; false ends the work early, with true but worse bounds.
  LocalSlopes(const Evaluator& field, const BoundingBox& box, const std::function<bool()>& go_on);

  /// A field with the value -`depth` at a point of the box has no zero within this distance of it,
  /// as far as the box reaches. 0 where no bound is known.
  double clear_radius(const Vec3& point, double depth) const;
  /// Over the whole box.
  double largest() const { return levels_[0].around[0]; }

 private:
  struct Level {
    int cells;
    double reach;  // the shortest side of a cell
    std::vector<double> of_cell;
    std::vector<double> around;  // the largest of the cell and its up to 26 neighbours
  };
  Level refined(const Evaluator& field, const Level& coarse,
                const std::function<bool()>& go_on) const;
  BoundingBox cell_box(const Level& level, const std::array<int, 3>& cell) const;

  BoundingBox box_;
  std::vector<Level> levels_;
};

}  // namespace sardf::rendering

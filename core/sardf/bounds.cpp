#include "sardf/bounds.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "sardf/error.hpp"
#include "sardf/short_number.hpp"
#include "sardf/shorten.hpp"

namespace sardf {

namespace {

// The search starts with the cube of twice this edge length around the origin.
constexpr double farthest = 0x1p40;
// A solid that reaches the cube's surface after this many halvings is called unbounded.
constexpr int unbounded_level = 5;
// Halvings after which what is left is smaller than any solid with meaning.
constexpr int last_level = 80;
// Cells along the longest side of the hull when the faces are moved one by one.
constexpr double coarse_cells = 8;
// A search that keeps more cells than this is given up.
constexpr size_t most_cells = 50'000;
// Boxes that one proof may look at, and how near, in diagonals, the bounds are to come.
constexpr int proof_boxes = 800;
constexpr double tightness = 1e-4;
constexpr double padding = 1e-4;
// A program of this many instructions is not shortened: it costs less than finding out.
constexpr size_t short_program = 8;

Error unbounded_error() {
  return Error(
      "the solid is unbounded, or it cannot be proven to be bounded; intersect it with a box or a "
      "half_space");
}

void include(BoundingBox& hull, const BoundingBox& box) {
  for (int axis = 0; axis < 3; ++axis) {
    hull.lo[axis] = std::min(hull.lo[axis], box.lo[axis]);
    hull.hi[axis] = std::max(hull.hi[axis], box.hi[axis]);
  }
}

double longest_side(const BoundingBox& box) {
  const Vec3 size = box.size();
  return std::max({size[0], size[1], size[2]});
}

// A box with an evaluator of the field that is good in it (shorten.hpp).
struct Cell {
  BoundingBox box;
  std::shared_ptr<const Evaluator> field;
  int patience = 0;  // halvings until it is tried again to shorten
};

// Whether the field is proven to be negative in the cell, by intervals. Where not, the cell gets a
// shorter program, if there is one.
bool has_negative_bound(Cell& cell) {
  constexpr int wait = 3;
  const size_t steps = cell.field->tape().instructions().size();
  if (steps > short_program && --cell.patience < 0) {
    const Shortening here(*cell.field, cell.box);
    if (here.range().hi < 0) return true;
    auto shorter = std::make_shared<const Evaluator>(here.shortened());
    cell.patience = shorter->tape().instructions().size() < steps ? 0 : wait;
    if (cell.patience == 0) cell.field = std::move(shorter);
  }
  return cell.field->interval(cell.box).hi < 0;
}

class Search {
 public:
  Search(const Evaluator& field, const Progress& progress)
      : field_(std::make_shared<const Evaluator>(field)), progress_(progress) {
    const Vec3 corner{farthest, farthest, farthest};
    all_ = {-1.0 * corner, corner};
    slope_ = field.slope(all_).length;
    for (const Tape::Constant& c : field.tape().constants()) include_constant(c.value);
    for (const Instruction& i : field.tape().instructions()) {
      for (const double number : i.operation->numbers()) include_constant(number);
    }
  }

  BoundingBox find() {
    BoundingBox hull = coarse_hull();
    hull_diagonal_ = hull.diagonal();
    const double longest = longest_side(hull);
    // Once more after the other faces have moved: the slabs are smaller then.
    for (const double farthest_step : {longest, longest / 64}) {
      for (int face = 0; face < 6; ++face) move_face(hull, face / 2, face % 2 == 1, farthest_step);
      hull_diagonal_ = hull.diagonal();
    }
    return hull;
  }

  /// Whether the solid is proven to have no point in the box.
  bool is_empty(const BoundingBox& box, int most_boxes) const {
    return is_empty(Cell{box, field_}, most_boxes);
  }

 private:
  bool is_empty(const Cell& cell, int most_boxes) const {
    const double least_side = 0.1 * tightness * hull_diagonal_;
    std::vector<Cell> open{cell};
    for (int looked_at = 0; !open.empty(); ++looked_at) {
      Cell part = std::move(open.back());
      open.pop_back();
      const double middle = part.field->value(part.box.center());
      if (middle >= 0 || looked_at >= most_boxes) return false;
      if (looked_at % 64 == 63) report(0.7);
      if (is_negative(part, middle)) continue;
      if (longest_side(part.box) < least_side) return false;
      for (const BoundingBox& half : split(part.box)) {
        open.push_back({half, part.field, part.patience});
      }
    }
    return true;
  }

  void report(double share) const {
    if (progress_ && !progress_(share)) throw Cancelled();
  }

  void include_constant(double value) {
    if (std::abs(value) < infinity) constants_ = std::max(constants_, std::abs(value));
  }

  // Whether the field, of which the value in the middle is given, is negative all over the box. The
  // Lipschitz bound tells it without the cost of an interval; 4500 roundings of the largest number
  // are set aside for the value.
  bool is_negative(Cell& cell, double middle) const {
    const BoundingBox& box = cell.box;
    const double rounding =
        1e-12 * (std::max({norm(box.lo), norm(box.hi), constants_}) + std::abs(middle));
    const double reach = slope_ * (0.5 * box.diagonal() * (1 + 1e-12) + rounding) + rounding;
    return middle < -reach || has_negative_bound(cell);
  }

  static std::array<BoundingBox, 2> split(const BoundingBox& box) {
    const Vec3 size = box.size();
    const int axis = int(std::max_element(size.begin(), size.end()) - size.begin());
    std::array<BoundingBox, 2> halves{box, box};
    halves[0].hi[axis] = halves[1].lo[axis] = box.center()[axis];
    return halves;
  }

  // Halves cells until the hull of those that may hold points of the solid is resolved by a few.
  BoundingBox coarse_hull() const {
    std::vector<Cell> cells{{all_, field_}};
    for (int level = 1; level <= last_level; ++level) {
      report(0.4 * level / last_level);
      cells = remaining_children(cells);
      if (cells.empty()) throw Error("the solid is empty: its field is negative everywhere");
      BoundingBox hull = cells[0].box;
      for (const Cell& cell : cells) include(hull, cell.box);
      const double reach =
          std::max({-hull.lo[0], -hull.lo[1], -hull.lo[2], hull.hi[0], hull.hi[1], hull.hi[2]});
      if (level >= unbounded_level && reach >= farthest) throw unbounded_error();
      if (cells.size() > most_cells) throw unbounded_error();
      if (level > unbounded_level &&
          longest_side(hull) >= coarse_cells * longest_side(cells[0].box)) {
        return hull;
      }
    }
    throw Error("the solid is empty or a single point: it has no volume");
  }

  static std::array<Cell, 8> eighths(const Cell& cell) {
    std::array<Cell, 8> parts;
    const Vec3 middle = cell.box.center();
    for (size_t k = 0; k < 8; ++k) {
      parts[k] = cell;
      for (int axis = 0; axis < 3; ++axis) {
        (k >> axis & 1 ? parts[k].box.lo : parts[k].box.hi)[axis] = middle[axis];
      }
    }
    return parts;
  }

  std::vector<Cell> remaining_children(const std::vector<Cell>& cells) const {
    std::vector<Cell> children;
    size_t looked_at = 0;
    for (const Cell& cell : cells) {
      if (++looked_at % 16 == 0) report(0.2);
      std::array<Cell, 8> parts = eighths(cell);
      double at[3][8], value[8], *out = value;
      for (size_t k = 0; k < 8; ++k) {
        for (int axis = 0; axis < 3; ++axis) at[axis][k] = parts[k].box.center()[axis];
      }
      cell.field->block(at[0], at[1], at[2], 8, &out);
      for (size_t k = 0; k < 8; ++k) {
        if (!is_negative(parts[k], value[k])) children.push_back(std::move(parts[k]));
      }
    }
    return children;
  }

  // Moves one face of the hull inwards as far as the slab that it leaves is proven empty.
  void move_face(BoundingBox& hull, int axis, bool upper, double farthest_step) const {
    double& face = upper ? hull.hi[axis] : hull.lo[axis];
    double inner = upper ? std::max(hull.lo[axis], face - farthest_step)
                         : std::min(hull.hi[axis], face + farthest_step);
    Cell rest{hull, field_};
    while (std::abs(face - inner) > tightness * hull_diagonal_) {
      report(0.7);
      const double middle = 0.5 * (face + inner);
      BoundingBox slab = hull;
      (upper ? slab.lo : slab.hi)[axis] = inner;
      rest.box = slab;
      if (has_negative_bound(rest)) {
        face = inner;
        break;
      }
      (upper ? slab.lo : slab.hi)[axis] = middle;
      if (is_empty(Cell{slab, rest.field}, proof_boxes)) {
        face = middle;
      } else {
        inner = middle;
      }
    }
  }

  std::shared_ptr<const Evaluator> field_;
  const Progress& progress_;
  BoundingBox all_;
  double slope_;
  double constants_ = 0;  // the largest constant of the field
  double hull_diagonal_ = 0;
};

// Throws unless what sticks out of the stated box, by more than the padding, is proven empty.
void check_stated(const Search& search, BoundingBox& bounds, const BoundingBox& stated) {
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const bool upper = face % 2 == 1;
    const double slack = (upper ? padding : -padding) * bounds.diagonal();
    const double limit = (upper ? stated.hi[axis] : stated.lo[axis]) + slack;
    double& reached = upper ? bounds.hi[axis] : bounds.lo[axis];
    if (upper ? reached <= limit : reached >= limit) continue;
    BoundingBox outside = bounds;
    (upper ? outside.lo : outside.hi)[axis] = limit;
    if (!search.is_empty(outside, 20 * proof_boxes)) {
      throw Error(std::string("the solid reaches out of its stated bounds: ") + "xyz"[axis] +
                  (upper ? " goes up to " : " goes down to ") + short_number(reached, 6) +
                  ", stated is " + short_number(limit - slack, 6));
    }
    reached = limit;
  }
}

}  // namespace

BoundingBox certified_bounds(const Evaluator& field, const Progress& progress,
                             const std::optional<BoundingBox>& stated) {
  Search search(field, progress);
  BoundingBox bounds = search.find();
  if (stated) check_stated(search, bounds, *stated);
  const double pad = padding * bounds.diagonal();
  const Vec3 by{pad, pad, pad};
  return {bounds.lo - by, bounds.hi + by};
}

}  // namespace sardf

#include "sardf/winding_number.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <numbers>

namespace sardf {

namespace {

constexpr uint32_t no_triangle = ~0u;
constexpr double full_turn = 4 * std::numbers::pi;

// Of the triangle seen from the origin, over 4 π.
// Source: van Oosterom and Strackee 1983, "The solid angle of a plane triangle".
double turns(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double la = quick_norm(a), lb = quick_norm(b), lc = quick_norm(c);
  const double volume = dot(a, cross(b, c));
  const double rest = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
  return volume == 0 ? 0 : 2 / full_turn * std::atan2(volume, rest);
}

void add_product(std::array<double, 6>& m, const Vec3& a, const Vec3& b) {
  m[0] += a[0] * b[0];
  m[1] += a[1] * b[1];
  m[2] += a[2] * b[2];
  m[3] += 0.5 * (a[0] * b[1] + a[1] * b[0]);
  m[4] += 0.5 * (a[0] * b[2] + a[2] * b[0]);
  m[5] += 0.5 * (a[1] * b[2] + a[2] * b[1]);
}

double quadratic(const std::array<double, 6>& m, const Vec3& u) {
  return m[0] * u[0] * u[0] + m[1] * u[1] * u[1] + m[2] * u[2] * u[2] +
         2 * (m[3] * u[0] * u[1] + m[4] * u[0] * u[2] + m[5] * u[1] * u[2]);
}

Vec3 mean_of(const Vec3& a, const Vec3& b, const Vec3& c) { return (1.0 / 3) * (a + b + c); }

double farthest_corner(const TriangleTree::Node& node, size_t child, const Vec3& from) {
  Vec3 away{};
  for (size_t k = 0; k < 3; ++k) {
    away[k] = std::max(double(node.hi[k][child]) - from[k], from[k] - double(node.lo[k][child]));
  }
  return quick_norm(away);
}

// How much the winding number of area 1 may change within `reach` of a point at this distance: its
// gradient is at most 2 / (4 π distance³).
double change(double distance, double reach) {
  const double nearest = distance - reach;
  return nearest > 0 ? reach * 2 / (full_turn * nearest * nearest * nearest) : infinity;
}

}  // namespace

WindingNumber::WindingNumber(const TriangleTree& tree, bool turned, Pulse& pulse)
    : tree_(tree), sign_(turned ? -1 : 1), cells_(tree.nodes().size()) {
  const std::vector<TriangleTree::Node>& nodes = tree.nodes();
  tbb::this_task_arena::isolate([&] {
    tbb::parallel_for(size_t(0), nodes.size(), [&](size_t i) {
      pulse.step(i, nodes.size());
      for (size_t child = 0; child < 4; ++child) {
        if (nodes[i].count[child] > 0) cells_[i][child] = cell_of_leaf(nodes[i], child);
      }
    });
  });
  for (size_t i = nodes.size(); i-- > 0;) {
    pulse.step(nodes.size() - i, nodes.size());
    for (size_t child = 0; child < 4; ++child) {
      if (nodes[i].count[child] > 0 || nodes[i].missing(child)) continue;
      cells_[i][child] = cell_of_node(nodes[i], child);
    }
  }
}

WindingNumber::Cell WindingNumber::cell_of_leaf(const TriangleTree::Node& node,
                                                size_t child) const {
  Cell cell;
  const uint32_t first = node.first[child], last = first + node.count[child];
  for (uint32_t i = first; i < last; ++i) {
    const TriangleTree::Triangle& t = tree_.triangles()[i];
    const Vec3 vector = 0.5 * tree_.area_vector(t);
    const double area = quick_norm(vector);
    cell.area += area;
    cell.dipole = cell.dipole + vector;
    cell.centre =
        cell.centre + area * mean_of(tree_.corner(t, 0), tree_.corner(t, 1), tree_.corner(t, 2));
  }
  if (cell.area == 0) return Cell();
  cell.centre = (1 / cell.area) * cell.centre;
  for (uint32_t i = first; i < last; ++i) {
    const TriangleTree::Triangle& t = tree_.triangles()[i];
    const Vec3 mean = mean_of(tree_.corner(t, 0), tree_.corner(t, 1), tree_.corner(t, 2));
    add_product(cell.moment, 0.5 * tree_.area_vector(t), mean - cell.centre);
    for (size_t k = 0; k < 3; ++k) {
      const Vec3 away = tree_.corner(t, k) - cell.centre;
      cell.radius = std::max(cell.radius, quick_norm(away));
    }
  }
  return cell;
}

WindingNumber::Cell WindingNumber::cell_of_node(const TriangleTree::Node& node,
                                                size_t child) const {
  const std::array<Cell, 4>& parts = cells_[node.first[child]];
  Cell cell;
  for (const Cell& part : parts) {
    cell.area += part.area;
    cell.dipole = cell.dipole + part.dipole;
    cell.centre = cell.centre + part.area * part.centre;
  }
  if (cell.area == 0) return Cell();
  cell.centre = (1 / cell.area) * cell.centre;
  double reach = 0;
  for (const Cell& part : parts) {
    if (part.area == 0) continue;
    const Vec3 offset = part.centre - cell.centre;
    for (size_t k = 0; k < 6; ++k) cell.moment[k] += part.moment[k];
    add_product(cell.moment, part.dipole, offset);
    reach = std::max(reach, quick_norm(offset) + part.radius);
  }
  cell.radius = std::min(reach, farthest_corner(node, child, cell.centre));
  return cell;
}

void WindingNumber::add_leaf(const Ball& ball, uint32_t first, uint32_t count, Sum& sum) const {
  for (uint32_t i = first; i < first + count; ++i) {
    if (i == ball.without) continue;
    const TriangleTree::Triangle& t = tree_.triangles()[i];
    const Vec3 a = tree_.corner(t, 0) - ball.centre, b = tree_.corner(t, 1) - ball.centre,
               c = tree_.corner(t, 2) - ball.centre;
    sum.value += turns(a, b, c);
    if (ball.radius == 0) continue;
    const Vec3 mean = mean_of(a, b, c), area = tree_.area_vector(t);
    double radius = 0;
    for (const Vec3& corner : {a, b, c}) {
      const Vec3 away = corner - mean;
      radius = std::max(radius, quick_norm(away));
    }
    const double most = 0.5 * quick_norm(area) * change(quick_norm(mean) - radius, ball.radius);
    // No triangle fills more than half of the view.
    sum.error += most < 1 ? most : 1;
  }
}

WindingNumber::Sum WindingNumber::pass(const Ball& ball, double steepest) const {
  Sum sum{0, 1e-9};  // of rounding
  std::array<uint32_t, 256> stack;
  size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const uint32_t at = stack[--size];
    const TriangleTree::Node& node = tree_.nodes()[at];
    for (size_t i = 0; i < 4; ++i) {
      const Cell& cell = cells_[at][i];
      if (cell.area == 0) continue;
      const Vec3 to = cell.centre - ball.centre;
      const double squared = dot(to, to), d = std::sqrt(squared);
      if (cell.radius > steepest * d || cell.radius + 2 * ball.radius > d) {
        if (node.count[i] > 0) {
          add_leaf(ball, node.first[i], node.count[i], sum);
        } else {
          stack[size++] = node.first[i];
        }
        continue;
      }
      const Vec3 u = (1 / d) * to;
      const double trace = cell.moment[0] + cell.moment[1] + cell.moment[2], q = cell.radius / d;
      const double first_order = (trace - 3 * quadratic(cell.moment, u)) / d;
      sum.value += (dot(cell.dipole, u) + first_order) / (full_turn * squared);
      sum.error += cell.area / (full_turn * squared) * q * q * (3 - 2 * q) / ((1 - q) * (1 - q));
      if (ball.radius > 0) sum.error += cell.area * change(d - cell.radius, ball.radius);
    }
  }
  sum.value *= sign_;
  return sum;
}

Interval WindingNumber::over_ball(const Vec3& centre, double radius) const {
  for (double steepest = 0.3;; steepest *= 0.5) {
    const Sum sum = pass({centre, radius, no_triangle}, steepest);
    const Interval all{sum.value - sum.error, sum.value + sum.error};
    // What the ball's radius adds does not shrink.
    const bool fine = sum.error <= accuracy || (radius > 0 && steepest < 0.1);
    if (all.lo > 0.5 || all.hi < 0.5 || fine) return all;
  }
}

double WindingNumber::on_triangle(uint32_t triangle) const {
  const TriangleTree::Triangle& t = tree_.triangles()[triangle];
  const Vec3 middle = mean_of(tree_.corner(t, 0), tree_.corner(t, 1), tree_.corner(t, 2));
  for (double steepest = 0.3;; steepest *= 0.5) {
    const Sum sum = pass({middle, 0, triangle}, steepest);
    if (sum.error <= 0.1) return sum.value;
  }
}

}  // namespace sardf

// The generalised winding number of triangles, with proven bounds.
#pragma once

#include <vector>

#include "sardf/numbers/interval.hpp"
#include "sardf/triangle_tree.hpp"

namespace sardf {

/// How often the triangles wind around a point: the sum of their solid angles as seen from it, over
/// 4 π; of a closed outward surface 1 inside and 0 outside. Sources: Jacobson, Kavan, Sorkine 2013,
/// "Robust inside-outside segmentation using generalized winding numbers"; Barill et al. 2018,
/// "Fast winding numbers for soups and clouds".
///
/// Far cells are expanded to their dipole and its first moments, near triangles summed exactly.
/// With ρ the radius of a cell of area A at distance d, and q = ρ / d, the terms of order n of the
/// field's expansion are at most (n + 1) qⁿ / d² (the terms are gradients of solid harmonics, which
/// Bernstein's and Szegő's inequality bounds), so what is left out is at most
/// A / (4 π d²) · q² (3 - 2 q) / (1 - q)². The sum of these bounds is known with each value.
class WindingNumber {
 public:
  /// Keeps a reference to the tree. `turned`: as if every triangle faced the other way. Throws
  /// Cancelled where the pulse does.
  explicit WindingNumber(const TriangleTree& tree, bool turned = false,
                         Pulse& pulse = Pulse::none());

  /// Values between which the winding number is all over the ball (local coordinates). With radius
  /// 0 the interval does not hold 1/2 or is narrower than 2 * accuracy.
  Interval over_ball(const Vec3& centre, double radius) const;
  static constexpr double accuracy = 1e-3;

  /// The winding number at the middle of a triangle of the tree, without the triangle itself: the
  /// mean of its values on the two sides. Exact to 0.1.
  double on_triangle(uint32_t triangle) const;

 private:
  struct Cell {
    Vec3 centre{};  // the triangles' centre of mass
    double radius = 0, area = 0;
    Vec3 dipole{};                   // sum of the area vectors
    std::array<double, 6> moment{};  // xx yy zz xy xz yz of the sum of areas ⊗ offsets, symmetric
  };
  struct Ball {
    Vec3 centre;
    double radius;
    uint32_t without;  // a triangle that is left out
  };
  struct Sum {
    double value = 0, error = 0;
  };

  Cell cell_of_leaf(const TriangleTree::Node& node, size_t child) const;
  Cell cell_of_node(const TriangleTree::Node& node, size_t child) const;
  Sum pass(const Ball& ball, double steepest) const;
  void add_leaf(const Ball& ball, uint32_t first, uint32_t count, Sum& sum) const;

  const TriangleTree& tree_;
  double sign_;
  std::vector<std::array<Cell, 4>> cells_;  // of each node's children
};

}  // namespace sardf

// Many points or segments as one set, with a tree.
#pragma once

#include "sardf/box_tree.hpp"

namespace sardf {

/// The union of straight segments; one whose ends are equal is a point.
class SegmentSet final : public PointSet {
 public:
  struct Ends {
    Vec3 a{}, b{};
  };
  /// `data`: what they are made from. At least one segment.
  SegmentSet(std::string name, std::string doc, std::span<const double> data,
             std::span<const Ends> segments);

  Nearest nearest(const Vec3& point) const override;
  std::array<Vec3, 3> jacobian(const Vec3& point, const Nearest& at) const override;
  std::array<Interval, 3> bounds() const override { return tree_.extent().intervals(); }

 private:
  struct Stored {
    Vec3 a{}, along{};
    double inverse = 0;  // 1 / |along|²; 0: a point
  };

  BoxTree tree_;
  std::vector<Stored> segments_;  // in the tree's order
};

}  // namespace sardf

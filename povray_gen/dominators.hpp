// Which term of a function every use of another term lies in.
#pragma once

#include <array>
#include <vector>

#include "povray_gen/terms.hpp"

namespace sardf::povray {

/// The dominator tree of the terms that `root` needs. Its nodes are the terms and, for every
/// choose, one node for each of its two branches: what lies under a branch is evaluated only when
/// that branch is taken. A term's parent is the innermost node that contains all of its uses, so
/// there, and nowhere deeper, its value has to be known.
class Dominators {
 public:
  Dominators(const Terms& terms, int root);

  int nodes() const { return int(parent_.size()); }
  bool is_reached(int node) const { return uses_[node] > 0; }
  bool is_branch(int node) const { return node >= terms_; }
  /// The nodes of the two branches of a choose, in the order of its operands 1 and 2.
  std::array<int, 2> branches(int choose) const {
    return {first_branch_[choose], first_branch_[choose] + 1};
  }
  /// The term that a branch node stands for.
  int term_of(int branch) const { return term_of_branch_[branch - terms_]; }

  /// How often a node's value occurs.
  int uses(int node) const { return uses_[node]; }
  /// -1 for the root.
  int parent(int node) const { return parent_[node]; }
  int depth(int node) const { return depth_[node]; }
  /// The root of the region that a node lies in: the branch or the root above it.
  int region(int node) const { return region_[node]; }

 private:
  void enter(int node, int parent);
  void use(int node, int user);
  int meet(int a, int b) const;

  int terms_;
  std::vector<int> parent_, depth_, jump_, uses_, region_, first_branch_, term_of_branch_;
};

}  // namespace sardf::povray

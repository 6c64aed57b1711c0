#include "povray_gen/dominators.hpp"

#include <utility>

namespace sardf::povray {

// Operands have smaller numbers than their users, so going down the numbers all uses of a term are
// known when it is reached, and its dominator is where their paths to the root meet.
Dominators::Dominators(const Terms& terms, int root) : terms_(terms.size()) {
  first_branch_.assign(terms_, -1);
  for (int term = 0; term < terms_; ++term) {
    if (terms[term].kind != Term::Kind::choose) continue;
    first_branch_[term] = terms_ + int(term_of_branch_.size());
    term_of_branch_.push_back(terms[term].operands[1]);
    term_of_branch_.push_back(terms[term].operands[2]);
  }
  const size_t nodes = size_t(terms_) + term_of_branch_.size();
  for (auto* list : {&parent_, &depth_, &jump_, &region_}) list->assign(nodes, -1);
  uses_.assign(nodes, 0);
  uses_[root] = 1;
  for (int term = root; term >= 0; --term) {
    if (!is_reached(term)) continue;
    enter(term, parent_[term]);
    const std::vector<int>& operands = terms[term].operands;
    if (terms[term].kind == Term::Kind::choose) {
      use(operands[0], term);
      for (int branch : branches(term)) {
        use(branch, term);
        enter(branch, term);
        use(term_of(branch), branch);
      }
    } else {
      for (int operand : operands) use(operand, term);
    }
  }
}

// Besides its parent every node keeps one ancestor farther up, so that walks take logarithmic time
// (Myers 1983, "An applicative random-access stack").
void Dominators::enter(int node, int parent) {
  parent_[node] = parent;
  if (parent < 0) {
    depth_[node] = 0;
    jump_[node] = region_[node] = node;
    return;
  }
  depth_[node] = depth_[parent] + 1;
  region_[node] = is_branch(node) ? node : region_[parent];
  const int far = jump_[parent], farther = jump_[far];
  const bool equal_strides = depth_[parent] - depth_[far] == depth_[far] - depth_[farther];
  jump_[node] = equal_strides ? farther : parent;
}

void Dominators::use(int node, int user) {
  ++uses_[node];
  parent_[node] = uses_[node] == 1 ? user : meet(parent_[node], user);
}

int Dominators::meet(int a, int b) const {
  if (depth_[a] < depth_[b]) std::swap(a, b);
  while (depth_[a] > depth_[b]) a = depth_[jump_[a]] >= depth_[b] ? jump_[a] : parent_[a];
  while (a != b) {
    const bool far = jump_[a] != jump_[b];
    a = far ? jump_[a] : parent_[a];
    b = far ? jump_[b] : parent_[b];
  }
  return a;
}

}  // namespace sardf::povray

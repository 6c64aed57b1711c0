#include "povray_gen/let_plan.hpp"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

#include "povray_gen/schedule.hpp"

namespace sardf::povray {

namespace {

// Text that nests deeper than this is unreadable; POV-Ray's parser overflows at some 20 000.
constexpr int readable_height = 100;
// Deep graphs take taller pieces, so that their chain of calls stays below POV-Ray's 1024.
constexpr int most_pieces = 300;
constexpr int repeated_operators = 4;
// A scope that needs more values from outside is no unit: what is in it is computed as they come.
constexpr int many_values = most_parameters / 2;

}  // namespace

LetPlan::LetPlan(const Terms& terms, int root, Simple simple)
    : terms_(terms), root_(root), dominators_(terms, root) {
  const int nodes = dominators_.nodes();
  for (auto* list : {&home_, &stage_, &owner_}) list->assign(nodes, -1);
  for (auto* list : {&children_, &height_, &tallest_}) list->assign(nodes, 0);
  scopes_.resize(nodes);
  repeated_.assign(nodes, false);
  find_repeated_terms(simple);
  bind_shared_terms();
  for (int term = 0; term <= root; ++term) {
    if (!dominators_.is_reached(term)) continue;
    if (terms[term].kind == Term::Kind::choose) {
      for (int branch : dominators_.branches(term)) process(branch);
    }
    process(term);
  }
}

void LetPlan::bind_shared_terms() {
  std::vector<int> depth(size_t(root_) + 1, 0);
  for (int term = 0; term <= root_; ++term) {
    if (!dominators_.is_reached(term) || terms_[term].is_leaf()) continue;
    for (int operand : terms_[term].operands) depth[term] = std::max(depth[term], depth[operand]);
    ++depth[term];
    if (dominators_.uses(term) > 1 && !repeated_[term]) move_home(term, dominators_.parent(term));
  }
  most_height_ = std::max(readable_height, depth[root_] / most_pieces);
}

void LetPlan::find_repeated_terms(Simple simple) {
  std::vector<int> operators(size_t(root_) + 1, 0);
  for (int term = 0; term < root_; ++term) {
    if (!terms_[term].is_operator()) continue;
    const std::vector<int>& operands = terms_[term].operands;
    if (operands.size() == 1) {
      // A value's negative costs no more than the value.
      repeated_[term] = terms_[operands[0]].is_leaf() || dominators_.uses(operands[0]) > 1;
    }
    if (simple == Simple::bind) continue;
    bool of_inputs = true;
    operators[term] = 1;
    for (int operand : operands) {
      of_inputs = of_inputs && (terms_[operand].is_leaf() || operators[operand] > 0);
      operators[term] += operators[operand];
    }
    if (!of_inputs || operators[term] > repeated_operators) operators[term] = 0;
    if (operators[term] > 0) repeated_[term] = true;
  }
}

void LetPlan::move_home(int term, int home) {
  if (home_[term] >= 0) --children_[home_[term]];
  home_[term] = home;
  ++children_[home];
}

// Nodes come operands first, so all scopes inside a node are built before it.
void LetPlan::process(int node) {
  if (children_[node] > 0) build_scope(node);
  height_[node] = text_height(node);
  if (!dominators_.is_branch(node)) limit_height(node);
  if (home_[node] >= 0) tallest_[home_[node]] = std::max(tallest_[home_[node]], height_[node]);
}

int LetPlan::text_height(int node) const {
  int tallest = tallest_[node];
  const auto count = [&](int operand) {
    if (home_[operand] < 0) tallest = std::max(tallest, height_[operand]);
  };
  if (dominators_.is_branch(node)) {
    count(dominators_.term_of(node));
  } else if (terms_[node].kind == Term::Kind::choose) {
    count(terms_[node].operands[0]);
    for (int branch : dominators_.branches(node)) count(branch);
  } else {
    for (int operand : terms_[node].operands) count(operand);
    if (terms_[node].is_leaf()) return 0;
  }
  return tallest + 1;
}

// A term whose text nests too deeply is bound as far out as its branch and the values that it uses
// allow.
void LetPlan::limit_height(int node) {
  if (height_[node] < most_height_ || node == root_) return;
  const int region = dominators_.region(node);
  if (dominators_.is_branch(region) && dominators_.term_of(region) == node) return;
  move_home(node, outermost_home(node, references(node, false)));
}

// The values and inputs that the node's text uses; those bound in the node itself only if `inside`.
std::vector<int> LetPlan::references(int node, bool inside) const {
  if (children_[node] > 0 && !inside) return scopes_[node].free;
  std::vector<int> out, pending;
  std::unordered_set<int> seen;
  const auto see = [&](int value) {
    if (seen.insert(value).second) out.push_back(value);
  };
  const auto descend = [&](int next) {
    if (dominators_.is_branch(next)) {
      pending.push_back(dominators_.term_of(next));
    } else if (terms_[next].kind == Term::Kind::choose) {
      pending.push_back(terms_[next].operands[0]);
      for (int branch : dominators_.branches(next)) pending.push_back(branch);
    } else {
      const std::vector<int>& operands = terms_[next].operands;
      pending.insert(pending.end(), operands.begin(), operands.end());
    }
  };
  descend(node);
  while (!pending.empty()) {
    const int next = pending.back();
    pending.pop_back();
    const bool branch = dominators_.is_branch(next);
    if (home_[next] >= 0 || (!branch && terms_[next].kind == Term::Kind::input)) {
      see(next);
    } else if (children_[next] > 0) {
      for (int value : scopes_[next].free) see(value);
    } else {
      descend(next);
    }
  }
  return out;
}

// Where a term can be bound at the farthest: in its region, below the homes of what it uses.
int LetPlan::outermost_home(int node, const std::vector<int>& used_values) const {
  int home = dominators_.region(node);
  for (int used : used_values) {
    const int outer = home_[used];
    if (outer >= 0 && dominators_.depth(outer) > dominators_.depth(home)) home = outer;
  }
  return home;
}

// Moves what is bound in a node outwards; false if that is impossible.
bool LetPlan::dissolve(int node, const std::vector<int>& terms) {
  const int outer = outermost_home(node, scopes_[node].free);
  if (outer == node) return false;
  for (int term : terms) {
    if (home_[term] == node) move_home(term, outer);
  }
  tallest_[outer] = std::max(tallest_[outer], tallest_[node]);
  scopes_[node].free.clear();
  return true;
}

namespace {

// Collects the items of one scope, each term once, and then numbers them operands first.
struct ItemCollector {
  std::unordered_map<int, std::vector<int>> uses;  // by term: the values and terms that it uses
  std::vector<int> pending;

  void want(int term) {
    if (uses.try_emplace(term).second) pending.push_back(term);
  }
};

}  // namespace

void LetPlan::build_scope(int node) {
  ItemCollector found;
  const int body = dominators_.is_branch(node) ? dominators_.term_of(node) : node;
  found.want(body);
  while (!found.pending.empty()) {
    const int term = found.pending.back();
    found.pending.pop_back();
    std::vector<int> uses;
    if ((term != node && children_[term] > 0) || terms_[term].kind == Term::Kind::choose) {
      // A scope inside this one, or a choose: nothing is taken out of it.
      uses = references(term, term == node);
    } else {
      std::vector<int> operands = terms_[term].operands;
      while (!operands.empty()) {
        const int operand = operands.back();
        operands.pop_back();
        const std::vector<int>& below = terms_[operand].operands;
        if (repeated_[operand]) {
          operands.insert(operands.end(), below.begin(), below.end());
        } else {
          uses.push_back(operand);
        }
      }
    }
    for (int used : uses) {
      const bool free = home_[used] >= 0 && home_[used] != node;
      if (!free && !terms_[used].is_leaf()) found.want(used);
    }
    found.uses[term] = std::move(uses);
  }
  std::vector<int> terms;
  for (const auto& entry : found.uses) terms.push_back(entry.first);
  std::sort(terms.begin(), terms.end());
  std::unordered_map<int, int> position, free_number;
  std::vector<ScopeItem> items;
  Scope& scope = scopes_[node];
  for (int term : terms) {
    ScopeItem item;
    item.term = term;
    item.shared = term != body && home_[term] == node;
    for (int used : found.uses[term]) {
      if (const auto inner = position.find(used); inner != position.end()) {
        item.items.push_back(inner->second);
      } else if (terms_[used].kind != Term::Kind::number) {
        const auto [at, added] = free_number.try_emplace(used, int(scope.free.size()));
        if (added) scope.free.push_back(used);
        item.free.push_back(at->second);
      }
    }
    position[term] = int(items.size());
    items.push_back(std::move(item));
  }
  if (int(scope.free.size()) > many_values && dissolve(node, terms)) return;
  const Schedule plan = schedule(items, int(scope.free.size()), most_parameters);
  scope.stages = plan.stages;
  for (size_t i = 0; i < items.size(); ++i) {
    stage_[items[i].term] = plan.stage[i];
    owner_[items[i].term] = node;
  }
}

}  // namespace sardf::povray

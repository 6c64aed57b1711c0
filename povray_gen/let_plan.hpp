// Where the shared values of a function are computed, so that none is computed twice.
//
// POV-Ray functions have no local variables: the only way to use a value twice is to pass it to
// another function as a parameter. So a term with several uses is *bound*: the innermost node that
// contains all of its uses, its home, becomes a call of a function of its own, to which the value
// is passed. A home and the values bound in it are a *scope*. Where one bound value needs another,
// the scope is a chain of functions, each calling the next: its *stages*.
#pragma once

#include <vector>

#include "povray_gen/dominators.hpp"
#include "povray_gen/terms.hpp"

namespace sardf::povray {

/// POV-Ray's MAX_PARAMETER_LIST. One more gives a misleading parse error.
inline constexpr int most_parameters = 56;

struct Scope {
  /// Functions in the chain; 0: nothing is bound here.
  int stages = 0;
  /// The values of outer scopes, and the inputs, that the scope uses.
  std::vector<int> free;
};

class LetPlan {
 public:
  /// What to do with a few shared operators on inputs and numbers, such as 0.5 * (x - 3).
  enum class Simple {
    bind,    // as with all shared terms but negatives of values
    repeat,  // write them again: they cost little more than passing them, and take no parameter
  };
  /// Throws Error if more values than a function can have are needed at once.
  LetPlan(const Terms& terms, int root, Simple simple = Simple::bind);

  const Dominators& dominators() const { return dominators_; }
  /// The scope at a node; its stages are 0 where there is none.
  const Scope& scope(int node) const { return scopes_[node]; }
  /// Whether the term is passed as a parameter, and if so, in the call of which stage of which
  /// scope it is computed: 0 is the call that stands in place of the scope's node.
  bool is_value(int term) const { return stage_[term] >= 0; }
  int stage(int term) const { return stage_[term]; }
  int owner(int term) const { return owner_[term]; }

 private:
  void bind_shared_terms();
  void find_repeated_terms(Simple simple);
  void process(int node);
  int text_height(int node) const;
  void limit_height(int node);
  std::vector<int> references(int node, bool inside) const;
  void build_scope(int node);
  bool dissolve(int node, const std::vector<int>& terms);
  int outermost_home(int node, const std::vector<int>& used_values) const;
  void move_home(int term, int home);

  const Terms& terms_;
  int root_;
  Dominators dominators_;
  std::vector<bool> repeated_;  // by term: written wherever it is used
  std::vector<int> home_;       // of bound terms, else -1
  std::vector<int> children_;   // by node: terms bound there
  std::vector<int> height_;     // by node: nesting of its text
  std::vector<int> tallest_;    // by node: height of the tallest term bound there
  std::vector<int> stage_;      // of values, else -1
  std::vector<int> owner_;      // by term: the scope that it is computed in
  std::vector<Scope> scopes_;
  int most_height_ = 0;
};

}  // namespace sardf::povray

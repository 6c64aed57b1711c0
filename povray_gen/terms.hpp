// The terms of a POV-Ray function: a graph in which equal terms are one node.
//
// Both levels of a formula become terms: the operations of an expression graph, and the steps
// inside one operation (numbers/trace.hpp).
#pragma once

#include <map>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "sardf/numbers/trace.hpp"

namespace sardf::povray {

struct Term {
  enum class Kind {
    input,   // an argument of the function: `index`
    number,  // `value`
    apply,   // `function` of the operands: "+", "-", "*", "/", "negate", "<", ">=", "&", "|", or
             // the name of a POV-Ray function, built in or declared. "select" is the second operand
             // where the first is negative, the third elsewhere
    choose,  // as "select", but nothing that only the branch not taken needs is evaluated
  };
  Kind kind = Kind::number;
  std::string function;
  int index = 0;
  double value = 0;
  std::vector<int> operands;

  bool is_operator() const {
    return kind == Kind::apply &&
           (operands.size() == 1 ? function == "negate" : function.size() == 1);
  }
  bool is_leaf() const { return kind == Kind::input || kind == Kind::number; }
};

/// Terms are added operands first. Adding simplifies where the result is the same number (but for
/// the sign of zero): products with 1 and 0, sums with 0, double negation, -min(-a, -b) = max(a,
/// b).
class Terms {
 public:
  int input(int index);
  int number(double value);
  int apply(const std::string& function, std::vector<int> operands);
  int select(int condition, int where_negative, int elsewhere, bool lazy);
  /// Adds what the trace records, for these inputs; returns the term of its result.
  int append(const Trace& trace, std::span<const int> inputs);

  /// The same terms with every choose a "select": what its branches need may be evaluated early.
  Terms without_branches() const;

  const Term& operator[](int term) const { return terms_[term]; }
  int size() const { return int(terms_.size()); }
  /// How many operators and calls the term needs, each counted once; stops counting at `limit`.
  int operations(int term, int limit) const;

 private:
  using Key = std::tuple<Term::Kind, std::string, int, uint64_t, std::vector<int>>;
  int add(Term term);
  bool is_number(int term, double value) const;
  bool is(int term, const char* function) const;
  int add_sum(int a, int b);
  int add_difference(int a, int b);
  int add_product(int a, int b);
  int add_quotient(int a, int b);
  int add_negation(int a);

  std::vector<Term> terms_;
  std::map<Key, int> known_;
};

}  // namespace sardf::povray

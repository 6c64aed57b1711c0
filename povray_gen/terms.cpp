#include "povray_gen/terms.hpp"

#include <bit>
#include <cassert>
#include <cmath>
#include <unordered_set>
#include <utility>

namespace sardf::povray {

namespace {

// A truth value as the sign of a term: it holds where the term is negative, or where it is not.
// So a comparison is a difference, which is exact in its sign, and costs select() nothing more.
struct Mask {
  int term = -1;
  bool negative = true;
};

}  // namespace

int Terms::add(Term term) {
  Key key{term.kind, term.function, term.index, std::bit_cast<uint64_t>(term.value), term.operands};
  const auto [known, added] = known_.try_emplace(std::move(key), size());
  if (added) terms_.push_back(std::move(term));
  return known->second;
}

bool Terms::is_number(int term, double value) const {
  return terms_[term].kind == Term::Kind::number && terms_[term].value == value;
}

bool Terms::is(int term, const char* function) const {
  return terms_[term].kind == Term::Kind::apply && terms_[term].function == function;
}

int Terms::input(int index) {
  Term term;
  term.kind = Term::Kind::input;
  term.index = index;
  return add(std::move(term));
}

int Terms::number(double value) {
  Term term;
  term.value = value;
  return add(std::move(term));
}

int Terms::select(int condition, int where_negative, int elsewhere, bool lazy) {
  if (where_negative == elsewhere) return elsewhere;
  Term term;
  term.kind = lazy ? Term::Kind::choose : Term::Kind::apply;
  term.function = "select";
  term.operands = {condition, where_negative, elsewhere};
  return add(std::move(term));
}

int Terms::add_sum(int a, int b) {
  if (is_number(a, 0)) return b;
  if (is_number(b, 0)) return a;
  if (is(b, "negate")) return apply("-", {a, terms_[b].operands[0]});
  if (is(a, "negate")) return apply("-", {b, terms_[a].operands[0]});
  if (terms_[b].kind == Term::Kind::number && terms_[b].value < 0) {
    return apply("-", {a, number(-terms_[b].value)});
  }
  return -1;
}

int Terms::add_difference(int a, int b) {
  if (is_number(b, 0)) return a;
  if (is_number(a, 0)) return apply("negate", {b});
  if (is(b, "negate")) return apply("+", {a, terms_[b].operands[0]});
  if (terms_[b].kind == Term::Kind::number && terms_[b].value < 0) {
    return apply("+", {a, number(-terms_[b].value)});
  }
  return -1;
}

int Terms::add_product(int a, int b) {
  if (is_number(a, 0) || is_number(b, 0)) return number(0);
  if (is_number(a, 1)) return b;
  if (is_number(b, 1)) return a;
  if (is_number(a, -1)) return apply("negate", {b});
  if (is_number(b, -1)) return apply("negate", {a});
  return -1;
}

int Terms::add_quotient(int a, int b) {
  if (is_number(b, 1)) return a;
  return -1;
}

int Terms::add_negation(int a) {
  if (terms_[a].kind == Term::Kind::number) return number(-terms_[a].value);
  if (is(a, "negate")) return terms_[a].operands[0];
  if (is(a, "-")) return apply("-", {terms_[a].operands[1], terms_[a].operands[0]});
  for (const auto& [from, to] : {std::pair("min", "max"), std::pair("max", "min")}) {
    if (!is(a, from)) continue;
    const std::vector<int> in = terms_[a].operands;
    if (is(in[0], "negate") && is(in[1], "negate")) {
      return apply(to, {terms_[in[0]].operands[0], terms_[in[1]].operands[0]});
    }
  }
  return -1;
}

int Terms::apply(const std::string& function, std::vector<int> operands) {
  int simple = -1;
  if (operands.size() == 2 && function.size() == 1) {
    const Term &a = terms_[operands[0]], &b = terms_[operands[1]];
    if (a.kind == Term::Kind::number && b.kind == Term::Kind::number) {
      double folded = std::nan("");
      if (function == "+") folded = a.value + b.value;
      if (function == "-") folded = a.value - b.value;
      if (function == "*") folded = a.value * b.value;
      if (function == "/") folded = a.value / b.value;
      if (std::isfinite(folded)) return number(folded);
    }
    if (function == "+") simple = add_sum(operands[0], operands[1]);
    if (function == "-") simple = add_difference(operands[0], operands[1]);
    if (function == "*") simple = add_product(operands[0], operands[1]);
    if (function == "/") simple = add_quotient(operands[0], operands[1]);
  }
  if (function == "negate") simple = add_negation(operands[0]);
  if (simple >= 0) return simple;
  Term term;
  term.kind = Term::Kind::apply;
  term.function = function;
  term.operands = std::move(operands);
  return add(std::move(term));
}

namespace {

class TraceReader {
 public:
  TraceReader(Terms& terms, const Trace& trace, std::span<const int> inputs)
      : terms_(terms), trace_(trace), inputs_(inputs) {}

  int result() {
    const size_t n = trace_.steps().size();
    std::vector<bool> needed(n, false);
    needed[trace_.result] = true;
    for (size_t i = n; i-- > 0;) {
      if (!needed[i]) continue;
      for (int operand : trace_[int(i)].operands) {
        if (operand >= 0) needed[operand] = true;
      }
    }
    values_.resize(n, -1);
    masks_.resize(n);
    for (size_t i = 0; i < n; ++i) {
      if (needed[i]) read(int(i));
    }
    return values_[trace_.result];
  }

 private:
  void read(int i) {
    const TraceStep& step = trace_[i];
    const auto [a, b, c] = step.operands;
    switch (step.kind) {
      case TraceStep::Kind::input:
        values_[i] = inputs_[step.index];
        break;
      case TraceStep::Kind::number:
        values_[i] = terms_.number(step.value);
        break;
      case TraceStep::Kind::call:
        call(i, step);
        break;
      case TraceStep::Kind::select:
      case TraceStep::Kind::shortcut: {
        const Mask& mask = masks_[a];
        const bool lazy = step.kind == TraceStep::Kind::shortcut;
        const auto [first, second] = mask.negative ? std::pair(b, c) : std::pair(c, b);
        values_[i] = terms_.select(mask.term, values_[first], values_[second], lazy);
        break;
      }
    }
  }

  void call(int i, const TraceStep& step) {
    const int a = step.operands[0], b = step.operands[1];
    const std::string& name = step.name;
    if (name == "<") {
      masks_[i] = {terms_.apply("-", {values_[a], values_[b]}), true};
    } else if (name == "<=") {
      masks_[i] = {terms_.apply("-", {values_[b], values_[a]}), false};
    } else if (name == "not") {
      masks_[i] = {masks_[a].term, !masks_[a].negative};
    } else if (name == "and" || name == "or") {
      masks_[i] = join(name == "and", masks_[a], masks_[b]);
    } else {
      std::vector<int> operands{values_[a]};
      if (b >= 0) operands.push_back(values_[b]);
      // POV-Ray's log is the decimal logarithm.
      values_[i] = terms_.apply(name == "log" ? "ln" : name, std::move(operands));
    }
  }

  // Both negative where the larger one is; both not negative where the smaller one is not.
  Mask join(bool both, const Mask& a, const Mask& b) {
    if (a.negative == b.negative) {
      return {terms_.apply(both == a.negative ? "max" : "min", {a.term, b.term}), a.negative};
    }
    const int joined = terms_.apply(both ? "&" : "|", {truth(a), truth(b)});
    return {terms_.apply("-", {terms_.number(0.5), joined}), true};
  }

  int truth(const Mask& mask) {
    return terms_.apply(mask.negative ? "<" : ">=", {mask.term, terms_.number(0)});
  }

  Terms& terms_;
  const Trace& trace_;
  std::span<const int> inputs_;
  std::vector<int> values_;
  std::vector<Mask> masks_;
};

}  // namespace

int Terms::append(const Trace& trace, std::span<const int> inputs) {
  return TraceReader(*this, trace, inputs).result();
}

Terms Terms::without_branches() const {
  Terms out(*this);
  for (Term& term : out.terms_) {
    if (term.kind == Term::Kind::choose) term.kind = Term::Kind::apply;
  }
  out.known_.clear();
  return out;
}

int Terms::operations(int term, int limit) const {
  std::unordered_set<int> seen;
  std::vector<int> pending{term};
  while (!pending.empty() && int(seen.size()) < limit) {
    const int next = pending.back();
    pending.pop_back();
    if (terms_[next].is_leaf() || !seen.insert(next).second) continue;
    pending.insert(pending.end(), terms_[next].operands.begin(), terms_[next].operands.end());
  }
  return int(seen.size());
}

}  // namespace sardf::povray

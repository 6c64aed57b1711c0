#include "povray_gen/function_printer.hpp"

#include <algorithm>
#include <array>
#include <unordered_map>
#include <utility>

#include "sardf/error.hpp"

namespace sardf::povray {

namespace {

// POV-Ray's limit at run time is 1024; functions of the scene call ours.
constexpr int most_calls = 1000;
// Characters of a text that is not worth a function of its own.
constexpr size_t longest_in_place = 400;
constexpr const char* coordinate_names[] = {"x", "y", "z"};

// How tightly an operator binds; operands that bind less tightly stand in parentheses.
enum Precedence { logical, comparison, sum, product, sign, primary };

int precedence_of(const Term& term) {
  if (term.kind == Term::Kind::number) return term.value < 0 ? sign : primary;
  if (term.kind != Term::Kind::apply) return primary;
  const std::string& f = term.function;
  if (f == "&" || f == "|") return logical;
  if (f == "<" || f == ">=") return comparison;
  if (f == "+" || f == "-") return sum;
  if (f == "*" || f == "/") return product;
  return f == "negate" ? sign : primary;
}

bool is_infix(const Term& term) {
  const int precedence = precedence_of(term);
  return term.kind == Term::Kind::apply && precedence != primary && precedence != sign;
}

// Breaks a long text at spaces.
std::string wrapped(const std::string& text) {
  constexpr size_t width = 96;
  std::string out = "  ";
  size_t line_start = 0, last_space = std::string::npos;
  for (char c : text) {
    if (c == ' ') last_space = out.size();
    out += c;
    if (out.size() - line_start > width && last_space != std::string::npos) {
      out.replace(last_space, 1, "\n    ");
      line_start = last_space + 1;
      last_space = std::string::npos;
    }
  }
  return out;
}

}  // namespace

/// Prints one declared function and its helpers.
class FamilyPrinter {
 public:
  FamilyPrinter(FunctionPrinter& out, const std::string& name, const Terms& terms, LetPlan plan,
                InputNames input_names)
      : out_(out), name_(name), terms_(terms), plan_(std::move(plan)), input_names_(input_names) {}

  /// A function's parameters, its text and the depth of calls in it. The helpers that it needs are
  /// declared.
  struct Printed {
    std::string signature, body;
    int depth;
  };
  Printed print_all(int root, int inputs) {
    const Dominators& dominators = plan_.dominators();
    for (int term = 0; term <= root; ++term) {
      if (!dominators.is_reached(term)) continue;
      if (terms_[term].kind == Term::Kind::choose) {
        for (int branch : dominators.branches(term)) print_scope(branch);
      }
      print_scope(term);
    }
    start_function();
    for (int i = 0; i < inputs; ++i) name_of(i);
    std::string signature = signature_text();
    std::string body = print({Piece::Kind::text_of, root, logical, {}});
    return {std::move(signature), std::move(body), depth_};
  }

 private:
  // What is still to be printed, on a stack: graphs may be deep.
  struct Piece {
    enum class Kind {
      word,     // `text`
      use,      // the node where it is used: the name of a value, else its text
      text_of,  // the node's own text, which is a call where it is a scope
      body_of,  // the node's own text inside its scope
    };
    Kind kind;
    int node = -1;
    int precedence = logical;  // the least that needs no parentheses
    std::string text;
  };
  // The first function of a scope and the values that its parameters stand for.
  struct FirstCall {
    FunctionPrinter::Call call;
    std::vector<int> values;
  };

  // The last stage first, because a stage's parameters are what its text turns out to use.
  void print_scope(int node) {
    const int stages = plan_.scope(node).stages;
    FirstCall next;
    for (int stage = stages; stage >= 1; --stage) {
      start_function();
      const std::string body = stage == stages ? print({Piece::Kind::body_of, node, logical, {}})
                                               : print_call(next, node, stage);
      next.values = parameters();
      next.call = out_.helper(name_, signature_text(), body, depth_);
    }
    if (stages > 0) first_calls_[node] = std::move(next);
  }

  void start_function() {
    coordinates_ = {};
    values_.clear();
    depth_ = 0;
  }

  // The name of a value or an input in the function being printed, which gets it as a parameter.
  std::string name_of(int value) {
    const Term& term = terms_[value];
    if (term.kind == Term::Kind::input && input_names_ == InputNames::coordinates) {
      coordinates_[term.index] = true;
      return coordinate_names[term.index];
    }
    const auto at = std::find(values_.begin(), values_.end(), value);
    const int letter = int(at - values_.begin());
    if (at == values_.end()) values_.push_back(value);
    return out_.names_.parameter(letter);
  }

  // Coordinates first, then values in the order of their letters.
  std::vector<int> parameters() const {
    std::vector<int> out;
    for (int i = 0; i < 3; ++i) {
      if (coordinates_[i]) out.push_back(i);
    }
    out.insert(out.end(), values_.begin(), values_.end());
    return out;
  }

  std::string signature_text() {
    std::string out;
    for (int value : parameters()) out += (out.empty() ? "" : ", ") + name_of(value);
    return out;
  }

  std::string print(Piece first) {
    std::string out;
    print_pieces({std::move(first)}, out);
    return out;
  }

  std::string print_call(const FirstCall& next, int scope, int stage) {
    std::string out;
    print_pieces(call_pieces(next, scope, stage), out);
    return out;
  }

  void print_pieces(std::vector<Piece> pending, std::string& out) {
    while (!pending.empty()) {
      Piece piece = std::move(pending.back());
      pending.pop_back();
      if (piece.kind == Piece::Kind::word) {
        out += piece.text;
        continue;
      }
      for (auto& part : parts_of(piece)) pending.push_back(std::move(part));
    }
  }

  static Piece word(std::string text) { return {Piece::Kind::word, -1, 0, std::move(text)}; }

  // In the order of a stack: the last is printed first.
  std::vector<Piece> call_pieces(const FirstCall& next, int scope, int stage) {
    depth_ = std::max(depth_, next.call.depth);
    std::vector<Piece> out{word(")")};
    for (size_t i = next.values.size(); i-- > 0;) {
      const int value = next.values[i];
      const bool now =
          plan_.is_value(value) && plan_.owner(value) == scope && plan_.stage(value) == stage;
      out.push_back({now ? Piece::Kind::text_of : Piece::Kind::use, value, logical, {}});
      if (i > 0) out.push_back(word(", "));
    }
    out.push_back(word(next.call.name + "("));
    return out;
  }

  std::vector<Piece> parts_of(const Piece& piece) {
    const int node = piece.node;
    const bool branch = plan_.dominators().is_branch(node);
    if (piece.kind == Piece::Kind::use && !branch) {
      if (plan_.is_value(node) || terms_[node].kind == Term::Kind::input)
        return {word(name_of(node))};
    }
    if (piece.kind != Piece::Kind::body_of && plan_.scope(node).stages > 0) {
      return call_pieces(first_calls_.at(node), node, 0);
    }
    if (branch) return {{Piece::Kind::use, plan_.dominators().term_of(node), piece.precedence, {}}};
    const Term& term = terms_[node];
    if (term.kind == Term::Kind::input) return {word(name_of(node))};
    std::vector<Piece> out = term_pieces(node, term);
    if (precedence_of(term) < piece.precedence) {
      out.insert(out.begin(), word(")"));
      out.push_back(word("("));
    }
    return out;
  }

  std::vector<Piece> term_pieces(int node, const Term& term) {
    using Kind = Piece::Kind;
    if (term.kind == Term::Kind::number) return {word(number_text(term.value))};
    const std::vector<int>& in = term.operands;
    const int own = precedence_of(term);
    if (is_infix(term)) {
      // Comparisons do not chain, and sums are evaluated in our order: (a + b) + c.
      const int left = own <= comparison ? own + 1 : own;
      return {{Kind::use, in[1], own + 1, {}},
              word(" " + term.function + " "),
              {Kind::use, in[0], left, {}}};
    }
    if (own == sign) return {{Kind::use, in[0], primary, {}}, word("-")};
    std::vector<int> nodes = in;
    if (term.kind == Term::Kind::choose) {
      const auto branches = plan_.dominators().branches(node);
      std::copy(branches.begin(), branches.end(), nodes.begin() + 1);
    }
    if (const auto known = out_.depth_.find(term.function); known != out_.depth_.end()) {
      depth_ = std::max(depth_, known->second);
    }
    std::vector<Piece> out{word(")")};
    for (size_t i = nodes.size(); i-- > 0;) {
      out.push_back({Kind::use, nodes[i], logical, {}});
      if (i > 0) out.push_back(word(", "));
    }
    out.push_back(word(term.function + "("));
    return out;
  }

  FunctionPrinter& out_;
  std::string name_;
  const Terms& terms_;
  LetPlan plan_;
  InputNames input_names_;
  std::unordered_map<int, FirstCall> first_calls_;  // by scope

  // Of the function being printed:
  std::array<bool, 3> coordinates_{};  // whether it uses x, y, z
  std::vector<int> values_;            // its other parameters
  int depth_ = 0;                      // of the calls in it
};

std::pair<const Terms*, LetPlan> FunctionPrinter::first_plan(std::span<const Attempt> attempts,
                                                             int root) {
  for (const auto& [terms, simple] : attempts.first(attempts.size() - 1)) {
    try {
      return {terms, LetPlan(*terms, root, simple)};
    } catch (const Error&) {
      continue;
    }
  }
  const auto& [terms, simple] = attempts.back();
  return {terms, LetPlan(*terms, root, simple)};
}

void FunctionPrinter::declare(const std::string& name, const Terms& terms, int root, int inputs,
                              InputNames input_names) {
  // A costly branch may need very many values that could be used up on the way to it.
  const Terms eager = terms.without_branches();
  const Attempt attempts[] = {{&terms, LetPlan::Simple::bind},
                              {&eager, LetPlan::Simple::bind},
                              {&eager, LetPlan::Simple::repeat}};
  auto [planned, plan] = first_plan(attempts, root);
  FamilyPrinter printer(*this, name, *planned, std::move(plan), input_names);
  const FamilyPrinter::Printed printed = printer.print_all(root, inputs);
  add(name, printed.signature, printed.body, printed.depth);
}

std::string FunctionPrinter::quick(const std::string& base, const Terms& terms, int root) {
  const Terms eager = terms.without_branches();
  const Attempt attempts[] = {{&terms, LetPlan::Simple::repeat}, {&eager, LetPlan::Simple::repeat}};
  auto [planned, plan] = first_plan(attempts, root);
  FamilyPrinter printer(*this, base, *planned, std::move(plan), InputNames::coordinates);
  const FamilyPrinter::Printed printed = printer.print_all(root, 3);
  if (printed.body.size() <= longest_in_place) return printed.body;
  const Call declared = helper(base, printed.signature, printed.body, printed.depth);
  return declared.name + "(" + printed.signature + ")";
}

FunctionPrinter::Call FunctionPrinter::helper(const std::string& base, const std::string& signature,
                                              const std::string& body, int depth) {
  std::string& name = known_[signature + "|" + body];
  if (name.empty()) {
    // What POV-Ray's language lacks most: it is nearly everywhere.
    const bool square = body == signature + " * " + signature;
    name = square ? names_.unique("square") : names_.numbered(base);
    add(name, signature, body, depth);
  }
  return {name, depth_.at(name)};
}

void FunctionPrinter::add(const std::string& name, const std::string& signature,
                          const std::string& body, int depth) {
  if (depth + 1 > most_calls) {
    throw Error("the formula of " + name + " needs " + std::to_string(depth + 1) +
                " calls inside each other; POV-Ray evaluates about 1000");
  }
  depth_[name] = depth + 1;
  if (const auto comment = comments_.find(name); comment != comments_.end()) {
    text_ += comment->second;
  }
  text_ += "#declare " + name + " = function(" + signature + ") {\n" + wrapped(body) + "\n}\n";
}

}  // namespace sardf::povray

#include "sardf/formula_functions.hpp"

#include <cmath>
#include <optional>

#include "sardf/arithmetic.hpp"
#include "sardf/constructor.hpp"
#include "sardf/derivative.hpp"
#include "sardf/error.hpp"
#include "sardf/formula.hpp"

namespace sardf {

namespace {

bool is_call_of(const Expression& e, const char* name) {
  return e->type == Node::Type::operation && e->operation->info().name == name;
}

bool is_positive(const Expression& e) { return is_constant(e) && e->value > 0; }

// r with r² = e, where e is a square, a constant >= 0, or a square times or over a constant.
std::optional<Expression> root_of_square(const Expression& e) {
  if (is_constant(e) && e->value >= 0) return constant(std::sqrt(e->value));
  if (is_call_of(e, "square")) return e->inputs[0];
  const bool product = is_call_of(e, "multiply"), quotient = is_call_of(e, "divide");
  if (!product && !quotient) return std::nullopt;
  const Expression &a = e->inputs[0], &b = e->inputs[1];
  if (is_call_of(a, "square") && is_positive(b)) {
    const Expression factor = constant(std::sqrt(b->value));
    return product ? a->inputs[0] * factor : a->inputs[0] / factor;
  }
  if (product && is_positive(a) && is_call_of(b, "square")) {
    return constant(std::sqrt(a->value)) * b->inputs[0];
  }
  return std::nullopt;
}

// The roots of the terms of a sum, or nothing when one term is no square.
std::vector<Expression> roots_of_terms(const Expression& sum) {
  std::vector<Expression> pending{sum}, roots;
  while (!pending.empty()) {
    const Expression term = pending.back();
    pending.pop_back();
    if (is_call_of(term, "add")) {
      pending.push_back(term->inputs[1]);
      pending.push_back(term->inputs[0]);
    } else if (const auto root = root_of_square(term)) {
      roots.push_back(*root);
    } else {
      return {};
    }
  }
  return roots;
}

Expression length_of(std::span<const Expression> v) {
  return v.size() == 2 ? length(v[0], v[1]) : function("length3", {v[0], v[1], v[2]});
}

// min, max, length and sqrt mean more than one operation, at and dx act on what their first
// argument is made of; the rest is one operation each.
struct Special {
  const char* name;
  size_t fewest, most;  // 0: no limit
};
constexpr Special specials[] = {{"min", 2, 0}, {"max", 2, 0}, {"length", 2, 3}, {"at", 4, 4},
                                {"dx", 1, 1},  {"dy", 1, 1},  {"dz", 1, 1}};

const Special* find_special(const std::string& name) {
  for (const Special& special : specials) {
    if (name == special.name) return &special;
  }
  return nullptr;
}

}  // namespace

Expression square_root(const Expression& a) {
  std::vector<Expression> roots = roots_of_terms(a);
  if (roots.empty()) return function("sqrt", {a});
  if (roots.size() == 1) return is_constant(roots[0]) ? roots[0] : abs(roots[0]);
  Expression whole = length_of(std::span(roots).first(roots.size() == 2 ? 2 : 3));
  for (size_t i = 3; i < roots.size(); ++i) whole = length(whole, roots[i]);
  return whole;
}

Expression apply_operator(const std::string& symbol, const Expression& a, const Expression& b) {
  switch (symbol[0]) {
    case '+':
      return a + b;
    case '-':
      return a - b;
    case '*':
      return a * b;
    case '/':
      return a / b;
    case '^':
      return pow(a, b);
    case '<':
      return symbol == "<" ? less(a, b) : less_equal(a, b);
    case '>':
      return symbol == ">" ? less(b, a) : less_equal(b, a);
    default:
      return symbol == "==" ? function("equal", {a, b}) : constant(1) - function("equal", {a, b});
  }
}

bool is_function(const std::string& name) { return find_special(name) || find_function(name); }

std::vector<std::string> all_functions() {
  std::vector<std::string> names{"length", "at", "dx", "dy", "dz"};
  for (const std::string& name : function_names()) {
    if (name != "length2" && name != "length3") names.push_back(name);
  }
  return names;
}

std::string arguments_message(const std::string& name, size_t count) {
  size_t fewest = 0, most = 0;
  if (const Special* special = find_special(name)) {
    fewest = special->fewest;
    most = special->most;
  } else {
    fewest = most = size_t(find_function(name)->info().arity);
  }
  if (count >= fewest && (most == 0 || count <= most)) return "";
  std::string accepted = std::to_string(fewest);
  if (most == 0) accepted += " or more";
  if (most > fewest) accepted += " or " + std::to_string(most);
  return "the function '" + name + "' takes " + accepted +
         (accepted == "1" ? " argument, " : " arguments, ") + std::to_string(count) +
         (count == 1 ? " is given" : " are given");
}

Expression apply_function(const std::string& name, std::span<const Expression> arguments) {
  if (!is_function(name)) {
    throw Error("there is no function '" + name + "'" + did_you_mean(name, all_functions()));
  }
  const std::string problem = arguments_message(name, arguments.size());
  if (!problem.empty()) throw Error(problem);
  if (name == "sqrt") return square_root(arguments[0]);
  if (name == "pow") return pow(arguments[0], arguments[1]);
  if (name == "multiply") return arguments[0] * arguments[1];
  if (name == "length") return length_of(arguments);
  if (name == "at") return substitute(arguments[0], {arguments[1], arguments[2], arguments[3]});
  if (name == "dx" || name == "dy" || name == "dz") return derivative(arguments[0], name[1] - 'x');
  const OperationPointer operation = find_function(name);
  if (!find_special(name)) return call(operation, arguments);
  Expression result = arguments[0];
  for (size_t i = 1; i < arguments.size(); ++i) result = call(operation, {result, arguments[i]});
  return result;
}

}  // namespace sardf

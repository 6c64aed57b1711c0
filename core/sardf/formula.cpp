#include "sardf/formula.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <set>

#include "sardf/arithmetic.hpp"
#include "sardf/constructor.hpp"
#include "sardf/error.hpp"
#include "sardf/formula_functions.hpp"
#include "sardf/formula_lexer.hpp"

namespace sardf {

namespace {

using Type = FormulaToken::Type;

// What a name means where a formula is parsed.
struct Scope {
  const std::map<std::string, Field>* fields = nullptr;
  const std::map<std::string, double>* parameters = nullptr;
};

// Precedence parsing with stacks of its own, so that no nesting overflows the call stack.
class Parser {
 public:
  Parser(const std::string& text, Scope scope)
      : text_(text), scope_(scope), tokens_(formula_tokens(text)) {}

  Expression parse() {
    for (; tokens_[next_].type != Type::end; ++next_) {
      const FormulaToken& token = tokens_[next_];
      if (token.type == Type::invalid) fail(token, invalid_message(token));
      if (operand_expected_) {
        read_operand(token);
      } else {
        read_operator(token);
      }
    }
    if (operand_expected_) fail(tokens_[next_], expected(tokens_[next_]));
    reduce(0);
    if (!pending_.empty()) fail(pending_.back().token, unclosed(pending_.back()));
    return values_.back();
  }

  std::map<std::string, Field> used;

 private:
  // An operator that waits for its right side, an open parenthesis, or an open function call.
  struct Pending {
    enum class Type { binary, negate, parenthesis, call };
    Type type;
    FormulaToken token;
    int precedence = 0;
    size_t arguments = 0;  // of a call: those complete
  };

  [[noreturn]] void fail(const FormulaToken& token, const std::string& message) const {
    throw Error(at_character(text_, token.begin) + ": " + message);
  }

  static std::string unclosed(const Pending& open) {
    if (open.type != Pending::Type::call) return "this '(' is never closed";
    return "the '(' of '" + open.token.text + "(' is never closed";
  }

  static std::string invalid_message(const FormulaToken& token) {
    if (token.text[0] == '.' || ('0' <= token.text[0] && token.text[0] <= '9')) {
      return "'" + token.text + "' is not a number that can be represented; write products with *";
    }
    if (token.text == "=") return "'=' alone has no meaning; == compares";
    return "'" + token.text + "' has no meaning in a formula";
  }

  static std::string expected(const FormulaToken& token) {
    const std::string found =
        token.type == Type::end ? "the formula ends" : "'" + token.text + "' stands";
    return found + " where a number, a name, a function, '-' or '(' is expected";
  }

  static int precedence(const std::string& symbol) {
    if (symbol == "^") return 5;
    if (symbol == "*" || symbol == "/") return 3;
    if (symbol == "+" || symbol == "-") return 2;
    return symbol == "(" || symbol == ")" || symbol == "," ? 0 : 1;
  }
  static constexpr int of_negation = 4;

  void read_operand(const FormulaToken& token) {
    const FormulaToken& after = tokens_[std::min(next_ + 1, tokens_.size() - 1)];
    if (token.type == Type::number) {
      values_.push_back(constant(token.value));
      operand_expected_ = false;
    } else if (token.type == Type::name && after.text == "(") {
      check_function(token);
      pending_.push_back({Pending::Type::call, token, 0, 0});
      ++next_;
      if (tokens_[next_ + 1].text == ")") fail(token, arguments_message(token.text, 0));
    } else if (token.type == Type::name) {
      values_.push_back(meaning(token));
      operand_expected_ = false;
    } else if (token.text == "-") {
      pending_.push_back({Pending::Type::negate, token, of_negation, 0});
    } else if (token.text == "(") {
      pending_.push_back({Pending::Type::parenthesis, token, 0, 0});
    } else {
      fail(token, expected(token));
    }
  }

  void read_operator(const FormulaToken& token) {
    if (token.text == ")") {
      close(token);
    } else if (token.text == ",") {
      reduce(0);
      if (pending_.empty() || pending_.back().type != Pending::Type::call) {
        fail(token, "',' stands outside of a function's arguments");
      }
      ++pending_.back().arguments;
      operand_expected_ = true;
    } else if (const int level = token.type == Type::symbol ? precedence(token.text) : 0) {
      reduce(level + (token.text == "^"));
      if (level == 1 && !pending_.empty() && pending_.back().precedence == 1) {
        fail(token, "comparisons cannot follow each other; put one in parentheses");
      }
      pending_.push_back({Pending::Type::binary, token, level, 0});
      operand_expected_ = true;
    } else {
      fail(token, "'" + token.text + "' stands where an operator or the end is expected" +
                      (token.text == "(" ? "; write products with *" : ""));
    }
  }

  // Applies what waits and binds at least as tightly as `level`; comparisons never wait for one.
  void reduce(int level) {
    while (!pending_.empty() && pending_.back().precedence >= std::max(level, 1)) {
      const Pending last = pending_.back();
      if (last.precedence == 1 && level == 1) return;
      pending_.pop_back();
      const Expression b = values_.back();
      values_.pop_back();
      if (last.type == Pending::Type::negate) {
        values_.push_back(-b);
      } else {
        values_.back() = apply_operator(last.token.text, values_.back(), b);
      }
    }
  }

  void close(const FormulaToken& token) {
    reduce(0);
    if (pending_.empty()) fail(token, "this ')' has no '('");
    const Pending opened = pending_.back();
    pending_.pop_back();
    if (opened.type == Pending::Type::parenthesis) return;
    const size_t count = opened.arguments + 1;
    const std::string problem = arguments_message(opened.token.text, count);
    if (!problem.empty()) fail(opened.token, problem);
    const std::vector<Expression> arguments(values_.end() - std::ptrdiff_t(count), values_.end());
    values_.resize(values_.size() - count);
    try {
      values_.push_back(apply_function(opened.token.text, arguments));
    } catch (const Error& error) {
      fail(opened.token, error.message);
    }
  }

  void check_function(const FormulaToken& token) const {
    const std::string& name = token.text;
    if (is_function(name)) return;
    if (is_known(name)) fail(token, "'" + name + "' is no function; write products with *");
    fail(token, "there is no function '" + name + "'" + did_you_mean(name, all_functions()));
  }

  bool is_known(const std::string& name) const {
    return name == "x" || name == "y" || name == "z" || name == "pi" ||
           (scope_.fields && scope_.fields->count(name)) ||
           (scope_.parameters && scope_.parameters->count(name));
  }

  Expression meaning(const FormulaToken& token) {
    const std::string& name = token.text;
    if (name == "pi") return constant(std::numbers::pi);
    if (name.size() == 1 && 'x' <= name[0] && name[0] <= 'z') {
      if (!scope_.fields) fail(token, "'" + name + "' stands in a formula that must be a number");
      return coordinate(name[0] - 'x');
    }
    if (scope_.fields) {
      const auto field = scope_.fields->find(name);
      if (field != scope_.fields->end()) {
        used.emplace(name, field->second);
        return field->second.expression();
      }
    }
    if (scope_.parameters) {
      const auto parameter = scope_.parameters->find(name);
      if (parameter != scope_.parameters->end()) {
        if (scope_.fields) used.emplace(name, Field::number(parameter->second));
        return constant(parameter->second);
      }
    }
    fail(token, unknown_message(name));
  }

  std::string unknown_message(const std::string& name) const {
    if (is_function(name)) return "the function '" + name + "' needs arguments in parentheses";
    std::vector<std::string> accepted{"pi"};
    if (scope_.fields) {
      accepted.insert(accepted.end(), {"x", "y", "z"});
      for (const auto& [known, field] : *scope_.fields) accepted.push_back(known);
    }
    if (scope_.parameters) {
      for (const auto& [known, value] : *scope_.parameters) accepted.push_back(known);
    }
    return "there is no " + std::string(scope_.fields ? "field or parameter" : "parameter") + " '" +
           name + "'" + did_you_mean(name, accepted);
  }

  const std::string& text_;
  Scope scope_;
  std::vector<FormulaToken> tokens_;
  size_t next_ = 0;
  bool operand_expected_ = true;
  std::vector<Pending> pending_;
  std::vector<Expression> values_;
};

}  // namespace

Field parse_formula(const std::string& text, const std::map<std::string, Field>& names,
                    const std::map<std::string, double>& parameters) {
  Parser parser(text, {&names, &parameters});
  Expression value = parser.parse();
  return formula_field(std::move(value), text, std::move(parser.used));
}

double parse_number(const std::string& text, const std::map<std::string, double>& parameters) {
  const Expression value = Parser(text, {nullptr, &parameters}).parse();
  if (!std::isfinite(value->value)) {
    throw Error("the formula '" + text + "' has no finite value");
  }
  return value->value;
}

std::vector<std::string> names_in_formula(const std::string& text) {
  const std::vector<FormulaToken> tokens = formula_tokens(text);
  std::set<std::string> names;
  for (size_t i = 0; i < tokens.size(); ++i) {
    if (tokens[i].type != Type::name || !is_name(tokens[i].text)) continue;
    const bool called = i + 1 < tokens.size() && tokens[i + 1].text == "(";
    if (!called) names.insert(tokens[i].text);
  }
  return {names.begin(), names.end()};
}

std::string rename_in_formula(const std::string& text,
                              const std::map<std::string, std::string>& new_names) {
  const std::vector<FormulaToken> tokens = formula_tokens(text);
  std::string renamed;
  size_t copied = 0;
  for (size_t i = 0; i + 1 < tokens.size(); ++i) {
    const auto found = new_names.find(tokens[i].text);
    if (found == new_names.end() || tokens[i + 1].text == "(") continue;
    renamed += text.substr(copied, tokens[i].begin - copied) + found->second;
    copied = tokens[i].begin + tokens[i].text.size();
  }
  return renamed + text.substr(copied);
}

bool is_name(const std::string& word) {
  const auto letter = [](char c) {
    return ('a' <= c && c <= 'z') || ('A' <= c && c <= 'Z') || c == '_';
  };
  const auto digit = [](char c) { return '0' <= c && c <= '9'; };
  return !word.empty() && letter(word[0]) &&
         std::all_of(word.begin(), word.end(), [&](char c) { return letter(c) || digit(c); }) &&
         word != "x" && word != "y" && word != "z" && word != "pi";
}

}  // namespace sardf

#include "povray_gen/linear_terms.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace sardf::povray {

namespace {

/// a x + b y + c z + d, and how many operators it takes as it is written.
struct Linear {
  std::array<double, 4> row{};
  int operators = 0;

  bool is_number() const { return row[0] == 0 && row[1] == 0 && row[2] == 0; }
};

Linear sum(const Linear& a, const Linear& b, double sign) {
  Linear out;
  for (size_t k = 0; k < 4; ++k) out.row[k] = a.row[k] + sign * b.row[k];
  out.operators = a.operators + b.operators + 1;
  return out;
}

Linear product(const Linear& a, double factor, int operators) {
  Linear out;
  for (size_t k = 0; k < 4; ++k) out.row[k] = a.row[k] * factor;
  out.operators = operators + 1;
  return out;
}

std::optional<Linear> applied(const Term& term, const std::vector<std::optional<Linear>>& known) {
  if (!term.is_operator()) return {};
  for (int operand : term.operands) {
    if (!known[size_t(operand)]) return {};
  }
  const Linear& a = *known[size_t(term.operands[0])];
  if (term.function == "negate") return product(a, -1, a.operators);
  const Linear& b = *known[size_t(term.operands[1])];
  const int operators = a.operators + b.operators;
  if (term.function == "+") return sum(a, b, 1);
  if (term.function == "-") return sum(a, b, -1);
  if (term.function == "*" && a.is_number()) return product(b, a.row[3], operators);
  if (term.function == "*" && b.is_number()) return product(a, b.row[3], operators);
  if (term.function == "/" && b.is_number() && b.row[3] != 0) {
    return product(a, 1 / b.row[3], operators);
  }
  return {};
}

bool is_finite(const Linear& linear) {
  double total = 0;
  for (double a : linear.row) total += std::abs(a);
  return std::isfinite(total);
}

// A positive part first: 3 - x instead of -x + 3.
int written(Terms& to, const Linear& linear) {
  std::vector<std::pair<double, int>> parts;
  for (int k = 0; k < 4; ++k) {
    if (linear.row[size_t(k)] == 0) continue;
    const double size = std::abs(linear.row[size_t(k)]);
    parts.push_back({linear.row[size_t(k)],
                     k == 3 ? to.number(size) : to.apply("*", {to.number(size), to.input(k)})});
  }
  if (parts.empty()) return to.number(0);
  for (size_t k = 0; k < parts.size() && parts[0].first < 0; ++k) {
    if (parts[k].first > 0) std::swap(parts[0], parts[k]);
  }
  int out = parts[0].first < 0 ? to.apply("negate", {parts[0].second}) : parts[0].second;
  for (size_t k = 1; k < parts.size(); ++k) {
    out = to.apply(parts[k].first < 0 ? "-" : "+", {out, parts[k].second});
  }
  return out;
}

int operators_of(const Linear& linear) {
  int out = -1;
  bool has_positive = false;
  for (size_t k = 0; k < 4; ++k) {
    const double a = linear.row[k];
    if (a == 0) continue;
    out += 1 + (k < 3 && std::abs(a) != 1);
    has_positive = has_positive || a > 0;
  }
  return out + !has_positive;
}

}  // namespace

std::pair<Terms, int> with_short_linear_terms(const Terms& terms, int root) {
  Terms out;
  for (int axis = 0; axis < 3; ++axis) out.input(axis);
  std::vector<std::optional<Linear>> linear(size_t(root) + 1);
  std::vector<int> made(size_t(root) + 1);
  for (int i = 0; i <= root; ++i) {
    const Term& term = terms[i];
    std::optional<Linear>& own = linear[size_t(i)];
    std::vector<int> operands;
    for (int operand : term.operands) operands.push_back(made[size_t(operand)]);
    if (term.kind == Term::Kind::input) {
      made[size_t(i)] = out.input(term.index);
      if (term.index < 3) own.emplace().row[size_t(term.index)] = 1;
    } else if (term.kind == Term::Kind::number) {
      made[size_t(i)] = out.number(term.value);
      own.emplace().row[3] = term.value;
    } else if (term.kind == Term::Kind::choose) {
      made[size_t(i)] = out.select(operands[0], operands[1], operands[2], true);
    } else {
      own = applied(term, linear);
      if (own && !is_finite(*own)) own.reset();
      const bool is_shorter = own && operators_of(*own) < own->operators;
      made[size_t(i)] = is_shorter ? written(out, *own) : out.apply(term.function, operands);
    }
  }
  return {std::move(out), made[size_t(root)]};
}

}  // namespace sardf::povray

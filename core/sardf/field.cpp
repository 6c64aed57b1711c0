#include "sardf/field.hpp"

#include <filesystem>

#include "sardf/arithmetic.hpp"
#include "sardf/number_text.hpp"

namespace sardf {

namespace {

// The operand of a formula: its own text in parentheses when it is a formula whose names mean the
// same in `names`, else a name for it.
std::string operand(const Field& field, std::map<std::string, Field>& names) {
  const Construction* made = field.construction();
  if (made && !made->constructor) {
    bool agrees = true;
    for (const auto& [name, named] : made->names) {
      const auto known = names.find(name);
      agrees =
          agrees && (known == names.end() || known->second.construction() == named.construction());
    }
    if (agrees && made->formula.size() < 200) {
      names.insert(made->names.begin(), made->names.end());
      return "(" + made->formula + ")";
    }
  }
  for (const auto& [name, named] : names) {
    if (named.construction() == made) return name;
  }
  std::string name;
  for (int i = 1; name.empty() || names.count(name); ++i) name = "field_" + std::to_string(i);
  names[name] = field;
  return name;
}

}  // namespace

std::string FilePath::full() const { return std::filesystem::path(folder) / text; }

Field::Field(Expression value, Quality how_exact, std::shared_ptr<const Construction> how_made)
    : expression_(std::move(value)), quality_(how_exact), construction_(std::move(how_made)) {}

Field Field::number(double value) { return formula_field(constant(value), number_text(value), {}); }

Field Field::coordinate(int axis) {
  return formula_field(sardf::coordinate(axis), std::string(1, char('x' + axis)), {});
}

Construction::~Construction() {
  thread_local std::vector<Value>* queue = nullptr;
  const auto take = [this](std::vector<Value>& to) {
    for (Value& value : arguments) to.push_back(std::move(value));
    for (auto& [name, field] : names) to.push_back(std::move(field));
    arguments.clear();
    names.clear();
  };
  if (queue) {
    take(*queue);
    return;
  }
  std::vector<Value> pending;
  queue = &pending;
  take(pending);
  while (!pending.empty()) {
    // Dropping a value may end a construction, whose destructor adds to the queue.
    const Value last = std::move(pending.back());
    pending.pop_back();
  }
  queue = nullptr;
}

Field formula_field(Expression expression, std::string text, std::map<std::string, Field> names) {
  auto made = std::make_shared<Construction>();
  made->formula = std::move(text);
  made->names = std::move(names);
  return Field(std::move(expression), {}, std::move(made));
}

Field combine(const Field& a, char symbol, const Field& b) {
  const Expression &x = a.expression(), &y = b.expression();
  const Expression value = symbol == '+'   ? x + y
                           : symbol == '-' ? x - y
                           : symbol == '*' ? x * y
                           : symbol == '/' ? x / y
                                           : pow(x, y);
  std::map<std::string, Field> names;
  const std::string left = operand(a, names), right = operand(b, names);
  return formula_field(value, left + " " + symbol + " " + right, std::move(names));
}

Field negate(const Field& a) {
  std::map<std::string, Field> names;
  const std::string text = operand(a, names);
  return formula_field(-a.expression(), "-" + text, std::move(names));
}

}  // namespace sardf

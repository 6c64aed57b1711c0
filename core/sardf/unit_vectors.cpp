#include "sardf/unit_vectors.hpp"

#include "sardf/arithmetic.hpp"

namespace sardf {

namespace {

// Of the largest prescribed component: what is smaller has cancelled out.
constexpr double vanishing = 1e-12;
// Still a normal number in float.
constexpr double least = 1e-37;

void collect(const Fractions& rule, std::vector<Expression>& values);

void collect(const std::vector<RuleParameter>& parameters, const std::vector<RuleValue>& arguments,
             std::vector<Expression>& values) {
  for (size_t i = 0; i < parameters.size(); ++i) {
    const RuleValue& argument = arguments.at(i);
    if (const auto* part = std::get_if<Fractions>(&argument)) collect(*part, values);
    if (const auto* components = std::get_if<std::vector<Field>>(&argument)) {
      for (const Field& f : *components) values.push_back(f.expression());
    }
    if (const auto* named = std::get_if<MaterialFunctions>(&argument)) {
      for (const auto& [name, f] : *named) values.push_back(f.expression());
    }
    if (const auto* records = std::get_if<std::vector<Record>>(&argument)) {
      for (const Record& record : *records) collect(parameters[i].record, record.values, values);
    }
  }
}

void collect(const Fractions& rule, std::vector<Expression>& values) {
  collect(rule.rule().type->parameters, rule.rule().arguments, values);
}

Expression largest_magnitude(const std::vector<Expression>& values) {
  Expression largest = abs(values.at(0));
  for (size_t i = 1; i < values.size(); ++i) largest = max(largest, abs(values[i]));
  return largest;
}

}  // namespace

Expression largest_prescribed(const Fractions& rule) {
  std::vector<Expression> values;
  collect(rule, values);
  return largest_magnitude(values);
}

std::vector<Expression> unit_vector(const std::vector<Expression>& vector,
                                    const Expression& prescribed, const Vec3& fallback) {
  const Expression size = largest_magnitude(vector);
  const Expression threshold = max(constant(vanishing) * prescribed, constant(least));
  const Expression vanishes = less_equal(size, threshold), divisor = max(size, constant(least));
  // Of components up to 1 the squares neither overflow nor vanish.
  std::vector<Expression> scaled;
  for (const Expression& component : vector) scaled.push_back(component / divisor);
  const Expression length = function("length3", {scaled[0], scaled[1], scaled[2]});
  const Vec3 instead = normalized(fallback);
  std::vector<Expression> out;
  for (size_t i = 0; i < 3; ++i) {
    out.push_back(select(vanishes, constant(instead[i]), scaled[i] / max(length, constant(0.5))));
  }
  return out;
}

}  // namespace sardf

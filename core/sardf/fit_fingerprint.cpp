// What tells the problems of fits apart, the same in every process and on every machine.
#include <bit>
#include <cmath>
#include <cstdio>
#include <unordered_map>

#include "sardf/fit.hpp"

namespace sardf {

namespace {

// Of a mantissa. Folded constants (the sine of an angle) may differ in their last bits with the
// mathematical library. Short numbers lie in the middle of what is rounded to them.
constexpr double kept = 0x1p40;

uint64_t bits_of(double value) {
  if (value == 0) return 0;  // of either sign
  if (!std::isfinite(value) || value == std::trunc(value)) return std::bit_cast<uint64_t>(value);
  int exponent = 0;
  const double mantissa = std::frexp(value, &exponent);
  return std::bit_cast<uint64_t>(std::ldexp(std::nearbyint(mantissa * kept) / kept, exponent));
}

class Digest {
 public:
  void add(uint64_t word) {
    // The finaliser of splitmix64, over what came before and the word.
    uint64_t a = std::rotl(value_, 23) + word + 0x9E3779B97F4A7C15ull;
    a = (a ^ (a >> 30)) * 0xBF58476D1CE4E5B9ull;
    a = (a ^ (a >> 27)) * 0x94D049BB133111EBull;
    value_ = a ^ (a >> 31);
  }
  void add_number(double value) { add(bits_of(value)); }
  void add_number(const std::optional<double>& value) {
    add(value.has_value());
    if (value) add_number(*value);
  }
  void add(const std::string& text) {
    add(text.size());
    for (const char c : text) add(static_cast<unsigned char>(c));
  }
  uint64_t value() const { return value_; }

 private:
  uint64_t value_ = 0;
};

using Digests = std::unordered_map<const Node*, uint64_t>;

uint64_t digest_of(const Node& node, const Digests& inputs) {
  Digest digest;
  digest.add(uint64_t(node.type));
  digest.add(node.axis);
  digest.add_number(node.value);
  if (!node.operation) return digest.value();
  digest.add(node.operation->info().name);
  for (const double number : node.operation->numbers()) digest.add_number(number);
  for (const Expression& input : node.arguments()) digest.add(inputs.at(input.get()));
  return digest.value();
}

}  // namespace

std::string fingerprint_of(const FitProblem& p) {
  const Expression all[] = {p.start, p.factor, p.solid, p.values, p.slope, p.along};
  std::vector<Expression> given;
  for (const Expression& e : all) {
    if (e) given.push_back(e);
  }
  Digests digests;
  for (const Node* node : topological_order(given)) digests[node] = digest_of(*node, digests);
  Digest digest;
  for (const Expression& e : all) digest.add(e ? digests.at(e.get()) : 0);
  for (size_t k = 0; k < size_t(p.grid.dimensions); ++k) {
    digest.add_number(p.grid.lower[k]);
    digest.add_number(p.grid.upper[k]);
    digest.add(uint64_t(p.grid.counts[k]));
    digest.add(uint64_t(p.grid.degrees[k]));
  }
  for (const double weight : {p.values_weight, p.slope_weight, p.smoothness}) {
    digest.add_number(weight);
  }
  digest.add(uint64_t(p.points));
  for (const std::optional<double>& value : {p.mean, p.at_least, p.at_most}) {
    digest.add_number(value);
  }
  char text[20];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(digest.value()));
  return text;
}

}  // namespace sardf

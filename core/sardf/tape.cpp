#include "sardf/tape.hpp"

#include <algorithm>
#include <atomic>
#include <map>
#include <tuple>
#include <unordered_map>

#include "sardf/operation_of.hpp"

namespace sardf {

namespace {

// Constants that have a register of their own.
constexpr size_t most_constants = 256;

/// A number as an operation.
struct Number {
  static constexpr const char *name = "number", *doc = "a number";
  static constexpr Kind kind = Kind::internal;
  static constexpr int arity = 0;
  double value = 0;
  template <class V>
  static void parameters(V& v) {
    v(Parameter{"value", "the number"}, &Number::value);
  }
  template <class T>
  T eval() const {
    return T(value);
  }
};

struct Source {
  std::vector<Expression> expressions;
  std::vector<OperationPointer> numbers;
};

class CodeOf {
 public:
  explicit CodeOf(std::span<const Expression> outputs)
      : order_(topological_order(outputs)), source_(std::make_shared<Source>()) {
    source_->expressions.assign(outputs.begin(), outputs.end());
    value_.reserve(order_.size());
    place_constants();
    find_families();
    for (const Node* node : order_) {
      if (node->type != Node::Type::operation) continue;
      if (!node->operation->kernels().together) {
        append(node);
      } else if (!value_.contains(node)) {
        // Those that are evaluated together stand together.
        for (const Node* member : families_.at(family_of(*node))) append(member);
      }
    }
    for (const Expression& output : outputs) code_.outputs.push_back(value_of(output.get()));
    code_.source = source_;
  }

  const Code& code() const { return code_; }

 private:
  void place_constants() {
    for (const Node* node : order_) {
      if (node->type == Node::Type::coordinate) {
        value_[node] = node->axis;
      } else if (node->type == Node::Type::constant && code_.constants.size() < most_constants) {
        value_[node] = uint32_t(3 + code_.constants.size());
        code_.constants.push_back(node->value);
      }
    }
  }

  // What nodes that can be evaluated together have in common: their kernel, their inputs and, where
  // they are parts of one formula, their parameters.
  using Family =
      std::tuple<const Together*, std::array<const Node*, max_arity>, std::vector<double>>;

  static Family family_of(const Node& node) {
    const Kernels& kernels = node.operation->kernels();
    std::array<const Node*, max_arity> inputs{};
    for (int i = 0; i < node.arity; ++i) inputs[i] = node.inputs[i].get();
    return {kernels.together, inputs,
            kernels.place < 0 ? std::vector<double>() : node.operation->numbers()};
  }

  void find_families() {
    for (const Node* node : order_) {
      if (node->type != Node::Type::operation || !node->operation->kernels().together) continue;
      families_[family_of(*node)].push_back(node);
    }
    const auto place = [](const Node* node) { return node->operation->kernels().place; };
    for (auto& [family, nodes] : families_) {
      std::stable_sort(nodes.begin(), nodes.end(),
                       [&](const Node* a, const Node* b) { return place(a) < place(b); });
    }
  }

  void append(const Node* node) {
    Code::Step step{node->operation.get(), {}};
    for (int i = 0; i < node->arity; ++i) step.in[i] = value_of(node->inputs[i].get());
    value_[node] = append(step);
  }

  uint32_t append(const Code::Step& step) {
    code_.steps.push_back(step);
    return uint32_t(2 + code_.constants.size() + code_.steps.size());
  }

  uint32_t value_of(const Node* node) {
    const auto [at, is_new] = value_.try_emplace(node);
    if (!is_new) return at->second;
    source_->numbers.push_back(make_operation(Number{node->value}));
    return at->second = append({source_->numbers.back().get(), {}});
  }

  std::vector<const Node*> order_;
  std::shared_ptr<Source> source_;
  std::unordered_map<const Node*, uint32_t> value_;
  std::map<Family, std::vector<const Node*>> families_;
  Code code_;
};

// Whether the instruction is number k of those that are evaluated together with the first.
bool is_together(const Instruction& first, const Instruction& instruction, size_t k) {
  if (instruction.kernels->together != first.kernels->together || instruction.in != first.in)
    return false;
  const int place = instruction.kernels->place;
  return place < 0 ||
         (place == int(k) && instruction.operation->numbers() == first.operation->numbers());
}

void find_together(std::vector<Instruction>& instructions) {
  for (size_t i = 0; i < instructions.size(); i += instructions[i].together) {
    Instruction& first = instructions[i];
    const Together* const together = first.kernels->together;
    if (!together || size_t(together->size) > instructions.size() - i) continue;
    const size_t size = size_t(together->size);
    size_t k = 0;
    while (k < size && is_together(first, instructions[i + k], k)) ++k;
    if (k == size) first.together = uint32_t(size);
  }
}

// The value that is the first step's result.
uint32_t first_result(const Code& code) { return uint32_t(3 + code.constants.size()); }

// The steps that one pass evaluates with the next one.
class Fusion {
 public:
  // last[s] is the step that uses the result of step s last.
  Fusion(const Code& code, std::span<const uint32_t> last) : code_(code), last_(last) {}

  // How step s is evaluated with the next; null where it is not.
  const Fused* of(size_t s) const {
    if (s + 1 >= code_.steps.size() || last_[s] != s + 1) return nullptr;
    const auto& in = code_.steps[s + 1].in;
    if (in[1] != result(s) || in[0] == in[1]) return nullptr;
    return kernels(s).fused_with(kernels(s + 1));
  }

  // How many pairs from that of step s on one call evaluates.
  size_t pairs(size_t s) const {
    const Fused* const fused = of(s);
    size_t count = 1;
    while (fused->several && count < most_pairs && goes_on(*fused, s + 2 * count)) ++count;
    return count;
  }

 private:
  // Whether the pair of step s takes the result of the one before, which nothing else needs, and
  // its solid and that one's are alike.
  bool goes_on(const Fused& fused, size_t s) const {
    if (of(s) != &fused || last_[s - 1] != s + 1) return false;
    const Code::Step &before = code_.steps[s - 2], &solid = code_.steps[s];
    return code_.steps[s + 1].in[0] == result(s - 1) && solid.in == before.in &&
           fused.alike(before.operation->object(), solid.operation->object());
  }

  const Kernels& kernels(size_t s) const { return code_.steps[s].operation->kernels(); }
  uint32_t result(size_t s) const { return first_result(code_) + uint32_t(s); }

  const Code& code_;
  std::span<const uint32_t> last_;
};

uint64_t next_number() {
  static std::atomic<uint64_t> last{0};
  return ++last;
}

// The step that uses each result last.
constexpr uint32_t to_the_end = UINT32_MAX;
std::vector<uint32_t> last_uses(const Code& code) {
  const uint32_t first = first_result(code);
  std::vector<uint32_t> last(code.steps.size(), 0);
  for (uint32_t s = 0; s < code.steps.size(); ++s) {
    for (int k = 0; k < code.steps[s].operation->info().arity; ++k) {
      const uint32_t value = code.steps[s].in[k];
      if (value >= first) last[value - first] = s;
    }
  }
  for (const uint32_t value : code.outputs) {
    if (value >= first) last[value - first] = to_the_end;
  }
  return last;
}

}  // namespace

Tape::Tape(std::span<const Expression> outputs) : Tape(CodeOf(outputs).code()) {}

Tape::Tape(const Code& code)
    : source_(code.source), outputs_(code.outputs), number_(next_number()) {
  for (uint32_t c = 0; c < code.constants.size(); ++c) {
    constants_.push_back({3 + c, code.constants[c]});
  }
  instructions_.reserve(code.steps.size());
  for (const Code::Step& step : code.steps) {
    const Operation* operation = step.operation;
    instructions_.push_back({operation, &operation->kernels(), operation->object(), step.in, 0});
  }
  std::vector<uint32_t> last = last_uses(code);
  find_pairs(code, last);
  place_results(std::move(last));
  find_together(instructions_);
}

void Tape::find_pairs(const Code& code, std::span<const uint32_t> last) {
  const Fusion fusion(code, last);
  for (size_t s = 0; s < instructions_.size();) {
    const Fused* const fused = fusion.of(s);
    const size_t pairs = fused ? fusion.pairs(s) : 0;
    const bool pays = pairs > 1 || (pairs == 1 && fused->value);
    if (pays) {
      instructions_[s].fused = fused;
      instructions_[s].pairs = uint32_t(pairs);
    }
    s += pays ? 2 * pairs : 1;
  }
}

void Tape::place_results(std::vector<uint32_t> last) {
  const uint32_t first = uint32_t(3 + constants_.size());
  registers_ = first;
  std::vector<uint32_t> free, place(instructions_.size());
  for (uint32_t s = 0; s < instructions_.size(); ++s) {
    Instruction& instruction = instructions_[s];
    // The result may not overwrite an input: kernels read and write in steps of their own width.
    if (free.empty()) {
      instruction.out = uint32_t(registers_++);
    } else {
      instruction.out = free.back();
      free.pop_back();
    }
    place[s] = instruction.out;
    for (int k = 0; k < instruction.operation->info().arity; ++k) {
      uint32_t& in = instruction.in[k];
      if (in < first) continue;
      const uint32_t step = in - first;
      in = place[step];
      if (last[step] != s) continue;
      free.push_back(in);
      last[step] = to_the_end;
    }
  }
  for (uint32_t& value : outputs_) {
    if (value >= first) value = place[value - first];
  }
}

}  // namespace sardf

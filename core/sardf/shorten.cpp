#include "sardf/shorten.hpp"

#include <algorithm>
#include <bit>
#include <memory>
#include <utility>

#include "sardf/numbers/choice.hpp"
#include "sardf/operation_of.hpp"
#include "sardf/ops_arithmetic.hpp"

namespace sardf {

namespace {

constexpr uint32_t none = UINT32_MAX;

// A value of the old program in terms of the new one: another old value, negated or not, or a
// number.
struct Origin {
  uint32_t value;
  bool negated = false;
};

const Operation* negation() {
  static const OperationPointer negate = make_operation(Negate{});
  return negate.get();
}

// What two users need together.
void add(Demand& to, const Demand& more) {
  to.floor = std::min(to.floor, more.floor);
  to.ceiling = std::max(to.ceiling, more.ceiling);
}

// Decides from the outputs back to the inputs what is computed, and writes the shorter program.
class Writer {
 public:
  Writer(const Tape& tape, uint32_t first,
         const std::vector<std::array<uint32_t, max_arity>>& inputs,
         const std::vector<Enclosure>& ranges)
      : tape_(tape), first_(first), inputs_(inputs), ranges_(ranges) {
    const size_t count = ranges.size();
    demand_.resize(count, {infinity, -infinity});
    is_needed_.resize(count);
    origin_.resize(count);
    for (uint32_t v = 0; v < count; ++v) origin_[v] = {v};
  }

  void need(uint32_t value, const Demand& demand) {
    add(demand_[value], demand);
    is_needed_[value] = true;
  }

  void decide() {
    for (uint32_t v = uint32_t(ranges_.size()); v-- > first_;) {
      if (!is_needed_[v]) continue;
      const auto& in = inputs_[v - first_];
      const Operation& operation = *tape_.instructions()[v - first_].operation;
      std::array<Enclosure, max_arity> at;
      const int arity = operation.info().arity;
      if (arity == 0) continue;  // a number that has no register of its own gets none
      for (int k = 0; k < max_arity; ++k) at[k] = ranges_[in[k]];
      Demand demand = demand_[v];
      // Then no value matters: any will do, and so will the right one.
      if (!(demand.floor < demand.ceiling)) demand = {};
      const Fate fate = operation.fate(at.data(), demand);
      if (fate.type == Fate::Type::computed) {
        for (int k = 0; k < arity; ++k) need(in[k], fate.demand[k]);
      } else if (fate.type == Fate::Type::copy) {
        origin_[v] = {in[fate.input], fate.negated};
        need(in[fate.input], fate.negated ? Demand{-demand.ceiling, -demand.floor} : demand);
      } else {
        origin_[v] = {number(fate.number)};
      }
    }
  }

  Code write(const std::vector<uint32_t>& outputs) {
    code_.source = tape_.source();
    place_.resize(ranges_.size() + numbers_.size(), none);
    for (uint32_t axis = 0; axis < 3; ++axis) place_[axis] = axis;
    place_constants();
    negative_.resize(place_.size(), none);
    for (uint32_t v = first_; v < ranges_.size(); ++v) {
      if (!is_needed_[v]) continue;
      // What it is a copy of comes before it.
      const Origin from = origin_[v];
      if (from.value != v) {
        if (from.value < ranges_.size()) {
          const Origin first = origin_[from.value];
          origin_[v] = {first.value, first.negated != from.negated};
        }
        continue;
      }
      Code::Step step{narrowed(v), {}};
      const int arity = step.operation->info().arity;
      for (int k = 0; k < arity; ++k) step.in[k] = placed(inputs_[v - first_][k]);
      place_[v] = append(step);
    }
    for (const uint32_t output : outputs) code_.outputs.push_back(placed(output));
    if (!made_.empty()) code_.source = std::make_shared<Source>(tape_.source(), std::move(made_));
    return std::move(code_);
  }

 private:
  /// What keeps the operations alive: of the longer program, and made for this one.
  using Source = std::pair<std::shared_ptr<const void>, std::vector<OperationPointer>>;

  // The operation of a value, or one for less work.
  const Operation* narrowed(uint32_t v) {
    const Operation* operation = tape_.instructions()[v - first_].operation;
    std::array<Enclosure, max_arity> at;
    for (int k = 0; k < max_arity; ++k) at[k] = ranges_[inputs_[v - first_][k]];
    OperationPointer made = operation->narrowed(at.data());
    if (!made) return operation;
    made_.push_back(std::move(made));
    return made_.back().get();
  }

  // The value that stands for a number: they come after all others.
  uint32_t number(double value) {
    size_t k = 0;
    const auto bits = std::bit_cast<uint64_t>(value);
    while (k < numbers_.size() && std::bit_cast<uint64_t>(numbers_[k]) != bits) ++k;
    if (k == numbers_.size()) numbers_.push_back(value);
    return uint32_t(ranges_.size() + k);
  }

  void place_constants() {
    const auto place = [this](uint32_t value, double constant) {
      place_[value] = uint32_t(3 + code_.constants.size());
      code_.constants.push_back(constant);
    };
    for (const Tape::Constant& c : tape_.constants()) {
      if (is_needed_[c.reg]) place(c.reg, c.value);
    }
    for (size_t k = 0; k < numbers_.size(); ++k) {
      place(uint32_t(ranges_.size() + k), numbers_[k]);
    }
  }

  uint32_t append(const Code::Step& step) {
    code_.steps.push_back(step);
    return uint32_t(2 + code_.constants.size() + code_.steps.size());
  }

  uint32_t placed(uint32_t value) {
    const Origin from = value < ranges_.size() ? origin_[value] : Origin{value};
    if (!from.negated) return place_[from.value];
    uint32_t& negative = negative_[from.value];
    if (negative == none) negative = append({negation(), {place_[from.value]}});
    return negative;
  }

  const Tape& tape_;
  uint32_t first_;
  const std::vector<std::array<uint32_t, max_arity>>& inputs_;
  const std::vector<Enclosure>& ranges_;
  std::vector<Demand> demand_;
  std::vector<uint8_t> is_needed_;
  std::vector<Origin> origin_;
  std::vector<double> numbers_;
  std::vector<uint32_t> place_, negative_;  // values of the new program
  std::vector<OperationPointer> made_;
  Code code_;
};

}  // namespace

Shortening::Shortening(const Evaluator& evaluator, const BoundingBox& box)
    : tape_(evaluator.tape()), first_(uint32_t(3 + evaluator.tape().constants().size())) {
  const std::vector<Instruction>& instructions = tape_.instructions();
  in_.resize(instructions.size());
  ranges_.resize(first_ + instructions.size());
  for (int axis = 0; axis < 3; ++axis) {
    const Choice c = Choice::of({box.lo[axis], box.hi[axis]}, false);
    ranges_[axis] = {c.range, c.may_be_nan};
  }
  std::vector<uint32_t> value(tape_.registers());
  for (uint32_t reg = 0; reg < first_; ++reg) value[reg] = reg;
  for (const Tape::Constant& c : tape_.constants()) {
    const Choice constant(c.value);
    ranges_[c.reg] = {constant.range, !(std::abs(c.value) < infinity)};
  }
  std::array<Enclosure, max_arity> in;
  for (size_t i = 0; i < instructions.size(); ++i) {
    const Instruction& instruction = instructions[i];
    // Where there are fewer inputs the others are x.
    for (int k = 0; k < max_arity; ++k) {
      in_[i][k] = value[instruction.in[k]];
      in[k] = ranges_[in_[i][k]];
    }
    ranges_[first_ + i] = instruction.operation->range(in.data());
    value[instruction.out] = uint32_t(first_ + i);
  }
  for (const uint32_t reg : tape_.outputs()) outputs_.push_back(value[reg]);
}

Evaluator Shortening::shortened(Wanted wanted) const {
  // Values of 0 or more are as good as one another, and so are those clearly below.
  return shortened(wanted == Wanted::signs ? Demand{-1e-30, 0} : Demand{});
}

Evaluator Shortening::shortened(const Demand& demand) const {
  Writer writer(tape_, first_, in_, ranges_);
  for (const uint32_t output : outputs_) writer.need(output, demand);
  writer.decide();
  return Evaluator(Tape(writer.write(outputs_)));
}

}  // namespace sardf

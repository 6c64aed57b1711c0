#include "sardf/render_rounding.hpp"

#include <algorithm>

namespace sardf::rendering {

namespace {

// What each operation's kernels keep to, of the largest argument, scale or result; the law
// tests of batches check it for every operation (tests/cpp/test_laws_batch.cpp).
constexpr double operation_error = 8e-7;
// The middle of a box and a place in it are rounded (render_table.hpp).
constexpr double coordinate_error = 0x1p-23;
// Beyond these single precision, or the squares in it, may overflow or vanish.
constexpr double largest_number = 1e18, smallest_size = 1e-12;

// The inputs' errors come out enlarged as gradients do: Operation::slope bounds that when errors
// stand in for lengths (mean value theorem), where the values lie within the intervals.
Slope with_error(const Operation& operation, const Slope* in) {
  Slope out = operation.slope(in);
  double largest = max(out.value.magnitude(), operation.scale());
  for (int k = 0; k < operation.info().arity; ++k) {
    largest = std::max(largest, in[k].value.magnitude());
  }
  out.length =
      largest < largest_number ? rounded_up(out.length + operation_error * largest) : infinity;
  out.partial.fill(Interval::all());  // nothing is known of the errors' directions
  // The operations that follow see rounded values.
  out.value = {rounded_down(out.value.lo - out.length), rounded_up(out.value.hi + out.length)};
  return out;
}

}  // namespace

bool is_single(const Evaluator& evaluator) {
  const auto& instructions = evaluator.tape().instructions();
  return std::all_of(instructions.begin(), instructions.end(),
                     [](const Instruction& i) { return i.operation->has_formula(); });
}

double single_precision_error(const Evaluator& evaluator, const BoundingBox& box) {
  if (!(box.diagonal() > smallest_size)) return infinity;
  const Tape& tape = evaluator.tape();
  std::vector<Slope> registers(tape.registers());
  for (int axis = 0; axis < 3; ++axis) {
    Slope& at = registers[axis];
    at.value = {box.lo[axis], box.hi[axis]};
    at.length = coordinate_error * at.value.magnitude();
    at.value = {at.value.lo - at.length, at.value.hi + at.length};
    at.partial.fill(Interval::all());
  }
  for (const Tape::Constant& c : tape.constants()) {
    registers[c.reg].value = c.value;
    registers[c.reg].length = coordinate_error * std::abs(c.value);
    registers[c.reg].partial.fill(Interval::all());
  }
  std::array<Slope, max_arity> in;
  for (const Instruction& i : tape.instructions()) {
    for (int k = 0; k < i.operation->info().arity; ++k) in[k] = registers[i.in[k]];
    registers[i.out] = with_error(*i.operation, in.data());
  }
  const double error = registers[tape.outputs()[0]].length;
  return error >= 0 ? error : infinity;
}

double double_precision_error(const BoundingBox& box, double slope) {
  // 4500 roundings of the largest coordinate, as certified_bounds sets aside.
  const double rounding = 1e-12 * std::max(norm(box.lo), norm(box.hi));
  return rounding * std::max(1.0, slope);
}

}  // namespace sardf::rendering

#include "sardf/certify.hpp"

#include <algorithm>
#include <queue>
#include <unordered_map>

#include "sardf/error.hpp"

namespace sardf {

namespace {

/// A value with and without blends: both lie in `value`, and differ by at most `error`.
struct Deviation {
  Interval value;
  double error = 0;
};

// The change that the inputs' errors cause: Operation::slope bounds it when errors stand in for
// gradient lengths (mean value theorem; the intervals hold both ends).
double passed_on(const Operation& operation, std::span<const Deviation> in) {
  std::array<Slope, max_arity> slopes;
  for (size_t k = 0; k < in.size(); ++k) {
    slopes[k].value = in[k].value;
    slopes[k].length = in[k].error;
    // Nothing is known of directions.
    if (in[k].error > 0) slopes[k].partial.fill(Interval::all());
  }
  return operation.slope(slopes.data()).length;
}

Deviation deviation_of(const Node& node, std::span<const Deviation> in) {
  if (node.type == Node::Type::constant) return {node.value, 0};
  if (node.type == Node::Type::coordinate) return {Interval::all(), 0};
  std::array<Interval, max_arity> values;
  double most = 0;
  for (size_t k = 0; k < in.size(); ++k) {
    values[k] = in[k].value;
    most = max(most, in[k].error);
  }
  Deviation out{node.operation->interval(values.data()), 0};
  const double own = node.operation->blend_error();
  // A blend's counterpart is min or max, which never enlarges the largest error.
  if (most > 0 || own > 0) {
    out.error = own > 0 ? rounded_up(own + most) : passed_on(*node.operation, in);
  }
  out.value = {rounded_down(out.value.lo - out.error), rounded_up(out.value.hi + out.error)};
  return out;
}

/// A part of the box with its bound, ordered by the bound.
struct Part {
  BoundingBox box;
  double length;
  bool operator<(const Part& other) const { return length < other.length; }
};

// 0 where there is no gradient, or none is known (data_operation.hpp).
double steepest_at(const Evaluator& evaluator, const Vec3& point) {
  Vec3 gradient;
  try {
    evaluator.gradients(point.data(), 1, nullptr, gradient.data());
  } catch (const Error&) {
    return 0;
  }
  const double length = norm(gradient);
  return std::isnan(length) ? 0 : length;
}

bool is_finite(const BoundingBox& box) {
  const double sum = norm(box.lo) + norm(box.hi);
  return sum < infinity;
}

std::array<BoundingBox, 2> halves(const BoundingBox& box) {
  const Vec3 size = box.size();
  const size_t axis = size_t(std::max_element(size.begin(), size.end()) - size.begin());
  std::array<BoundingBox, 2> parts{box, box};
  parts[0].hi[axis] = parts[1].lo[axis] = box.center()[axis];
  return parts;
}

// The operation whose bound is infinite although its inputs' bounds are finite.
std::string infinite_node(const Evaluator& evaluator, const BoundingBox& box) {
  const Tape& tape = evaluator.tape();
  std::vector<Slope> registers(tape.registers());
  for (int axis = 0; axis < 3; ++axis) {
    registers[axis].value = {box.lo[axis], box.hi[axis]};
    registers[axis].partial[axis] = 1;
    registers[axis].length = 1;
  }
  for (const Tape::Constant& c : tape.constants()) registers[c.reg].value = c.value;
  std::array<Slope, max_arity> in;
  for (const Instruction& i : tape.instructions()) {
    const OperationInfo& info = i.operation->info();
    bool finite = true;
    for (int k = 0; k < info.arity; ++k) {
      in[k] = registers[i.in[k]];
      finite = finite && in[k].length < infinity;
    }
    registers[i.out] = i.operation->slope(in.data());
    // The first such operation: all later infinities follow from one.
    if (finite && !(registers[i.out].length < infinity)) return info.name;
  }
  return "";
}

}  // namespace

CertifiedBound certified_error(const Expression& expression) {
  std::unordered_map<const Node*, Deviation> known;
  std::string infinite_at;
  std::array<Deviation, max_arity> in;
  for (const Node* node : topological_order({&expression, 1})) {
    for (size_t k = 0; k < node->arity; ++k) in[k] = known.at(node->inputs[k].get());
    const Deviation& out = known[node] = deviation_of(*node, {in.data(), node->arity});
    if (infinite_at.empty() && out.error == infinity) infinite_at = node->operation->info().name;
  }
  const double error = known.at(expression.get()).error;
  return {error, error == infinity ? infinite_at : ""};
}

double error_bound(const Expression& expression) { return certified_error(expression).value; }

CertifiedBound certified_lipschitz(const Evaluator& evaluator, const BoundingBox& box, int boxes) {
  constexpr double close_enough = 1.001;
  std::priority_queue<Part> parts;
  parts.push({box, evaluator.slope(box).length});
  if (is_finite(box)) {
    double attained = steepest_at(evaluator, box.center());
    for (int used = 1; used < boxes; ++used) {
      const Part worst = parts.top();
      if (worst.length <= close_enough * attained) break;
      parts.pop();
      for (const BoundingBox& half : halves(worst.box)) {
        // A part is never worse than the whole.
        parts.push({half, min(worst.length, evaluator.slope(half).length)});
        attained = max(attained, steepest_at(evaluator, half.center()));
      }
    }
  }
  const Part worst = parts.top();
  if (worst.length < infinity) return {worst.length, ""};
  return {infinity, infinite_node(evaluator, worst.box)};
}

double lipschitz_bound(const Evaluator& evaluator, const BoundingBox& box, int boxes) {
  return certified_lipschitz(evaluator, box, boxes).value;
}

}  // namespace sardf

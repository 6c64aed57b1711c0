// Runs a recorded formula (trace.hpp) on another number type.
//
// The record must be a Trace::Detail::differentiable one where the number type has derivatives.
#pragma once

#include <cassert>
#include <span>
#include <vector>

#include "sardf/numbers/trace.hpp"

namespace sardf {

namespace replaying {

template <class V>
V of_one(const std::string& name, const V& a) {
  if (name == "negate") return -a;
  if (name == "abs") return abs(a);
  if (name == "sqrt") return sqrt(a);
  if (name == "exp") return exp(a);
  if (name == "log") return log(a);
  if (name == "sin") return sin(a);
  if (name == "cos") return cos(a);
  if (name == "tan") return tan(a);
  if (name == "asin") return asin(a);
  if (name == "acos") return acos(a);
  if (name == "floor") return floor(a);
  assert(name == "freeze");
  return freeze(a);
}

template <class V>
V of_two(const std::string& name, const V& a, const V& b) {
  if (name == "+") return a + b;
  if (name == "-") return a - b;
  if (name == "*") return &a == &b ? square(a) : a * b;
  if (name == "/") return a / b;
  if (name == "min") return min(a, b);
  if (name == "max") return max(a, b);
  if (name == "smaller") return smaller(a, b);
  if (name == "larger") return larger(a, b);
  if (name == "length") return length(a, b);
  if (name == "atan2") return atan2(a, b);
  assert(name == "pow");
  return pow(a, b);
}

}  // namespace replaying

/// The record's result for these inputs. V has the operations of a number type (README.md beside
/// this file), square, smaller and larger among them.
template <class V>
V replay(const Trace& trace, std::span<const V> inputs) {
  using Mask = decltype(inputs[0] < inputs[0]);
  const std::vector<TraceStep>& steps = trace.steps();
  std::vector<V> values(steps.size());
  std::vector<Mask> masks(steps.size());
  for (size_t i = 0; i < steps.size(); ++i) {
    const TraceStep& step = steps[i];
    const auto [a, b, c] = step.operands;
    switch (step.kind) {
      case TraceStep::Kind::input:
        values[i] = inputs[size_t(step.index)];
        break;
      case TraceStep::Kind::number:
        values[i] = V(step.value);
        break;
      case TraceStep::Kind::select:
      case TraceStep::Kind::shortcut:
        values[i] = select(Mask(masks[size_t(a)]), values[size_t(b)], values[size_t(c)]);
        break;
      case TraceStep::Kind::call:
        if (step.name == "<") {
          masks[i] = values[size_t(a)] < values[size_t(b)];
        } else if (step.name == "<=") {
          masks[i] = values[size_t(a)] <= values[size_t(b)];
        } else if (step.name == "and") {
          masks[i] = masks[size_t(a)] && masks[size_t(b)];
        } else if (step.name == "or") {
          masks[i] = masks[size_t(a)] || masks[size_t(b)];
        } else if (step.name == "not") {
          masks[i] = !masks[size_t(a)];
        } else if (b < 0) {
          values[i] = replaying::of_one(step.name, values[size_t(a)]);
        } else if (c < 0) {
          values[i] = replaying::of_two(step.name, values[size_t(a)], values[size_t(b)]);
        } else {
          values[i] = length(values[size_t(a)], values[size_t(b)], values[size_t(c)]);
        }
        break;
    }
  }
  return values[size_t(trace.result)];
}

}  // namespace sardf

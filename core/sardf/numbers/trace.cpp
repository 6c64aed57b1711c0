#include "sardf/numbers/trace.hpp"

#include <bit>
#include <cassert>
#include <utility>

namespace sardf {

namespace {

thread_local Trace* innermost = nullptr;

int record(TraceStep::Kind kind, const char* name, std::array<int, 3> operands) {
  return Trace::current().add({.kind = kind, .name = name, .operands = operands});
}

int record(const char* name, int a, int b = -1) {
  return record(TraceStep::Kind::call, name, {a, b, -1});
}

}  // namespace

Trace::Trace(int inputs, Detail detail) : detail_(detail), outer_(std::exchange(innermost, this)) {
  for (int i = 0; i < inputs; ++i) add({.kind = TraceStep::Kind::input, .name = {}, .index = i});
}

Trace::~Trace() { innermost = outer_; }

Trace& Trace::current() {
  assert(innermost);
  return *innermost;
}

int Trace::add(TraceStep step) {
  // The bits, not the value, tell constants apart: -0.0 is not 0.0.
  const Key key{step.kind, step.name, step.index, std::bit_cast<uint64_t>(step.value),
                step.operands};
  const auto [known, added] = known_.try_emplace(key, int(steps_.size()));
  if (added) steps_.push_back(std::move(step));
  return known->second;
}

Text::Text(double number)
    : step(Trace::current().add({.kind = TraceStep::Kind::number, .name = {}, .value = number})) {}

Text Text::at(int step) {
  Text text;
  text.step = step;
  return text;
}

Text Text::call(const char* name, Text a) { return at(record(name, a.step)); }

Text Text::call(const char* name, Text a, Text b) { return at(record(name, a.step, b.step)); }

TextMask Text::compare(const char* name, Text a, Text b) { return {record(name, a.step, b.step)}; }

Text Text::choose(TraceStep::Kind kind, TextMask mask, Text a, Text b) {
  return at(record(kind, "", {mask.step, a.step, b.step}));
}

namespace {

bool differentiable() { return Trace::current().is_differentiable(); }

}  // namespace

Text freeze(Text a) { return differentiable() ? Text::call("freeze", a) : a; }

Text smaller(Text a, Text b) { return Text::call(differentiable() ? "smaller" : "min", a, b); }

Text larger(Text a, Text b) { return Text::call(differentiable() ? "larger" : "max", a, b); }

Text length(Text a, Text b) {
  if (differentiable()) return Text::call("length", a, b);
  return sqrt(square(a) + square(b));
}

Text length(Text a, Text b, Text c) {
  if (!differentiable()) return sqrt(square(a) + square(b) + square(c));
  return Text::at(record(TraceStep::Kind::call, "length", {a.step, b.step, c.step}));
}

TextMask operator&&(TextMask a, TextMask b) { return {record("and", a.step, b.step)}; }
TextMask operator||(TextMask a, TextMask b) { return {record("or", a.step, b.step)}; }
TextMask operator!(TextMask a) { return {record("not", a.step)}; }

}  // namespace sardf

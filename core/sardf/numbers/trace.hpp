// The number type Text: it records a formula instead of computing it. A back end prints the record.
//
// A record is a graph, not a string: equal terms are one node, so a value used many times is
// printed once and named, and text never grows exponentially.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <vector>

namespace sardf {

/// One recorded step.
struct TraceStep {
  enum class Kind {
    input,     // an argument of the formula: `index`
    number,    // a constant: `value`
    call,      // a function or operator `name` of the operands: "+", "-", "*", "/", "negate",
               // "min", "max", "abs", "sqrt", "exp", "log", "sin", "cos", "tan", "asin", "acos",
               // "atan2", "floor", "pow"; of masks: "<", "<=", "and", "or", "not"; and in a
               // Trace::Detail::differentiable record "freeze", "smaller", "larger", "length"
    select,    // operands: mask, value where it holds, value elsewhere
    shortcut,  // as select, but the third operand is costly: evaluate it only where it is needed
  };
  Kind kind;
  std::string name;
  int index = 0;
  double value = 0;
  std::array<int, 3> operands{-1, -1, -1};
};

/// The steps of one formula; a step's operands come before it.
class Trace {
 public:
  /// A differentiable record tells apart what has one value but different derivatives.
  enum class Detail { printable, differentiable };
  explicit Trace(int inputs, Detail detail = Detail::printable);
  Trace(const Trace&) = delete;
  Trace& operator=(const Trace&) = delete;
  ~Trace();

  /// The trace that Text records into on this thread: the one made last and still alive.
  static Trace& current();
  /// The step, or the equal one that is known already.
  int add(TraceStep step);
  const std::vector<TraceStep>& steps() const { return steps_; }
  const TraceStep& operator[](int step) const { return steps_[step]; }
  bool is_differentiable() const { return detail_ == Detail::differentiable; }
  int result = -1;

 private:
  using Key = std::tuple<TraceStep::Kind, std::string, int, uint64_t, std::array<int, 3>>;
  std::vector<TraceStep> steps_;
  std::map<Key, int> known_;
  Detail detail_;
  Trace* outer_;
};

/// A truth value in a recorded formula.
struct TextMask {
  int step;
};

/// A value in the formula that Trace::current() records.
struct Text {
  int step = -1;

  Text() = default;
  Text(double number);
  static Text at(int step);
  static Text call(const char* name, Text a);
  static Text call(const char* name, Text a, Text b);
  static TextMask compare(const char* name, Text a, Text b);
  static Text choose(TraceStep::Kind kind, TextMask mask, Text a, Text b);

  friend Text operator+(Text a, Text b) { return call("+", a, b); }
  friend Text operator-(Text a, Text b) { return call("-", a, b); }
  friend Text operator*(Text a, Text b) { return call("*", a, b); }
  friend Text operator/(Text a, Text b) { return call("/", a, b); }
  friend Text operator-(Text a) { return call("negate", a); }
  friend TextMask operator<(Text a, Text b) { return compare("<", a, b); }
  friend TextMask operator<=(Text a, Text b) { return compare("<=", a, b); }
  friend TextMask operator>(Text a, Text b) { return compare("<", b, a); }
  friend TextMask operator>=(Text a, Text b) { return compare("<=", b, a); }
};

TextMask operator&&(TextMask a, TextMask b);
TextMask operator||(TextMask a, TextMask b);
TextMask operator!(TextMask a);

inline Text select(TextMask mask, Text a, Text b) {
  return Text::choose(TraceStep::Kind::select, mask, a, b);
}
template <class Full>
Text shortcut(TextMask mask, Text cheap, Full full) {
  return Text::choose(TraceStep::Kind::shortcut, mask, cheap, full());
}
inline Text min(Text a, Text b) { return Text::call("min", a, b); }
inline Text max(Text a, Text b) { return Text::call("max", a, b); }
inline Text abs(Text a) { return Text::call("abs", a); }
inline Text sqrt(Text a) { return Text::call("sqrt", a); }
inline Text square(Text a) { return Text::call("*", a, a); }
/// What a printable record has no word for becomes elementary steps there.
Text freeze(Text a);
Text smaller(Text a, Text b);
Text larger(Text a, Text b);
Text length(Text a, Text b);
Text length(Text a, Text b, Text c);
inline Text cosine(Text a, Text b) { return Text::call("/", a, b); }
inline Text exp(Text a) { return Text::call("exp", a); }
inline Text log(Text a) { return Text::call("log", a); }
inline Text sin(Text a) { return Text::call("sin", a); }
inline Text cos(Text a) { return Text::call("cos", a); }
inline Text tan(Text a) { return Text::call("tan", a); }
inline Text asin(Text a) { return Text::call("asin", a); }
inline Text acos(Text a) { return Text::call("acos", a); }
inline Text atan2(Text a, Text b) { return Text::call("atan2", a, b); }
inline Text floor(Text a) { return Text::call("floor", a); }
inline Text pow(Text a, Text b) { return Text::call("pow", a, b); }

}  // namespace sardf

#include "sardf/symbol.hpp"

#include "sardf/arithmetic.hpp"

namespace sardf {

namespace {

Symbol called(const char* name, const Symbol& a) { return Symbol(function(name, {a.node})); }

bool is_number(const Expression& e, double value) { return is_constant(e) && e->value == value; }

}  // namespace

bool is_zero(const Symbol& a) { return is_number(a.node, 0); }
bool is_constant(const Symbol& a) { return is_constant(a.node); }

Symbol operator+(const Symbol& a, const Symbol& b) { return Symbol(a.node + b.node); }
Symbol operator-(const Symbol& a, const Symbol& b) { return Symbol(a.node - b.node); }
Symbol operator*(const Symbol& a, const Symbol& b) {
  if (is_zero(a) || is_zero(b)) return 0.0;
  if (is_number(a.node, -1)) return -b;
  if (is_number(b.node, -1)) return -a;
  return Symbol(a.node * b.node);
}
Symbol operator/(const Symbol& a, const Symbol& b) {
  if (is_zero(a)) return 0.0;
  return Symbol(a.node / b.node);
}
Symbol operator-(const Symbol& a) { return is_zero(a) ? a : Symbol(-a.node); }

SymbolMask operator<(const Symbol& a, const Symbol& b) { return {less(a.node, b.node)}; }
SymbolMask operator<=(const Symbol& a, const Symbol& b) { return {less_equal(a.node, b.node)}; }
SymbolMask operator>(const Symbol& a, const Symbol& b) { return b < a; }
SymbolMask operator>=(const Symbol& a, const Symbol& b) { return b <= a; }

SymbolMask operator&&(const SymbolMask& a, const SymbolMask& b) {
  if (is_number(a.node, 0) || is_number(b.node, 1)) return a;
  if (is_number(b.node, 0) || is_number(a.node, 1)) return b;
  return {a.node * b.node};
}
SymbolMask operator||(const SymbolMask& a, const SymbolMask& b) { return !(!a && !b); }
SymbolMask operator!(const SymbolMask& a) {
  const Expression& e = a.node;
  // What a mask was before it was negated.
  const bool negated = e->type == Node::Type::operation &&
                       e->operation->info().name == "subtract" && is_number(e->inputs[0], 1);
  return {negated ? e->inputs[1] : constant(1) - e};
}
Symbol select(const SymbolMask& mask, const Symbol& a, const Symbol& b) {
  if (is_constant(mask.node)) return mask.node->value != 0 ? a : b;
  return Symbol(select(mask.node, a.node, b.node));
}

Symbol min(const Symbol& a, const Symbol& b) { return Symbol(min(a.node, b.node)); }
Symbol max(const Symbol& a, const Symbol& b) { return Symbol(max(a.node, b.node)); }
Symbol abs(const Symbol& a) { return Symbol(abs(a.node)); }
Symbol square(const Symbol& a) { return a * a; }
Symbol freeze(const Symbol& a) { return a; }
Symbol sqrt(const Symbol& a) { return called("sqrt", a); }
Symbol exp(const Symbol& a) { return called("exp", a); }
Symbol log(const Symbol& a) { return called("log", a); }
Symbol sin(const Symbol& a) { return called("sin", a); }
Symbol cos(const Symbol& a) { return called("cos", a); }
Symbol tan(const Symbol& a) { return called("tan", a); }
Symbol asin(const Symbol& a) { return called("asin", a); }
Symbol acos(const Symbol& a) { return called("acos", a); }
Symbol floor(const Symbol& a) { return called("floor", a); }
Symbol atan2(const Symbol& y, const Symbol& x) {
  return Symbol(function("atan2", {y.node, x.node}));
}
Symbol pow(const Symbol& a, const Symbol& b) { return Symbol(pow(a.node, b.node)); }
Symbol length(const Symbol& a, const Symbol& b) { return Symbol(length(a.node, b.node)); }
Symbol length(const Symbol& a, const Symbol& b, const Symbol& c) {
  return Symbol(function("length3", {a.node, b.node, c.node}));
}

Symbol within(const Symbol& a, double most) {
  const bool is_done = a.node->type == Node::Type::operation &&
                       a.node->operation->info().name == "max" &&
                       is_number(a.node->inputs[0], -most);
  if (is_done || is_constant(a)) return a;
  // min and max give their second argument where the comparison fails, as it does for NaN.
  return max(Symbol(-most), min(Symbol(most), a));
}

Symbol cosine(const Symbol& a, const Symbol& b) { return within(a / b, 1); }

}  // namespace sardf

// The number type Symbol: a value that is a node of a graph.
//
// Formulas that run on it build graphs of elementary functions. A term that is 0 whatever the point
// is, left out: the derivative of what does not vary costs nothing, and 0 times a value that may be
// NaN is 0.
#pragma once

#include "sardf/graph.hpp"

namespace sardf {

struct Symbol {
  Expression node;

  Symbol() : Symbol(0.0) {}
  Symbol(double number) : node(constant(number)) {}
  explicit Symbol(Expression value) : node(std::move(value)) {}
};

/// 1 where it holds, else 0.
struct SymbolMask {
  Expression node = constant(0);
};

/// Whether it is the number 0 everywhere.
bool is_zero(const Symbol& a);
/// Whether it is one number everywhere; which, is `node->value`.
bool is_constant(const Symbol& a);

Symbol operator+(const Symbol& a, const Symbol& b);
Symbol operator-(const Symbol& a, const Symbol& b);
Symbol operator*(const Symbol& a, const Symbol& b);
Symbol operator/(const Symbol& a, const Symbol& b);
Symbol operator-(const Symbol& a);
SymbolMask operator<(const Symbol& a, const Symbol& b);
SymbolMask operator<=(const Symbol& a, const Symbol& b);
SymbolMask operator>(const Symbol& a, const Symbol& b);
SymbolMask operator>=(const Symbol& a, const Symbol& b);
SymbolMask operator&&(const SymbolMask& a, const SymbolMask& b);
SymbolMask operator||(const SymbolMask& a, const SymbolMask& b);
SymbolMask operator!(const SymbolMask& a);
Symbol select(const SymbolMask& mask, const Symbol& a, const Symbol& b);

Symbol min(const Symbol& a, const Symbol& b);
Symbol max(const Symbol& a, const Symbol& b);
Symbol abs(const Symbol& a);
Symbol square(const Symbol& a);
Symbol freeze(const Symbol& a);
Symbol sqrt(const Symbol& a);
Symbol exp(const Symbol& a);
Symbol log(const Symbol& a);
Symbol sin(const Symbol& a);
Symbol cos(const Symbol& a);
Symbol tan(const Symbol& a);
Symbol asin(const Symbol& a);
Symbol acos(const Symbol& a);
Symbol floor(const Symbol& a);
Symbol atan2(const Symbol& y, const Symbol& x);
Symbol pow(const Symbol& a, const Symbol& b);
Symbol length(const Symbol& a, const Symbol& b);
Symbol length(const Symbol& a, const Symbol& b, const Symbol& c);
/// a within [-most, most], for an a that lies there but for rounding: its bounds are then finite.
/// NaN stays NaN.
Symbol within(const Symbol& a, double most);
/// a / b for a component a of a vector of length b.
Symbol cosine(const Symbol& a, const Symbol& b);

}  // namespace sardf

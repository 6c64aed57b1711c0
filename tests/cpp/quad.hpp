// Graphs evaluated to 33 digits, for errors that double arithmetic would hide.
#pragma once

#include <cmath>
#include <unordered_map>
#include <vector>

#include "sardf/graph.hpp"
#include "sardf/numbers/replay.hpp"

namespace sardf {

struct Quad {
  __float128 v = 0;

  Quad() = default;
  Quad(double a) : v(a) {}
  static Quad of(__float128 a) {
    Quad q;
    q.v = a;
    return q;
  }
  explicit operator double() const { return double(v); }

  friend Quad operator+(Quad a, Quad b) { return of(a.v + b.v); }
  friend Quad operator-(Quad a, Quad b) { return of(a.v - b.v); }
  friend Quad operator*(Quad a, Quad b) { return of(a.v * b.v); }
  friend Quad operator/(Quad a, Quad b) { return of(a.v / b.v); }
  friend Quad operator-(Quad a) { return of(-a.v); }
  friend bool operator<(Quad a, Quad b) { return a.v < b.v; }
  friend bool operator<=(Quad a, Quad b) { return a.v <= b.v; }
};

inline Quad select(bool mask, Quad a, Quad b) { return mask ? a : b; }
inline Quad min(Quad a, Quad b) { return a < b ? a : b; }
inline Quad max(Quad a, Quad b) { return b < a ? a : b; }
inline Quad smaller(Quad a, Quad b) { return min(a, b); }
inline Quad larger(Quad a, Quad b) { return max(a, b); }
inline Quad abs(Quad a) { return a < 0.0 ? -a : a; }
inline Quad square(Quad a) { return a * a; }
inline Quad freeze(Quad a) { return a; }
inline Quad sqrt(Quad a) {
  // Newton's iteration doubles the digits of double's root twice.
  Quad root = std::sqrt(double(a));
  if (!(0.0 < root)) return root;
  for (int i = 0; i < 2; ++i) root = Quad(0.5) * (root + a / root);
  return root;
}
inline Quad length(Quad a, Quad b) { return sqrt(a * a + b * b); }
inline Quad length(Quad a, Quad b, Quad c) { return sqrt(a * a + b * b + c * c); }

/// What is not needed to 33 digits has 16.
#define SARDF_IN_DOUBLE(name) \
  inline Quad name(Quad a) { return std::name(double(a)); }
SARDF_IN_DOUBLE(exp)
SARDF_IN_DOUBLE(log)
SARDF_IN_DOUBLE(sin)
SARDF_IN_DOUBLE(cos)
SARDF_IN_DOUBLE(tan)
SARDF_IN_DOUBLE(asin)
SARDF_IN_DOUBLE(acos)
SARDF_IN_DOUBLE(floor)
#undef SARDF_IN_DOUBLE
inline Quad atan2(Quad a, Quad b) { return std::atan2(double(a), double(b)); }
inline Quad pow(Quad a, Quad b) { return std::pow(double(a), double(b)); }

inline Quad evaluate_in_quad(const Expression& f, const std::array<Quad, 3>& at) {
  std::unordered_map<const Node*, Quad> found;
  for (const Node* node : topological_order({&f, 1})) {
    if (node->type != Node::Type::operation) {
      found[node] = node->type == Node::Type::constant ? Quad(node->value) : at[node->axis];
      continue;
    }
    std::vector<Quad> inputs;
    for (const Expression& input : node->arguments()) inputs.push_back(found.at(input.get()));
    Trace trace(node->arity);
    node->operation->record(trace);
    found[node] = replay<Quad>(trace, inputs);
  }
  return found.at(f.get());
}

}  // namespace sardf

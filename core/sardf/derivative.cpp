#include "sardf/derivative.hpp"

#include <cmath>
#include <unordered_map>

#include "sardf/arithmetic.hpp"
#include "sardf/error.hpp"
#include "sardf/numbers/gradient.hpp"
#include "sardf/numbers/replay.hpp"
#include "sardf/numbers/series.hpp"
#include "sardf/symbol.hpp"

namespace sardf {

namespace {

Expression known_derivative(const Node& node, int input) {
  const Expression by = node.operation->derivative(input, node.arguments());
  if (by) return by;
  const std::string reason = node.operation->no_derivatives();
  throw Error(!reason.empty()
                  ? reason
                  : "the derivative of '" + node.operation->info().name + "' is not known");
}

template <class V>
V replayed(const Operation& operation, std::span<const V> inputs) {
  Trace trace(int(inputs.size()), Trace::Detail::differentiable);
  operation.record(trace);
  return replay(trace, inputs);
}

// The length of a constant vector, a little more than it may be rounded to; infinite for others.
double constant_length(std::span<const Symbol> vector) {
  double squares = 0;
  for (const Symbol& a : vector) {
    squares += is_constant(a) ? a.node->value * a.node->value : infinity;
  }
  const double length = std::sqrt(squares);
  // A direction that was normalised counts as one.
  return std::abs(length - 1) < 1e-12 ? 1 : length * (1 + 1e-12);
}

/// Derivatives by N variables on which the coordinates depend.
template <int N>
class Forward {
 public:
  using Dual = Gradient<Symbol, N>;
  using Derivatives = std::array<Symbol, N>;

  /// seeds[i]: the derivatives of coordinate i.
  explicit Forward(const std::array<Derivatives, 3>& seeds) : seeds_(seeds) {}

  std::vector<Derivatives> of(std::span<const Expression> roots) {
    for (const Node* node : topological_order(roots)) {
      if (node->coordinates) found_[node] = derivatives(*node);
    }
    std::vector<Derivatives> out;
    for (const Expression& root : roots) out.push_back(at(root));
    return out;
  }

 private:
  Derivatives at(const Expression& e) const {
    const auto found = found_.find(e.get());
    return found == found_.end() ? Derivatives{} : found->second;
  }

  Derivatives derivatives(const Node& node) const {
    if (node.type == Node::Type::coordinate) return seeds_[node.axis];
    std::array<Dual, max_arity> in;
    for (size_t k = 0; k < node.arity; ++k) {
      in[k].v = Symbol(node.inputs[k]);
      in[k].d = at(node.inputs[k]);
    }
    const std::span<const Dual> inputs(in.data(), node.arity);
    Derivatives out = node.operation->has_formula() ? replayed<Dual>(*node.operation, inputs).d
                                                    : by_chain_rule(node, inputs);
    if (node.operation->is_distance()) limit(out, inputs);
    return out;
  }

  static Derivatives by_chain_rule(const Node& node, std::span<const Dual> inputs) {
    Derivatives out;
    for (size_t k = 0; k < inputs.size(); ++k) {
      bool varies = false;
      for (const Symbol& d : inputs[k].d) varies = varies || !is_zero(d);
      if (!varies) continue;
      const Symbol by(known_derivative(node, int(k)));
      for (size_t n = 0; n < N; ++n) out[n] = out[n] + by * inputs[k].d[n];
    }
    return out;
  }

  // A distance changes by no more than its point moves. The quotients of its formula have no finite
  // bounds near its points; with this they have.
  static void limit(Derivatives& derivatives, std::span<const Dual> inputs) {
    for (size_t n = 0; n < N; ++n) {
      std::vector<Symbol> moves;
      for (const Dual& input : inputs) moves.push_back(input.d[n]);
      const double most = constant_length(moves);
      if (most < infinity) derivatives[n] = within(derivatives[n], most);
    }
  }

  std::array<Derivatives, 3> seeds_;
  std::unordered_map<const Node*, Derivatives> found_;
};

using Coefficients = Series<Symbol>;
using SeriesOfNodes = std::unordered_map<const Node*, Coefficients>;

/// The Taylor series of the nodes of some expressions along a direction.
class Along {
 public:
  explicit Along(const std::array<Expression, 3>& direction) : direction_(direction) {}

  SeriesOfNodes of(std::span<const Expression> roots, int order) {
    const std::vector<const Node*> nodes = topological_order(roots);
    const SeriesOfNodes slopes = order > 1 ? of(slopes_of_opaque(nodes), order - 1) : none();
    SeriesOfNodes found;
    std::unordered_map<const Node*, Expression> handles;
    for (const Expression& root : roots) handles[root.get()] = root;
    for (const Node* node : nodes) {
      for (const Expression& input : node->arguments()) handles.try_emplace(input.get(), input);
    }
    for (const Node* node : nodes) {
      const Coefficients made = series(*node, order, found, slopes);
      found[node] = made.with_value(Symbol(handles.at(node)));
    }
    return found;
  }

 private:
  static SeriesOfNodes none() { return {}; }

  static std::vector<Expression> slopes_of_opaque(std::span<const Node* const> nodes) {
    std::vector<Expression> slopes;
    for (const Node* node : nodes) {
      if (!is_opaque(*node)) continue;
      for (int k = 0; k < node->arity; ++k) {
        if (node->inputs[size_t(k)]->coordinates) slopes.push_back(known_derivative(*node, k));
      }
    }
    return slopes;
  }

  static bool is_opaque(const Node& node) {
    return node.type == Node::Type::operation && node.coordinates && !node.operation->has_formula();
  }

  Coefficients series(const Node& node, int order, const SeriesOfNodes& found,
                      const SeriesOfNodes& slopes) const {
    if (!node.coordinates) return {};
    if (node.type == Node::Type::coordinate) {
      return {{Symbol(), Symbol(direction_[node.axis])}, order};
    }
    std::vector<Coefficients> inputs;
    for (const Expression& input : node.arguments()) inputs.push_back(found.at(input.get()));
    if (!is_opaque(node)) return replayed<Coefficients>(*node.operation, inputs);
    return by_chain_rule(node, order, inputs, slopes);
  }

  // s f' = Σ (∂f/∂input) s input', with the series of the slopes one order shorter.
  static Coefficients by_chain_rule(const Node& node, int order,
                                    std::span<const Coefficients> inputs,
                                    const SeriesOfNodes& slopes) {
    std::vector<Symbol> c(size_t(order) + 1);
    for (size_t k = 0; k < inputs.size(); ++k) {
      if (inputs[k].degree() == 0) continue;
      const Expression by = known_derivative(node, int(k));
      const Coefficients slope = order > 1 ? slopes.at(by.get()) : Coefficients();
      for (int n = 1; n <= order; ++n) {
        for (int i = 1; i <= n; ++i) {
          const Symbol factor = i == n ? Symbol(by) : slope[n - i];
          c[size_t(n)] = c[size_t(n)] + Symbol(double(i) / n) * inputs[k][i] * factor;
        }
      }
    }
    return {std::move(c), order};
  }

  std::array<Expression, 3> direction_;
};

}  // namespace

Expression derivative(const Expression& f, int axis) {
  Vec3 unit{};
  unit[size_t(axis)] = 1;
  return derivative(f, unit);
}

Expression derivative(const Expression& f, const Vec3& along) {
  Forward<1> forward({{{Symbol(along[0])}, {Symbol(along[1])}, {Symbol(along[2])}}});
  return forward.of({&f, 1})[0][0].node;
}

std::vector<std::array<Expression, 3>> gradients(std::span<const Expression> fs) {
  Forward<3> forward({{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}});
  std::vector<std::array<Expression, 3>> out;
  for (const auto& [x, y, z] : forward.of(fs)) out.push_back({x.node, y.node, z.node});
  return out;
}

std::array<Expression, 3> gradient(const Expression& f) { return gradients({&f, 1})[0]; }

Expression gradient_length(const std::array<Expression, 3>& gradient) {
  std::vector<Expression> parts;
  for (const Expression& part : gradient) {
    if (!is_zero(Symbol(part))) parts.push_back(part);
  }
  if (parts.empty()) return constant(0);
  if (parts.size() == 1) return abs(parts[0]);
  if (parts.size() == 2) return length(parts[0], parts[1]);
  return function("length3", {parts[0], parts[1], parts[2]});
}

std::vector<Expression> directional_series(const Expression& f,
                                           const std::array<Expression, 3>& direction, int order) {
  if (order == 0) return {f};
  const Coefficients series = Along(direction).of({&f, 1}, order).at(f.get());
  std::vector<Expression> out;
  for (int k = 0; k <= order; ++k) out.push_back(series[k].node);
  return out;
}

namespace {

bool is_call_of(const Expression& e, const char* name) {
  return e->type == Node::Type::operation && e->operation->info().name == name;
}

// p - u du, where du is (p - n) / u: n.
Expression nearest_in(const Expression& p, const Expression& u, const Expression& du) {
  if (!is_call_of(du, "divide") || du->inputs[1] != u) return nullptr;
  const Expression& apart = du->inputs[0];
  return is_call_of(apart, "subtract") && apart->inputs[0] == p ? apart->inputs[1] : nullptr;
}

}  // namespace

std::array<Expression, 3> foot(const Expression& distance) {
  std::array<Expression, 3> out;
  const bool is_searched = distance->type == Node::Type::operation && distance->arity == 3 &&
                           !distance->operation->has_formula();
  const std::array<Expression, 3> slopes = gradient(distance);
  for (int axis = 0; axis < 3; ++axis) {
    const Expression p = coordinate(axis);
    const Expression known =
        is_searched
            ? nearest_in(p, distance, distance->operation->derivative(axis, distance->arguments()))
            : nullptr;
    const Symbol u(distance), at_point(p);
    const Symbol nearest = at_point - u * Symbol(slopes[size_t(axis)]);
    const SymbolMask is_there = u <= Symbol(0.0) && Symbol(0.0) <= u;
    out[size_t(axis)] = known ? known : select(is_there, at_point, nearest).node;
  }
  return out;
}

}  // namespace sardf

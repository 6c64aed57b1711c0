#include "povray_gen/sharp_edges.hpp"

#include <unordered_map>
#include <vector>

#include "sardf/arithmetic.hpp"
#include "sardf/operation_of.hpp"
#include "sardf/ops.hpp"

namespace sardf::povray {

namespace {

/// The struct that the operation is made of; null if it is another operation.
template <class Op>
const Op* as(const Operation& operation) {
  const bool is_one = dynamic_cast<const OperationOf<Op>*>(&operation) != nullptr;
  return is_one ? static_cast<const Op*>(operation.object()) : nullptr;
}

template <template <class> class Of>
bool is_sharp_join(const Operation& operation) {
  return as<Of<MinMax>>(operation) || as<Of<Sardf>>(operation) || as<Of<SardfC1>>(operation);
}

/// How far inside two planes at `center`, `size` apart.
Expression between(const Expression& x, double center, double size) {
  return constant(0.5 * size) - abs(x - constant(center));
}

// A bar without its caps and, along its axis, how far inside them.
Expression capped(const Cylinder& bar, std::span<const Expression> at) {
  Cylinder endless;
  endless.center = bar.center;
  endless.axis = bar.axis;
  endless.radius = bar.radius;
  HalfSpace along;
  along.point = bar.center;
  along.normal = bar.axis;
  const Expression height = call(make_operation(along), {at[0], at[1], at[2]});
  return min(call(make_operation(endless), {at[0], at[1], at[2]}),
             constant(0.5 * *bar.height) - abs(height));
}

/// Of one operation on these inputs; `sharp`: fields with the inputs' signs.
Expression sharpened(const Node& node, std::span<const Expression> sharp) {
  const Operation& operation = *node.operation;
  const std::span<const Expression> in = node.arguments();
  if (is_sharp_join<IntersectionOf>(operation) || as<PerpendicularIntersection>(operation) ||
      as<Min>(operation)) {
    return min(sharp[0], sharp[1]);
  }
  if (is_sharp_join<UnionOf>(operation) || as<Max>(operation)) return max(sharp[0], sharp[1]);
  if (is_sharp_join<DifferenceOf>(operation)) return min(sharp[0], -sharp[1]);
  if (as<Negate>(operation)) return -sharp[0];
  if (as<Multiply>(operation) && is_constant(in[0]) && in[0]->value > 0) return in[0] * sharp[1];
  if (const auto* box = as<Box>(operation)) {
    return min(min(between(in[0], box->center[0], box->size[0]),
                   between(in[1], box->center[1], box->size[1])),
               between(in[2], box->center[2], box->size[2]));
  }
  if (const auto* box = as<Box2d>(operation)) {
    return min(between(in[0], box->center[0], box->size[0]),
               between(in[1], box->center[1], box->size[1]));
  }
  if (const auto* bar = as<Cylinder>(operation); bar && bar->height) return capped(*bar, in);
  return nullptr;
}

}  // namespace

Expression with_sharp_edges(const Expression& solid) {
  std::unordered_map<const Node*, Expression> known;
  // Nodes are kept alive by the solid.
  for (const Node* node : topological_order({&solid, 1})) {
    for (const Expression& input : node->arguments()) known.try_emplace(input.get(), input);
    if (node->type != Node::Type::operation) continue;
    std::vector<Expression> inputs;
    for (const Expression& input : node->arguments()) inputs.push_back(known.at(input.get()));
    if (Expression sharp = sharpened(*node, inputs)) known[node] = std::move(sharp);
  }
  const auto found = known.find(solid.get());
  return found == known.end() ? solid : found->second;
}

}  // namespace sardf::povray

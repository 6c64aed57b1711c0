#include "sardf/shapes_combine.hpp"

#include "sardf/arithmetic.hpp"

namespace sardf {

namespace {

Expression folded(const std::vector<Field>& of, const OperationPointer& operation) {
  Expression result = of[0].expression();
  for (size_t i = 1; i < of.size(); ++i) result = call(operation, {result, of[i].expression()});
  return result;
}

Exactness worse(Exactness a, Exactness b) { return std::max(a, b); }

// min of exact distances is exact inside and a bound outside; any other blend proves neither.
Quality intersected(const Quality& a, const Quality& b, const Blend& blend) {
  if (!blend.is_min_max) return {};
  return {worse(a.inside, b.inside), worse(Exactness::bound, worse(a.outside, b.outside))};
}

Quality swapped(const Quality& q) { return {q.outside, q.inside}; }

}  // namespace

Expression Union::expression() const { return folded(of, blend->unite); }

Quality Union::quality() const {
  Quality q = of[0].quality();
  for (size_t i = 1; i < of.size(); ++i) {
    q = swapped(intersected(swapped(q), swapped(of[i].quality()), *blend));
  }
  return q;
}

Expression Intersection::expression() const { return folded(of, blend->intersection); }

Quality Intersection::quality() const {
  Quality q = of[0].quality();
  for (size_t i = 1; i < of.size(); ++i) q = intersected(q, of[i].quality(), *blend);
  return q;
}

Expression Difference::expression() const { return folded(of, blend->difference); }

Quality Difference::quality() const {
  Quality q = of[0].quality();
  for (size_t i = 1; i < of.size(); ++i) q = intersected(q, swapped(of[i].quality()), *blend);
  return q;
}

Expression Complement::expression() const { return -field.expression(); }
Quality Complement::quality() const { return swapped(field.quality()); }

Expression Offset::expression() const { return field.expression() + constant(distance); }

// Level sets of an exact distance are offsets on the side that the surface moves away to; on the
// other side the field only bounds the distance. Without an exact distance nothing is proven.
Quality Offset::quality() const {
  const Quality q = field.quality();
  const bool exact = q.inside == Exactness::exact && q.outside == Exactness::exact;
  if (distance == 0) return q;
  if (!exact) return {};
  return distance > 0 ? Quality{Exactness::bound, Exactness::exact}
                      : Quality{Exactness::exact, Exactness::bound};
}

Expression Shell::expression() const {
  double shift = 0;
  if (side == "inside") {
    shift = -0.5 * thickness;
  } else if (side == "outside") {
    shift = 0.5 * thickness;
  } else if (side != "centred") {
    throw Error("side is '" + side + "'; accepted are 'inside', 'outside' and 'centred'" +
                did_you_mean(side, {"inside", "outside", "centred"}));
  }
  return constant(0.5 * thickness) - abs(field.expression() + constant(shift));
}

Quality Shell::quality() const {
  const Quality q = field.quality();
  const bool exact = q.inside == Exactness::exact && q.outside == Exactness::exact;
  return exact ? Quality{Exactness::bound, Exactness::exact} : Quality{};
}

Expression WithBlend::expression() const { return joined_by(*blend, field.expression()); }

namespace {

// The field made once more with another blend; empty where it is not made by constructors alone, or
// too deep to be worth it.
Field remade(const Field& field, const BlendPointer& blend, int depth) {
  const Construction* made = field.construction();
  if (depth == 0 || !made || !made->constructor) return {};
  std::vector<Value> arguments = made->arguments;
  for (Value& value : arguments) {
    if (std::holds_alternative<BlendPointer>(value)) value = blend;
    if (auto* one = std::get_if<Field>(&value)) {
      *one = remade(*one, blend, depth - 1);
      if (!*one) return {};
    }
    if (auto* all = std::get_if<std::vector<Field>>(&value)) {
      for (Field& each : *all) {
        each = remade(each, blend, depth - 1);
        if (!each) return {};
      }
    }
    if (std::holds_alternative<std::vector<PlaneSection>>(value) ||
        std::holds_alternative<RulePointer>(value)) {
      return {};
    }
  }
  return made->constructor->make(*made->constructor, std::move(arguments));
}

}  // namespace

// A tree of other blends is another field; only with minima and maxima is anything known of it.
Quality WithBlend::quality() const {
  const Expression joined = expression();
  if (joined == field.expression()) return field.quality();
  if (!blend->is_min_max) return {};
  constexpr int deepest = 30;
  const Field again = remade(field, blend, deepest);
  return again && again.expression() == joined ? again.quality() : Quality{};
}

Expression BlendError::expression() const {
  return field.expression() - without_blends(field.expression());
}

}  // namespace sardf

#include "sardf/shapes_normalize.hpp"

#include <cmath>

#include "sardf/arithmetic.hpp"
#include "sardf/derivative.hpp"
#include "sardf/operation_of.hpp"
#include "sardf/ops_blends.hpp"
#include "sardf/symbol.hpp"

namespace sardf {

namespace {

using Vector = std::array<Symbol, 3>;

Vector operator*(const Symbol& s, const Vector& v) { return {s * v[0], s * v[1], s * v[2]}; }
Vector operator-(const Vector& a, const Vector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

// √(f² + g_x² + g_y² + g_z²), with a derivative wherever it is not 0.
Symbol length_of(const Symbol& f, const Vector& g) {
  Symbol whole = abs(f);
  std::vector<Symbol> parts{f};
  for (const Symbol& part : g) {
    if (!is_zero(part)) parts.push_back(part);
  }
  if (parts.size() == 2) whole = length(parts[0], parts[1]);
  if (parts.size() > 2) whole = length(parts[0], parts[1], parts[2]);
  return parts.size() > 3 ? length(whole, parts[3]) : whole;
}

Symbol where_positive(const Symbol& a, const Symbol& b, const Symbol& otherwise) {
  return select(Symbol(0.0) < a, b, otherwise);
}

// f / √(f² + |g|²). Where f has no gradient, as a distance in the middle of its feature, it counts
// as one of length 1; where f is 0, the result is 0.
Symbol step(const Symbol& f, const Vector& g) {
  const Symbol whole = length_of(f, g);
  return where_positive(whole, cosine(f, whole), cosine(f, length(f, Symbol(1.0))));
}

/// A field and its gradient, at points that are expressions.
class Smooth {
 public:
  explicit Smooth(const Expression& f) : f_(f), gradient_(gradient(f)) {}

  Symbol value(const Vector& at) const { return Symbol(substitute(f_, nodes(at))); }
  Vector gradient_at(const Vector& at) const {
    const std::vector<Expression> g = substitute(gradient_, nodes(at));
    return {Symbol(g[0]), Symbol(g[1]), Symbol(g[2])};
  }

 private:
  static std::array<Expression, 3> nodes(const Vector& v) {
    return {v[0].node, v[1].node, v[2].node};
  }

  Expression f_;
  std::array<Expression, 3> gradient_;
};

// The distance s along a ray p - s n to the zero of f, n the unit gradient at a point q. With q at
// the foot of p but for an error e, n turns by O(e), and s is the distance but for O(s e²). Taking
// p - s n for the next q brings e to O(s e). It starts with q = p, e = O(s): the error of s is then
// of order 3, 5, 7, ... A Newton step for each n keeps up, since its slope is taken at q. All costs
// one gradient and two values more for two orders more.
//
// √(f² + |grad f|²) stands for |grad f| throughout: f(q) soon is small of higher order, and nothing
// is divided by 0 where the gradient vanishes.
Expression normalized(const Expression& field, int order) {
  const Smooth f(field);
  const Vector p{Symbol(coordinate(0)), Symbol(coordinate(1)), Symbol(coordinate(2))};
  Vector q = p, n{};
  Symbol s;
  for (int reached = 0; reached < order; reached += 2) {
    const Symbol value = f.value(q);
    const Vector slope = f.gradient_at(q);
    const Symbol whole = length_of(value, slope);
    for (size_t axis = 0; axis < 3; ++axis) {
      // Without a gradient the last direction stays.
      n[axis] = where_positive(whole, cosine(slope[axis], whole), n[axis]);
    }
    if (reached == 0) s = step(value, slope);
    if (order == 1) break;
    s = s + step(f.value(p - s * n), slope);
    q = p - s * n;
  }
  return s.node;
}

}  // namespace

Expression Normalized::expression() const {
  if (order > 12) {
    throw Error("order is " + std::to_string(int64_t(std::min(order, 1e9))) +
                "; 1 to 12 are accepted");
  }
  return normalized(field.expression(), int(order));
}

Expression REquivalence::expression() const {
  Equivalence pair;
  pair.order = order;
  const OperationPointer join = make_operation(pair);
  Expression joined = of[0].expression();
  for (size_t i = 1; i < of.size(); ++i) joined = call(join, {joined, of[i].expression()});
  return joined;
}

Quality REquivalence::quality() const {
  Exactness how = of.size() == 1 ? Exactness::exact : Exactness::bound;
  for (const Field& u : of) {
    how = std::max({how, u.quality().inside, u.quality().outside});
  }
  return {how, how};
}

namespace {

Expression trimmed(const Symbol& f, const Symbol& t) {
  const Symbol squared = square(f), whole = length(t, squared);
  // √(t² + f⁴) - t without cancellation where t > 0.
  const Symbol beyond = select(Symbol(0.0) < t, squared * cosine(squared, whole + t), whole - t);
  return length(f, Symbol(0.5) * beyond).node;
}

}  // namespace

Expression Trimmed::expression() const {
  return trimmed(Symbol(field.expression()), Symbol(by.expression()));
}

Expression TrimmedSegment::expression() const {
  const double size = norm(b - a);
  if (!(size > 0)) throw Error("a and b are the same point; a segment needs two");
  const Vec3 along = (1 / size) * (b - a), middle = 0.5 * (a + b);
  // Two directions perpendicular to it and to each other.
  const Vec3 least = std::abs(along[2]) < 0.9 ? Vec3{0, 0, 1} : Vec3{1, 0, 0};
  const Vec3 side = sardf::normalized(cross(along, least)), other = cross(along, side);
  const std::array<Expression, 3> xyz{coordinate(0), coordinate(1), coordinate(2)};
  const auto across = [&](const Vec3& row) { return Symbol(affine(xyz, row, -dot(row, a))); };
  const Symbol from_line = length(across(side), across(other));
  Symbol squares;
  for (size_t i = 0; i < 3; ++i) {
    squares = squares + square(Symbol(xyz[i]) - Symbol(middle[i]));
  }
  return trimmed(from_line, (Symbol(size * size / 4) - squares) / Symbol(size));
}

}  // namespace sardf

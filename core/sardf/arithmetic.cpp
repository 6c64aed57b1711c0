#include "sardf/arithmetic.hpp"

#include "sardf/constructor.hpp"
#include "sardf/operation_of.hpp"
#include "sardf/ops_domain.hpp"
#include "sardf/ops_functions.hpp"

namespace sardf {

namespace {

bool equals(const Expression& e, double value) { return is_constant(e) && e->value == value; }

}  // namespace

Expression function(const char* name, std::initializer_list<Expression> inputs) {
  return call(find_function(name), inputs);
}

Expression operator+(const Expression& a, const Expression& b) {
  if (equals(a, 0)) return b;
  if (equals(b, 0)) return a;
  return function("add", {a, b});
}
Expression operator-(const Expression& a, const Expression& b) {
  if (equals(b, 0)) return a;
  return equals(a, 0) ? -b : function("subtract", {a, b});
}
Expression operator*(const Expression& a, const Expression& b) {
  if (equals(a, 1)) return b;
  if (equals(b, 1)) return a;
  return a == b ? function("square", {a}) : function("multiply", {a, b});
}
Expression operator/(const Expression& a, const Expression& b) {
  return equals(b, 1) ? a : function("divide", {a, b});
}
Expression operator-(const Expression& a) { return function("negate", {a}); }
Expression min(const Expression& a, const Expression& b) { return function("min", {a, b}); }
Expression max(const Expression& a, const Expression& b) { return function("max", {a, b}); }
Expression abs(const Expression& a) { return function("abs", {a}); }
Expression exp(const Expression& a) { return function("exp", {a}); }
Expression log(const Expression& a) { return function("log", {a}); }
Expression length(const Expression& a, const Expression& b) { return function("length2", {a, b}); }

Expression pow(const Expression& a, const Expression& b) {
  if (is_constant(b) && b->value == std::floor(b->value) && std::abs(b->value) <= 64) {
    if (b->value == 0) return constant(1);
    if (b->value == 1) return a;
    if (b->value == 2) return function("square", {a});
    IntegerPower power;
    power.exponent = int(std::abs(b->value));
    const Expression whole = call(make_operation(power), {a});
    return b->value > 0 ? whole : constant(1) / whole;
  }
  return function("pow", {a, b});
}

Expression less(const Expression& a, const Expression& b) { return function("less", {a, b}); }
Expression less_equal(const Expression& a, const Expression& b) {
  return function("less_equal", {a, b});
}
Expression select(const Expression& condition, const Expression& b, const Expression& c) {
  if (b == c) return b;
  return function("select", {condition, b, c});
}

Expression affine(const std::array<Expression, 3>& xyz, const Vec3& row, double offset) {
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 unit{};
    unit[axis] = 1;
    if (row == unit) return xyz[axis] + constant(offset);
  }
  Affine map;
  map.row = row;
  map.offset = offset;
  // What does not count is no input: a plane field turned about z stays one.
  std::array<Expression, 3> used;
  for (int axis = 0; axis < 3; ++axis) used[axis] = row[axis] == 0 ? constant(0) : xyz[axis];
  return call(make_operation(map), used);
}

}  // namespace sardf

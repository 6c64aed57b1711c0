#include "sardf/inverse_shares.hpp"

#include <algorithm>
#include <cmath>

#include "sardf/arithmetic.hpp"
#include "sardf/operation_of.hpp"
#include "sardf/ops_features.hpp"
#include "sardf/ops_weights.hpp"

namespace sardf {

namespace {

constexpr double highest_power = 8;
// Below this a distance has the root of this: a root's derivative at 0 is infinite.
constexpr double least_rooted = 1e-30;

bool is_call_of(const Expression& e, const char* name) {
  return e->type == Node::Type::operation && e->operation->info().name == name;
}

// The square of a distance, without its root where that is known.
Expression squared(const Expression& u) {
  if (is_call_of(u, Point::name)) {
    PointSquared op;
    std::copy_n(u->operation->numbers().begin(), 3, op.at.begin());
    return call(make_operation(op), u->arguments());
  }
  return function("square", {is_call_of(u, "abs") ? u->inputs[0] : u});
}

Expression rooted(const Expression& u) {
  return function("sqrt", {function("max", {u, constant(least_rooted)})});
}

template <int N, int I>
OperationPointer share(int exponent, double least) {
  InverseShare<N, I> op;
  op.exponent = exponent;
  op.least = least;
  return make_operation(op);
}

template <int... I>
std::vector<Expression> shares_of(const std::vector<Expression>& u, int exponent, double least,
                                  std::integer_sequence<int, I...>) {
  return {call(share<sizeof...(I), I>(exponent, least), u)...};
}

constexpr size_t most_summed = 4;

template <int N>
OperationPointer sum_with(std::span<const double> factors) {
  WeightedSum<N> op;
  std::copy_n(factors.begin(), N, op.factors.begin());
  return make_operation(op);
}

// Of at most most_summed.
Expression sum_of(std::span<const Expression> values, std::span<const double> factors) {
  switch (values.size()) {
    case 1:
      return values[0] * constant(factors[0]);
    case 2:
      return call(sum_with<2>(factors), values);
    case 3:
      return call(sum_with<3>(factors), values);
    default:
      return call(sum_with<4>(factors), values);
  }
}

}  // namespace

std::vector<Expression> inverse_shares(std::vector<Expression> u, double exponent, double least) {
  const size_t n = u.size();
  if (n < 2 || n > 4 || 2 * exponent != std::floor(2 * exponent)) return {};
  if (!(exponent >= 1 && exponent * double(n - 1) <= highest_power)) return {};
  int power = static_cast<int>(exponent);
  if (power != exponent) {
    power = static_cast<int>(2 * exponent);
    least = std::sqrt(std::max(least, least_rooted));
    for (Expression& each : u) each = rooted(each);
  } else if (power % 2 == 0) {
    power /= 2;
    least *= least;
    for (Expression& each : u) each = squared(each);
  }
  return n == 2   ? shares_of(u, power, least, std::make_integer_sequence<int, 2>())
         : n == 3 ? shares_of(u, power, least, std::make_integer_sequence<int, 3>())
                  : shares_of(u, power, least, std::make_integer_sequence<int, 4>());
}

Expression weighted_sum(std::span<const Expression> values, std::span<const double> factors) {
  std::vector<Expression> counted;
  std::vector<double> by;
  for (size_t i = 0; i < values.size(); ++i) {
    if (factors[i] == 0) continue;
    counted.push_back(values[i]);
    by.push_back(factors[i]);
  }
  Expression total = constant(0);
  for (size_t next = 0; next < by.size(); next += most_summed) {
    const size_t n = std::min(most_summed, by.size() - next);
    total = total + sum_of(std::span(counted).subspan(next, n), std::span(by).subspan(next, n));
  }
  return total;
}

}  // namespace sardf

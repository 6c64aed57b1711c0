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

template <int N>
std::vector<Expression> shares_of(std::vector<Expression> u, int exponent, double least) {
  InverseShare<N> op;
  op.exponent = exponent;
  op.least = least;
  const OperationPointer share = make_operation(op);
  std::vector<Expression> shares;
  for (size_t i = 0; i < N; ++i) {
    std::swap(u[0], u[i]);
    shares.push_back(call(share, u));
    std::swap(u[0], u[i]);
  }
  return shares;
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
  return n == 2   ? shares_of<2>(u, power, least)
         : n == 3 ? shares_of<3>(u, power, least)
                  : shares_of<4>(u, power, least);
}

Expression weighted_sum(std::span<const Expression> values, std::span<const double> factors) {
  std::vector<size_t> counted;
  for (size_t i = 0; i < values.size(); ++i)
    if (factors[i] != 0) counted.push_back(i);
  Expression total = constant(0);
  size_t next = 0;
  for (; next + 3 <= counted.size(); next += 3) {
    const size_t a = counted[next], b = counted[next + 1], c = counted[next + 2];
    WeightedSum op;
    op.factors = {factors[a], factors[b], factors[c]};
    total = total + call(make_operation(op), {values[a], values[b], values[c]});
  }
  for (; next < counted.size(); ++next)
    total = total + values[counted[next]] * constant(factors[counted[next]]);
  return total;
}

}  // namespace sardf

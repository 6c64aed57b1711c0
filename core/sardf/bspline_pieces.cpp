#include "sardf/bspline_pieces.hpp"

#include <algorithm>
#include <cstdio>

#include "sardf/error.hpp"
#include "sardf/short_number.hpp"

namespace sardf {

namespace {

int checked_degree(const Direction& direction) {
  const double degree = direction.degree;
  if (!(degree >= 1 && degree <= most_degree && degree == std::floor(degree))) {
    throw Error("degree" + direction.suffix + " is " + short_number(degree, 6) +
                "; a whole number from 1 to " + std::to_string(most_degree) + " is accepted");
  }
  return int(degree);
}

void check_knots(const Direction& direction, size_t count, int degree) {
  const std::vector<double>& knots = direction.knots;
  const std::string name = "knots" + direction.suffix;
  if (direction.closed) {
    throw Error(name + " are given and closed" + direction.suffix +
                " is true; a closed B-spline has uniform knots of its own, so leave one out");
  }
  const size_t needed = count + size_t(degree) + 1;
  if (knots.size() != needed) {
    throw Error(name + " has " + std::to_string(knots.size()) + " elements; " +
                std::to_string(count) + " control points and degree " + std::to_string(degree) +
                " need " + std::to_string(needed));
  }
  for (size_t i = 1; i < knots.size(); ++i) {
    if (knots[i] < knots[i - 1]) {
      throw Error(name + " falls from " + short_number(knots[i - 1], 6) + " to " +
                  short_number(knots[i], 6) + " at element " + std::to_string(i) +
                  "; knots that never fall are accepted");
    }
  }
  if (!(knots[count] > knots[size_t(degree)])) {
    throw Error(name + " leaves no length between element " + std::to_string(degree) + " and " +
                std::to_string(count) + ", where the B-spline is defined");
  }
}

std::vector<double> knots_of(const Direction& direction, size_t count, int degree) {
  if (!direction.knots.empty()) return direction.knots;
  // Closed: the first control points come once more at the end.
  const size_t all = direction.closed ? count + size_t(degree) : count;
  std::vector<double> knots(all + size_t(degree) + 1);
  for (size_t i = 0; i < knots.size(); ++i) {
    const double knot = double(i) - degree;
    knots[i] = direction.closed ? knot : std::clamp(knot, 0.0, double(all) - degree);
  }
  return knots;
}

// The weight of control point k of the piece between knots `at` and `at + 1` in its polar form at
// `ones` times the right knot and else the left one.
double polar_weight(const std::vector<double>& knots, size_t at, int degree, int ones, int k) {
  std::array<double, most_degree + 1> d{};
  d[size_t(k)] = 1;
  for (int level = 1; level <= degree; ++level) {
    const double argument = level <= ones ? knots[at + 1] : knots[at];
    for (int j = degree; j >= level; --j) {
      const double left = knots[at - size_t(degree - j)];
      const double right = knots[at + size_t(j - level) + 1];
      const double share = (argument - left) / (right - left);
      d[size_t(j)] = (1 - share) * d[size_t(j - 1)] + share * d[size_t(j)];
    }
  }
  return d[size_t(degree)];
}

}  // namespace

std::vector<Span> spans_of(const Direction& direction, size_t count) {
  const int degree = checked_degree(direction);
  if (count < size_t(degree) + 1) {
    throw Error("there are " + std::to_string(count) + " control points" +
                (direction.suffix.empty() ? "" : " in direction " + direction.suffix.substr(1)) +
                "; degree " + std::to_string(degree) + " needs at least " +
                std::to_string(degree + 1));
  }
  if (!direction.knots.empty()) check_knots(direction, count, degree);
  const std::vector<double> knots = knots_of(direction, count, degree);
  std::vector<Span> spans;
  for (size_t at = size_t(degree); at + size_t(degree) + 1 < knots.size(); ++at) {
    if (!(knots[at] < knots[at + 1])) continue;
    Span span{at - size_t(degree), degree, {}};
    for (int j = 0; j <= degree; ++j) {
      for (int k = 0; k <= degree; ++k) {
        span.weights.push_back(polar_weight(knots, at, degree, j, k));
      }
    }
    spans.push_back(std::move(span));
  }
  return spans;
}

void split_bezier(const Weighted* points, int degree, size_t stride, double t, Weighted* left,
                  Weighted* right) {
  std::array<Weighted, most_degree + 1> work;
  for (int k = 0; k <= degree; ++k) work[size_t(k)] = points[size_t(k) * stride];
  for (int level = 0; level <= degree; ++level) {
    left[size_t(level) * stride] = work[0];
    right[size_t(degree - level) * stride] = work[size_t(degree - level)];
    for (int k = 0; k < degree - level; ++k) {
      const Weighted &a = work[size_t(k)], &b = work[size_t(k + 1)];
      work[size_t(k)] = (1 - t) * a + t * b;
    }
  }
}

Bernstein::Bernstein(int n, double t) : degree(n) {
  values[0] = 1;
  for (int d = 1; d <= n; ++d) {
    if (d == n) one_less = values;
    if (d == n - 1) two_less = values;
    double carried = 0;
    for (size_t k = 0; k < size_t(d); ++k) {
      const double value = values[k];
      values[k] = carried + (1 - t) * value;
      carried = t * value;
    }
    values[size_t(d)] = carried;
  }
}

Jet jet_of(const Weighted* points, const Bernstein& basis) {
  Jet jet;
  const size_t n = size_t(basis.degree);
  Weighted step{};
  for (size_t k = 0; k <= n; ++k) {
    jet.at = jet.at + basis.values[k] * points[k];
    if (k == n) break;
    const Weighted next = points[k + 1] - points[k];
    jet.first = jet.first + basis.one_less[k] * next;
    if (k > 0) jet.second = jet.second + basis.two_less[k - 1] * (next - step);
    step = next;
  }
  jet.first = double(n) * jet.first;
  jet.second = double(n * (n - 1)) * jet.second;
  return jet;
}

double unit_scale(double magnitude) {
  return magnitude > 0 ? std::exp2(-double(std::ilogb(magnitude))) : 1;
}

}  // namespace sardf

#include <cmath>
#include <cstdio>

#include "sardf/error.hpp"
#include "sardf/fit_system.hpp"

namespace sardf {

namespace {

constexpr size_t block = Evaluator::block_size;

Evaluator evaluator_of(const Expression& expression) {
  return expression ? Evaluator(expression) : Evaluator();
}

struct Points {
  double x[block], y[block], z[block];
};

struct WithGradient {
  double value[block], by[3][block];

  void fill(const Evaluator& of, const Points& at, size_t n, bool with_gradient) {
    if (with_gradient) {
      double* to[3] = {by[0], by[1], by[2]};
      of.gradient_block(at.x, at.y, at.z, n, value, to);
    } else {
      double* to = value;
      of.block(at.x, at.y, at.z, n, &to);
    }
  }
};

[[noreturn]] void not_finite(const char* what, const Vec3& at) {
  char text[160];
  std::snprintf(text, sizeof text, "%s is not a finite number at (%.6g, %.6g, %.6g)", what, at[0],
                at[1], at[2]);
  throw Error(text);
}

void check_finite(const char* name, const WithGradient& values, const Vec3* points, size_t n,
                  bool with_gradient) {
  for (size_t i = 0; i < n; ++i) {
    if (!std::isfinite(values.value[i])) not_finite(name, points[i]);
    if (!with_gradient) continue;
    if (!std::isfinite(values.by[0][i] + values.by[1][i] + values.by[2][i])) {
      not_finite((std::string("the gradient of ") + name).c_str(), points[i]);
    }
  }
}

}  // namespace

struct FitFields::Values {
  WithGradient start, factor, along;
  double values[block], slope[block];
};

FitFields::FitFields(const FitProblem& problem)
    : values_weight_(problem.values_weight),
      slope_weight_(problem.slope_weight),
      smoothness_(problem.smoothness),
      needs_slopes_(problem.slope || problem.smoothness > 0),
      start_(problem.start),
      factor_(problem.factor),
      values_(evaluator_of(problem.values)),
      slope_(evaluator_of(problem.slope)),
      along_(evaluator_of(problem.along)),
      has_values_(problem.values != nullptr),
      has_slope_(problem.slope != nullptr) {}

FitFields::Values FitFields::values_at(const Vec3* points, size_t n) const {
  Points at;
  for (size_t i = 0; i < n; ++i) {
    at.x[i] = points[i][0];
    at.y[i] = points[i][1];
    at.z[i] = points[i][2];
  }
  Values all;
  all.start.fill(start_, at, n, needs_slopes_);
  all.factor.fill(factor_, at, n, needs_slopes_);
  check_finite("start", all.start, points, n, needs_slopes_);
  check_finite("factor", all.factor, points, n, needs_slopes_);
  WithGradient plain;
  if (has_values_) {
    plain.fill(values_, at, n, false);
    check_finite("values", plain, points, n, false);
    std::copy_n(plain.value, n, all.values);
  }
  if (has_slope_) {
    plain.fill(slope_, at, n, false);
    check_finite("slope", plain, points, n, false);
    std::copy_n(plain.value, n, all.slope);
    all.along.fill(along_, at, n, true);
    check_finite("along", all.along, points, n, true);
  }
  return all;
}

namespace {

// Adds by * (row . v - wanted)².
void add_square(const double* row, double wanted, double by, FitFields::Density& to) {
  size_t entry = 0;
  for (int a = 0; a < 4; ++a) {
    to.linear[a] += by * row[a] * wanted;
    for (int b = a; b < 4; ++b) to.quadratic[entry++] += by * row[a] * row[b];
  }
  to.constant += by * wanted * wanted;
}

}  // namespace

FitFields::Density FitFields::density(const Values& v, size_t i) const {
  Density d{};
  d.start = v.start.value[i];
  d.factor = v.factor.value[i];
  if (has_values_) {
    const double row[4] = {d.factor, 0, 0, 0};
    add_square(row, v.values[i] - d.start, values_weight_, d);
  }
  if (has_slope_) {
    double row[4] = {}, wanted = v.slope[i];
    for (int k = 0; k < 3; ++k) {
      row[0] += v.factor.by[k][i] * v.along.by[k][i];
      row[k + 1] = d.factor * v.along.by[k][i];
      wanted -= v.start.by[k][i] * v.along.by[k][i];
    }
    add_square(row, wanted, slope_weight_, d);
  }
  for (int k = 0; k < 3 && smoothness_ > 0; ++k) {
    double row[4] = {v.factor.by[k][i], 0, 0, 0};
    row[k + 1] = d.factor;
    add_square(row, -v.start.by[k][i], smoothness_, d);
  }
  return d;
}

void FitFields::at(const Vec3* points, size_t n, Density* out) const {
  const Values values = values_at(points, n);
  for (size_t i = 0; i < n; ++i) out[i] = density(values, i);
}

}  // namespace sardf

#include "sardf/smooth_formula.hpp"

#include <algorithm>
#include <atomic>
#include <unordered_map>
#include <utility>

#include "sardf/data_operation.hpp"
#include "sardf/derivative.hpp"
#include "sardf/evaluate.hpp"
#include "sardf/shorten.hpp"

namespace sardf {

namespace {

// No two are the same, not even of one formula.
double serial() {
  static std::atomic<uint64_t> made{0};
  return double(++made);
}

// Where the entry of the Hessian stands among the nine derivatives.
int entry(int i, int j) {
  if (i > j) std::swap(i, j);
  return i == 0 ? 3 + j : 5 + i + j - 1;
}

std::vector<Expression> nine_derivatives(const std::array<Expression, 3>& first) {
  const auto second = gradients(first);
  return {first[0],     first[1],     first[2],     second[0][0], second[0][1],
          second[0][2], second[1][1], second[1][2], second[2][2]};
}

/// A formula of the three coordinates. It may be called with coordinates only.
class SmoothFormula final : public DataOperation {
 public:
  SmoothFormula(const Expression& f, const std::array<Expression, 3>& first)
      : DataOperation({"smooth_formula", Kind::internal, 3, "A formula without kinks."},
                      {serial()}),
        formula_(f),
        derivatives_(nine_derivatives(first)) {}

  // An evaluator within an evaluator must not use its blocks.
  using DataOperation::evaluate;
  void evaluate(const double* const* in, double* out, size_t n) const override {
    for (size_t i = 0; i < n; ++i) out[i] = formula_.value({in[0][i], in[1][i], in[2][i]});
  }
  void partials(const double* const* in, double* out, double* const* partial,
                size_t n) const override {
    for (size_t i = 0; i < n; ++i) {
      std::array<double, 9> all;
      const Vec3 at{in[0][i], in[1][i], in[2][i]};
      derivatives_.values(at, all.data());
      out[i] = formula_.value(at);
      for (int axis = 0; axis < 3; ++axis) partial[axis][i] = all[size_t(axis)];
    }
  }
  Interval interval(const Interval* in) const override {
    return formula_.interval(box_of({in[0], in[1], in[2]}));
  }
  Enclosure range(const Enclosure* in) const override {
    const Shortening here(formula_, box_of({in[0].value, in[1].value, in[2].value}));
    return {here.range(), here.may_be_nan()};
  }

  Slope slope(const Slope* in) const override {
    const BoundingBox box = box_of({in[0].value, in[1].value, in[2].value});
    Slope out = formula_.slope(box);
    std::array<Interval, 9> all, centre;
    derivatives_.intervals(box, all.data());
    const Vec3 middle = box.center();
    derivatives_.intervals({middle, middle}, centre.data());
    double most = 0;
    std::array<Interval, 3> away;
    for (int axis = 0; axis < 3; ++axis) away[axis] = in[axis].value - Interval(middle[axis]);
    for (const Interval& a : all) most = max(most, a.magnitude());
    // Without finite bounds the mean value theorem says nothing.
    if (!(most < infinity)) return out;
    Interval squared = 0;
    for (int i = 0; i < 3; ++i) {
      Interval partial = centre[i];
      for (int j = 0; j < 3; ++j) partial = partial + all[entry(i, j)] * away[j];
      out.partial[i] = intersect(out.partial[i], intersect(all[i], partial));
      squared = squared + square(centre[i]);
    }
    for (int j = 0; j < 3; ++j) {
      Interval rise = 0;
      for (int i = 0; i < 3; ++i) rise = rise + all[entry(i, j)] * out.partial[i];
      squared = squared + 2 * rise * away[j];
    }
    const Interval norm = length(out.partial[0], out.partial[1], out.partial[2]);
    out.length = min(min(out.length, norm.hi), sqrt(squared).hi);
    return out;
  }

 private:
  static BoundingBox box_of(const std::array<Interval, 3>& sides) {
    return {{sides[0].lo, sides[1].lo, sides[2].lo}, {sides[0].hi, sides[1].hi, sides[2].hi}};
  }

  Evaluator formula_, derivatives_;
};

/// What is known of a node, and what stands for it; null until that is asked for.
struct Part {
  bool is_smooth = true;
  Expression made;
};

// A formula without kinks; itself where it is linear, since its bounds are as good as they can be.
Expression bounded(const Expression& f) {
  const std::array<Expression, 3> first = gradient(f);
  if (std::all_of(first.begin(), first.end(), [](const auto& d) { return is_constant(d); })) {
    return f;
  }
  return call(std::make_shared<SmoothFormula>(f, first),
              {coordinate(0), coordinate(1), coordinate(2)});
}

}  // namespace

Expression with_smooth_bounds(const Expression& expression) {
  std::unordered_map<const Node*, Part> parts;
  const auto finished = [&](const Expression& node) {
    Part& part = parts.at(node.get());
    if (!part.made) part.made = bounded(node);
    return part.made;
  };
  for (const Node* node : topological_order({&expression, 1})) {
    Part& part = parts[node];
    if (node->type != Node::Type::operation) continue;
    part.is_smooth = node->operation->is_smooth();
    for (const Expression& input : node->arguments()) {
      part.is_smooth = part.is_smooth && parts.at(input.get()).is_smooth;
    }
    if (part.is_smooth) continue;
    std::vector<Expression> inputs;
    for (const Expression& input : node->arguments()) inputs.push_back(finished(input));
    parts.at(node).made = call(node->operation, inputs);
  }
  return finished(expression);
}

}  // namespace sardf

#include "sardf/certify.hpp"

#include <algorithm>
#include <memory>
#include <queue>
#include <unordered_map>
#include <utility>

#include "sardf/shorten.hpp"

namespace sardf {

namespace {

// Of the diagonal: parts that small are not split for a bound within a band.
constexpr double smallest_part = 1.0 / 400;

/// A value with and without blends: both lie in `value`, and differ by at most `error`.
struct Deviation {
  Interval value;
  double error = 0;
};

// The change that the inputs' errors cause: Operation::slope bounds it when errors stand in for
// gradient lengths (mean value theorem; the intervals hold both ends).
double passed_on(const Operation& operation, std::span<const Deviation> in) {
  std::array<Slope, max_arity> slopes;
  for (size_t k = 0; k < in.size(); ++k) {
    slopes[k].value = in[k].value;
    slopes[k].length = in[k].error;
    // Nothing is known of directions.
    if (in[k].error > 0) slopes[k].partial.fill(Interval::all());
  }
  return operation.slope(slopes.data()).length;
}

Deviation deviation_of(const Node& node, std::span<const Deviation> in) {
  if (node.type == Node::Type::constant) return {node.value, 0};
  if (node.type == Node::Type::coordinate) return {Interval::all(), 0};
  std::array<Interval, max_arity> values;
  double most = 0;
  for (size_t k = 0; k < in.size(); ++k) {
    values[k] = in[k].value;
    most = max(most, in[k].error);
  }
  Deviation out{node.operation->interval(values.data()), 0};
  const double own = node.operation->blend_error();
  // A blend's counterpart is min or max, which never enlarges the largest error.
  if (most > 0 || own > 0) {
    out.error = own > 0 ? rounded_up(own + most) : passed_on(*node.operation, in);
  }
  out.value = {rounded_down(out.value.lo - out.error), rounded_up(out.value.hi + out.error)};
  return out;
}

bool is_finite(const BoundingBox& box) {
  const double sum = norm(box.lo) + norm(box.hi);
  return sum < infinity;
}

std::array<BoundingBox, 2> halves(const BoundingBox& box) {
  const Vec3 size = box.size();
  const size_t axis = size_t(std::max_element(size.begin(), size.end()) - size.begin());
  std::array<BoundingBox, 2> parts{box, box};
  parts[0].hi[axis] = parts[1].lo[axis] = box.center()[axis];
  return parts;
}

/// The parts of a box in which values may lie within a band around 0, the one with the largest
/// bound first; what is proven to lie outside is left out. Parts have their own programs, in which
/// what does not matter for values in the band is left out: it has no slope there either.
class BoundedParts {
 public:
  BoundedParts(const Evaluator& evaluator, const BoundingBox& box, double band)
      : band_(band), has_gradients_(evaluator.has_gradients()) {
    // The caller's evaluator outlives this object.
    add({box, infinity, {std::shared_ptr<void>(), &evaluator}});
  }

  struct Part {
    BoundingBox box;
    double length;
    std::shared_ptr<const Evaluator> field;
    bool operator<(const Part& other) const { return length < other.length; }
  };
  bool empty() const { return parts_.empty(); }
  const Part& worst() const { return parts_.top(); }

  /// Halves the worst part, until there are so many parts, or its bound is small enough or less
  /// than close_enough times a gradient that is attained, or its diagonal is below the smallest.
  void split(const BoundEffort& effort, double close_enough, double smallest) {
    constexpr int boxes_per_report = 64;
    const auto is_done = [&](const Part& part) {
      return part.length <= max(effort.enough, close_enough * attained_) ||
             (effort.enough > 0 && attained_ > effort.enough) || part.box.diagonal() < smallest;
    };
    for (int used = 1; used < effort.boxes && !parts_.empty() && !is_done(worst()); ++used) {
      if (used % boxes_per_report == 0 && effort.progress && !effort.progress(0)) {
        throw Cancelled();
      }
      const Part part = worst();
      parts_.pop();
      const std::shared_ptr<const Evaluator> field = shortened(part);
      for (const BoundingBox& half : halves(part.box)) add({half, part.length, field});
    }
  }

 private:
  // A part is never worse than the whole.
  void add(Part part) {
    const Slope slope = part.field->slope(part.box);
    if (slope.value.lo > band_ || slope.value.hi < -band_) return;
    part.length = min(part.length, slope.length);
    if (is_finite(part.box)) {
      attained_ = max(attained_, steepness_at(*part.field, part.box.center()));
    }
    parts_.push(std::move(part));
  }

  // The part's program without what does not matter in it; its own where that saves little.
  std::shared_ptr<const Evaluator> shortened(const Part& part) const {
    const size_t size = part.field->tape().instructions().size();
    if (size < 2) return part.field;
    auto shorter = std::make_shared<const Evaluator>(
        Shortening(*part.field, part.box).shortened(Demand{-band_, band_}));
    return 10 * shorter->tape().instructions().size() <= 9 * size ? shorter : part.field;
  }

  // 0 where the value is not in the band, there is no gradient, or it is not known.
  double steepness_at(const Evaluator& field, const Vec3& point) const {
    if (!has_gradients_) return 0;
    double value;
    Vec3 gradient;
    double* const to[3] = {&gradient[0], &gradient[1], &gradient[2]};
    field.gradient_block(&point[0], &point[1], &point[2], 1, &value, to);
    const double length = norm(gradient);
    return std::isnan(length) || std::abs(value) > band_ ? 0 : length;
  }

  double band_;
  bool has_gradients_;
  double attained_ = 0;
  std::priority_queue<Part> parts_;
};

// The operation whose bound is infinite although its inputs' bounds are finite.
std::string infinite_node(const Evaluator& evaluator, const BoundingBox& box) {
  const Tape& tape = evaluator.tape();
  std::vector<Slope> registers(tape.registers());
  for (int axis = 0; axis < 3; ++axis) {
    registers[axis].value = {box.lo[axis], box.hi[axis]};
    registers[axis].partial[axis] = 1;
    registers[axis].length = 1;
  }
  for (const Tape::Constant& c : tape.constants()) registers[c.reg].value = c.value;
  std::array<Slope, max_arity> in;
  for (const Instruction& i : tape.instructions()) {
    const OperationInfo& info = i.operation->info();
    bool finite = true;
    for (int k = 0; k < info.arity; ++k) {
      in[k] = registers[i.in[k]];
      finite = finite && in[k].length < infinity;
    }
    registers[i.out] = i.operation->slope(in.data());
    // The first such operation: all later infinities follow from one.
    if (finite && !(registers[i.out].length < infinity)) return info.name;
  }
  return "";
}

}  // namespace

CertifiedBound certified_error(const Expression& expression) {
  std::unordered_map<const Node*, Deviation> known;
  std::string infinite_at;
  std::array<Deviation, max_arity> in;
  for (const Node* node : topological_order({&expression, 1})) {
    for (size_t k = 0; k < node->arity; ++k) in[k] = known.at(node->inputs[k].get());
    const Deviation& out = known[node] = deviation_of(*node, {in.data(), node->arity});
    if (infinite_at.empty() && out.error == infinity) infinite_at = node->operation->info().name;
  }
  const double error = known.at(expression.get()).error;
  return {error, error == infinity ? infinite_at : ""};
}

double error_bound(const Expression& expression) { return certified_error(expression).value; }

CertifiedBound certified_lipschitz(const Evaluator& evaluator, const BoundingBox& box, int boxes) {
  BoundedParts parts(evaluator, box, infinity);
  if (is_finite(box)) parts.split({boxes}, 1.001, 0);
  const double length = parts.worst().length;
  if (length < infinity) return {length, ""};
  return {infinity, infinite_node(*parts.worst().field, parts.worst().box)};
}

std::optional<double> band_lipschitz_bound(const Evaluator& evaluator, const BoundingBox& box,
                                           double band, const BoundEffort& effort) {
  constexpr double close_enough = 1.03;
  BoundedParts parts(evaluator, box, band);
  parts.split(effort, close_enough, smallest_part * box.diagonal());
  if (parts.empty()) return {};
  return parts.worst().length;
}

double lipschitz_bound(const Evaluator& evaluator, const BoundingBox& box, int boxes) {
  return certified_lipschitz(evaluator, box, boxes).value;
}

}  // namespace sardf

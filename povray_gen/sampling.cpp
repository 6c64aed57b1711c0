#include "povray_gen/sampling.hpp"

#include <algorithm>
#include <map>
#include <unordered_map>

#include "povray_gen/sampler.hpp"
#include "sardf/error.hpp"
#include "sardf/operation_of.hpp"
#include "sardf/spline_operation.hpp"

namespace sardf::povray {

namespace {

// Normals and roots are found with steps of less than a thousandth of this share.
constexpr double padding = 1e-3;
// Bounds are padded by half of this.
constexpr double padding_of_bounds = 2e-4;
// The bounds are cut into so many parts along each axis: inputs that turn or bend are enclosed more
// tightly in parts than in the whole.
constexpr int parts = 4;

using OperationKey = std::pair<std::string, std::vector<double>>;

OperationKey key_of(const Operation& operation) {
  return {operation.info().name, operation.numbers()};
}

/// All uses of one operation.
struct Uses {
  OperationPointer operation;
  std::array<Interval, 3> box;      // of the inputs
  std::array<Interval, 3> visible;  // of those inside the scene's bounds, without their padding
  double scale = infinity;          // the least enlargement of lengths on their way to the inputs
};

BoundingBox padded(BoundingBox box, double share) {
  const double by = share * box.diagonal();
  for (int k = 0; k < 3; ++k) {
    box.lo[k] -= by;
    box.hi[k] += by;
  }
  return box;
}

BoundingBox part_of(const BoundingBox& whole, int index) {
  BoundingBox part;
  for (int k = 0; k < 3; ++k, index /= parts) {
    const double size = (whole.hi[k] - whole.lo[k]) / parts;
    const int i = index % parts;
    part.lo[k] = whole.lo[k] + i * size;
    part.hi[k] = i + 1 == parts ? whole.hi[k] : whole.lo[k] + (i + 1) * size;
  }
  return part;
}

std::array<Interval, 3> box_of_inputs(const Node& node, const BoundingBox& bounds) {
  const Evaluator inputs(node.arguments());
  std::array<Interval, max_arity> all, here;
  for (int i = 0; i < parts * parts * parts; ++i) {
    inputs.intervals(part_of(bounds, i), here.data());
    for (int k = 0; k < node.arity; ++k) all[k] = i ? hull(all[k], here[k]) : here[k];
  }
  std::array<Interval, 3> box;
  for (int k = 0; k < std::min<int>(node.arity, 3); ++k) {
    box[k] = all[k];
    if (box[k].magnitude() < infinity) continue;
    throw Error("'" + node.operation->info().name + "' has no formula, and cannot be sampled " +
                "because its input " + std::to_string(k + 1) + " has no bounds in the scene");
  }
  return box;
}

double scale_of_inputs(const Node& node, const BoundingBox& bounds) {
  std::vector<Slope> rows;
  for (const Expression& input : node.arguments()) rows.push_back(Evaluator(input).slope(bounds));
  const double scale = spectral_bound(rows);
  return scale > 0 && scale < infinity ? scale : 1;
}

// A spline is flat beyond its box, where samples go on as at its edge just as well; a derivative of
// one jumps there to 0. A jump within the padding of the bounds would spoil the samples of all
// cells along the faces of a part that fills the box.
void keep_to_box_of_spline(Uses& uses) {
  const std::optional<SplineReach> reach = spline_reach(*uses.operation);
  if (!reach) return;
  for (size_t k = 0; k < 3; ++k) {
    const Interval &whole = reach->box[k], &visible = uses.visible[k];
    if (reach->jumps[k] && !(whole.lo <= visible.lo && visible.hi <= whole.hi)) continue;
    uses.box[k] = {std::clamp(uses.box[k].lo, whole.lo, whole.hi),
                   std::clamp(uses.box[k].hi, whole.lo, whole.hi)};
  }
}

std::vector<Uses> uses_of_data(std::span<const Node* const> order, const BoundingBox& scene) {
  const BoundingBox bounds = padded(scene, padding);
  std::vector<Uses> out;
  std::map<OperationKey, size_t> known;
  for (const Node* node : order) {
    if (!is_sampled(*node)) continue;
    const std::array<Interval, 3> box = box_of_inputs(*node, bounds);
    const std::array<Interval, 3> visible = box_of_inputs(*node, padded(scene, -padding_of_bounds));
    const auto [at, added] = known.try_emplace(key_of(*node->operation), out.size());
    if (added) out.push_back({node->operation, box, visible});
    Uses& uses = out[at->second];
    for (size_t k = 0; k < 3; ++k) {
      uses.box[k] = hull(uses.box[k], box[k]);
      uses.visible[k] = hull(uses.visible[k], visible[k]);
    }
    uses.scale = min(uses.scale, scale_of_inputs(*node, bounds));
  }
  for (Uses& uses : out) keep_to_box_of_spline(uses);
  return out;
}

// The graph again with other operations in place of those of the map.
std::vector<Expression> replaced(std::span<const Expression> roots,
                                 std::span<const Node* const> order,
                                 const std::map<OperationKey, OperationPointer>& by) {
  std::unordered_map<const Node*, Expression> made;
  for (const Node* node : order) {
    if (node->type == Node::Type::constant) made[node] = constant(node->value);
    if (node->type == Node::Type::coordinate) made[node] = coordinate(node->axis);
    if (node->type != Node::Type::operation) continue;
    std::vector<Expression> inputs;
    for (const Expression& input : node->arguments()) inputs.push_back(made.at(input.get()));
    made[node] =
        call(is_sampled(*node) ? by.at(key_of(*node->operation)) : node->operation, inputs);
  }
  std::vector<Expression> out;
  for (const Expression& root : roots) out.push_back(made.at(root.get()));
  return out;
}

}  // namespace

bool is_sampled(const Node& node) {
  return node.type == Node::Type::operation && !node.operation->has_formula();
}

Sampling sample_operations(std::span<const Expression> expressions, const BoundingBox& bounds,
                           const std::string& stem, const SamplingOptions& options) {
  Sampling out;
  const std::vector<const Node*> order = topological_order(expressions);
  const std::vector<Uses> all = uses_of_data(order, bounds);
  if (all.empty()) {
    out.expressions.assign(expressions.begin(), expressions.end());
    return out;
  }
  std::map<OperationKey, OperationPointer> by;
  Work work(options.progress);
  for (const Uses& uses : all) {
    const double number = double(out.functions.size() + 1);
    const double unit = uses.operation->is_distance() ? bounds.diagonal() * uses.scale : 1;
    Sampler sampler(uses.operation, uses.box);
    Sampler::Result result = sampler.sample(options.error_share * unit, options.most_samples, work,
                                            number / double(all.size()));
    const std::string file = stem + "_sampled_" + std::to_string(int(number)) + ".df3";
    out.functions.push_back(std::make_shared<SampledFunction>(
        uses.operation, std::move(result.samples), result.error, file));
    by[key_of(*uses.operation)] = out.functions.back();
  }
  work.stage(1);
  work.run(1, 1, [&](size_t, size_t) { out.expressions = replaced(expressions, order, by); });
  return out;
}

}  // namespace sardf::povray

#include "povray_gen/scene_samples.hpp"

#include <algorithm>
#include <unordered_set>

#include "sardf/pulse.hpp"

namespace sardf::povray {

namespace {

// The share of the progress that samples take; the rest goes into the errors of fields.
constexpr double share_of_samples = 0.9;

std::vector<Expression> picture_of(const PovrayScene& scene) {
  std::vector<Expression> out{scene.solid};
  for (const Expression& channel : scene.color) {
    if (channel) out.push_back(channel);
  }
  return out;
}

// Drops the fields and fractions that need other samples than the picture does; returns the names
// of the fields. What counts is the operation on these inputs: the distance to a curve in space
// needs other samples than that in a plane.
std::vector<std::string> leave_out(PovrayScene& scene) {
  std::unordered_set<const Node*> taken;
  for (const Node* node : topological_order(picture_of(scene))) {
    if (is_sampled(*node)) taken.insert(node);
  }
  const auto needs_more = [&](const NamedExpression& field) {
    const auto nodes = topological_order({&field.expression, 1});
    return std::any_of(nodes.begin(), nodes.end(),
                       [&](const Node* n) { return is_sampled(*n) && !taken.contains(n); });
  };
  std::vector<std::string> names;
  for (const NamedExpression& field : scene.fields) {
    if (needs_more(field)) names.push_back(field.name);
  }
  std::erase_if(scene.fields, needs_more);
  std::erase_if(scene.fractions, needs_more);
  return names;
}

/// An expression of the scene: where it is, what users call it, and where its error is stated.
struct Place {
  Expression* expression;
  std::string name;
  std::string* comment;
};

std::vector<Place> places_of(SceneSamples& out) {
  std::vector<Place> places;
  for (NamedExpression& field : out.scene.fields) {
    places.push_back({&field.expression, field.name, &field.comment});
  }
  places.push_back({&out.scene.solid, "solid", &out.solid_comment});
  constexpr const char* channels[] = {"red", "green", "blue"};
  for (size_t i = 0; i < 3; ++i) {
    if (!out.scene.color[i]) continue;
    places.push_back({&out.scene.color[i], channels[i], &out.color_comments[i]});
  }
  for (NamedExpression& fraction : out.scene.fractions) {
    places.push_back(
        {&fraction.expression, "fraction of " + fraction.name, &out.fractions_comment});
  }
  return places;
}

}  // namespace

SceneSamples sample_scene(const PovrayScene& exact, const std::string& stem,
                          const SamplingOptions& options) {
  SceneSamples out{exact, {}, {}, {}, {}, {}, {}};
  if (!options.all_fields) out.left_out = leave_out(out.scene);
  const std::vector<Place> places = places_of(out);
  std::vector<Expression> before;
  for (const Place& place : places) before.push_back(*place.expression);
  SamplingOptions sampling = options;
  sampling.progress = part_of(options.progress, 0, share_of_samples);
  Sampling sampled = sample_operations(before, exact.bounds, stem, sampling);
  out.functions = std::move(sampled.functions);
  const std::vector<FieldError> errors = errors_of_fields(
      before, sampled.expressions, exact.bounds, part_of(options.progress, share_of_samples, 1));
  for (size_t i = 0; i < places.size(); ++i) {
    *places[i].expression = sampled.expressions[i];
    if (before[i] == sampled.expressions[i]) continue;
    out.errors.push_back({places[i].name, errors[i]});
    std::string& comment = *places[i].comment;
    comment += (comment.empty() ? "" : " ") + out.errors.back().sentence() + ".";
  }
  return out;
}

std::vector<std::string> SceneSamples::sentences() const {
  std::vector<std::string> out;
  for (const SampledPointer& function : functions) out.push_back(function->description());
  for (const StatedError& stated : errors) out.push_back(stated.sentence());
  if (!left_out.empty()) out.push_back(left_out_sentence());
  return out;
}

std::string SceneSamples::left_out_sentence() const {
  std::string out;
  for (const std::string& name : left_out) {
    out += (out.empty() ? "not written, because the picture does not need their samples: " : ", ") +
           name;
  }
  return out;
}

}  // namespace sardf::povray

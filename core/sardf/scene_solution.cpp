#include "sardf/scene_solution.hpp"

#include "sardf/scene_file_names.hpp"
#include "sardf/shapes_fit.hpp"

namespace sardf {

namespace {

struct Solution {
  const Construction* made;
  SolvedField field;
  std::string fingerprint;
};

std::vector<Solution> solutions(const SceneDescription& scene, const Progress& progress) {
  const FieldNames names(scene);
  std::vector<Solution> all;
  for (const Construction* made : names.constructions()) {
    if (!made->constructor || made->constructor->name != Fitted::name) continue;
    const std::string name = names.name_of(made);
    all.push_back({made, {name.empty() ? Fitted::name : name, nullptr}, ""});
  }
  for (size_t i = 0; i < all.size(); ++i) {
    const double from = double(i) / double(all.size()), share = 1 / double(all.size());
    Progress part;
    if (progress) part = [&](double done) { return progress(from + share * done); };
    try {
      const FitProblem problem = with_arguments<Fitted>(all[i].made->arguments).problem();
      all[i].field.result = recent_fit(problem, part);
      all[i].fingerprint = fingerprint_of(problem);
    } catch (const Error& error) {
      throw Error(all[i].field.name + ": " + error.message);
    }
  }
  return all;
}

Value& argument(std::vector<Value>& arguments, const Constructor& fitted, const char* name) {
  size_t place = 0;
  while (fitted.parameters[place].name != name) ++place;
  return arguments[place];
}

}  // namespace

std::vector<SolvedField> solve_fields(const SceneDescription& scene, const Progress& progress) {
  std::vector<SolvedField> all;
  for (Solution& each : solutions(scene, progress)) all.push_back(std::move(each.field));
  return all;
}

ReplacedArguments solved_arguments(const SceneDescription& scene, const Progress& progress) {
  ReplacedArguments replaced;
  for (const Solution& each : solutions(scene, progress)) {
    std::vector<Value> arguments = each.made->arguments;
    const Constructor& fitted = *each.made->constructor;
    argument(arguments, fitted, "coefficients") = each.field.result->coefficients;
    argument(arguments, fitted, "fingerprint") = each.fingerprint;
    replaced[each.made] = std::move(arguments);
  }
  return replaced;
}

}  // namespace sardf

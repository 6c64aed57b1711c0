#include "sardf/scene_solution.hpp"

#include "sardf/scene_file_names.hpp"
#include "sardf/shapes_fit.hpp"

namespace sardf {

namespace {

struct Solution {
  const Construction* made;
  SolvedField field;
};

std::vector<Solution> solutions(const SceneDescription& scene, const Progress& progress) {
  const FieldNames names(scene);
  std::vector<Solution> all;
  for (const Construction* made : names.constructions()) {
    if (!made->constructor || made->constructor->name != Fitted::name) continue;
    const std::string name = names.name_of(made);
    all.push_back({made, {name.empty() ? Fitted::name : name, nullptr}});
  }
  for (size_t i = 0; i < all.size(); ++i) {
    const double from = double(i) / double(all.size()), share = 1 / double(all.size());
    Progress part;
    if (progress) part = [&](double done) { return progress(from + share * done); };
    try {
      all[i].field.result =
          recent_fit(with_arguments<Fitted>(all[i].made->arguments).problem(), part);
    } catch (const Error& error) {
      throw Error(all[i].field.name + ": " + error.message);
    }
  }
  return all;
}

size_t place_of_coefficients(const Constructor& fitted) {
  size_t place = 0;
  while (fitted.parameters[place].name != "coefficients") ++place;
  return place;
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
    arguments[place_of_coefficients(*each.made->constructor)] = each.field.result->coefficients;
    replaced[each.made] = std::move(arguments);
  }
  return replaced;
}

}  // namespace sardf

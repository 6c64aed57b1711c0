#include "sardf/scene_file_names.hpp"

#include <algorithm>

#include "sardf/constructor.hpp"
#include "sardf/error.hpp"
#include "sardf/field_parts.hpp"
#include "sardf/formula.hpp"

namespace sardf {

namespace {

// So deep constructors may stand inside each other: readable, and far from deepest_json.
constexpr size_t deepest_nesting = 12;
constexpr size_t longest_inline_formula = 60;

// A short formula without names, such as a number: written where it is used.
bool stands_alone(const Construction& made) {
  return !made.constructor && made.names.empty() && made.formula.size() <= longest_inline_formula;
}

std::vector<Field> fields_of(const SceneDescription& scene) {
  std::vector<Field> all;
  for (const NamedField& named : scene.fields) all.push_back(named.field);
  if (scene.solid) all.push_back(scene.solid);
  append_fields(scene.fractions, all);
  for (const Attribute& a : scene.attributes) {
    if (a.rule) {
      append_fields(a.rule, all);
    } else {
      all.insert(all.end(), a.components.begin(), a.components.end());
    }
  }
  for (const Section& section : scene.sections) {
    all.push_back(section.remove);
    all.insert(all.end(), section.keep.begin(), section.keep.end());
  }
  return all;
}

}  // namespace

FieldNames::FieldNames(const SceneDescription& scene) {
  for (const auto& [name, value] : scene.parameters) {
    parameters_[name] = value;
    taken_.insert(name);
  }
  for (const NamedField& named : scene.fields) {
    names_.emplace(named.field.construction(), named.name);
    taken_.insert(named.name);
    defined_.push_back(named);
  }
  collect(fields_of(scene));
  give_names();
}

// A depth-first walk without recursion that counts how often each field is used.
void FieldNames::collect(const std::vector<Field>& roots) {
  struct Step {
    const Construction* made;
    std::vector<Field> parts;
    size_t next = 0;
  };
  std::vector<Step> path;
  const auto use = [&](const Field& field) {
    const Construction* made = field.construction();
    if (!made) throw Error("a field that no constructor or formula made cannot be written");
    Use& seen = uses_[made];
    seen.field = field;
    if (seen.count++ > 0) return;
    path.push_back({made, {}});
    for (const Value& value : made->arguments) append_fields(value, path.back().parts);
    for (const auto& [name, part] : made->names) path.back().parts.push_back(part);
  };
  for (const Field& root : roots) {
    use(root);
    while (!path.empty()) {
      Step& step = path.back();
      if (step.next < step.parts.size()) {
        const Field part = step.parts[step.next++];
        use(part);
        continue;
      }
      for (const auto& [name, part] : step.made->names) {
        Use& seen = uses_[part.construction()];
        seen.by_formula = true;
        seen.wanted = name;
      }
      order_.push_back(step.made);
      path.pop_back();
    }
  }
}

void FieldNames::give_names() {
  std::unordered_map<const Construction*, size_t> depths;
  for (const Construction* made : order_) {
    std::vector<Field> parts;
    for (const Value& value : made->arguments) append_fields(value, parts);
    size_t depth = 0;
    for (const Field& part : parts) {
      if (!names_.count(part.construction())) {
        depth = std::max(depth, depths[part.construction()] + 1);
      }
    }
    depths[made] = depth;
    if (names_.count(made) || stands_alone(*made)) continue;
    const Use& seen = uses_[made];
    if (seen.count == 1 && !seen.by_formula && depth < deepest_nesting) continue;
    const std::string wanted = seen.by_formula     ? seen.wanted
                               : made->constructor ? made->constructor->name
                                                   : std::string("formula");
    names_[made] = fresh(wanted);
    defined_.push_back({names_[made], seen.field});
  }
}

std::string FieldNames::fresh(const std::string& wanted) {
  const bool usable = is_name(wanted) && !find_constructor(wanted) && wanted != "formula";
  std::string name = usable ? wanted : "";
  while (name.empty() || !taken_.insert(name).second) {
    name = wanted + "_" + std::to_string(++numbers_[wanted]);
  }
  return name;
}

std::string FieldNames::name_of(const Construction* made) const {
  const auto found = names_.find(made);
  return found == names_.end() ? "" : found->second;
}

std::string FieldNames::formula_text(const Construction& formula) const {
  std::map<std::string, std::string> new_names;
  for (const auto& [name, field] : formula.names) {
    const std::string here = name_of(field);
    const auto parameter = parameters_.find(name);
    const Expression& value = field.expression();
    if (!here.empty()) {
      new_names[name] = here;
    } else if (field.construction()->formula == name) {
      continue;  // the u of an influence
    } else if (parameter == parameters_.end() || !is_constant(value) ||
               value->value != parameter->second) {
      new_names[name] = "(" + field.construction()->formula + ")";
    }
  }
  return rename_in_formula(formula.formula, new_names);
}

}  // namespace sardf

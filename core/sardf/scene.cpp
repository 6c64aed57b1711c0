#include "sardf/scene.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "sardf/arithmetic.hpp"
#include "sardf/bounds.hpp"
#include "sardf/constructor.hpp"
#include "sardf/error.hpp"
#include "sardf/field_parts.hpp"
#include "sardf/inverse_shares.hpp"
#include "sardf/shapes_combine.hpp"
#include "sardf/short_number.hpp"
#include "sardf/unit_vectors.hpp"

namespace sardf {

namespace {

struct LengthUnit {
  const char* name;
  double metres;
};
constexpr LengthUnit length_units[] = {
    {"um", 1e-6}, {"mm", 1e-3}, {"cm", 1e-2}, {"m", 1}, {"in", 0.0254}};

[[noreturn]] void fail(const SceneDescription& scene, const std::string& pointer,
                       const std::string& message) {
  throw scene.source.error(message, pointer);
}

// Runs f; its errors get the place in the scene file unless they name one.
template <class F>
auto located(const SceneDescription& scene, const std::string& pointer, F f) {
  try {
    return f();
  } catch (const Error& error) {
    if (!error.pointer.empty()) throw;
    fail(scene, pointer, error.message);
  }
}

std::string cannot_normalise(const double* point) {
  return "fractions cannot be normalised at " + short_point(point) +
         ": the sum of the formulas is not positive there";
}

void check_materials(SceneDescription& scene) {
  if (scene.materials.empty()) {
    scene.materials.emplace_back();
    scene.materials.back().name = "material";
  }
  std::set<std::string> names;
  for (const Material& m : scene.materials) {
    if (m.name.empty()) fail(scene, "/materials", "a material has no name");
    if (!names.insert(m.name).second) {
      fail(scene, "/materials", "there are two materials named '" + m.name + "'");
    }
  }
}

bool is_taken_by_channels(const std::string& name) {
  return name.starts_with("fractions_") ||
         std::any_of(common_channels.begin(), common_channels.end(),
                     [&](const CommonChannel& channel) { return channel.name == name; });
}

void check_parts(SceneDescription& scene) {
  if (!scene.solid) fail(scene, "", "the scene has no solid");
  metres_per_unit(scene.units);
  check_materials(scene);
  std::set<std::string> names;
  std::vector<std::pair<std::string, std::string>> columns;  // of components with names
  for (const Attribute& a : scene.attributes) {
    if (!names.insert(a.name).second) {
      fail(scene, "/attributes", "there are two attributes named '" + a.name + "'");
    }
    if (is_taken_by_channels(a.name)) {
      fail(scene, "/attributes/" + a.name,
           "'" + a.name + "' names a channel of every bake; an attribute needs another name");
    }
    for (size_t c = 0; c < a.component_names.size(); ++c) {
      columns.push_back({a.name, a.column(c, a.component_names.size())});
    }
  }
  for (const auto& [owner, column] : columns) {
    if (!names.insert(column).second) {
      fail(scene, "/attributes/" + owner,
           "a component of '" + owner + "' would be called '" + column +
               "', as something else is; it needs another name");
    }
  }
  for (const Section& section : scene.sections) {
    if (!section.remove) fail(scene, "/sections", "a section removes nothing");
  }
}

Field joined(const SceneDescription& scene, const Field& field) {
  return scene.blend ? make_field(WithBlend::name, {field, scene.blend}) : field;
}

std::vector<Expression> joined(const SceneDescription& scene, const std::vector<Expression>& all) {
  return scene.blend ? joined_by(*scene.blend, all) : all;
}

// The part of space that one section takes away.
Expression taken(const Section& section) {
  Expression removed = section.remove.expression();
  for (const Field& kept : section.keep) removed = min(removed, -kept.expression());
  return removed;
}

// Formulas may sum to 0 somewhere in the solid; found by sampling, it is said before work starts.
void check_sums(const SceneDescription& scene, const Expression& solid,
                const std::vector<Expression>& fractions, const BoundingBox& box) {
  if (!uses_rule(scene.fractions, "formulas")) return;
  Expression sum = constant(0);
  for (const Expression& fraction : fractions) sum = sum + fraction;
  constexpr size_t per_axis = 32, n = per_axis * per_axis * per_axis;
  std::vector<double> points(3 * n), values(2 * n);
  for (size_t i = 0; i < n; ++i) {
    const size_t place[3] = {i % per_axis, i / per_axis % per_axis, i / (per_axis * per_axis)};
    for (int axis = 0; axis < 3; ++axis) {
      const double share = (double(place[axis]) + 0.5) / double(per_axis);
      points[3 * i + axis] = box.lo[axis] + share * (box.hi[axis] - box.lo[axis]);
    }
  }
  const std::vector<Expression> outputs{solid, sum};
  Evaluator(outputs).values(points.data(), n, values.data());
  for (size_t i = 0; i < n; ++i) {
    if (values[2 * i] >= 0 && !(values[2 * i + 1] > 0.5)) {
      fail(scene, "/fractions", cannot_normalise(&points[3 * i]));
    }
  }
}

Lowering lowering_of_fractions(const Scene& scene) {
  Lowering lowering;
  lowering.materials = scene.material_names();
  lowering.diagonal = scene.bounds().diagonal();
  return lowering;
}

// The rules inside the scene's fields, each once, and what they are called.
std::vector<std::pair<std::string, RulePointer>> rules_in_fields(const SceneDescription& scene) {
  std::map<const Construction*, std::string> names;
  std::vector<Field> open;
  for (const NamedField& named : scene.fields) {
    names.emplace(named.field.construction(), "the field '" + named.name + "'");
    open.push_back(named.field);
  }
  open.push_back(scene.solid);
  append_fields(scene.fractions, open);
  for (const Attribute& attribute : scene.attributes) append_fields(attribute.rule, open);
  std::set<const Construction*> seen;
  std::vector<std::pair<std::string, RulePointer>> rules;
  while (!open.empty()) {
    const Field field = open.back();
    open.pop_back();
    const Construction* made = field.construction();
    if (!made || !seen.insert(made).second) continue;
    for (const Value& value : made->arguments) {
      append_fields(value, open);
      if (const auto* rule = std::get_if<RulePointer>(&value)) {
        const auto name = names.find(made);
        rules.emplace_back(name == names.end() ? "a field without a name" : name->second, *rule);
      }
    }
    for (const auto& [name, part] : made->names) open.push_back(part);
  }
  return rules;
}

}  // namespace

std::string Attribute::column(size_t c, size_t n) const {
  if (c < component_names.size()) return name + "_" + component_names[c];
  return n == 1 ? name : name + "_" + "xyzw"[c % 4];
}

std::vector<std::string> unit_names() {
  std::vector<std::string> names;
  for (const LengthUnit& unit : length_units) names.push_back(unit.name);
  return names;
}

double metres_per_unit(const std::string& units) {
  for (const LengthUnit& unit : length_units) {
    if (units == unit.name) return unit.metres;
  }
  throw Error("units is '" + units + "'; accepted are um, mm, cm, m and in" +
              did_you_mean(units, unit_names()));
}

Scene::Scene(SceneDescription description, const Progress& progress)
    : description_(std::move(description)) {
  SceneDescription& scene = description_;
  check_parts(scene);
  solid_field_ = joined(scene, scene.solid);
  for (const NamedField& named : scene.fields) {
    fields_.push_back({named.name, joined(scene, named.field)});
  }
  bounds_ = located(scene, "/solid", [&] {
    return certified_bounds(Evaluator(solid()), progress, scene.stated_bounds);
  });
  drawn_ = solid();
  for (const Section& section : scene.sections) {
    const Expression removed = joined(scene, {taken(section)})[0];
    drawn_ = min(drawn_, -removed);
    removed_ = removed_ ? max(removed_, removed) : removed;
  }
  const std::vector<std::string> names = material_names();
  const double diagonal = bounds_.diagonal();
  fractions_ = located(scene, "/fractions", [&] {
    return joined(scene, lower(scene.fractions ? scene.fractions : Fractions::material(names[0]),
                               names, diagonal));
  });
  check_sums(scene, solid(), fractions_, bounds_);
  unproven_ = located(scene, "/fractions", [&] {
    return check_functions({"the fractions", scene.fractions, lowering_of_fractions(*this)},
                           checked_place(), scene.source, progress);
  });
  lower_attributes();
  std::vector<Expression> outputs = fractions_;
  outputs.push_back(solid());
  fraction_evaluator_ = Evaluator(outputs);
}

void Scene::lower_attributes() {
  for (Attribute& attribute : description_.attributes) {
    if (!attribute.rule) {
      attribute.rule = Fractions::value(attribute.components);
      attribute.rule_components = attribute.components.size();
    }
    const auto lowered = located(description_, "/attributes/" + attribute.name, [&] {
      auto components = lower(attribute.rule, lowering_of(attribute));
      if (!attribute.unit_vector) return components;
      if (components.size() != 3) {
        throw Error("a unit vector has 3 components; the value has " +
                    std::to_string(components.size()));
      }
      return unit_vector(components, largest_prescribed(attribute.rule), attribute.fallback);
    });
    attribute.components.clear();
    for (const Expression& e : joined(description_, lowered)) {
      attribute.components.push_back(Field(e, {}, nullptr));
    }
  }
}

Lowering Scene::lowering_of(const Attribute& attribute) const {
  return {material_names(), bounds_.diagonal(), attribute.rule_components, fractions_,
          attribute.component_names};
}

CheckedPlace Scene::checked_place() const {
  return {solid(), bounds_, in_region * bounds_.diagonal(), description_.blend};
}

std::vector<Warning> Scene::warnings(const Progress& progress) const {
  const CheckedPlace place = checked_place();
  std::vector<Warning> all = unproven_;
  const auto search = [&](const CheckedRule& checked, const std::vector<std::string>& names) {
    if (!checked.rule) return;
    for (const Contradiction& found : find_contradictions(checked, place, progress)) {
      all.push_back(warning_of(found, names));
    }
  };
  search({"the fractions", description_.fractions, lowering_of_fractions(*this)}, material_names());
  for (const Attribute& attribute : description_.attributes) {
    search({"the attribute '" + attribute.name + "'", attribute.rule, lowering_of(attribute)},
           attribute.component_names);
  }
  for (const auto& [owner, rule] : rules_in_fields(description_)) {
    Lowering one;
    one.diagonal = bounds_.diagonal();
    one.components = 1;
    search({owner, Fractions(rule), one}, {});
  }
  return all;
}

std::vector<std::string> Scene::material_names() const {
  std::vector<std::string> names;
  for (const Material& m : description_.materials) names.push_back(m.name);
  return names;
}

namespace {

// Σ fraction × property; a constant where all materials have the same.
template <class Property>
Expression averaged(const Scene& scene, Property property) {
  const std::vector<Material>& materials = scene.description().materials;
  const auto is_same = [&](const Material& m) { return property(m) == property(materials[0]); };
  if (std::all_of(materials.begin(), materials.end(), is_same)) {
    return constant(property(materials[0]));
  }
  std::vector<double> factors;
  for (const Material& m : materials) factors.push_back(property(m));
  return weighted_sum(scene.fractions(), factors);
}

}  // namespace

std::array<Expression, 3> Scene::base_color() const {
  std::array<Expression, 3> color;
  for (size_t c = 0; c < 3; ++c) {
    color[c] = averaged(*this, [c](const Material& m) { return m.color[c]; });
  }
  return color;
}

std::array<Expression, 3> Scene::emission() const {
  std::array<Expression, 3> color;
  for (size_t c = 0; c < 3; ++c) {
    color[c] = averaged(*this, [c](const Material& m) { return m.emission[c]; });
  }
  return color;
}

Expression Scene::roughness() const {
  return averaged(*this, [](const Material& m) { return m.roughness; });
}

Expression Scene::metallic() const {
  return averaged(*this, [](const Material& m) { return m.metallic; });
}

void Scene::fractions_at(const double* points, size_t n, double* out, bool outside_nan) const {
  const size_t count = fractions_.size(), outputs = count + 1;
  constexpr size_t at_once = 1 << 16;
  std::vector<double> values(std::min(n, at_once) * outputs);
  for (size_t first = 0; first < n; first += at_once) {
    const size_t m = std::min(at_once, n - first);
    fraction_evaluator_.values(points + 3 * first, m, values.data());
    for (size_t i = 0; i < m; ++i) {
      const double* row = &values[i * outputs];
      double* to = out + (first + i) * count;
      if (outside_nan && !(row[count] >= 0)) {
        std::fill_n(to, count, std::nan(""));
        continue;
      }
      double sum = 0;
      for (size_t k = 0; k < count; ++k) sum += row[k];
      // Defined fractions sum to 1 but for rounding.
      if (!(sum > 0.5)) throw Error(cannot_normalise(points + 3 * (first + i)));
      for (size_t k = 0; k < count; ++k) to[k] = row[k] / sum;
    }
  }
}

}  // namespace sardf

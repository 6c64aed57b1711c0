#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <set>

#include "cli/commands.hpp"
#include "cli/scene_option.hpp"
#include "sardf/certify.hpp"
#include "sardf/constructor.hpp"
#include "sardf/contour.hpp"
#include "sardf/field_parts.hpp"
#include "sardf/scene.hpp"
#include "sardf/short_number.hpp"
#include "sardf/volume.hpp"

namespace sardf {

namespace {

struct Options {
  SceneOption scene;
  int resolution = 72;
};

std::string text(double value) { return short_number(value, 6); }

const char* name(Exactness e) {
  return e == Exactness::exact ? "exact" : e == Exactness::bound ? "bound" : "estimate";
}

// Rows of two columns, printed together once nothing can fail any more.
class Table {
 public:
  void row(const std::string& label, const std::string& value) {
    width_ = std::max(width_, label.size());
    rows_.emplace_back(label, value);
  }

  void print() const {
    for (const auto& [label, value] : rows_) {
      std::printf("%-*s  %s\n", int(width_), label.c_str(), value.c_str());
    }
  }

 private:
  size_t width_ = 0;
  std::vector<std::pair<std::string, std::string>> rows_;
};

// An infinite bound is named with the operation that makes it so.
std::string text(const CertifiedBound& bound) {
  return std::isfinite(bound.value) ? text(bound.value) : "inf, because of " + bound.infinite_at;
}

// "within about 0.01 %"
std::string accuracy(const MaterialVolumes& volumes) {
  const double percent = volumes.total > 0 ? 100 * volumes.error / volumes.total : 0;
  return "within about " + short_number(std::max(percent, 0.01), 1) + " %";
}

void add_volumes(Table& table, const Scene& scene, int resolution) {
  const MaterialVolumes volumes =
      measure_volumes(scene, resolution, terminal_progress("measuring"));
  const double cm = 100 * scene.metres_per_unit(), cm3 = cm * cm * cm;
  table.row("volume", text(volumes.total) + " " + scene.description().units +
                          "³ = " + text(volumes.total * cm3) + " cm³, " + accuracy(volumes));
  const auto& materials = scene.description().materials;
  for (size_t m = 0; m < volumes.materials.size(); ++m) {
    const double volume = volumes.materials[m] * cm3;
    std::string line = text(volume) + " cm³";
    if (materials[m].density) line += ", " + text(volume * *materials[m].density) + " g";
    table.row("  " + materials[m].name, line);
  }
}

// The fields that a field is made of, in the order of its parameters.
std::vector<Field> parts_of(const Field& field) {
  std::vector<Field> parts;
  if (!field.construction()) return parts;
  for (const Value& value : field.construction()->arguments) append_fields(value, parts);
  return parts;
}

// What is accepted, but may not be what was meant.
std::string remark(const Field& field) {
  const Construction* made = field.construction();
  if (!made || !made->constructor || made->constructor->group != "plane") return "";
  for (const Value& value : made->arguments) {
    const auto* contour = std::get_if<Contour>(&value);
    if (contour && doubled_area(*contour) < 0) return "; its contour runs clockwise";
  }
  return "";
}

// Every node of every tree, each named field once with its unnamed parts below it.
class FieldRows {
 public:
  FieldRows(Table& table, const Scene& scene) : table_(table) {
    for (const NamedField& named : scene.fields()) names_.insert(named.field.construction());
    table.row("fields", "distance inside, outside");
    for (const NamedField& named : scene.fields()) add(named.name, named.field, 1);
    const bool is_named = names_.count(scene.solid_field().construction()) > 0;
    if (!is_named) add("(solid)", scene.solid_field(), 1);
  }

 private:
  void add(const std::string& label, const Field& field, size_t depth) {
    table_.row(std::string(2 * depth, ' ') + label,
               std::string(name(field.quality().inside)) + ", " + name(field.quality().outside) +
                   ", error bound " + text(certified_error(field.expression())) + remark(field));
    for (const Field& part : parts_of(field)) {
      if (!part.construction() || names_.count(part.construction())) continue;
      const Constructor* constructor = part.construction()->constructor;
      add(constructor ? constructor->name : "formula", part, depth + 1);
    }
  }

  Table& table_;
  std::set<const Construction*> names_;
};

void check(const Options& options) {
  const Scene scene = options.scene.read(terminal_progress("finding bounds"));
  const SceneDescription& d = scene.description();
  Table table;
  table.row("title", d.title);
  table.row("units", d.units);
  table.row("bounds", short_point(scene.bounds().lo.data()) + " to " +
                          short_point(scene.bounds().hi.data()) + ", certified");
  add_volumes(table, scene, options.resolution);
  const Evaluator solid(scene.solid());
  if (d.stated_lipschitz) {
    table.row("Lipschitz", text(*d.stated_lipschitz) + ", stated, not proven");
  } else {
    table.row("Lipschitz", text(certified_lipschitz(solid, scene.bounds())));
  }
  table.row("error bound", text(certified_error(scene.solid())));
  FieldRows(table, scene);
  if (!d.sections.empty()) table.row("sections", std::to_string(d.sections.size()));
  for (const Warning& warning : scene.warnings(terminal_progress("searching contradictions"))) {
    table.row("warning", warning.message);
  }
  table.print();
}

}  // namespace

void add_check(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "check", "Print what a scene is: bounds, volumes, exactness; or its errors");
  const auto options = std::make_shared<Options>();
  options->scene.add_to(*command);
  command
      ->add_option("--resolution", options->resolution,
                   "Cells along each side of the bounds, for volumes")
      ->check(CLI::Range(8, 2048))
      ->capture_default_str();
  command->callback([options] { check(*options); });
}

}  // namespace sardf

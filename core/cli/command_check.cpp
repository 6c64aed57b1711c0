#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>

#include "cli/commands.hpp"
#include "sardf/certify.hpp"
#include "sardf/scene.hpp"
#include "sardf/scene_file.hpp"
#include "sardf/volume.hpp"

namespace sardf {

namespace {

struct Options {
  std::string scene;
  int resolution = 72;
};

std::string text(double value) {
  char out[32];
  std::snprintf(out, sizeof out, "%.6g", value);
  return out;
}

std::string text(const Vec3& v) {
  return "(" + text(v[0]) + ", " + text(v[1]) + ", " + text(v[2]) + ")";
}

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
  char out[32];
  const double percent = volumes.total > 0 ? 100 * volumes.error / volumes.total : 0;
  std::snprintf(out, sizeof out, "%.1g", std::max(percent, 0.01));
  return std::string("within about ") + out + " %";
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

void add_fields(Table& table, const Scene& scene) {
  table.row("fields", "distance inside, outside");
  const auto line = [&table](const std::string& label, const Field& field) {
    table.row("  " + label, std::string(name(field.quality().inside)) + ", " +
                                name(field.quality().outside) + ", error bound " +
                                text(certified_error(field.expression())));
  };
  for (const NamedField& named : scene.description().fields) line(named.name, named.field);
  line("(solid)", scene.description().solid);
}

void check(const Options& options) {
  const Scene scene(read_scene(options.scene), terminal_progress("finding bounds"));
  const SceneDescription& d = scene.description();
  Table table;
  table.row("title", d.title);
  table.row("units", d.units);
  table.row("bounds", text(scene.bounds().lo) + " to " + text(scene.bounds().hi) + ", certified");
  add_volumes(table, scene, options.resolution);
  const Evaluator solid(scene.solid());
  if (d.stated_lipschitz) {
    table.row("Lipschitz", text(*d.stated_lipschitz) + ", stated, not proven");
  } else {
    table.row("Lipschitz", text(certified_lipschitz(solid, scene.bounds())));
  }
  table.row("error bound", text(certified_error(scene.solid())));
  add_fields(table, scene);
  if (!d.sections.empty()) table.row("sections", std::to_string(d.sections.size()));
  table.print();
}

}  // namespace

void add_check(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "check", "Print what a scene is: bounds, volumes, exactness; or its errors");
  const auto options = std::make_shared<Options>();
  command->add_option("scene", options->scene, "Scene file; - for standard input")->required();
  command
      ->add_option("--resolution", options->resolution,
                   "Cells along each side of the bounds, for volumes")
      ->check(CLI::Range(8, 2048))
      ->capture_default_str();
  command->callback([options] { check(*options); });
}

}  // namespace sardf

#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>

#include "cli/commands.hpp"
#include "sardf/scene_file.hpp"
#include "sardf/scene_solution.hpp"
#include "sardf/shapes_fit.hpp"

namespace sardf {

namespace {

struct Options {
  std::string scene, output;
};

using Row = std::vector<std::string>;

std::string text(const char* format, double value) {
  char out[40];
  std::snprintf(out, sizeof out, format, value);
  return out;
}

Row row_of(const SolvedField& solved) {
  const FitReport& r = solved.result->report;
  return {solved.name,
          std::to_string(r.unknowns),
          std::to_string(r.quadrature_points),
          std::to_string(r.iterations),
          text("%.1e", r.residual),
          text("%.8g", r.energy_before),
          text("%.8g", r.energy_after),
          text("%.4g", r.rms_before),
          text("%.4g", r.rms_after),
          text("%.6g", r.mean),
          text("%.1e", r.cut),
          text("%.2f", r.seconds)};
}

// The first column to the left, numbers to the right.
std::string table_of(const std::vector<Row>& rows) {
  std::vector<size_t> width(rows[0].size());
  for (const Row& row : rows) {
    for (size_t c = 0; c < row.size(); ++c) width[c] = std::max(width[c], row[c].size());
  }
  std::string table;
  for (const Row& row : rows) {
    for (size_t c = 0; c < row.size(); ++c) {
      const std::string fill(width[c] - row[c].size(), ' ');
      table += c == 0 ? row[c] + fill : "  " + fill + row[c];
    }
    table += '\n';
  }
  return table;
}

void solve_scene(const Options& options) {
  SceneDescription scene;
  {
    const ProgressScope scope(terminal_progress("solving"));
    // Those of an older problem are no error here.
    const IgnoredCoefficients ignored;
    scene = read_scene(options.scene);
  }
  const std::vector<SolvedField> solved = solve_fields(scene, terminal_progress("solving"));
  std::vector<Row> rows{{"field", "unknowns", "points", "iterations", "residual", "energy before",
                         "after", "rms before", "after", "mean", "cut", "seconds"}};
  for (const SolvedField& each : solved) rows.push_back(row_of(each));
  // The table must not mix with a scene on the standard output.
  std::ostream& to = options.output == "-" ? std::cerr : std::cout;
  to << (solved.empty() ? "no field is fitted\n" : table_of(rows));
  if (!options.output.empty()) {
    write_scene(options.output, scene, solved_arguments(scene));
  }
}

}  // namespace

void add_solve(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "solve", "Solve for all fitted fields; the scene with their coefficients reads at once");
  const auto options = std::make_shared<Options>();
  command->add_option("scene", options->scene, "Scene file; - for standard input")->required();
  command->add_option("-o,--output", options->output,
                      "Scene file to write, with coefficients; - for standard output");
  command->callback([options] { solve_scene(*options); });
}

}  // namespace sardf

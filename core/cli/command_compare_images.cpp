#include "cli/command_compare_images.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/compare_json.hpp"
#include "cli/compare_report.hpp"
#include "cli/write_text.hpp"
#include "sardf/compare_images.hpp"
#include "sardf/error.hpp"

namespace sardf {

namespace {

struct Options {
  std::string reference;
  std::string candidate;
  std::string reference_normal;
  std::string candidate_normal;
  std::array<float, 3> background = {0, 0, 0};
  bool lattice = false;
  std::string title = "Comparison of two renders";
  std::string report;
  std::string numbers;
};

// By alpha; an alpha that is opaque all over says nothing, as some programs write it always.
Mask mask_of(const Image& image, const Options& options) {
  if (image.channels == 4) {
    Mask mask = mask_from_alpha(image);
    if (std::find(mask.begin(), mask.end(), 0) != mask.end()) return mask;
  }
  return mask_from_background(image, options.background);
}

std::string file_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

ReportScene scene_of(const Options& options, Image reference, Image candidate,
                     const Image& reference_normal, const Image& candidate_normal,
                     const Comparison& numbers, const Limits& limits) {
  ReportScene scene;
  scene.title = options.title;
  scene.reference_label = file_name(options.reference);
  scene.facts = {{"Size", std::to_string(numbers.width) + " × " + std::to_string(numbers.height)}};
  ReportView view;
  view.label = file_name(options.candidate);
  view.numbers = numbers;
  view.limits = limits;
  view.pictures.push_back(
      report_picture("Colour", std::move(reference), std::move(candidate), Meaning::color));
  if (numbers.normal)
    view.pictures.push_back(
        report_picture("Normal", reference_normal, candidate_normal, Meaning::data));
  scene.views.push_back(std::move(view));
  return scene;
}

void compare(const Options& options) {
  if (options.reference_normal.empty() != options.candidate_normal.empty())
    throw Error("normals are compared where both pictures have them; only one was given");
  Image reference = read_image(options.reference, Meaning::color);
  Image candidate = read_image(options.candidate, Meaning::color);
  const bool normals = !options.reference_normal.empty();
  Image reference_normal, candidate_normal;
  if (normals) {
    reference_normal = read_image(options.reference_normal, Meaning::data);
    candidate_normal = read_image(options.candidate_normal, Meaning::data);
  }
  const Mask reference_mask = mask_of(reference, options);
  const Mask candidate_mask = mask_of(candidate, options);
  const Comparison numbers =
      compare_images({reference, reference_mask, normals ? &reference_normal : nullptr},
                     {candidate, candidate_mask, normals ? &candidate_normal : nullptr});
  const Limits limits = options.lattice ? Limits::lattice() : Limits{};
  if (!options.numbers.empty())
    write_text(options.numbers, to_json(numbers, limits).dump(2) + "\n");
  if (!options.report.empty())
    write_report(options.report, options.title,
                 {scene_of(options, std::move(reference), std::move(candidate), reference_normal,
                           candidate_normal, numbers, limits)});
  const auto failed = failed_criteria(numbers, limits);
  for (const std::string& sentence : failed) std::cerr << sentence << ".\n";
  if (!failed.empty()) throw CLI::RuntimeError(1);
}

}  // namespace

void add_compare_images(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "compare-images", "Compare two pictures of one scene: outline, colours, normals");
  const auto options = std::make_shared<Options>();
  command->add_option("reference", options->reference, "The exact picture, EXR or PNG")->required();
  command->add_option("candidate", options->candidate, "The picture to check")->required();
  command->add_option("-o,--output", options->report, "Write the comparison as an HTML page");
  command->add_option("--json", options->numbers, "Write all numbers as JSON");
  command->add_option("--reference-normal", options->reference_normal,
                      "World normals as colours 0.5 + 0.5 n, for the reference");
  command->add_option("--candidate-normal", options->candidate_normal,
                      "World normals as colours, for the candidate");
  command->add_option("--background", options->background,
                      "Linear red, green, blue where nothing is; for pictures without alpha");
  command->add_flag("--lattice", options->lattice, "Use the limits for lattices");
  command->add_option("--title", options->title, "The page's title");
  command->callback([options] { compare(*options); });
}

}  // namespace sardf

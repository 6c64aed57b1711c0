#include <CLI/CLI.hpp>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "cli/commands.hpp"
#include "cli/scene_option.hpp"
#include "cli/write_text.hpp"
#include "sardf/error.hpp"
#include "sardf/number_text.hpp"
#include "sardf/scene.hpp"

namespace sardf {

namespace {

struct Options {
  SceneOption scene;
  std::string points, output = "-", outside = "extend";
};

const char* skip_blanks(const char* at, const char* end) {
  while (at < end && (*at == ' ' || *at == '\t' || *at == '\r')) ++at;
  return at;
}

// Three numbers and nothing else, separated by commas.
bool parse_point(const std::string& line, Vec3& point) {
  const char *at = line.data(), *end = at + line.size();
  for (int axis = 0; axis < 3; ++axis) {
    at = skip_blanks(at, end);
    const auto [next, error] = std::from_chars(at, end, point[axis]);
    if (error != std::errc() || !std::isfinite(point[axis])) return false;
    at = skip_blanks(next, end);
    if (axis < 2 && (at == end || *at++ != ',')) return false;
  }
  return at == end;
}

std::vector<double> read_points(const std::string& path) {
  std::ifstream file;
  if (path != "-") {
    if (std::filesystem::is_directory(path)) throw Error("is a folder", path);
    file.open(path);
    if (!file) throw Error("cannot be read: " + std::string(std::strerror(errno)), path);
  }
  std::istream& from = path == "-" ? std::cin : file;
  std::vector<double> points;
  std::string line;
  for (int number = 1; std::getline(from, line); ++number) {
    Vec3 point;
    const char* text = skip_blanks(line.data(), line.data() + line.size());
    if (text == line.data() + line.size()) continue;
    if (parse_point(line, point)) {
      points.insert(points.end(), point.begin(), point.end());
    } else if (number > 1 || *text != 'x') {
      throw Error("found '" + line + "'; three finite numbers x,y,z are accepted", path, number);
    }
  }
  return points;
}

std::string quoted(const std::string& name) {
  if (name.find_first_of(",\"\n") == std::string::npos) return name;
  std::string out = "\"";
  for (char c : name) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

std::string header(const Scene& scene) {
  std::string text = "x,y,z,field";
  for (const std::string& name : scene.material_names()) text += "," + quoted(name);
  for (const Attribute& a : scene.description().attributes) {
    for (size_t c = 0; c < a.components.size(); ++c) {
      text += "," + quoted(a.column(c, a.components.size()));
    }
  }
  return text + "\n";
}

void evaluate(const Options& options) {
  if (options.scene.path == "-" && options.points == "-") {
    throw Error("standard input cannot be both the scene and the points");
  }
  const Scene scene = options.scene.read();
  const std::vector<double> points = read_points(options.points);
  const size_t n = points.size() / 3, materials = scene.fractions().size();
  std::vector<Expression> outputs{scene.solid()};
  for (const Attribute& a : scene.description().attributes) {
    for (const Field& f : a.components) outputs.push_back(f.expression());
  }
  const Evaluator evaluator(outputs);
  std::vector<double> values(n * outputs.size()), fractions(n * materials);
  evaluator.values(points.data(), n, values.data(), terminal_progress("evaluating"));
  scene.fractions_at(points.data(), n, fractions.data(), options.outside == "nan");
  std::string text = header(scene);
  for (size_t i = 0; i < n; ++i) {
    const double* row = &values[i * outputs.size()];
    for (int axis = 0; axis < 3; ++axis) {
      append_number(text, points[3 * i + axis]);
      text += ',';
    }
    append_number(text, row[0]);
    for (size_t m = 0; m < materials; ++m) append_number(text += ',', fractions[i * materials + m]);
    for (size_t k = 1; k < outputs.size(); ++k) append_number(text += ',', row[k]);
    text += '\n';
  }
  write_text(options.output, text);
}

}  // namespace

void add_eval(CLI::App& app) {
  CLI::App* command = app.add_subcommand("eval", "Values at points: field, fractions, attributes");
  const auto options = std::make_shared<Options>();
  options->scene.add_to(*command);
  command->add_option("--points", options->points, "CSV of x,y,z; - for standard input")
      ->required();
  command->add_option("-o,--output", options->output, "CSV to write; - for standard output")
      ->capture_default_str();
  command->add_option("--outside", options->outside, "Fractions outside the solid: extend or nan")
      ->check(CLI::IsMember({"extend", "nan"}))
      ->capture_default_str();
  command->callback([options] { evaluate(*options); });
}

}  // namespace sardf

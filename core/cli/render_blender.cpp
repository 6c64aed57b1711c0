#include "cli/render_blender.hpp"

#include <filesystem>
#include <sstream>

#include "sardf/error.hpp"
#include "sardf/process.hpp"

namespace sardf {

namespace {

constexpr double start_timeout = 120, render_timeout = 1800;  // seconds

bool is_python(const std::string& program) {
  return std::filesystem::path(program).filename().string().starts_with("python");
}

// The word after `marker` in the output.
std::string word_after(const std::string& output, const std::string& marker) {
  const size_t at = output.find(marker);
  if (at == std::string::npos) return "";
  std::istringstream rest(output.substr(at + marker.size()));
  std::string word;
  rest >> word;
  return word;
}

std::string last_lines(const std::string& text, size_t most) {
  size_t at = text.size();
  for (size_t lines = 0; at > 0 && lines <= most; --at) lines += text[at - 1] == '\n';
  return text.substr(at);
}

}  // namespace

std::string find_headless() {
  namespace fs = std::filesystem;
  const fs::path name = "blender_addon/headless.py";
  if (fs::exists(name)) return name;
  std::error_code unknown;
  const fs::path program = fs::read_symlink("/proc/self/exe", unknown);
  for (fs::path at = program.parent_path(); at.has_relative_path(); at = at.parent_path()) {
    if (fs::exists(at / name)) return at / name;
  }
  return name;
}

Blender find_blender(const std::string& program, const std::string& headless) {
  if (!std::filesystem::exists(headless)) {
    throw Error("there is no " + headless + "; --headless names the add-on's headless.py");
  }
  const std::string marker = "Blender version ";
  const std::string ask = "import bpy; print('" + marker + "', bpy.app.version_string)";
  const bool python = is_python(program);
  const std::vector<std::string> question =
      python ? std::vector<std::string>{program, "-c", ask}
             : std::vector<std::string>{program, "-b", "--factory-startup", "--python-expr", ask};
  const ProcessResult answer = run_process(question, {.timeout = start_timeout});
  const std::string version = word_after(answer.output, marker);
  if (version.empty()) {
    throw Failure(program + " is no Blender" + (python ? " (it has no bpy module)" : "") + ": " +
                  last_lines(answer.errors + answer.output, 3));
  }
  Blender blender;
  blender.label = (python ? "bpy " : "Blender ") + version;
  blender.command = python
                        ? std::vector<std::string>{program, headless}
                        : std::vector<std::string>{
                              program,  "-b", "--factory-startup", "--python-exit-code", "1", "-P",
                              headless, "--"};
  return blender;
}

void render_in_blender(const Blender& blender, const BlenderJob& job, const Progress& progress) {
  std::vector<std::string> command = blender.command;
  const auto add = [&](const std::string& option, const std::string& value) {
    command.push_back(option);
    command.push_back(value);
  };
  command.push_back(job.scene);
  add("-o", job.folder);
  add("--camera", job.camera);
  add("--look", job.looks);
  add("--width", std::to_string(job.width));
  add("--height", std::to_string(job.height));
  add("--resolution", std::to_string(job.resolution));
  add("--size", std::to_string(job.texture_size));
  add("--samples", std::to_string(job.samples));
  command.push_back("--no-keep-blend");
  const ProcessResult result =
      run_process(command, {.timeout = render_timeout, .progress = progress});
  if (result.exit_code != 0) {
    throw std::runtime_error(blender.label + " failed on " + job.scene + ": " +
                             last_lines(result.errors.empty() ? result.output : result.errors, 5));
  }
}

}  // namespace sardf

#include "povray_gen/run.hpp"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <utility>
#include <vector>

#include "sardf/error.hpp"
#include "sardf/process.hpp"

namespace sardf::povray {

namespace {

namespace fs = std::filesystem;

// POV-Ray wraps its messages at 80 columns; a message ends where the next one begins or at a line
// that does not fill up. Joined, every message is one line.
std::string joined(const std::string& messages) {
  std::string out;
  std::istringstream lines(messages);
  for (std::string line; std::getline(lines, line);) {
    while (!line.empty() && (line.back() == ' ' || line.back() == '\r')) line.pop_back();
    const size_t begin = line.find_first_not_of(' ');
    if (begin == std::string::npos) continue;
    if (!out.empty()) out += ' ';
    out.append(line, begin);
  }
  return out;
}

// The message that begins with, or around, the marker: from the file it names to its last sentence.
std::string message_at(const std::string& text, size_t marker) {
  constexpr size_t longest = 400;
  size_t begin = text.rfind("File '", marker);
  if (begin == std::string::npos || marker - begin > 300) begin = marker;
  std::string out = text.substr(begin, longest);
  for (const char* next :
       {" Fatal error in parser", " ----", " Possible Parse Error", " Render failed"}) {
    const size_t end = out.find(next, marker - begin + 1);
    if (end != std::string::npos) out.resize(end);
  }
  return out;
}

const char* extension_of(Format format) { return format == Format::exr ? ".exr" : ".png"; }

std::vector<std::string> command(const std::string& scene, const std::string& image,
                                 const RunOptions& options) {
  const char* format = options.format == Format::exr     ? "+FE"
                       : options.format == Format::png16 ? "+FN16"
                                                         : "+FN8";
  // Names get ./ in front: POV-Ray takes a leading - for an option.
  const std::pair<const char*, std::string> settings[] = {{"+I./", scene},
                                                          {"+O./", image},
                                                          {"+W", std::to_string(options.width)},
                                                          {"+H", std::to_string(options.height)},
                                                          {"+WT", std::to_string(options.threads)}};
  std::vector<std::string> out{find_povray(options.program)};
  for (const auto& [option, value] : settings) out.push_back(std::string(option).append(value));
  out.insert(out.end(), {format, "-D"});
  if (options.alpha) out.push_back("+UA");
  if (options.antialias) {
    out.insert(out.end(), {"+A0.1", "+AM2", "+R2", "-J"});
  } else {
    out.push_back("-A");
  }
  return out;
}

// Removes the file unless it was renamed.
struct Remover {
  fs::path path;
  ~Remover() {
    std::error_code ignored;
    fs::remove(path, ignored);
  }
};

}  // namespace

std::string find_povray(const std::string& named) {
  const std::string path = named.empty() ? find_program("povray", "POVRAY") : find_program(named);
  if (!path.empty() && ::access(path.c_str(), X_OK) == 0) return path;
  throw Failure(
      std::string("POV-Ray 3.7 was not found; install it (Debian: apt install povray) or ") +
      "set the environment variable POVRAY to its path" +
      (path.empty() ? "" : "; it is '" + path + "'"));
}

std::string complaint_in(const std::string& messages) {
  std::string text = joined(messages);
  // A lens shift is a direction that is not perpendicular to the picture: that is meant.
  for (const std::string meant = "Parse Warning: Camera vectors are not perpendicular.";;) {
    const size_t at = text.find(meant);
    if (at == std::string::npos) break;
    text.erase(at, meant.size());
  }
  for (const char* marker : {"Parse Error:", "Parse Warning:", "may contain holes", "Fatal error",
                             "Render failed", "Cannot open"}) {
    const size_t at = text.find(marker);
    if (at == std::string::npos) continue;
    if (std::string(marker) != "may contain holes") return message_at(text, at);
    const size_t begin = text.rfind("The maximum gradient found", at);
    return message_at(text, begin == std::string::npos ? at : begin);
  }
  return "";
}

double share_in(const std::string& messages) {
  const size_t end = messages.rfind("%)");
  const size_t begin = end == std::string::npos ? end : messages.rfind("pixels (", end);
  if (begin == std::string::npos) return 0;
  double percent = 0;
  const char* first = messages.data() + begin + std::strlen("pixels (");
  std::from_chars(first, messages.data() + end, percent);
  return std::clamp(percent / 100, 0.0, 1.0);
}

void render(const std::string& scene, const std::string& image, const RunOptions& options,
            const std::function<std::string(const std::string&)>& check) {
  if (options.width < 1 || options.height < 1) {
    throw Error("a picture of " + std::to_string(options.width) + " x " +
                std::to_string(options.height) + " pixels; both must be positive");
  }
  if (!fs::is_regular_file(scene)) throw Error("there is no such scene for POV-Ray", scene);
  const fs::path target = fs::absolute(image), source = fs::absolute(scene);
  if (!fs::is_directory(target.parent_path())) {
    throw Failure("the folder " + target.parent_path().string() + " does not exist", image);
  }
  // POV-Ray may write only below the folder that it runs in: the picture goes there first.
  std::string name(".");
  name.append(target.stem().string()).append(".").append(std::to_string(::getpid()));
  name.append(extension_of(options.format));
  const Remover temporary{source.parent_path() / name};
  // What POV-Ray would continue an interrupted render from.
  const Remover state{fs::path(temporary.path).replace_extension(".pov-state")};
  const ProcessResult result =
      run_process(command(source.filename().string(), name, options),
                  {source.parent_path().string(), options.timeout, options.progress, share_in});
  if (result.timed_out) {
    throw Failure("POV-Ray was stopped after " + std::to_string(int(options.timeout)) + " s",
                  scene);
  }
  std::string complaint = complaint_in(result.errors);
  if (complaint.empty() && result.exit_code != 0) {
    complaint = "exit code " + std::to_string(result.exit_code);
  }
  if (!complaint.empty()) throw Failure("POV-Ray: " + complaint, scene);
  if (!fs::is_regular_file(temporary.path)) throw Failure("POV-Ray wrote no picture", scene);
  if (check) complaint = check(temporary.path.string());
  if (!complaint.empty()) throw Failure("POV-Ray: " + complaint, scene);
  std::error_code error;
  fs::rename(temporary.path, target, error);
  if (error) {
    // Another file system: copy next to the target, then rename there.
    const Remover copy{target.string() + "." + std::to_string(::getpid())};
    fs::copy_file(temporary.path, copy.path, fs::copy_options::overwrite_existing, error);
    if (!error) fs::rename(copy.path, target, error);
    if (error) throw Failure("cannot be written: " + error.message(), image);
  }
}

}  // namespace sardf::povray

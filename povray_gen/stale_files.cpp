#include "povray_gen/stale_files.hpp"

#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>

#include "povray_gen/samples.hpp"

namespace sardf::povray {

namespace {

namespace fs = std::filesystem;

std::string contents(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Comments as one line each: they are broken at spaces.
std::string unwrapped(std::string text) {
  const std::string broken = "\n// ";
  for (size_t at = 0; (at = text.find(broken, at)) != std::string::npos;) {
    text.replace(at, broken.size(), " ");
  }
  return text;
}

// The three numbers of "12 x 34 x 1" at the end of the text.
std::optional<std::array<int, 3>> counts_at_end(const std::string& text) {
  const size_t first = text.rfind(' ', text.rfind(" x ", text.rfind(" x ") - 1) - 1) + 1;
  std::istringstream words(text.substr(first));
  std::array<int, 3> counts{};
  char x = 'x', y = 'x';
  if (!(words >> counts[0] >> x >> counts[1] >> y >> counts[2]) || x != 'x' || y != 'x') return {};
  return counts;
}

// The header of the density file, and as many bytes as it asks for.
bool holds(const fs::path& path, const std::array<int, 3>& counts) {
  std::error_code failed;
  if (!fs::is_regular_file(fs::symlink_status(path, failed))) return false;
  const SampleGrid grid{{}, counts};
  if (double(fs::file_size(path, failed)) != 6 + 4 * grid.stored_size() || failed) return false;
  std::ifstream file(path, std::ios::binary);
  for (int k = 0; k < 3; ++k) {
    const int high = file.get(), low = file.get();
    if (256 * high + low != grid.stored(k)) return false;
  }
  return true;
}

}  // namespace

std::vector<std::string> density_files_of(const std::string& include) {
  const fs::path path(include);
  std::vector<std::string> out;
  const std::string read = contents(path), said = unwrapped(read);
  const std::string before = " samples in ", stem = path.stem().string() + "_sampled_";
  for (size_t at = 0; (at = said.find(before + stem, at)) != std::string::npos; ++at) {
    const size_t begin = at + before.size();
    size_t end = begin + stem.size();
    while (end < said.size() && std::isdigit(static_cast<unsigned char>(said[end]))) ++end;
    if (end == begin + stem.size() || said.compare(end, 5, ".df3;") != 0) continue;
    const std::string file = said.substr(begin, end - begin) + ".df3";
    if (read.find("density_file df3 \"" + file + "\" interpolate 1") == std::string::npos) continue;
    const auto counts = counts_at_end(said.substr(0, at));
    const fs::path beside = path.parent_path() / file;
    if (counts && holds(beside, *counts)) out.push_back(beside.string());
  }
  return out;
}

}  // namespace sardf::povray

#include "sardf/error.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace sardf {

namespace {

std::string located(const std::string& message, const std::string& file, int line,
                    const std::string& pointer) {
  std::string text = file;
  if (line > 0) text += (text.empty() ? "line " : ":") + std::to_string(line);
  if (!pointer.empty()) text += (text.empty() ? "" : ": ") + pointer;
  return text.empty() ? message : text + ": " + message;
}

size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0]++;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t replaced = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row.back();
}

size_t common(const std::string& a, const std::string& b) {
  return size_t(std::mismatch(a.begin(), a.end(), b.begin(), b.end()).first - a.begin());
}

}  // namespace

Error::Error(std::string text, std::string where, int at_line, std::string at)
    : std::runtime_error(located(text, where, at_line, at)),
      message(std::move(text)),
      file(std::move(where)),
      line(at_line),
      pointer(std::move(at)) {}

std::string did_you_mean(const std::string& found, const std::vector<std::string>& accepted) {
  const std::string* nearest = nullptr;
  size_t least = std::max<size_t>(found.size() / 2, 2) + 1;
  for (const std::string& name : accepted) {
    const size_t distance = edit_distance(found, name);
    // Of equally near names the one that begins alike.
    const bool alike =
        nearest && distance == least && common(found, name) > common(found, *nearest);
    if (distance < least || alike) {
      least = distance;
      nearest = &name;
    }
  }
  return nearest ? "; did you mean '" + *nearest + "'?" : "";
}

}  // namespace sardf

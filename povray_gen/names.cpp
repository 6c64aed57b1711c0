#include "povray_gen/names.hpp"

#include <charconv>
#include <cmath>

#include "sardf/error.hpp"

namespace sardf::povray {

namespace {

constexpr size_t longest_prefix = 16;

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Runs of anything else become one _; none at either end.
std::string identifier(const std::string& text) {
  std::string out;
  for (char c : text) {
    if (is_letter(c) || is_digit(c)) {
      out += c;
    } else if (!out.empty() && out.back() != '_') {
      out += '_';
    }
  }
  while (!out.empty() && out.back() == '_') out.pop_back();
  return out;
}

}  // namespace

Names::Names(const std::string& title) : prefix_(identifier(title)) {
  // It stands in front of every name: as many whole words as stay readable.
  if (prefix_.size() > longest_prefix) {
    const size_t end = prefix_.rfind('_', longest_prefix);
    prefix_.resize(end == std::string::npos ? longest_prefix : end);
  }
  if (prefix_.empty() || !is_letter(prefix_[0])) prefix_ = "part" + prefix_;
}

std::string Names::join(const std::string& word) const {
  const std::string tail = identifier(word);
  if (tail.starts_with(prefix_ + "_")) return tail;
  return prefix_ + "_" + (tail.empty() ? "field" : tail);
}

std::string Names::unique(const std::string& word) {
  const std::string first = join(word);
  std::string name = first;
  for (int i = 2; !taken_.insert(name).second; ++i) name = first + "_" + std::to_string(i);
  return name;
}

std::string Names::numbered(const std::string& word) {
  const std::string first = join(word);
  for (int& number = numbers_[first];;) {
    const std::string name = first + "_" + std::to_string(++number);
    if (taken_.insert(name).second) return name;
  }
}

std::string Names::parameter(int index) const {
  std::string name = prefix_ + "__" + char('a' + index % 26);
  if (index >= 26) name += std::to_string(index / 26);
  return name;
}

std::string number_text(double value) {
  if (!std::isfinite(value)) {
    throw Error("the number " + std::to_string(value) +
                " occurs in the model; POV-Ray has finite numbers only");
  }
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return {text, end};
}

std::string bound_text(double value) {
  char text[32];
  const auto end =
      std::to_chars(text, text + sizeof text, value * 1.005, std::chars_format::general, 3).ptr;
  return {text, end};
}

}  // namespace sardf::povray

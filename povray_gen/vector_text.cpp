#include "povray_gen/vector_text.hpp"

namespace sardf::povray {

std::string vector_text(const Vec3& v) {
  std::string out = "<";
  for (int i = 0; i < 3; ++i) out.append(i ? ", " : "").append(number_text(v[i]));
  return out.append(">");
}

std::string one_line(std::string text) {
  for (char& c : text) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  return text;
}

std::string filled(const std::string& pattern, std::initializer_list<std::string> words) {
  std::string out;
  auto word = words.begin();
  for (size_t i = 0; i < pattern.size(); ++i) {
    if (pattern.compare(i, 2, "{}") == 0 && word != words.end()) {
      out += *word++;
      ++i;
    } else {
      out += pattern[i];
    }
  }
  return out;
}

}  // namespace sardf::povray

// Numbers in files and documents; messages have short_number.hpp.
#pragma once

#include <charconv>
#include <string>

namespace sardf {

/// Appends the shortest decimal that reads back as the same float or double.
template <class Real>
void append_number(std::string& to, Real value) {
  char text[32];
  to.append(text, std::to_chars(text, text + sizeof text, value).ptr);
}

/// The shortest decimal that reads back as the same double.
inline std::string number_text(double value) {
  std::string text;
  append_number(text, value);
  return text;
}

}  // namespace sardf

// Numbers in messages.
#pragma once

#include <sstream>
#include <string>

namespace sardf {

/// The number with so many significant digits, without trailing zeros.
inline std::string short_number(double value, int digits = 3) {
  std::ostringstream text;
  text.precision(digits);
  text << value;
  return text.str();
}

}  // namespace sardf

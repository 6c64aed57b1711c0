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

/// (x, y, z) of three numbers.
inline std::string short_point(const double* p, int digits = 6) {
  return "(" + short_number(p[0], digits) + ", " + short_number(p[1], digits) + ", " +
         short_number(p[2], digits) + ")";
}

}  // namespace sardf

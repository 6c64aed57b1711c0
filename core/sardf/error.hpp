// The one exception for everything a user can get wrong.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace sardf {

/// Bad input, said in one clear sentence. `file`, `line` (from 1, 0: unknown) and `pointer` (JSON
/// pointer) locate it when it comes from a scene file. what() is "file:line: pointer: message".
struct Error : std::runtime_error {
  explicit Error(std::string text, std::string where = "", int at_line = 0, std::string at = "");
  std::string message;
  std::string file;
  int line;
  std::string pointer;
};

/// What went wrong although the input was right: an output that cannot be written, a program that
/// is missing, too little memory.
struct Failure : Error {
  using Error::Error;
};

/// "; did you mean 'x'?" for the accepted name nearest to `found`, or "" when none is near.
std::string did_you_mean(const std::string& found, const std::vector<std::string>& accepted);

}  // namespace sardf

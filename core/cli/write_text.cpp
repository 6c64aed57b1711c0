#include "cli/write_text.hpp"

#include <cerrno>
#include <iostream>
#include <system_error>

#include "sardf/error.hpp"
#include "sardf/output_file.hpp"

namespace sardf {

void write_text(const std::string& path, const std::string& text) {
  if (path != "-") return write_file(path, text);
  errno = 0;
  std::cout << text << std::flush;
  if (std::cout) return;
  throw Failure("cannot be written: " + std::generic_category().message(errno), "standard output");
}

}  // namespace sardf

// Text to a file or to the standard output.
#pragma once

#include <string>

namespace sardf {

/// write_file, or the standard output where the path is "-". Throws Failure with the system's
/// reason.
void write_text(const std::string& path, const std::string& text);

}  // namespace sardf

// Text files that are either whole or not there.
#pragma once

#include <string>

namespace sardf {

/// Writes `text` to a temporary name in the path's folder and renames it; "-" is the standard
/// output. Throws Error naming the file with the system's reason; then nothing is left of it.
void write_text(const std::string& path, const std::string& text);

}  // namespace sardf

// The size of a picture as the command line states it.
#pragma once

#include <string>

namespace sardf {

struct PictureSize {
  int width = 0, height = 0;  // pixels
};

/// WIDTHxHEIGHT, as 640x480; each at least 8. Throws Error.
PictureSize parse_size(const std::string& text);

}  // namespace sardf

#include "cli/picture_size.hpp"

#include <cstdio>

#include "sardf/error.hpp"

namespace sardf {

PictureSize parse_size(const std::string& text) {
  PictureSize size;
  char end = 0;
  if (std::sscanf(text.c_str(), "%dx%d%c", &size.width, &size.height, &end) != 2 ||
      size.width < 8 || size.height < 8) {
    throw Error("the size is '" + text + "'; WIDTHxHEIGHT in pixels is accepted, such as 640x480");
  }
  return size;
}

}  // namespace sardf

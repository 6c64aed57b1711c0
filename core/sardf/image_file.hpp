// Images in memory and on disk. image_file.cpp is the only file that includes OpenImageIO.
#pragma once

#include <string>
#include <vector>

namespace sardf {

/// Interleaved float samples, row 0 at the top.
struct Image {
  int width = 0;
  int height = 0;
  int channels = 0;
  std::vector<float> samples;  // width * height * channels
  float* at(int x, int y) { return &samples[(size_t(y) * width + x) * channels]; }
  const float* at(int x, int y) const { return &samples[(size_t(y) * width + x) * channels]; }
};

/// What the samples mean, so that a file carries the right colour-space tag: `color` is linear
/// Rec.709 in memory and becomes sRGB in 8- and 16-bit files; `data` is never converted.
enum class Meaning { color, data };

enum class Depth { byte8, byte16, float32, half16 };

/// Reads any file that OpenImageIO reads; 8/16-bit sRGB files are decoded when `meaning` is
/// color. Throws Error naming the file.
Image read_image(const std::string& path, Meaning meaning);

/// Writes EXR (linear) or PNG by the path's extension, to a temporary name that is then renamed.
/// Throws Error naming the file.
void write_image(const std::string& path, const Image& image, Meaning meaning, Depth depth,
                 const std::vector<std::string>& channel_names = {});

/// Fills every texel whose `covered` byte is 0 smoothly from the covered ones (OpenImageIO's
/// push-pull). `covered` has width * height entries.
void fill_uncovered(Image& image, const std::vector<unsigned char>& covered);

}  // namespace sardf

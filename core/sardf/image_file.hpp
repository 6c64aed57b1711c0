// Images in memory and on disk. image_file.cpp is the only file that includes OpenImageIO.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sardf/zeroed_memory.hpp"

namespace sardf {

/// They begin as zeros.
using ImageSamples = std::vector<float, ZeroedMemory<float>>;

/// Interleaved float samples, row 0 at the top.
struct Image {
  int width = 0;
  int height = 0;
  int channels = 0;
  ImageSamples samples;  // width * height * channels
  float* at(int x, int y) { return &samples[(size_t(y) * width + x) * channels]; }
  const float* at(int x, int y) const { return &samples[(size_t(y) * width + x) * channels]; }
};

/// What the samples mean, so that a file carries the right colour-space tag: `color` is linear
/// Rec.709 in memory and becomes sRGB in 8- and 16-bit files; `data` is never converted. The
/// last of two or four channels of a colour is alpha: colour is multiplied by it in memory and in
/// EXR and is not in PNG, as both formats prescribe.
enum class Meaning { color, data };

/// byte8 and byte16 are written as PNG, half16 and float32 as EXR.
enum class Depth { byte8, byte16, float32, half16 };

/// The transfer functions of sRGB (IEC 61966-2-1), for values in [0, 1]; beyond them they continue.
float srgb_from_linear(float linear);
float linear_from_srgb(float encoded);

/// Reads any file that OpenImageIO reads; files whose colour space is sRGB or a gamma are decoded
/// when `meaning` is color. Channels come in the order in which write_image got them; other
/// programs' EXR channels come as R, G, B, A and then by name. Their names go to `channel_names`
/// where it is given. Throws Error naming the file.
Image read_image(const std::string& path, Meaning meaning,
                 std::vector<std::string>* channel_names = nullptr);

/// Writes EXR (linear) or PNG by the path's extension, to a temporary name that is then renamed.
/// Without channel names, images of 1, 2, 3 and 4 channels get Y, YA, RGB and RGBA. Throws Error
/// naming the file; then nothing is left of it and an older file of that name is untouched.
void write_image(const std::string& path, const Image& image, Meaning meaning, Depth depth,
                 const std::vector<std::string>& channel_names = {});

/// Writes a tiled, mip-mapped texture (.tx, a TIFF of 32-bit floats, linear), as renderers with
/// OpenImageIO read in parts; to a temporary name that is then renamed. Throws Error for another
/// extension and Failure where it cannot be written.
void write_texture(const std::string& path, const Image& image, Meaning meaning,
                   const std::vector<std::string>& channel_names = {});

/// The image as the bytes of an 8-bit PNG file of 1 to 4 channels.
std::string encode_png(const Image& image, Meaning meaning);

/// How an ImageWriter's file is laid out.
struct ImageLayout {
  int width = 0;
  int height = 0;
  int channels = 0;
  Meaning meaning = Meaning::color;
  Depth depth = Depth::float32;
  std::vector<std::string> channel_names = {};
  int tile = 0;  ///< 0: rows in order; else the edge of square tiles in any order (EXR only)
};

/// Writes a file piece by piece, for images that should not lie in memory whole. Pieces go to a
/// temporary name in the same folder; finish() renames it. A writer destroyed before finish()
/// removes what it wrote. All members throw Error naming the file. One thread at a time.
class ImageWriter {
 public:
  ImageWriter(const std::string& path, const ImageLayout& layout);
  ~ImageWriter();
  ImageWriter(const ImageWriter&) = delete;
  ImageWriter& operator=(const ImageWriter&) = delete;

  /// The next `rows` rows from the top: rows * width * channels samples.
  void write_rows(const float* samples, int rows);
  /// The tile whose top left texel is (x, y), multiples of the tile's edge: width * height *
  /// channels samples, where width and height are the tile's edge or what the image leaves of it.
  void write_tile(const float* samples, int x, int y);
  /// Closes and renames. An Error if rows or tiles are missing.
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Fills every texel whose `covered` byte is 0 smoothly from the covered ones, which stay as they
/// are, bit for bit. `covered` has width * height entries. Uses OpenImageIO's push-pull up to
/// 2048 x 2048; larger images are halved until they are that small and filled from their half,
/// because push-pull needs five times the memory of its image. An Error if nothing is covered.
void fill_uncovered(Image& image, const std::vector<unsigned char>& covered);

}  // namespace sardf

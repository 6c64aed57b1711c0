#include "sardf/image_file.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <span>
#include <system_error>
#include <utility>

#include "sardf/error.hpp"
#include "sardf/output_file.hpp"

namespace sardf {

namespace {

namespace fs = std::filesystem;
using OIIO::TypeDesc;

// OpenEXR sorts a file's channels by name; this attribute keeps the order they were given in.
constexpr const char* channel_order_attribute = "sardf:channels";

std::string lower_extension(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return extension;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ",") + name;
  return text;
}

std::string without(std::string text, const std::string& part, const std::string& replacement) {
  for (size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += replacement.size())
    text.replace(at, part.size(), replacement);
  return text;
}

bool is_png(const ImageLayout& layout) {
  return layout.depth == Depth::byte8 || layout.depth == Depth::byte16;
}

void check_layout(const std::string& path, const ImageLayout& layout) {
  if (layout.width < 1 || layout.height < 1 || layout.channels < 1)
    throw Error("an image of " + std::to_string(layout.width) + " x " +
                    std::to_string(layout.height) + " with " + std::to_string(layout.channels) +
                    " channels cannot be written; all three must be at least 1",
                path);
  if (is_png(layout) && layout.channels > 4)
    throw Error("PNG holds 1 to 4 channels, not " + std::to_string(layout.channels), path);
  if (is_png(layout) && layout.tile > 0)
    throw Error("PNG is written row by row, not in tiles", path);
  if (!layout.channel_names.empty() && int(layout.channel_names.size()) != layout.channels)
    throw Error(std::to_string(layout.channel_names.size()) + " channel names for " +
                    std::to_string(layout.channels) + " channels",
                path);
}

void check_extension(const std::string& path, const ImageLayout& layout) {
  const std::string extension = lower_extension(path);
  if (extension != ".png" && extension != ".exr")
    throw Error("image files are written as .exr or .png, not '" + extension + "'", path);
  if (is_png(layout) != (extension == ".png"))
    throw Error(extension == ".png" ? "PNG holds 8 or 16 bits, not floating-point samples"
                                    : "EXR holds half or float samples, not 8 or 16 bits",
                path);
}

TypeDesc sample_type(Depth depth) {
  switch (depth) {
    case Depth::byte8:
      return TypeDesc::UINT8;
    case Depth::byte16:
      return TypeDesc::UINT16;
    case Depth::half16:
      return TypeDesc::HALF;
    default:
      return TypeDesc::FLOAT;
  }
}

OIIO::ImageSpec file_spec(const ImageLayout& layout) {
  OIIO::ImageSpec spec(layout.width, layout.height, layout.channels, sample_type(layout.depth));
  if (layout.channels == 1) spec.channelnames = {"Y"};
  if (layout.channels == 2) spec.channelnames = {"Y", "A"};
  if (!layout.channel_names.empty()) {
    spec.channelnames = layout.channel_names;
    if (!is_png(layout)) spec.attribute(channel_order_attribute, joined(layout.channel_names));
  }
  const bool color = layout.meaning == Meaning::color;
  if (!color) spec.alpha_channel = -1;
  // Untagged PNG data: a gamma of 1 would make viewers brighten it.
  spec.attribute("oiio:ColorSpace", !color ? "raw" : is_png(layout) ? "sRGB" : "Linear");
  spec.attribute("oiio:UnassociatedAlpha", is_png(layout) ? 1 : 0);
  spec.attribute("compression", "zip");
  // zlib level 4 writes textures about twice as fast as 6 and hardly larger.
  spec.attribute("png:compressionLevel", 4);
  if (layout.tile > 0) {
    spec.tile_width = spec.tile_height = layout.tile;
    // Any other line order makes OpenEXR keep in memory the tiles that come too early.
    spec.attribute("openexr:lineOrder", "randomY");
  }
  return spec;
}

// Linear samples to what a PNG stores: colour freed from alpha, then sRGB.
void encode_pixels(std::span<float> samples, size_t channels) {
  const bool has_alpha = channels == 2 || channels == 4;
  const size_t colors = has_alpha ? channels - 1 : channels;
  for (size_t i = 0; i < samples.size(); i += channels) {
    const float alpha = has_alpha ? samples[i + colors] : 1.0f;
    const float scale = alpha > 0 ? 1 / alpha : 1.0f;
    for (size_t c = i; c < i + colors; ++c) samples[c] = srgb_from_linear(samples[c] * scale);
  }
}

void decode_pixels(Image& image, const std::string& space, int alpha, bool unassociated) {
  const bool srgb = space == "sRGB";
  const float gamma = space.starts_with("Gamma") ? std::strtof(space.c_str() + 5, nullptr) : 1.0f;
  const size_t channels = size_t(image.channels);
  for (size_t i = 0; i < image.samples.size(); i += channels) {
    float* pixel = &image.samples[i];
    const float scale = unassociated && alpha >= 0 ? pixel[alpha] : 1.0f;
    for (size_t c = 0; c < channels; ++c) {
      if (int(c) == alpha) continue;
      if (srgb) pixel[c] = linear_from_srgb(pixel[c]);
      if (gamma > 0 && gamma != 1) pixel[c] = std::pow(std::max(pixel[c], 0.0f), gamma);
      pixel[c] *= scale;
    }
  }
}

// Puts the samples back into the order that write_image got them in.
void restore_order(Image& image, std::vector<std::string>& names, const std::string& order) {
  std::vector<size_t> from;
  for (size_t start = 0; start <= order.size();) {
    const size_t end = std::min(order.find(',', start), order.size());
    const auto found = std::find(names.begin(), names.end(), order.substr(start, end - start));
    if (found == names.end()) return;
    from.push_back(size_t(found - names.begin()));
    start = end + 1;
  }
  if (from.size() != names.size() || std::is_sorted(from.begin(), from.end())) return;
  std::vector<std::string> file_names = names;
  std::vector<float> pixel(names.size());
  for (size_t c = 0; c < from.size(); ++c) names[c] = file_names[from[c]];
  for (size_t i = 0; i < image.samples.size(); i += pixel.size()) {
    std::copy_n(&image.samples[i], pixel.size(), pixel.begin());
    for (size_t c = 0; c < from.size(); ++c) image.samples[i + c] = pixel[from[c]];
  }
}

// A file that remembers failed writes: OpenImageIO 2.4's PNG writer does not look at their result
// and would report a full disk as success.
class WatchedFile : public OIIO::Filesystem::IOFile {
 public:
  explicit WatchedFile(const std::string& path) : IOFile(path, Write) {}
  size_t write(const void* bytes, size_t size) override {
    const size_t written = IOFile::write(bytes, size);
    if (written != size) note_failure();
    return written;
  }
  void flush() const override {
    if (std::fflush(handle()) != 0) note_failure();
  }
  const std::string& failure() const { return failure_; }

 private:
  void note_failure() const {
    if (failure_.empty()) failure_ = std::generic_category().message(errno);
  }
  mutable std::string failure_;
};

}  // namespace

float srgb_from_linear(float linear) {
  return linear <= 0.0031308f ? linear * 12.92f : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

float linear_from_srgb(float encoded) {
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

Image read_image(const std::string& path, Meaning meaning,
                 std::vector<std::string>* channel_names) {
  if (!fs::exists(path)) throw Error("there is no such file", path);
  OIIO::ImageSpec wanted;
  wanted.attribute("oiio:UnassociatedAlpha", 1);
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path, &wanted);
  if (!input) throw Error("cannot be read as an image: " + OIIO::geterror(), path);
  const OIIO::ImageSpec spec = input->spec();
  if (spec.depth > 1 || spec.deep)
    throw Error("is a volume or a deep image; a flat picture is needed", path);
  Image image{spec.width, spec.height, spec.nchannels, {}};
  image.samples.resize(size_t(spec.width) * spec.height * spec.nchannels);
  if (!input->read_image(0, 0, 0, spec.nchannels, TypeDesc::FLOAT, image.samples.data()))
    throw Error("cannot be read to its end: " + input->geterror(), path);

  if (meaning == Meaning::color) {
    const bool bytes = !spec.format.is_floating_point();
    const auto space = spec.get_string_attribute("oiio:ColorSpace", bytes ? "sRGB" : "Linear");
    const bool unassociated = spec.get_int_attribute("oiio:UnassociatedAlpha", 0) != 0;
    decode_pixels(image, std::string(space), spec.alpha_channel, unassociated);
  }
  std::vector<std::string> names = spec.channelnames;
  const auto order = std::string(spec.get_string_attribute(channel_order_attribute));
  if (!order.empty()) restore_order(image, names, order);
  if (channel_names) *channel_names = std::move(names);
  return image;
}

struct ImageWriter::State {
  std::string path;
  std::string temporary;
  ImageLayout layout;
  std::unique_ptr<WatchedFile> file;  // PNG only; outlives `output`
  std::unique_ptr<OIIO::ImageOutput> output;
  int rows_written = 0;
  std::vector<bool> tiles_written;
  std::vector<float> encoded;

  int tiles_across() const { return (layout.width + layout.tile - 1) / layout.tile; }
  int tiles_down() const { return (layout.height + layout.tile - 1) / layout.tile; }

  [[noreturn]] void fail(const std::string& doing, const std::string& reason) const {
    throw Failure(doing + ": " + without(reason, temporary, path), path);
  }

  void open() {
    output = OIIO::ImageOutput::create(is_png(layout) ? "png" : "exr");
    if (!output) fail("cannot be written", OIIO::geterror());
    if (is_png(layout)) {
      file = std::make_unique<WatchedFile>(temporary);
      output->set_ioproxy(file.get());
    }
    if (!output->open(temporary, file_spec(layout))) fail("cannot be written", output->geterror());
  }

  void check(bool good) const {
    if (file && !file->failure().empty()) fail("cannot be written", file->failure());
    if (!good) fail("cannot be written", output->geterror());
  }
};

ImageWriter::ImageWriter(const std::string& path, const ImageLayout& layout)
    : state_(std::make_unique<State>()) {
  check_extension(path, layout);
  check_layout(path, layout);
  State& state = *state_;
  state.path = path;
  state.layout = layout;
  state.temporary = temporary_name(path);
  const fs::path folder = fs::absolute(fs::path(path)).parent_path();
  if (!fs::is_directory(folder))
    throw Failure("cannot be written: there is no folder '" + folder.string() + "'", path);
  if (fs::is_directory(path)) throw Failure("cannot be written: it is a folder", path);
  state.open();
  if (layout.tile > 0)
    state.tiles_written.resize(size_t(state.tiles_across()) * state.tiles_down());
}

ImageWriter::~ImageWriter() {
  if (!state_->output) return;
  state_->output->close();
  std::error_code ignored;
  fs::remove(state_->temporary, ignored);
}

void ImageWriter::write_rows(const float* samples, int rows) {
  State& state = *state_;
  const ImageLayout& layout = state.layout;
  if (!state.output || layout.tile > 0 || rows < 1 || state.rows_written + rows > layout.height)
    throw Error("got " + std::to_string(rows) + " rows after " +
                    std::to_string(state.rows_written) + " of " + std::to_string(layout.height),
                state.path);
  const bool encode = is_png(layout) && layout.meaning == Meaning::color;
  const size_t row = size_t(layout.width) * layout.channels;
  const int step = encode ? std::max(1, int((size_t{1} << 18) / row)) : rows;
  for (int done = 0; done < rows; done += step) {
    const int now = std::min(step, rows - done);
    const float* piece = samples + row * done;
    if (encode) {
      state.encoded.assign(piece, piece + row * now);
      encode_pixels(state.encoded, size_t(layout.channels));
      piece = state.encoded.data();
    }
    const int y = state.rows_written;
    state.check(state.output->write_scanlines(y, y + now, 0, TypeDesc::FLOAT, piece));
    state.rows_written += now;
  }
}

void ImageWriter::write_tile(const float* samples, int x, int y) {
  State& state = *state_;
  const ImageLayout& layout = state.layout;
  if (!state.output || layout.tile < 1 || x < 0 || y < 0 || x >= layout.width ||
      y >= layout.height || x % layout.tile || y % layout.tile)
    throw Error("has no tile at " + std::to_string(x) + ", " + std::to_string(y), state.path);
  const int right = std::min(x + layout.tile, layout.width);
  const int bottom = std::min(y + layout.tile, layout.height);
  state.check(state.output->write_tiles(x, right, y, bottom, 0, 1, TypeDesc::FLOAT, samples));
  state.tiles_written[size_t(y / layout.tile) * state.tiles_across() + x / layout.tile] = true;
}

void ImageWriter::finish() {
  State& state = *state_;
  if (!state.output) throw Error("is finished already", state.path);
  const auto missing = std::count(state.tiles_written.begin(), state.tiles_written.end(), false);
  if (state.layout.tile > 0 ? missing > 0 : state.rows_written < state.layout.height)
    throw Error(state.layout.tile > 0
                    ? std::to_string(missing) + " tiles were not written"
                    : "only " + std::to_string(state.rows_written) + " of " +
                          std::to_string(state.layout.height) + " rows were written",
                state.path);
  const bool closed = state.output->close();
  if (state.file) state.file->flush();
  state.check(closed);
  std::error_code failed;
  fs::rename(state.temporary, state.path, failed);
  if (failed) state.fail("cannot be written", failed.message());
  state.output.reset();
}

void write_image(const std::string& path, const Image& image, Meaning meaning, Depth depth,
                 const std::vector<std::string>& channel_names) {
  if (image.samples.size() != size_t(image.width) * image.height * image.channels)
    throw Error("the image's samples do not match its size", path);
  ImageWriter writer(path,
                     {image.width, image.height, image.channels, meaning, depth, channel_names});
  writer.write_rows(image.samples.data(), image.height);
  writer.finish();
}

void write_texture(const std::string& path, const Image& image, Meaning meaning,
                   const std::vector<std::string>& channel_names) {
  if (fs::path(path).extension() != ".tx") throw Error("a texture ends in .tx", path);
  const OIIO::ImageSpec spec = file_spec(
      {image.width, image.height, image.channels, meaning, Depth::float32, channel_names});
  const OIIO::ImageBuf pixels(spec, const_cast<float*>(image.samples.data()));
  OIIO::ImageSpec options;
  options.attribute("maketx:filtername", "box");
  options.attribute("maketx:fileformatname", "tiff");
  const std::string temporary = temporary_name(path);
  std::stringstream report;
  std::error_code failed;
  if (!OIIO::ImageBufAlgo::make_texture(OIIO::ImageBufAlgo::MakeTxTexture, pixels, temporary,
                                        options, &report)) {
    fs::remove(temporary, failed);
    throw Failure("cannot be written: " + OIIO::geterror(), path);
  }
  fs::rename(temporary, path, failed);
  if (failed) throw Failure("cannot be written: " + failed.message(), path);
}

std::string encode_png(const Image& image, Meaning meaning) {
  const ImageLayout layout{image.width, image.height, image.channels, meaning, Depth::byte8};
  check_layout("PNG", layout);
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create("png");
  if (!output || !output->set_ioproxy(&memory) || !output->open("memory.png", file_spec(layout)))
    throw Failure("a PNG cannot be made: " + (output ? output->geterror() : OIIO::geterror()));
  Image encoded = image;
  if (meaning == Meaning::color) encode_pixels(encoded.samples, size_t(image.channels));
  if (!output->write_image(TypeDesc::FLOAT, encoded.samples.data()) || !output->close())
    throw Failure("a PNG cannot be made: " + output->geterror());
  return std::string(bytes.begin(), bytes.end());
}

namespace {

constexpr int push_pull_limit = 2048;

void fill_by_push_pull(Image& image, const std::vector<unsigned char>& covered) {
  OIIO::ImageSpec spec(image.width, image.height, image.channels + 1, TypeDesc::FLOAT);
  spec.alpha_channel = image.channels;
  OIIO::ImageBuf holes(spec);
  const size_t channels = size_t(image.channels);
  auto* pixel = static_cast<float*>(holes.localpixels());
  for (size_t i = 0; i < covered.size(); ++i, pixel += channels + 1) {
    if (!covered[i]) continue;
    std::copy_n(&image.samples[i * channels], channels, pixel);
    pixel[channels] = 1;
  }
  const OIIO::ImageBuf filled = OIIO::ImageBufAlgo::fillholes_pushpull(holes);
  if (filled.has_error()) throw Error("uncovered texels cannot be filled: " + filled.geterror());
  const auto* source = static_cast<const float*>(filled.localpixels());
  for (size_t i = 0; i < covered.size(); ++i, source += channels + 1)
    if (!covered[i]) std::copy_n(source, channels, &image.samples[i * channels]);
}

// The mean of the covered ones of each 2 x 2 texels; `covered` becomes that of the half image.
Image half_of(const Image& image, std::vector<unsigned char>& covered) {
  Image half{(image.width + 1) / 2, (image.height + 1) / 2, image.channels, {}};
  half.samples.resize(size_t(half.width) * half.height * half.channels);
  std::vector<unsigned char> half_covered(size_t(half.width) * half.height);
  for (int y = 0; y < half.height; ++y) {
    for (int x = 0; x < half.width; ++x) {
      float count = 0;
      float* mean = half.at(x, y);
      for (int v = 2 * y; v < std::min(2 * y + 2, image.height); ++v)
        for (int u = 2 * x; u < std::min(2 * x + 2, image.width); ++u) {
          if (!covered[size_t(v) * image.width + u]) continue;
          ++count;
          for (int c = 0; c < image.channels; ++c) mean[c] += image.at(u, v)[c];
        }
      if (count == 0) continue;
      for (int c = 0; c < image.channels; ++c) mean[c] /= count;
      half_covered[size_t(y) * half.width + x] = 1;
    }
  }
  covered = std::move(half_covered);
  return half;
}

void fill_from_half(Image& image, const std::vector<unsigned char>& covered, const Image& half) {
  const auto neighbours = [](int i, int size) {
    const int near = i / 2;
    return std::pair(near, std::clamp(near + (i % 2 ? 1 : -1), 0, size - 1));
  };
  for (int y = 0; y < image.height; ++y) {
    const auto [y0, y1] = neighbours(y, half.height);
    for (int x = 0; x < image.width; ++x) {
      if (covered[size_t(y) * image.width + x]) continue;
      const auto [x0, x1] = neighbours(x, half.width);
      // Bilinear: a texel's centre lies a quarter of a half texel from the nearest one's centre.
      for (int c = 0; c < image.channels; ++c)
        image.at(x, y)[c] = 0.5625f * half.at(x0, y0)[c] + 0.0625f * half.at(x1, y1)[c] +
                            0.1875f * (half.at(x1, y0)[c] + half.at(x0, y1)[c]);
    }
  }
}

void fill(Image& image, const std::vector<unsigned char>& covered) {
  if (std::max(image.width, image.height) <= push_pull_limit) {
    fill_by_push_pull(image, covered);
    return;
  }
  std::vector<unsigned char> half_covered = covered;
  Image half = half_of(image, half_covered);
  fill(half, half_covered);
  fill_from_half(image, covered, half);
}

}  // namespace

void fill_uncovered(Image& image, const std::vector<unsigned char>& covered) {
  if (covered.size() != size_t(image.width) * image.height)
    throw Error("the coverage has " + std::to_string(covered.size()) + " entries for " +
                std::to_string(image.width) + " x " + std::to_string(image.height) + " texels");
  const auto holes = std::count(covered.begin(), covered.end(), 0);
  if (size_t(holes) == covered.size())
    throw Error("no texel of the texture is covered, so there is nothing to fill it from");
  if (holes > 0) fill(image, covered);
}

}  // namespace sardf

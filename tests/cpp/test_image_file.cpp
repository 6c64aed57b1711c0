#include "sardf/image_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>

#include "error_of.hpp"

namespace sardf {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

class ImageFile : public testing::Test {
 protected:
  void SetUp() override {
    const auto own = fs::temp_directory_path() / ("sardf_image_" + std::to_string(getpid()));
    setenv(folder_variable, own.c_str(), 0);  // a death test's child gets its parent's folder
    folder_ = getenv(folder_variable);
    fs::create_directories(folder_);
  }
  void TearDown() override {
    fs::remove_all(folder_);
    unsetenv(folder_variable);
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  size_t files() const {
    return size_t(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  static constexpr const char* folder_variable = "SARDF_IMAGE_TEST_FOLDER";
  fs::path folder_;
};

Image random_image(int width, int height, int channels, float low = 0, float high = 1) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> value(low, high);
  Image image{width, height, channels, {}};
  image.samples.resize(size_t(width) * height * channels);
  for (float& sample : image.samples) sample = value(random);
  return image;
}

TEST(Srgb, FollowsThePublishedCurve) {
  // IEC 61966-2-1: linear below 0.0031308, then 1.055 c^(1/2.4) - 0.055. 0.5 is encoded as
  // 0.735357 and 18 % grey as 0.461356 (both widely tabulated).
  EXPECT_NEAR(srgb_from_linear(0.5f), 0.735357, 1e-6);
  EXPECT_NEAR(srgb_from_linear(0.18f), 0.461356, 1e-6);
  EXPECT_FLOAT_EQ(srgb_from_linear(0.001f), 0.01292f);
  EXPECT_EQ(srgb_from_linear(0), 0);
  EXPECT_FLOAT_EQ(srgb_from_linear(1), 1);
  for (int i = 0; i <= 1000; ++i) {
    const double c = i / 1000.0;
    const double formula = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
    EXPECT_NEAR(srgb_from_linear(float(c)), formula, 2e-7);
    EXPECT_NEAR(linear_from_srgb(float(formula)), c, 4e-7);
  }
}

TEST_F(ImageFile, FloatExrIsExact) {
  Image image = random_image(37, 19, 3, -5, 5);
  image.samples[0] = 1e-30f;
  image.samples[1] = 3e20f;
  for (const Meaning meaning : {Meaning::color, Meaning::data}) {
    write_image(path("a.exr"), image, meaning, Depth::float32);
    const Image back = read_image(path("a.exr"), meaning);
    EXPECT_EQ(back.width, 37);
    EXPECT_EQ(back.height, 19);
    EXPECT_EQ(back.channels, 3);
    EXPECT_EQ(back.samples, image.samples);
  }
  EXPECT_EQ(files(), 1u);
}

TEST_F(ImageFile, HalfExrIsWithinHalfPrecision) {
  const Image image = random_image(20, 20, 3);
  write_image(path("a.exr"), image, Meaning::color, Depth::half16);
  const Image back = read_image(path("a.exr"), Meaning::color);
  for (size_t i = 0; i < image.samples.size(); ++i)
    EXPECT_NEAR(back.samples[i], image.samples[i], image.samples[i] / 2048 + 1e-7);
}

TEST_F(ImageFile, ExrKeepsTheOrderOfNamedChannels) {
  const Image image = random_image(5, 4, 3);
  write_image(path("a.exr"), image, Meaning::data, Depth::float32, {"steel", "carbide", "bronze"});
  std::vector<std::string> names;
  const Image back = read_image(path("a.exr"), Meaning::data, &names);
  EXPECT_THAT(names, ElementsAre("steel", "carbide", "bronze"));
  EXPECT_EQ(back.samples, image.samples);
}

TEST_F(ImageFile, PngStoresColorAsSrgbWithinHalfAStep) {
  const Image image = random_image(64, 64, 3);
  write_image(path("a.png"), image, Meaning::color, Depth::byte16);
  const Image stored = read_image(path("a.png"), Meaning::data);
  const Image back = read_image(path("a.png"), Meaning::color);
  for (size_t i = 0; i < image.samples.size(); ++i) {
    const double c = image.samples[i];
    const double formula = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
    EXPECT_NEAR(stored.samples[i], formula, 0.5 / 65535 + 3e-7);
    EXPECT_NEAR(back.samples[i], c, 1.2 / 65535);  // the curve's slope is below 2.4
  }
  write_image(path("b.png"), image, Meaning::color, Depth::byte8);
  const Image bytes = read_image(path("b.png"), Meaning::data);
  for (size_t i = 0; i < image.samples.size(); ++i)
    EXPECT_NEAR(bytes.samples[i], stored.samples[i], 0.5 / 255 + 1e-5);
}

TEST_F(ImageFile, PngStoresDataAsItIs) {
  for (const int channels : {1, 2, 3, 4}) {
    const Image image = random_image(33, 21, channels);
    write_image(path("a.png"), image, Meaning::data, Depth::byte16);
    const Image back = read_image(path("a.png"), Meaning::data);
    ASSERT_EQ(back.channels, channels);
    for (size_t i = 0; i < image.samples.size(); ++i)
      EXPECT_NEAR(back.samples[i], image.samples[i], 0.5 / 65535 + 1e-7);
  }
}

TEST_F(ImageFile, AlphaIsMultipliedInMemoryAndNotInPng) {
  const Image image{1, 1, 4, {0.25f, 0.125f, 0, 0.5f}};
  write_image(path("a.png"), image, Meaning::color, Depth::byte16);
  const Image stored = read_image(path("a.png"), Meaning::data);
  EXPECT_NEAR(stored.samples[0], 0.735357, 1e-5);  // sRGB of 0.25 / 0.5
  EXPECT_NEAR(stored.samples[3], 0.5, 1e-5);
  const Image back = read_image(path("a.png"), Meaning::color);
  for (size_t c = 0; c < 4; ++c) EXPECT_NEAR(back.samples[c], image.samples[c], 2e-5);
}

TEST_F(ImageFile, TilesInAnyOrderGiveTheSameImageAsRows) {
  const Image image = random_image(100, 70, 3);
  ImageWriter writer(path("tiled.exr"),
                     {100, 70, 3, Meaning::data, Depth::float32, {"a", "b", "c"}, 32});
  for (int y = 64; y >= 0; y -= 32)
    for (int x = 96; x >= 0; x -= 32) {
      std::vector<float> tile;
      for (int v = y; v < std::min(y + 32, 70); ++v)
        for (int u = x; u < std::min(x + 32, 100); ++u)
          tile.insert(tile.end(), image.at(u, v), image.at(u, v) + 3);
      if (x == 0 && y == 0) {
        EXPECT_THAT(error_of([&] { writer.finish(); }), HasSubstr("1 tiles were not written"));
      }
      writer.write_tile(tile.data(), x, y);
    }
  EXPECT_FALSE(fs::exists(path("tiled.exr")));
  writer.finish();
  EXPECT_EQ(read_image(path("tiled.exr"), Meaning::data).samples, image.samples);
}

TEST_F(ImageFile, RowsInPiecesGiveTheSameFileAsAtOnce) {
  const Image image = random_image(300, 50, 3);
  for (const std::string name : {"a.png", "a.exr"}) {
    const Depth depth = name == "a.png" ? Depth::byte8 : Depth::half16;
    ImageWriter writer(path(name), {300, 50, 3, Meaning::color, depth});
    for (int y = 0; y < 50; y += 10) {
      if (y == 40) {
        EXPECT_THAT(error_of([&] { writer.finish(); }), HasSubstr("only 40 of 50 rows"));
      }
      writer.write_rows(image.at(0, y), 10);
    }
    writer.finish();
    write_image(path("once" + name), image, Meaning::color, depth);
    EXPECT_EQ(read_image(path(name), Meaning::data).samples,
              read_image(path("once" + name), Meaning::data).samples);
    EXPECT_THAT(error_of([&] { writer.write_rows(image.at(0, 0), 1); }), HasSubstr(name));
  }
}

TEST_F(ImageFile, PngInMemoryIsTheFile) {
  const Image image = random_image(40, 30, 3);
  const std::string bytes = encode_png(image, Meaning::color);
  EXPECT_EQ(bytes.substr(0, 8), "\x89PNG\r\n\x1a\n");
  std::ofstream(path("memory.png"), std::ios::binary) << bytes;
  write_image(path("file.png"), image, Meaning::color, Depth::byte8);
  EXPECT_EQ(read_image(path("memory.png"), Meaning::data).samples,
            read_image(path("file.png"), Meaning::data).samples);
}

TEST_F(ImageFile, UnwritablePlacesAreErrorsAndLeaveNothing) {
  const Image image = random_image(4, 4, 3);
  const auto write = [&](const std::string& name, Depth depth) {
    return error_of([&] { write_image(path(name), image, Meaning::color, depth); });
  };
  std::ofstream(path("plain")) << "a file";
  fs::create_directory(path("folder.exr"));
  EXPECT_THAT(write("missing/a.exr", Depth::float32),
              AllOf(HasSubstr("missing/a.exr"), HasSubstr("there is no folder")));
  EXPECT_THAT(write("plain/a.png", Depth::byte8), HasSubstr("there is no folder"));
  EXPECT_THAT(write("folder.exr", Depth::float32), HasSubstr("it is a folder"));
  EXPECT_THAT(write("a.jpeg", Depth::byte8), HasSubstr("written as .exr or .png"));
  EXPECT_THAT(write("a.png", Depth::float32), HasSubstr("8 or 16 bits"));
  EXPECT_THAT(write("a.exr", Depth::byte8), HasSubstr("half or float"));
  EXPECT_THAT(error_of([&] {
                write_image(path("a.exr"), image, Meaning::data, Depth::float32, {"one", "two"});
              }),
              HasSubstr("2 channel names for 3 channels"));
  EXPECT_EQ(files(), 2u);
}

TEST_F(ImageFile, UnreadableFilesAreErrors) {
  const auto read = [&](const std::string& name) {
    return error_of([&] { read_image(path(name), Meaning::color); });
  };
  std::ofstream(path("text.png")) << "this is no picture";
  EXPECT_THAT(read("none.exr"), AllOf(HasSubstr("none.exr"), HasSubstr("no such file")));
  EXPECT_THAT(read("text.png"), AllOf(HasSubstr("text.png"), HasSubstr("cannot be read")));
  for (const std::string name : {"cut.png", "cut.exr"}) {
    write_image(path(name), random_image(200, 200, 3), Meaning::color,
                name == "cut.png" ? Depth::byte8 : Depth::float32);
    fs::resize_file(path(name), fs::file_size(path(name)) / 2);
    EXPECT_THAT(read(name), AllOf(HasSubstr(name), HasSubstr("cannot be read")));
  }
}

// A full disk, played by the limit of a file's size.
TEST_F(ImageFile, AFullDiskIsAnErrorAndKeepsTheOldFile) {
  const Image old_image = random_image(4, 4, 3);
  const Image image = random_image(400, 400, 3);
  signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  for (const std::string name : {"a.png", "a.exr"}) {
    const Depth depth = name == "a.png" ? Depth::byte8 : Depth::float32;
    write_image(path(name), old_image, Meaning::data, depth);
    const rlimit small{20000, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    const std::string error =
        error_of([&] { write_image(path(name), image, Meaning::data, depth); });
    setrlimit(RLIMIT_FSIZE, &before);
    EXPECT_THAT(error, HasSubstr(name + ": cannot be written"));
    EXPECT_THAT(error, Not(HasSubstr("partial")));
    EXPECT_EQ(read_image(path(name), Meaning::data).width, 4);
  }
  EXPECT_EQ(files(), 2u);
}

TEST_F(ImageFile, AnUnfinishedWriterLeavesNothing) {
  const Image image = random_image(64, 64, 3);
  {
    ImageWriter writer(path("a.exr"), {64, 64, 3, Meaning::color, Depth::float32});
    writer.write_rows(image.samples.data(), 64);
    EXPECT_EQ(files(), 1u);
  }
  EXPECT_EQ(files(), 0u);
}

TEST_F(ImageFile, AKilledWriterLeavesNothingUnderTheFinalName) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // OpenImageIO's threads do not survive a fork
  for (const std::string name : {"a.png", "a.exr"}) {
    const Depth depth = name == "a.png" ? Depth::byte8 : Depth::float32;
    const auto write_and_die = [&] {
      const std::vector<float> row(64 * 3);
      ImageWriter writer(path(name), {64, 64, 3, Meaning::color, depth});
      writer.write_rows(row.data(), 1);
      raise(SIGKILL);
    };
    EXPECT_EXIT(write_and_die(), testing::KilledBySignal(SIGKILL), "");
    EXPECT_FALSE(fs::exists(path(name)));
  }
  EXPECT_EQ(files(), 2u);  // what the dead could not remove
}

TEST(FillUncovered, KeepsTheCoveredAndStaysWithinTheirRange) {
  for (const int size : {61, 2500}) {
    const Image before = random_image(size, size / 2, 3, 0.25f, 0.75f);
    Image image = before;
    std::mt19937 random(3);
    std::vector<unsigned char> covered(size_t(size) * (size / 2));
    for (size_t i = 0; i < covered.size(); ++i) {
      covered[i] = random() % 50 == 0 && i > covered.size() / 4;
      if (!covered[i]) image.at(int(i) % size, int(i) / size)[1] = NAN;
    }
    fill_uncovered(image, covered);
    for (size_t i = 0; i < covered.size(); ++i)
      for (size_t c = 3 * i; c < 3 * i + 3; ++c) {
        if (covered[i])
          ASSERT_EQ(std::bit_cast<uint32_t>(image.samples[c]),
                    std::bit_cast<uint32_t>(before.samples[c]));
        else
          ASSERT_TRUE(image.samples[c] > 0.2499f && image.samples[c] < 0.7501f)
              << image.samples[c] << " at " << i << " of " << size;
      }
  }
}

TEST(FillUncovered, FillsAHoleFromAroundIt) {
  // Left half 0.2, right half 0.8, the right half's middle missing: it becomes 0.8.
  for (const int size : {64, 4096}) {
    Image image{size, 64, 1, ImageSamples(size_t(size) * 64)};
    std::vector<unsigned char> covered(size_t(size) * 64, 1);
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < size; ++x) *image.at(x, y) = x < size / 2 ? 0.2f : 0.8f;
    for (int y = 28; y < 36; ++y)
      for (int x = size - 16; x < size - 8; ++x) {
        *image.at(x, y) = 100;
        covered[size_t(y) * size + x] = 0;
      }
    fill_uncovered(image, covered);
    for (int y = 28; y < 36; ++y)
      for (int x = size - 16; x < size - 8; ++x) EXPECT_NEAR(*image.at(x, y), 0.8f, 1e-3f);
  }
}

TEST(FillUncovered, NeedsSomethingToFillFrom) {
  Image image = random_image(8, 8, 3);
  EXPECT_THAT(error_of([&] { fill_uncovered(image, std::vector<unsigned char>(64)); }),
              HasSubstr("no texel of the texture is covered"));
  EXPECT_THAT(error_of([&] { fill_uncovered(image, std::vector<unsigned char>(63)); }),
              HasSubstr("63 entries for 8 x 8"));
}

}  // namespace
}  // namespace sardf

#include "sardf/compare_images.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/compare_json.hpp"
#include "cli/compare_report.hpp"
#include "sardf/edge_distance.hpp"
#include "sardf/error.hpp"

namespace sardf {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

template <typename Inside>
Mask mask_of(int width, int height, Inside inside) {
  Mask mask;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) mask.push_back(inside(x, y) ? 1 : 0);
  return mask;
}

Image plain(int width, int height, const std::array<float, 3>& color) {
  Image image{width, height, 3, {}};
  for (int i = 0; i < width * height; ++i)
    image.samples.insert(image.samples.end(), color.begin(), color.end());
  return image;
}

// A disc with a colour gradient on black, as a renderer would sample it at the pixels' centres.
struct Render {
  Image color = plain(160, 120, {0, 0, 0});
  Image normal = plain(160, 120, {0, 0, 0});
  Mask mask;
  explicit Render(double center_x = 80, double radius = 45, double step = 0) {
    mask = mask_of(160, 120, [&](int x, int y) {
      const double u = x - center_x, v = y - 60;
      const double square = u * u + v * v;
      if (square > radius * radius) return false;
      const float shade = float(0.2 + 0.004 * (u + 50) + step / 255);
      const double z = std::sqrt(std::max(0.0, 1 - square / (radius * radius)));
      const float colors[3] = {shade, 0.5f, 0.9f - shade};
      const double normals[3] = {u / radius, v / radius, z};
      for (int c = 0; c < 3; ++c) {
        color.at(x, y)[c] = colors[c];
        normal.at(x, y)[c] = float(0.5 + 0.5 * normals[c]);
      }
      return true;
    });
  }
  Picture picture() const { return {color, mask, &normal}; }
};

std::vector<std::string> failed(const Render& reference, const Render& candidate) {
  return failed_criteria(compare_images(reference.picture(), candidate.picture()), {});
}

TEST(EdgeDistance, AHalfPlaneMovedByAPixelIsAPixelAway) {
  for (const int pixels : {0, 1, 3}) {
    const Mask a = mask_of(30, 20, [](int x, int) { return x < 10; });
    const Mask b = mask_of(30, 20, [&](int x, int) { return x < 10 + pixels; });
    const auto edge = edge_elements(a, 30, 20);
    ASSERT_EQ(edge.size(), 20u);
    for (const EdgeElement& element : edge) EXPECT_DOUBLE_EQ(element.x, 9.5);
    for (const double d : edge_distances(edge, edge_elements(b, 30, 20), 30, 20))
      EXPECT_NEAR(d, pixels, 1e-12);
  }
}

// The outline of a hard disc, found to a fraction of a pixel.
TEST(EdgeDistance, FindsACircleBetweenThePixels) {
  const Mask disc =
      mask_of(160, 120, [](int x, int y) { return std::hypot(x - 80.3, y - 60.1) <= 45; });
  double sum = 0;
  const auto edge = edge_elements(disc, 160, 120);
  for (const EdgeElement& element : edge) {
    const double off = std::hypot(element.x - 80.3, element.y - 60.1) - 45;
    EXPECT_LT(std::abs(off), 0.45);
    sum += std::abs(off);
  }
  EXPECT_GT(edge.size(), 280u);  // the sides of a circle's pixels number 8 r
  EXPECT_LT(sum / double(edge.size()), 0.13);
}

TEST(EdgeDistance, MeasuresShiftsFinerThanAPixel) {
  const auto tilted = [](double shift) {  // an edge of slope 0.3, moved along its normal
    return mask_of(120, 100,
                   [&](int x, int y) { return (y - 0.3 * x - 30) / std::hypot(1, 0.3) > shift; });
  };
  for (const double shift : {0.25, 0.5, 1.0, 2.0}) {
    const auto distances = edge_distances(edge_elements(tilted(0), 120, 100),
                                          edge_elements(tilted(shift), 120, 100), 120, 100);
    double sum = 0;
    for (const double d : distances) sum += d;
    EXPECT_NEAR(sum / double(distances.size()), shift, 0.12) << shift;
  }
}

TEST(EdgeDistance, AWrongPixelOnAnEdgeIsLessThanHalfAPixel) {
  const Mask a = mask_of(60, 40, [](int, int y) { return y < 20; });
  Mask b = a;
  b[20 * 60 + 30] = 1;
  const auto edge_a = edge_elements(a, 60, 40), edge_b = edge_elements(b, 60, 40);
  EXPECT_EQ(edge_b.size(), 62u);  // two more sides
  const auto distances = edge_distances(edge_b, edge_a, 60, 40);
  const double largest = *std::max_element(distances.begin(), distances.end());
  EXPECT_GT(largest, 0.2);
  EXPECT_LT(largest, 0.5);
}

TEST(EdgeDistance, SeesThinAndMissingThings) {
  const Mask wall = mask_of(80, 60, [](int x, int) { return x < 20; });
  const Mask with_line = mask_of(80, 60, [](int x, int) { return x < 20 || x == 50; });
  const auto distances =
      edge_distances(edge_elements(with_line, 80, 60), edge_elements(wall, 80, 60), 80, 60);
  EXPECT_EQ(
      std::count_if(distances.begin(), distances.end(), [](double d) { return d > 29 && d < 32; }),
      120);
  for (const double d : edge_distances(edge_elements(wall, 80, 60), {}, 80, 60))
    EXPECT_EQ(d, 100);  // the diagonal
}

TEST(Comparison, OfTinyMasksByHand) {
  const Image image = plain(8, 8, {0.5f, 0.5f, 0.5f});
  // Two 2 x 2 squares that share one column: 2 pixels of 6.
  const Mask a = mask_of(8, 8, [](int x, int y) { return (x == 2 || x == 3) && y / 2 == 1; });
  const Mask b = mask_of(8, 8, [](int x, int y) { return (x == 3 || x == 4) && y / 2 == 1; });
  const Comparison result = compare_images({image, a}, {image, b});
  EXPECT_DOUBLE_EQ(result.intersection_over_union, 2.0 / 6);
  EXPECT_EQ(result.edge_elements, 16u);
  EXPECT_EQ(result.color.compared_pixels, 0u);
  EXPECT_EQ(result.color.outline_share, 1);
  EXPECT_THAT(failed_criteria(result, {}), Contains(HasSubstr("colour pixels compared is 0")));
}

TEST(Comparison, CountsAndQuantilesByHand) {
  // A square of 30 x 30 pixels in 40 x 40: its inner 28 x 28 = 784 see only pixels inside. Left
  // half red, right half green: the 2 x 28 at the border between them span more than 16 steps.
  const Mask mask =
      mask_of(40, 40, [](int x, int y) { return x >= 5 && x < 35 && y >= 5 && y < 35; });
  Image reference = plain(40, 40, {1, 0, 0});
  for (int y = 0; y < 40; ++y)
    for (int x = 20; x < 40; ++x) {
      reference.at(x, y)[0] = 0;
      reference.at(x, y)[1] = 1;
    }
  Image candidate = reference;
  const auto compare = [&] { return compare_images({reference, mask}, {candidate, mask}).color; };
  EXPECT_EQ(compare().compared_pixels, 728u);
  EXPECT_DOUBLE_EQ(compare().left_out_share, 172.0 / 900);
  EXPECT_DOUBLE_EQ(compare().outline_share, 116.0 / 900);
  EXPECT_EQ(compare().left_out_within_share, 1);

  // 1 % of 728 pixels is 7.28: the 99 % quantile sees the eighth wrong pixel, not the seventh.
  for (int i = 0; i < 8; ++i) {
    EXPECT_EQ(compare().quantile_99, 0) << i;
    candidate.at(8 + i, 10)[2] = 10.0f / 255;
  }
  EXPECT_NEAR(compare().quantile_99, 10, 1e-4);
  EXPECT_NEAR(compare().maximum, 10, 1e-4);
  EXPECT_EQ(compare().median, 0);

  // At the border yellow lies between red and green, blue does not.
  candidate.at(20, 20)[0] = 1;
  EXPECT_EQ(compare().left_out_within_share, 1);
  candidate.at(20, 20)[2] = 3.9f / 255;
  EXPECT_EQ(compare().left_out_within_share, 1);
  candidate.at(20, 20)[2] = 4.1f / 255;
  EXPECT_DOUBLE_EQ(compare().left_out_within_share, 171.0 / 172);
}

TEST(Comparison, IdenticalPicturesPassWithZeros) {
  const Render render;
  const Comparison result = compare_images(render.picture(), render.picture());
  EXPECT_EQ(result.intersection_over_union, 1);
  EXPECT_EQ(result.edge_within_half_pixel_share, 1);
  EXPECT_EQ(result.edge_distance_maximum, 0);
  EXPECT_EQ(result.color.maximum, 0);
  EXPECT_EQ(result.color.left_out_within_share, 1);
  EXPECT_EQ(result.normal->maximum, 0);
  EXPECT_GT(result.color.compared_pixels, 5000u);
  EXPECT_THAT(failed_criteria(result, {}), ElementsAre());
  EXPECT_TRUE(passes(result, {}));
}

TEST(Comparison, SmallDifferencesPass) {
  EXPECT_THAT(failed(Render(80.37, 45.11), Render(80.4, 45.12, 0.3)), ElementsAre());
}

TEST(Comparison, AShiftOfAPixelFails) {
  EXPECT_THAT(failed(Render(80), Render(81)), AllOf(Contains(HasSubstr("intersection over union")),
                                                    Contains(HasSubstr("edges within 0.5 px"))));
}

TEST(Comparison, ALargerObjectFails) {
  EXPECT_THAT(failed(Render(80, 45), Render(80, 45.8)), Contains(HasSubstr("edges within")));
}

TEST(Comparison, AnotherColorFails) {
  EXPECT_THAT(failed(Render(), Render(80, 45, 3)),
              AllOf(Contains(HasSubstr("colour difference, median is 3/255, but at most 0.5/255")),
                    Contains(HasSubstr("colour difference, 99 % is 3/255"))));
}

TEST(Comparison, OtherNormalsFail) {
  const Render reference;
  Render candidate;
  for (float& sample : candidate.normal.samples) sample += 3.0f / 255;
  EXPECT_THAT(failed(reference, candidate), ElementsAre(HasSubstr("normal difference, median")));
}

TEST(Comparison, OneNanIsSeen) {
  const Render reference;
  Render candidate;
  candidate.color.at(80, 60)[1] = NAN;
  EXPECT_EQ(compare_images(reference.picture(), candidate.picture()).color.maximum, 255);
  EXPECT_THAT(failed(reference, candidate),
              ElementsAre(HasSubstr("not finite is 1, but at most 0")));
}

TEST(Comparison, LatticesMayDifferMore) {
  Comparison result = compare_images(Render().picture(), Render().picture());
  result.intersection_over_union = 0.996;
  EXPECT_FALSE(passes(result, {}));
  EXPECT_TRUE(passes(result, Limits::lattice()));
}

TEST(Comparison, NeedsPicturesOfOneSize) {
  const Image small = plain(4, 4, {1, 1, 1}), large = plain(5, 4, {1, 1, 1});
  const Mask full_small(16, 1), full_large(20, 1), empty(16);
  const auto error = [](const Picture& a, const Picture& b) -> std::string {
    try {
      compare_images(a, b);
    } catch (const Error& caught) {
      return caught.what();
    }
    return "no error";
  };
  EXPECT_THAT(error({small, full_small}, {large, full_large}),
              AllOf(HasSubstr("5 x 4"), HasSubstr("4 x 4")));
  EXPECT_THAT(error({small, full_small}, {small, full_large}), HasSubstr("20 pixels"));
  EXPECT_THAT(error({small, full_small}, {small, empty}),
              HasSubstr("the candidate's mask is empty"));
}

TEST(Masks, FromAlphaAndFromBackground) {
  const Image alpha{3, 1, 4, {1, 1, 1, 0.4f, 0, 0, 0, 0.5f, 0, 0, 0, 1}};
  EXPECT_THAT(mask_from_alpha(alpha), ElementsAre(0, 1, 1));
  EXPECT_THROW(mask_from_alpha(plain(2, 2, {0, 0, 0})), Error);
  const Image color{3, 1, 3, {0.1f, 0.2f, 0.3f, 0.1f, 0.2f, 0.31f, 0.1015f, 0.2f, 0.3f}};
  EXPECT_THAT(mask_from_background(color, {0.1f, 0.2f, 0.3f}), ElementsAre(0, 1, 0));
}

TEST(Difference, IsSixteenfoldAndClamped) {
  const Image a{2, 1, 3, {0.5f, 0.5f, 0.5f, 0, 0, 0}};
  const Image b{2, 1, 3, {0.51f, 0.49f, 0.5f, 0.5f, NAN, 0}};
  const Image apart = difference_image(a, b);
  const float expected[] = {0.16f, 0.16f, 0, 1, 1, 0};
  for (size_t i = 0; i < 6; ++i) EXPECT_NEAR(apart.samples[i], expected[i], 1e-6f);
}

TEST(Comparison, JsonHoldsTheNumbersAndTheVerdict) {
  const Render a, b(81);
  const auto json = to_json(compare_images(a.picture(), b.picture()), {});
  EXPECT_FALSE(json["passes"].get<bool>());
  EXPECT_GT(json["edge_distance_99"].get<double>(), 0.9);
  EXPECT_EQ(json["width"], 160);
  EXPECT_EQ(json["criteria"].size(), 10u);
  EXPECT_GE(json["failed"].size(), 2u);
}

TEST(Report, EscapesTextAndRefusesUnevenScenes) {
  const Render a;
  ReportScene scene;
  scene.title = "<script>&\"";
  EXPECT_THROW(report_page("t", {scene}), Error);
  ReportView view{"one", {report_picture("Colour", a.color, a.color, Meaning::color)}, {}, {}};
  scene.views = {view, view};
  EXPECT_THAT(report_page("t", {scene}),
              AllOf(HasSubstr("&lt;script&gt;&amp;&quot;"), Not(HasSubstr("<script"))));
  scene.views[1].pictures.clear();
  EXPECT_THROW(report_page("t", {scene}), Error);
}

}  // namespace
}  // namespace sardf

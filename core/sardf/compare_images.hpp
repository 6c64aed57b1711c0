// How far two renders of one scene agree, in numbers, and whether that is enough.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "sardf/image_file.hpp"

namespace sardf {

/// One byte for each pixel, row 0 at the top: not 0 where the object is.
using Mask = std::vector<unsigned char>;

/// The pixels whose last channel is at least 0.5. An Error without 2 or 4 channels.
Mask mask_from_alpha(const Image& image);

/// The pixels that differ from `background` (linear RGB) by more than `tolerance` in any of the
/// first three channels. A NaN differs.
Mask mask_from_background(const Image& image, const std::array<float, 3>& background,
                          float tolerance = 0.5f / 255);

/// One renderer's pictures of the scene. Colours are linear RGB (further channels are ignored);
/// a normal is stored as the colour 0.5 + 0.5 n. `normal` may be null.
struct Picture {
  const Image& color;
  const Mask& mask;
  const Image* normal = nullptr;
};

/// Differences are the largest of the three channels, in steps of 8-bit images: x 255, linear.
/// Quantiles are values that occur: the smallest one that the share of pixels does not exceed.
struct ColorAgreement {
  /// Pixels whose 3 x 3 neighbourhood lies wholly in both masks and spans at most 16 steps in
  /// every channel of the reference.
  size_t compared_pixels = 0;
  double median = 0;
  double quantile_99 = 0;
  double maximum = 0;
  /// The others, as a share of the pixels in both masks; those at the outline alone (the
  /// neighbourhood leaves a mask); and the share of the others that lies within the range of the
  /// reference's neighbourhood inside its mask, widened by 4 steps.
  double left_out_share = 0;
  double outline_share = 0;
  double left_out_within_share = 1;
};

struct Comparison {
  int width = 0;
  int height = 0;
  /// Pixels in both masks over pixels in either.
  double intersection_over_union = 0;
  /// An edge element is a side between a pixel in a mask and one that is not (the picture's frame
  /// is no edge). The masks are hard, so every element is moved to the 0.5 level of its mask
  /// smoothed with the 5 x 5 binomial filter: a circle is found to 0.1 px in the mean, a single
  /// wrong pixel shows as less than 0.5 px, a straight edge moved by 1 px as 1 px. An element's
  /// distance is to the nearest one of the other mask, taken as 1.5 px of tangent. Both directions
  /// count; without any element in one mask, distances to it are the picture's diagonal. Measured
  /// on discs, boxes and bars: 99 % lie within 0.5 px where one is moved by 0.05 px, and no longer
  /// where it is moved by 0.2 px.
  size_t edge_elements = 0;
  double edge_within_half_pixel_share = 1;
  double edge_distance_99 = 0;
  double edge_distance_maximum = 0;
  /// NaN or infinite samples of either renderer in both masks; such a pixel's difference is 255.
  size_t non_finite_pixels = 0;
  ColorAgreement color;
  std::optional<ColorAgreement> normal;  // where both pictures have normals
};

/// What a comparison must reach. The defaults hold for solids; lattices have so much outline that
/// single pixels count more.
struct Limits {
  double intersection_over_union = 0.998;
  double edge_within_half_pixel_share = 0.99;
  double color_median = 0.5;
  double color_quantile_99 = 2;
  double left_out_share = 0.2;
  double left_out_within_share = 0.995;
  double normal_median = 2;
  static Limits lattice();
};

/// One line of the verdict.
struct Criterion {
  std::string name;       // "colour difference, median"
  std::string unit;       // "", "%", "/255"
  double value = 0;       // in that unit
  double limit = 0;       // in that unit
  bool at_least = false;  // else at most
  bool holds = false;
  /// "colour difference, median is 3/255, but at most 0.5/255 is asked for"
  std::string sentence() const;
  std::string value_text() const;  // "3/255"
  std::string limit_text() const;  // "at most 0.5/255"
};

/// Throws Error where sizes differ, an image has fewer than 3 channels or the masks are empty.
Comparison compare_images(const Picture& reference, const Picture& candidate);

std::vector<Criterion> criteria(const Comparison& comparison, const Limits& limits);
/// The criteria that do not hold, as sentences; empty: the two agree.
std::vector<std::string> failed_criteria(const Comparison& comparison, const Limits& limits);
bool passes(const Comparison& comparison, const Limits& limits);

/// |candidate - reference| x factor in each of three channels, clamped to [0, 1].
Image difference_image(const Image& reference, const Image& candidate, float factor = 16);

}  // namespace sardf

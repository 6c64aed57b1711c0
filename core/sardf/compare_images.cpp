#include "sardf/compare_images.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "sardf/edge_distance.hpp"
#include "sardf/error.hpp"

namespace sardf {

namespace {

constexpr double steps = 255;
constexpr double flat_span = 16;    // a neighbourhood that spans more is a crease or an edge
constexpr double range_margin = 4;  // how far a left-out pixel may leave its neighbourhood

// The smallest value that `share` of all values does not exceed.
double quantile(std::vector<double>& values, double share) {
  if (values.empty()) return 0;
  const double rank = std::ceil(share * double(values.size()));
  const size_t at = size_t(std::clamp(rank - 1, 0.0, double(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(at), values.end());
  return values[at];
}

double share_of(size_t part, size_t whole, double otherwise) {
  return whole == 0 ? otherwise : double(part) / double(whole);
}

bool finite(const float* pixel) {
  return std::isfinite(pixel[0]) && std::isfinite(pixel[1]) && std::isfinite(pixel[2]);
}

double difference(const float* a, const float* b) {
  if (!finite(a) || !finite(b)) return steps;
  double largest = 0;
  for (int c = 0; c < 3; ++c)
    largest = std::max(largest, std::abs(double(a[c]) - double(b[c])) * steps);
  return largest;
}

// The 3 x 3 pixels around one, as the reference shows them.
struct Neighbourhood {
  bool inside_both = true;
  std::array<double, 3> low = {INFINITY, INFINITY, INFINITY};
  std::array<double, 3> high = {-INFINITY, -INFINITY, -INFINITY};

  bool flat() const {
    for (size_t c = 0; c < 3; ++c)
      if (!(high[c] - low[c] <= flat_span)) return false;
    return true;
  }
  bool contains(const float* pixel) const {
    for (size_t c = 0; c < 3; ++c) {
      const double value = pixel[c] * steps;
      if (!(value >= low[c] - range_margin && value <= high[c] + range_margin)) return false;
    }
    return true;
  }
};

Neighbourhood neighbourhood(const Image& reference, const Mask& mask, const Mask& other, int x,
                            int y) {
  Neighbourhood result;
  for (int v = y - 1; v <= y + 1; ++v)
    for (int u = x - 1; u <= x + 1; ++u) {
      const bool in_picture = u >= 0 && v >= 0 && u < reference.width && v < reference.height;
      const size_t i = in_picture ? size_t(v) * reference.width + u : 0;
      result.inside_both = result.inside_both && in_picture && mask[i] && other[i];
      if (!in_picture || !mask[i]) continue;
      for (size_t c = 0; c < 3; ++c) {
        const double value = reference.at(u, v)[c] * steps;
        result.low[c] = std::min(result.low[c], value);
        result.high[c] = std::max(result.high[c], value);
      }
    }
  return result;
}

ColorAgreement color_agreement(const Image& reference, const Mask& mask, const Image& candidate,
                               const Mask& other) {
  std::vector<double> differences;
  size_t left_out = 0, outline = 0, within = 0;
  for (int y = 0; y < reference.height; ++y)
    for (int x = 0; x < reference.width; ++x) {
      const size_t i = size_t(y) * reference.width + x;
      if (!mask[i] || !other[i]) continue;
      const Neighbourhood around = neighbourhood(reference, mask, other, x, y);
      if (around.inside_both && around.flat()) {
        differences.push_back(difference(reference.at(x, y), candidate.at(x, y)));
        continue;
      }
      ++left_out;
      outline += around.inside_both ? 0 : 1;
      within += around.contains(candidate.at(x, y)) ? 1 : 0;
    }
  ColorAgreement result;
  result.compared_pixels = differences.size();
  const size_t all = left_out + differences.size();
  result.left_out_share = share_of(left_out, all, 1);
  result.outline_share = share_of(outline, all, 1);
  result.left_out_within_share = share_of(within, left_out, 1);
  result.median = quantile(differences, 0.5);
  result.quantile_99 = quantile(differences, 0.99);
  result.maximum = quantile(differences, 1);
  return result;
}

void compare_edges(const Mask& a, const Mask& b, Comparison& result) {
  const auto edges_a = edge_elements(a, result.width, result.height);
  const auto edges_b = edge_elements(b, result.width, result.height);
  auto distances = edge_distances(edges_a, edges_b, result.width, result.height);
  const auto back = edge_distances(edges_b, edges_a, result.width, result.height);
  distances.insert(distances.end(), back.begin(), back.end());
  result.edge_elements = distances.size();
  // Rounding must not turn a shift of exactly half a pixel into more.
  const auto near = std::count_if(distances.begin(), distances.end(),
                                  [](double distance) { return distance <= 0.5 + 1e-9; });
  result.edge_within_half_pixel_share = share_of(size_t(near), distances.size(), 1);
  result.edge_distance_99 = quantile(distances, 0.99);
  result.edge_distance_maximum = quantile(distances, 1);
}

std::string size_text(const Image& image) {
  return std::to_string(image.width) + " x " + std::to_string(image.height);
}

void check_picture(const Image& image, const Image& reference, const std::string& what) {
  if (image.width != reference.width || image.height != reference.height)
    throw Error(what + " is " + size_text(image) + " pixels, the reference's colour is " +
                size_text(reference) + "; both must be of one size");
  if (image.channels < 3)
    throw Error(what + " has " + std::to_string(image.channels) + " channels; red, green and " +
                "blue are needed");
}

void check_mask(const Mask& mask, const Image& reference, const std::string& what) {
  if (mask.size() != size_t(reference.width) * reference.height)
    throw Error(what + " has " + std::to_string(mask.size()) + " pixels, the picture is " +
                size_text(reference));
  if (std::all_of(mask.begin(), mask.end(), [](unsigned char in) { return in == 0; }))
    throw Error(what + " is empty: the picture shows nothing but background");
}

// Counts whole; else digits enough to tell 0.99798 from a limit of 0.998.
std::string number_text(double value) {
  std::array<char, 32> text{};
  const bool whole = value == std::floor(value) && std::abs(value) < 1e15;
  std::snprintf(text.data(), text.size(), whole ? "%.0f" : "%.5g", value);
  return text.data();
}

}  // namespace

Mask mask_from_alpha(const Image& image) {
  if (image.channels != 2 && image.channels != 4)
    throw Error("a picture of " + std::to_string(image.channels) +
                " channels has no alpha; 2 or 4 channels are needed");
  Mask mask(size_t(image.width) * image.height);
  for (size_t i = 0; i < mask.size(); ++i)
    mask[i] = image.samples[(i + 1) * size_t(image.channels) - 1] >= 0.5f;
  return mask;
}

Mask mask_from_background(const Image& image, const std::array<float, 3>& background,
                          float tolerance) {
  check_picture(image, image, "the picture");
  Mask mask(size_t(image.width) * image.height);
  for (size_t i = 0; i < mask.size(); ++i)
    for (size_t c = 0; c < 3; ++c)
      if (!(std::abs(image.samples[i * size_t(image.channels) + c] - background[c]) <= tolerance))
        mask[i] = 1;
  return mask;
}

Comparison compare_images(const Picture& reference, const Picture& candidate) {
  const Image& color = reference.color;
  check_picture(color, color, "the reference's colour");
  check_picture(candidate.color, color, "the candidate's colour");
  check_mask(reference.mask, color, "the reference's mask");
  check_mask(candidate.mask, color, "the candidate's mask");
  Comparison result;
  result.width = color.width;
  result.height = color.height;
  size_t both = 0, either = 0;
  for (size_t i = 0; i < reference.mask.size(); ++i) {
    const bool in_both = reference.mask[i] && candidate.mask[i];
    both += in_both ? 1 : 0;
    either += reference.mask[i] || candidate.mask[i] ? 1 : 0;
    const int x = int(i) % color.width, y = int(i) / color.width;
    if (in_both && !(finite(color.at(x, y)) && finite(candidate.color.at(x, y))))
      ++result.non_finite_pixels;
  }
  result.intersection_over_union = share_of(both, either, 1);
  compare_edges(reference.mask, candidate.mask, result);
  result.color = color_agreement(color, reference.mask, candidate.color, candidate.mask);
  if (reference.normal && candidate.normal) {
    check_picture(*reference.normal, color, "the reference's normal");
    check_picture(*candidate.normal, color, "the candidate's normal");
    result.normal =
        color_agreement(*reference.normal, reference.mask, *candidate.normal, candidate.mask);
  }
  return result;
}

Limits Limits::lattice() {
  Limits limits;
  limits.intersection_over_union = 0.995;
  return limits;
}

std::string Criterion::value_text() const { return number_text(value) + unit; }

std::string Criterion::limit_text() const {
  return (at_least ? "at least " : "at most ") + number_text(limit) + unit;
}

std::string Criterion::sentence() const {
  return name + " is " + value_text() + (holds ? ", and " : ", but ") + limit_text() +
         " is asked for";
}

std::vector<Criterion> criteria(const Comparison& comparison, const Limits& limits) {
  std::vector<Criterion> list;
  const auto add = [&](const std::string& name, const std::string& unit, double value, double limit,
                       bool at_least) {
    list.push_back(
        {name, unit, value, limit, at_least, at_least ? value >= limit : value <= limit});
  };
  const ColorAgreement& color = comparison.color;
  add("mask intersection over union", "", comparison.intersection_over_union,
      limits.intersection_over_union, true);
  add("edges within 0.5 px", " %", 100 * comparison.edge_within_half_pixel_share,
      100 * limits.edge_within_half_pixel_share, true);
  add("colour pixels compared", "", double(color.compared_pixels), 1, true);
  add("colour difference, median", "/255", color.median, limits.color_median, false);
  add("colour difference, 99 %", "/255", color.quantile_99, limits.color_quantile_99, false);
  add("pixels left out", " %", 100 * color.left_out_share, 100 * limits.left_out_share, false);
  add("left-out pixels within their surroundings", " %", 100 * color.left_out_within_share,
      100 * limits.left_out_within_share, true);
  add("pixels that are not finite", "", double(comparison.non_finite_pixels), 0, false);
  if (comparison.normal) {
    add("normal pixels compared", "", double(comparison.normal->compared_pixels), 1, true);
    add("normal difference, median", "/255", comparison.normal->median, limits.normal_median,
        false);
  }
  return list;
}

std::vector<std::string> failed_criteria(const Comparison& comparison, const Limits& limits) {
  std::vector<std::string> sentences;
  for (const Criterion& criterion : criteria(comparison, limits))
    if (!criterion.holds) sentences.push_back(criterion.sentence());
  return sentences;
}

bool passes(const Comparison& comparison, const Limits& limits) {
  return failed_criteria(comparison, limits).empty();
}

Image difference_image(const Image& reference, const Image& candidate, float factor) {
  check_picture(reference, reference, "the reference");
  check_picture(candidate, reference, "the candidate");
  Image result{reference.width, reference.height, 3, {}};
  result.samples.resize(size_t(result.width) * result.height * 3);
  for (int y = 0; y < result.height; ++y)
    for (int x = 0; x < result.width; ++x)
      for (int c = 0; c < 3; ++c) {
        const float apart = std::abs(candidate.at(x, y)[c] - reference.at(x, y)[c]) * factor;
        result.at(x, y)[c] = apart <= 1 ? apart : 1;  // NaN becomes 1
      }
  return result;
}

}  // namespace sardf

// The distance between the outlines of two masks, finer than a pixel.
#pragma once

#include <vector>

namespace sardf {

/// A place on a mask's outline, in pixels (pixel centres are whole numbers), and the outline's
/// direction there; (0, 0) where it has none.
struct EdgeElement {
  double x = 0;
  double y = 0;
  double tangent_x = 0;
  double tangent_y = 0;
};

/// One element for each pixel side between in and out, as Comparison describes.
std::vector<EdgeElement> edge_elements(const std::vector<unsigned char>& mask, int width,
                                       int height);

/// For each element of `from` its distance to the nearest of `to`, in pixels; the diagonal of the
/// picture when `to` is empty.
std::vector<double> edge_distances(const std::vector<EdgeElement>& from,
                                   const std::vector<EdgeElement>& to, int width, int height);

}  // namespace sardf

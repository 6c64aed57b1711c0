// Several samples of each pixel; private to core/sardf/render*.cpp.
#pragma once

#include "sardf/image_file.hpp"

namespace sardf::rendering {

/// One pixel for each square of `edge`² pixels, whose sides are multiples of `edge`. The first four
/// channels become their mean; then, where there are, the depth becomes the least, and the normal
/// the unit vector of the sum.
Image averaged(const Image& fine, int edge, bool depth, bool normals);

}  // namespace sardf::rendering

// Baking: expressions evaluated, as a volume, at the surface point of every texel of a UV map.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sardf/graph.hpp"
#include "sardf/image_file.hpp"
#include "sardf/mesh.hpp"
#include "sardf/progress.hpp"

namespace sardf {

/// One image to bake, e.g. base_color with three components.
///
/// tangent_normal: no components; the image is a normal map instead. Its colour 0.5 + 0.5 (a, b, c)
/// says the solid's unit normal n = -grad f as a direction a t + b s (m x t) + c m, where t with
/// its sign s is the mesh's tangent (tangents.hpp) and m its normal, interpolated over the
/// triangles as they are: what renderers' normal maps mean, the y of "OpenGL". Where n is more than
/// 45 degrees away from m (the gradient is that of another face) or has no direction, the colour is
/// (0.5, 0.5, 1), the mesh's own normal.
struct BakeChannel {
  std::string name;
  std::vector<Expression> components;
  bool tangent_normal = false;
};

namespace baking {
struct UvLayout;
}

/// Which texels of a square image lie on a mesh, by its corner_uv; made once, used by every bake.
///
/// Texel (i, j), j from the top, has its centre at u = (i + 0.5) / size, v = 1 - (j + 0.5) / size.
/// A texel whose centre lies on the mesh stands for the point there, a face (a, b, c, d) taken as
/// the triangles (a, b, c) and (a, c, d). A texel beside the mesh, at most `gutter` texels and at
/// least as far as a bilinear lookup on the mesh reaches (1.5 texels), stands for the point that
/// continues the surface linearly over the nearest border. Borders are the edges whose two faces
/// have different texture coordinates, so any UV map without overlaps will do.
class TexelMap {
 public:
  /// The mesh must outlive the map and stay unchanged. Throws Error: no or wrongly many corner_uv,
  /// a coordinate that is not finite, a vertex index out of range, `size` outside [1, 16384],
  /// `gutter` outside [0, 64], faces that cover the image more than twice over (a UV map that was
  /// never unwrapped). Throws Cancelled.
  TexelMap(const Mesh& mesh, int size, int gutter = 8, const Progress& progress = {});
  ~TexelMap();
  TexelMap(TexelMap&&) noexcept;
  TexelMap& operator=(TexelMap&&) noexcept;

  int size() const;
  const baking::UvLayout& layout() const { return *layout_; }

 private:
  std::unique_ptr<baking::UvLayout> layout_;
};

/// What a bake found.
struct BakeReport {
  /// Texels that got a value, gutters included.
  size_t covered = 0;
  /// For each channel the covered texels where a component is not finite, nor close by; it is 0
  /// there.
  std::vector<size_t> undefined;
};

/// Takes one baked image of size² texels; `covered` has a byte for each texel, 0 where it got no
/// value (its samples are 0).
using BakeConsumer =
    std::function<void(size_t channel, Image&& image, const std::vector<unsigned char>& covered)>;

/// Bakes the channels and hands their images over one by one, in order. No image holds NaN or
/// infinities.
///
/// Each point is moved along the gradient of `solid`, its own or mixed from those at its triangle's
/// corners, onto the zero set first, by at most half an edge of its face and only along a gradient
/// within 45 degrees of the face's normal; points beyond a crease (mesh.creases) stay where the
/// linear continuation puts them. Null: no point is moved.
///
/// As many channels are baked together (and share their common parts) as have images of at most
/// `memory` bytes together, at least one; each time again, points are found anew. Runs on all
/// threads; the result does not depend on their number. Throws Error: a channel without
/// components, no texel covered, a normal map without `solid` or corner_normals. Throws Cancelled.
BakeReport bake(const TexelMap& texels, const Expression& solid,
                std::span<const BakeChannel> channels, const BakeConsumer& take,
                const Progress& progress = {}, size_t memory = size_t(1) << 30);

/// All images at once, in memory, the texels without a value filled by fill_with_mean.
std::vector<Image> bake_images(const TexelMap& texels, const Expression& solid,
                               std::span<const BakeChannel> channels,
                               const Progress& progress = {});

/// Gives every texel whose `covered` byte is 0 the mean of the covered ones: what is seen of them
/// from afar, where a renderer averages many texels. image_file.hpp's fill_uncovered is better for
/// files. An Error if nothing is covered.
void fill_with_mean(Image& image, const std::vector<unsigned char>& covered);

}  // namespace sardf

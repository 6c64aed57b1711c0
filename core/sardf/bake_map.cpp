// TexelMap: the checks of a UV map and the stages that index it.

#include <algorithm>
#include <cmath>
#include <string>

#include "sardf/bake.hpp"
#include "sardf/bake_stages.hpp"
#include "sardf/error.hpp"

namespace sardf {
namespace {

void check_range(const char* what, int value, int low, int high) {
  if (value < low || value > high)
    throw Error(std::string(what) + " of " + std::to_string(value) + " texels; accepted are " +
                std::to_string(low) + " to " + std::to_string(high));
}

bool finite(const Vec3& v) {
  return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

void check_mesh(const Mesh& mesh) {
  if (mesh.faces.empty()) throw Error("a mesh without faces cannot be baked");
  if (mesh.corner_uv.size() != 4 * mesh.faces.size())
    throw Error("a bake needs 4 texture coordinates for each face; found " +
                std::to_string(mesh.corner_uv.size()) + " for " +
                std::to_string(mesh.faces.size()) + " faces");
  for (size_t corner = 0; corner < mesh.corner_uv.size(); ++corner) {
    const auto where = [&] { return " of face " + std::to_string(corner / 4); };
    const uint32_t vertex = mesh.faces[corner / 4][corner % 4];
    if (vertex >= mesh.vertices.size())
      throw Error("a corner" + where() + " is vertex " + std::to_string(vertex) + "; there are " +
                  std::to_string(mesh.vertices.size()));
    if (!finite(mesh.vertices[vertex])) throw Error("a vertex" + where() + " is not finite");
    const Vec2& uv = mesh.corner_uv[corner];
    if (!std::isfinite(uv[0]) || !std::isfinite(uv[1]))
      throw Error("a texture coordinate" + where() + " is not finite");
  }
}

/// Area in the image of the faces that touch it, as a share of the image.
double share_of_image(const Mesh& mesh) {
  double area = 0;
  for (size_t face = 0; face < mesh.faces.size(); ++face) {
    const Vec2* uv = &mesh.corner_uv[4 * face];
    const auto outside = [&](size_t axis) {
      const auto [lo, hi] = std::minmax({uv[0][axis], uv[1][axis], uv[2][axis], uv[3][axis]});
      return hi < 0 || lo > 1;
    };
    if (outside(0) || outside(1)) continue;
    for (size_t k = 1; k < 3; ++k)
      area += 0.5 * std::abs((uv[k][0] - uv[0][0]) * (uv[k + 1][1] - uv[0][1]) -
                             (uv[k][1] - uv[0][1]) * (uv[k + 1][0] - uv[0][0]));
  }
  return area;
}

}  // namespace

TexelMap::TexelMap(const Mesh& mesh, int size, int gutter, const Progress& progress)
    : layout_(std::make_unique<baking::UvLayout>()) {
  check_range("a texture", size, 1, 16384);
  check_range("a gutter", gutter, 0, 64);
  check_mesh(mesh);
  const double share = share_of_image(mesh);
  if (share > 2)
    throw Error("the UV map covers the image " + std::to_string(std::lround(share)) +
                " times; a bake needs one without overlaps, so unwrap the mesh first");
  double done = 0;
  const auto report = [&] {
    if (progress && !progress(done)) throw Cancelled();
    done += 0.25;
  };
  layout_->mesh = &mesh;
  layout_->size = size;
  // A bilinear lookup reaches less than one texel along x and y, so less than 1.5 across both.
  layout_->reach = std::max(1.5, double(gutter));
  layout_->tiles_across = (size + baking::tile_size - 1) / baking::tile_size;
  report();
  baking::find_borders(*layout_, report);
  report();
  baking::fill_bins(*layout_);
  report();
}

TexelMap::~TexelMap() = default;
TexelMap::TexelMap(TexelMap&&) noexcept = default;
TexelMap& TexelMap::operator=(TexelMap&&) noexcept = default;

int TexelMap::size() const { return layout_->size; }

}  // namespace sardf

#include "sardf/bake.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>
#include <mutex>
#include <optional>

#include "sardf/bake_stages.hpp"
#include "sardf/error.hpp"
#include "sardf/evaluate.hpp"
#include "sardf/numbers/lanes.hpp"
#include "sardf/tangents.hpp"
#include "sardf/zeroed_memory.hpp"

namespace sardf {
namespace {

constexpr size_t block_size = Evaluator::block_size;
/// Share of the mesh's diagonal within which a point counts as lying on the solid's surface; below
/// the 1e-6 within which a point counts as lying in a region.
constexpr double on_surface = 2e-7;
/// Points tried beside one where a channel is not finite (a centre, an axis, an edge), as shares of
/// the mesh's diagonal along directions that no symmetric shape prefers.
constexpr double nudge_length = 1e-5;
constexpr Vec3 nudges[] = {{0.61, 0.47, 0.64}, {-0.73, 0.31, 0.61}, {0.29, -0.83, -0.48}};

BoundingBox bounds(const Mesh& mesh) {
  BoundingBox box{mesh.vertices[0], mesh.vertices[0]};
  for (const Vec3& v : mesh.vertices)
    for (size_t axis = 0; axis < 3; ++axis) {
      box.lo[axis] = std::min(box.lo[axis], v[axis]);
      box.hi[axis] = std::max(box.hi[axis], v[axis]);
    }
  return box;
}

int components_of(const BakeChannel& channel) {
  return channel.tangent_normal ? 3 : static_cast<int>(channel.components.size());
}
bool has_normals(std::span<const BakeChannel> channels) {
  return std::any_of(channels.begin(), channels.end(),
                     [](const BakeChannel& channel) { return channel.tangent_normal; });
}

/// What a normal map is made of.
struct NormalSource {
  const Evaluator& solid;
  const Mesh& mesh;
  const std::vector<std::array<float, 4>>& tangents;

  /// Colours of points[first, first + n) in three rows.
  void colors(const baking::TilePoints& points, const baking::TexelCorners& corners, size_t first,
              size_t n, float* const* rows) const {
    std::array<float, block_size> value;
    solid.gradient_block(&points.point[0][first], &points.point[1][first], &points.point[2][first],
                         n, value.data(), rows);
    baking::tangent_normals(mesh, tangents, corners, first, n, rows);
  }
};

/// Some channels of a bake: one evaluator for all their components, and their images.
class Group {
 public:
  /// The points lie in the box, or near it.
  Group(std::span<const BakeChannel> channels, const BoundingBox& box, int size)
      : channels_(channels) {
    std::vector<Expression> outputs;
    for (const BakeChannel& channel : channels) {
      const int components = components_of(channel);
      images.push_back({size, size, components, {}});
      images.back().samples.resize(size_t(size) * size * components);
      outputs.insert(outputs.end(), channel.components.begin(), channel.components.end());
    }
    if (!outputs.empty()) evaluator_ = LocalEvaluator(Evaluator(outputs), box);
    undefined = std::vector<std::atomic<size_t>>(channels.size());
  }

  bool has_normals() const { return sardf::has_normals(channels_); }

  /// Evaluates the points and writes their texels. `normals` and `corners` are there if
  /// has_normals.
  void evaluate(const baking::TilePoints& points, double nudge, const NormalSource* normals,
                const baking::TexelCorners* corners) {
    thread_local Scratch<float> storage;
    const size_t outputs = evaluator_.outputs();
    float* const rows = storage.get((outputs + 3) * block_size);
    std::vector<float*> out(outputs);
    for (size_t k = 0; k < outputs; ++k) out[k] = rows + k * block_size;
    float* const bent[3] = {rows + outputs * block_size, rows + (outputs + 1) * block_size,
                            rows + (outputs + 2) * block_size};
    baking::for_blocks(points, block_size, [&](int first_row, int last_row) {
      const size_t first = points.start[size_t(first_row)];
      const size_t n = points.start[size_t(last_row)] - first;
      fetch(points, first_row, last_row);
      if (outputs > 0)
        evaluator_.block(&points.point[0][first], &points.point[1][first], &points.point[2][first],
                         n, out.data());
      if (normals) normals->colors(points, *corners, first, n, bent);
      if (!all_finite(out, n)) repair(points, first, n, nudge, out);
      baking::for_runs(points, first_row, last_row, [&](size_t i, size_t count, int x, int y) {
        const float* const* from = out.data();
        for (size_t k = 0; k < images.size(); ++k) {
          const bool bends = channels_[k].tangent_normal;
          interleave(bends ? bent : from, i - first, count, images[k].channels, images[k].at(x, y));
          if (!bends) from += images[k].channels;
        }
      });
    });
  }

  std::vector<Image> images;
  std::vector<std::atomic<size_t>> undefined;

 private:
  static bool all_finite(const std::vector<float*>& rows, size_t n) {
    using L = Lanes<Baseline>;
    // 0 times what is not finite is NaN. Several sums, since one would wait for each addition.
    constexpr size_t at_once = 4 * L::width;
    std::array<L, 4> zeros;
    zeros.fill(L(0.0));
    float rest = 0;
    for (const float* row : rows) {
      size_t i = 0;
      for (; i + at_once <= n; i += at_once)
        for (size_t k = 0; k < 4; ++k)
          zeros[k] = zeros[k] + L::load(row + i + k * L::width) * L(0.0);
      for (; i < n; ++i) rest += row[i] * 0;
    }
    const L sum = (zeros[0] + zeros[1]) + (zeros[2] + zeros[3]);
    for (int k = 0; k < L::width; ++k) rest += sum.v[k];
    return rest == 0;
  }

  static void interleave_three(const float* a, const float* b, const float* c, size_t count,
                               float* to) {
    typedef float Four __attribute__((vector_size(16)));
    const auto load = [](const float* from) {
      Four v;
      std::memcpy(&v, from, sizeof v);
      return v;
    };
    const auto store = [](float* at, Four v) { std::memcpy(at, &v, sizeof v); };
    size_t i = 0;
    for (; i + 4 <= count; i += 4, to += 12) {
      const Four x = load(a + i), y = load(b + i), z = load(c + i);
      const Four z0x1 = __builtin_shufflevector(z, x, 0, 0, 5, 5);
      const Four y1z1 = __builtin_shufflevector(y, z, 1, 1, 5, 5);
      const Four x2y2 = __builtin_shufflevector(x, y, 2, 2, 6, 6);
      const Four z2x3 = __builtin_shufflevector(z, x, 2, 2, 7, 7);
      const Four y3z3 = __builtin_shufflevector(y, z, 3, 3, 7, 7);
      const Four x0y0 = __builtin_shufflevector(x, y, 0, 4, 1, 5);
      store(to, __builtin_shufflevector(x0y0, z0x1, 0, 1, 4, 6));
      store(to + 4, __builtin_shufflevector(y1z1, x2y2, 0, 2, 4, 6));
      store(to + 8, __builtin_shufflevector(z2x3, y3z3, 0, 2, 4, 6));
    }
    for (; i < count; ++i, to += 3) {
      to[0] = a[i];
      to[1] = b[i];
      to[2] = c[i];
    }
  }

  /// Asks for the memory of the rows' texels, which arrives while they are evaluated.
  void fetch(const baking::TilePoints& points, int first_row, int last_row) {
    constexpr size_t line = 64 / sizeof(float);
    baking::for_runs(points, first_row, last_row, [&](size_t, size_t count, int x, int y) {
      for (Image& image : images) {
        const float* const to = image.at(x, y);
        for (size_t i = 0; i < count * size_t(image.channels); i += line)
          __builtin_prefetch(to + i, 1);
      }
    });
  }

  /// Texels of n components from an array for each.
  static void interleave(const float* const* from, size_t first, size_t count, int n, float* to) {
    if (n == 3)
      return interleave_three(from[0] + first, from[1] + first, from[2] + first, count, to);
    const size_t stride = size_t(n);
    for (size_t c = 0; c < stride; ++c)
      for (size_t i = 0; i < count; ++i) to[stride * i + c] = from[c][first + i];
  }

  void repair(const baking::TilePoints& points, size_t first, size_t n, double nudge,
              const std::vector<float*>& out) {
    for (size_t i = 0; i < n; ++i) {
      const bool finite = std::all_of(out.begin(), out.end(),
                                      [i](const float* row) { return std::isfinite(row[i]); });
      if (!finite) repair_point(points, first + i, nudge, i, out);
    }
  }

  /// Replaces what is not finite by the double path's value there or close by, at last by 0.
  void repair_point(const baking::TilePoints& points, size_t p, double nudge, size_t i,
                    const std::vector<float*>& out) {
    const Vec3 point{points.point[0][p], points.point[1][p], points.point[2][p]};
    std::vector<double> values(out.size());
    const auto take = [&](const Vec3& from) {
      evaluator_.whole().values(from, values.data());
      for (size_t k = 0; k < out.size(); ++k)
        if (!std::isfinite(out[k][i])) out[k][i] = static_cast<float>(values[k]);
    };
    take(point);
    for (const Vec3& direction : nudges) take(point + nudge * direction);
    size_t row = 0;
    for (size_t channel = 0; channel < channels_.size(); ++channel) {
      if (channels_[channel].tangent_normal) continue;
      bool lost = false;
      for (int c = 0; c < images[channel].channels; ++c, ++row)
        if (!std::isfinite(out[row][i])) {
          lost = true;
          out[row][i] = 0;
        }
      undefined[channel] += lost;
    }
  }

  std::span<const BakeChannel> channels_;
  LocalEvaluator evaluator_;
};

/// work(tile) for all tiles on all threads, reporting shares [from, to].
template <class Work>
void for_tiles(size_t tiles, const Progress& progress, double from, double to, Work work) {
  std::atomic<bool> cancelled{false};
  std::mutex reporting;
  size_t done = 0;
  tbb::parallel_for(size_t(0), tiles, [&](size_t tile) {
    if (cancelled) return;
    work(tile);
    if (!progress) return;
    const std::scoped_lock lock(reporting);
    const double share = double(++done) / double(tiles);
    if (!cancelled && !progress(from + (to - from) * share)) cancelled = true;
  });
  if (cancelled) throw Cancelled();
}

class Baker {
 public:
  Baker(const baking::UvLayout& layout, const Expression& solid)
      : box(bounds(*layout.mesh)), layout_(layout) {
    const double length = box.diagonal();
    if (solid) solid_.emplace(Evaluator(solid), box);
    tolerance_ = static_cast<float>(on_surface * length);
    nudge_ = nudge_length * length;
    resize_large(covered, size_t(layout.size) * size_t(layout.size));
  }

  /// Throws Error and Cancelled.
  void prepare_normals(const Progress& progress) {
    if (!solid_) throw Error("a normal map can only be baked of a solid");
    tangents_ = corner_tangents(*layout_.mesh, progress);
    normals_.emplace(NormalSource{solid_->whole(), *layout_.mesh, tangents_});
  }

  void run(Group& group, const Progress& progress, double from, double to) {
    found = 0;
    const NormalSource* normals = group.has_normals() ? &*normals_ : nullptr;
    for_tiles(layout_.tiles(), progress, from, to, [&](size_t tile) {
      // Kept from tile to tile: making their memory anew takes as long as a tile's evaluation.
      thread_local const auto points = std::make_unique_for_overwrite<baking::TilePoints>();
      const auto corners =
          normals ? std::make_unique_for_overwrite<baking::TexelCorners>() : nullptr;
      fetch_covered(tile);
      baking::find_texels(layout_, tile, *points, corners.get());
      found += points->count;
      if (solid_) baking::project(*solid_, *points, tolerance_);
      group.evaluate(*points, nudge_, normals, corners.get());
      baking::for_runs(*points, 0, baking::tile_size, [&](size_t, size_t count, int x, int y) {
        std::fill_n(&covered[size_t(y) * layout_.size + x], count, 1);
      });
    });
  }

  const BoundingBox box;  // of the mesh
  std::vector<unsigned char> covered;
  std::atomic<size_t> found{0};  // covered texels

 private:
  /// Asks for the memory of the tile's part of `covered`, which arrives while its texels are found.
  void fetch_covered(size_t tile) const {
    const size_t size = size_t(layout_.size), across = size_t(layout_.tiles_across);
    const size_t x = tile % across * baking::tile_size, y = tile / across * baking::tile_size;
    for (size_t row = y; row < std::min(y + baking::tile_size, size); ++row) {
      const unsigned char* const first = &covered[row * size + x];
      __builtin_prefetch(first, 1);
      __builtin_prefetch(first + std::min(size_t(baking::tile_size), size - x) - 1, 1);
    }
  }

  const baking::UvLayout& layout_;
  std::optional<LocalEvaluator> solid_;
  std::vector<std::array<float, 4>> tangents_;
  std::optional<NormalSource> normals_;
  float tolerance_ = 0;
  double nudge_ = 0;
};

/// How many of the channels, from the first on, have images of at most `memory` bytes together.
size_t count_within(std::span<const BakeChannel> channels, int size, size_t memory) {
  size_t count = 0, bytes = 0;
  for (const BakeChannel& channel : channels) {
    bytes += sizeof(float) * size_t(components_of(channel)) * size_t(size) * size_t(size);
    if (bytes > memory && count > 0) break;
    ++count;
  }
  return count;
}

}  // namespace

BakeReport bake(const TexelMap& texels, const Expression& solid,
                std::span<const BakeChannel> channels, const BakeConsumer& take,
                const Progress& progress, size_t memory) {
  for (const BakeChannel& channel : channels)
    if (channel.components.empty() && !channel.tangent_normal)
      throw Error("the channel '" + channel.name + "' has no components to bake");
  Baker baker(texels.layout(), solid);
  // Of no account for the progress: a second for millions of faces.
  if (has_normals(channels))
    baker.prepare_normals(progress ? [&](double) { return progress(0); } : Progress());
  BakeReport report;
  for (size_t first = 0; first < channels.size();) {
    const size_t n = count_within(channels.subspan(first), texels.size(), memory);
    const double from = double(first) / double(channels.size());
    const double to = double(first + n) / double(channels.size());
    if (progress && !progress(from)) throw Cancelled();
    Group group(channels.subspan(first, n), baker.box, texels.size());
    baker.run(group, progress, from, to);
    if (first == 0) {
      report.covered = baker.found;
      if (report.covered == 0)
        throw Error("no texel lies on the mesh: its texture coordinates are outside [0, 1]");
    }
    for (size_t i = 0; i < n; ++i) {
      report.undefined.push_back(group.undefined[i]);
      take(first + i, std::move(group.images[i]), baker.covered);
      group.images[i] = {};
    }
    first += n;
  }
  return report;
}

std::vector<Image> bake_images(const TexelMap& texels, const Expression& solid,
                               std::span<const BakeChannel> channels, const Progress& progress) {
  std::vector<Image> images;
  const auto take = [&](size_t, Image&& image, const std::vector<unsigned char>& covered) {
    if (progress && !progress(1)) throw Cancelled();
    images.push_back(std::move(image));
    fill_with_mean(images.back(), covered);
  };
  bake(texels, solid, channels, take, progress, std::numeric_limits<size_t>::max());
  return images;
}

void fill_with_mean(Image& image, const std::vector<unsigned char>& covered) {
  const size_t channels = size_t(image.channels), width = size_t(image.width);
  struct RowSum {
    std::vector<double> sum;
    size_t count = 0;
  };
  // By rows, so that the order of summation does not depend on the number of threads.
  std::vector<RowSum> rows(size_t(image.height));
  tbb::parallel_for(size_t(0), rows.size(), [&](size_t y) {
    rows[y].sum.assign(channels, 0);
    for (size_t i = y * width; i < (y + 1) * width; ++i) {
      if (!covered[i]) continue;
      ++rows[y].count;
      for (size_t c = 0; c < channels; ++c) rows[y].sum[c] += image.samples[i * channels + c];
    }
  });
  std::vector<double> mean(channels, 0);
  size_t count = 0;
  for (const RowSum& row : rows) {
    count += row.count;
    for (size_t c = 0; c < channels; ++c) mean[c] += row.sum[c];
  }
  if (count == 0) throw Error("no texel of the texture is covered, so there is no mean");
  for (double& sum : mean) sum /= double(count);
  tbb::parallel_for(size_t(0), rows.size(), [&](size_t y) {
    for (size_t i = y * width; i < (y + 1) * width; ++i)
      if (!covered[i])
        for (size_t c = 0; c < channels; ++c)
          image.samples[i * channels + c] = static_cast<float>(mean[c]);
  });
}

}  // namespace sardf

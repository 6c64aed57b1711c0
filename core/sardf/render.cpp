#include "sardf/render.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "sardf/error.hpp"
#include "sardf/render_average.hpp"
#include "sardf/render_rounding.hpp"
#include "sardf/render_shading.hpp"
#include "sardf/short_number.hpp"

namespace sardf {

namespace rendering {

namespace {

constexpr int tile_edge = 32, most_pixels = 16384, most_samples = 8;
constexpr double default_tolerance = 1e-4;
// Above this error, in diagonals, beams and steps in single precision stop too early to be of use.
constexpr double most_single_error = 1e-3;
// Depths in single precision are told apart by less than a tenth of this share of their range, and
// what they count as the tolerance is less than it by that tenth.
constexpr double least_single_tolerance = 0x1p-16, tolerance_kept = 0.9;
// Steps of a ray in double before intervals are tried, which cost more than hundreds of steps in
// blocks.
constexpr int double_steps = 512;

void check_options(const RenderOptions& options, const BoundingBox& bounds) {
  for (const int edge : {options.width, options.height}) {
    if (edge >= 1 && edge <= most_pixels) continue;
    throw Error("the picture has " + std::to_string(options.width) + " x " +
                std::to_string(options.height) + " pixels; 1 to " + std::to_string(most_pixels) +
                " are accepted for each");
  }
  if (options.samples < 1 || options.samples > most_samples ||
      std::max(options.width, options.height) * options.samples > most_pixels) {
    throw Error("the samples along a pixel's side are " + std::to_string(options.samples) +
                "; 1 to " + std::to_string(most_samples) + " are accepted, and " +
                std::to_string(most_pixels) + " along each side of the picture");
  }
  if (options.tolerance && !(*options.tolerance > 0 && *options.tolerance < infinity)) {
    throw Error("the tolerance is " + short_number(*options.tolerance) +
                "; a positive length is accepted");
  }
  if (options.threads < 0) {
    throw Error("the number of threads is " + std::to_string(options.threads) +
                "; 0 (all) or more are accepted");
  }
  const Vec3 size = bounds.size();
  if (!(std::min({size[0], size[1], size[2]}) > 0) || !(norm(size) < infinity)) {
    throw Error("the bounds of what is rendered must be finite and have positive size");
  }
}

// Finer bounds of the slope pay where there are many rays.
int slope_cells(const RenderOptions& options) {
  const double pixels = double(options.width) * options.height;
  return pixels < 5e4 ? 4 : pixels < 1e6 ? 8 : 16;
}

// What the rays in single precision need; false where that is not good enough.
bool set_frame(Subject& subject, const RenderOptions& options) {
  const BoundingBox& bounds = subject.bounds;
  const double slope = subject.slopes.largest();
  const double error = subject.error_single;
  if (!is_single(subject.solid.whole())) return false;
  RayFrame frame = frame_of_places(subject.rays, bounds, options.width, options.height);
  const double range = double(frame.range);
  if (!(error < most_single_error * bounds.diagonal()) || !(range > 0)) return false;
  // Of a tolerance that is not many roundings nothing would be left.
  if (!(subject.tolerance > least_single_tolerance * range)) return false;
  frame.error = float(error * (1 + depth_slack));
  frame.per_slope = float((1 - depth_slack) / slope);
  frame.tolerance = float(subject.tolerance * tolerance_kept);
  subject.frame = frame;
  return true;
}

Subject make_subject(const LocalEvaluator& solid, const BoundingBox& bounds,
                     const RenderOptions& options, Watch& watch) {
  const double diagonal = bounds.diagonal();
  Subject subject{solid,
                  bounds,
                  Rays(options.camera, options.width, options.height),
                  LocalSlopes(solid.whole(), bounds, slope_cells(options), [&] { watch.check(); }),
                  options.tolerance.value_or(default_tolerance * diagonal),
                  single_precision_error(solid.whole(), bounds)};
  subject.error_double = double_precision_error(bounds, std::min(subject.slopes.largest(), 1e6));
  subject.single = set_frame(subject, options);
  return subject;
}

// What a tile shows.
struct TileHits {
  RayTables tables;       // of which the rays that have met the solid count
  std::vector<Ray> rays;  // others that may meet it or have met it
};

// Rays in single precision, until the thread's next tile; all are open where that does not serve.
TileHits& cast(const Subject& subject, const Tile& tile, const RenderOptions& options,
               Watch& watch) {
  // Too large for a thread's own memory, and large enough that every tile would have the system map
  // new pages for it.
  thread_local const auto storage = std::make_unique<TileHits>();
  TileHits& hits = *storage;
  RayTables& tables = hits.tables;
  tables.met.count = 0;
  hits.rays.clear();
  const std::vector<Beam> beams = find_beams(subject, tile, watch);
  if (!subject.single) {
    begin_rays(subject, beams, options.width, options.height, hits.rays);
    return hits;
  }
  march(subject, beams, options.width, options.height, tables, watch);
  for (size_t i = 0; i < tables.open.count; ++i) {
    hits.rays.push_back(ray_of(subject, tables.open, i));
  }
  return hits;
}

// All that have met the solid, in double, on its surface.
std::span<const Ray> on_surface(const Subject& subject, TileHits& hits, Watch& watch) {
  for (size_t i = 0; i < hits.tables.met.count; ++i) {
    hits.rays.push_back(ray_of(subject, hits.tables.met, i));
  }
  march(subject, hits.rays, double_steps, watch);
  march_by_intervals(subject, hits.rays, watch);
  std::erase_if(hits.rays, [](const Ray& ray) { return ray.state == Ray::State::missed; });
  find_roots(subject, hits.rays, watch);
  return hits.rays;
}

// take(tile, subject) for all tiles, on as many threads as the options say.
template <class Take>
void for_tiles(const Evaluator& solid, const BoundingBox& bounds, const RenderOptions& options,
               const Progress& progress, Take take) {
  check_options(options, bounds);
  const int columns = (options.width + tile_edge - 1) / tile_edge;
  const int rows = (options.height + tile_edge - 1) / tile_edge;
  Watch watch(progress, size_t(columns) * rows);
  // oneTBB would complain on standard error of more threads than it has.
  const int most_threads = tbb::this_task_arena::max_concurrency();
  tbb::task_arena arena(options.threads > 0 ? std::min(options.threads, most_threads)
                                            : tbb::task_arena::automatic);
  arena.execute([&] {
    const LocalEvaluator local(solid, bounds);
    const Subject subject = make_subject(local, bounds, options, watch);
    tbb::parallel_for(0, columns * rows, [&](int i) {
      watch.check();
      const Tile tile{i % columns * tile_edge, i / columns * tile_edge, tile_edge};
      take(subject, tile, watch);
      watch.tile_done();
    });
  });
  watch.finish();
}

// Writes a tile of the picture.
class Painter {
 public:
  Painter(const Scene& scene, const RenderOptions& options, Image& image)
      : options_(options), image_(image) {
    const std::array<Expression, 3> color = scene.base_color();
    color_ = LocalEvaluator(Evaluator(std::span<const Expression>(color)), scene.bounds());
    shows_colors_alone_ = options.look == RenderLook::flat && !options.normals && !options.depth &&
                          single_pays(scene.bounds(), color_.whole());
  }

  void paint(const Subject& subject, const Tile& tile, Watch& watch) const {
    TileHits& hits = cast(subject, tile, options_, watch);
    if (shows_colors_alone_) paint_roughly(subject, hits, watch);
    paint_exactly(subject, hits, watch);
  }

  /// All that a pixel shows where there is nothing of the solid.
  std::vector<float> background() const {
    std::vector<float> pixel;
    for (const double channel : options_.background.value_or(Vec3{})) {
      pixel.push_back(float(channel));
    }
    pixel.push_back(options_.background ? 1 : 0);
    if (options_.depth) pixel.push_back(float(infinity));
    if (options_.normals) pixel.insert(pixel.end(), 3, 0);
    return pixel;
  }

 private:
  // Paints the table's rays where the colours on both sides of the surface are the same; leaves the
  // others to be painted exactly.
  void paint_roughly(const Subject& subject, TileHits& hits, Watch& watch) const {
    RayTable& table = hits.tables.met;
    mix_colors(subject, color_, table, watch, [&](size_t first, size_t n, const RayBlock& block) {
      for (size_t i = 0; i < n; ++i) {
        const size_t ray = first + i;
        if (std::isnan(table.trial[ray])) continue;
        const std::array<float, 4> pixel{block.channels[0][i], block.channels[1][i],
                                         block.channels[2][i], 1};
        // In one piece: four stores of a float each would wait for memory four times.
        std::memcpy(image_.at(int(table.x[ray]), int(table.y[ray])), &pixel, sizeof pixel);
      }
    });
    for (size_t i = 0; i < table.count; ++i) {
      if (std::isnan(table.trial[i])) hits.rays.push_back(ray_of(subject, table, i));
    }
    table.count = 0;
  }

  void paint_exactly(const Subject& subject, TileHits& found, Watch& watch) const {
    const std::span<const Ray> rays = on_surface(subject, found, watch);
    std::vector<Hit> hits;
    hits.reserve(rays.size());
    for (const Ray& ray : rays) {
      hits.push_back({ray.line.at(ray.beyond), -1.0 * normalized(ray.line.along)});
    }
    if (options_.look != RenderLook::flat || options_.normals) find_normals(subject, hits, watch);
    color(subject, hits, watch);
    for (size_t i = 0; i < hits.size(); ++i) set(rays[i].x, rays[i].y, hits[i], rays[i].beyond);
  }

  void color(const Subject& subject, std::vector<Hit>& hits, Watch& watch) const {
    if (options_.look == RenderLook::normals) {
      for (Hit& hit : hits) hit.color = 0.5 * (hit.normal + Vec3{1, 1, 1});
      return;
    }
    find_colors(subject, color_, hits, watch);
    if (options_.look == RenderLook::shaded) light(subject, hits, watch);
  }

  void set(int x, int y, const Hit& hit, double depth) const {
    float* pixel = image_.at(x, y);
    for (const double channel : hit.color) *pixel++ = float(channel);
    *pixel++ = 1;
    if (options_.depth) *pixel++ = float(depth);
    if (!options_.normals) return;
    for (const double component : hit.normal) *pixel++ = float(component);
  }

  const RenderOptions& options_;
  Image& image_;
  LocalEvaluator color_;
  // No one sees where exactly the surface lies, if the colours on both its sides are the same.
  bool shows_colors_alone_;
};

}  // namespace

}  // namespace rendering

RenderLook render_look(const std::string& name) {
  if (name == "flat") return RenderLook::flat;
  if (name == "shaded") return RenderLook::shaded;
  if (name == "normals") return RenderLook::normals;
  throw Error("there is no look '" + name + "'; accepted are flat, shaded, normals" +
              did_you_mean(name, {"flat", "shaded", "normals"}));
}

RenderedPicture render(const Scene& scene, const RenderOptions& options, const Progress& progress) {
  if (options.samples > 1) {
    rendering::check_options(options, scene.bounds());
    RenderOptions fine = options;
    fine.samples = 1;
    fine.width *= options.samples;
    fine.height *= options.samples;
    RenderedPicture smooth = render(scene, fine, progress);
    smooth.image =
        rendering::averaged(smooth.image, options.samples, options.depth, options.normals);
    return smooth;
  }
  RenderedPicture picture;
  picture.channels = {"R", "G", "B", "A"};
  if (options.depth) picture.channels.push_back("Z");
  if (options.normals) picture.channels.insert(picture.channels.end(), {"NX", "NY", "NZ"});
  rendering::check_options(options, scene.bounds());
  Image& image = picture.image;
  image = {options.width, options.height, int(picture.channels.size()), {}};
  const rendering::Painter painter(scene, options, image);
  const std::vector<float> behind = painter.background();
  const size_t pixels = size_t(image.width) * image.height;
  if (std::all_of(behind.begin(), behind.end(), [](float sample) { return sample == 0; })) {
    image.samples.resize(pixels * image.channels);  // zeros, which no one has to write
  } else {
    image.samples.reserve(pixels * image.channels);
    for (size_t i = 0; i < pixels; ++i) {
      image.samples.insert(image.samples.end(), behind.begin(), behind.end());
    }
  }
  const Evaluator drawn(scene.drawn());
  rendering::for_tiles(drawn, scene.bounds(), options, progress,
                       [&](const auto& subject, const auto& tile, auto& watch) {
                         painter.paint(subject, tile, watch);
                       });
  return picture;
}

std::vector<double> render_depths(const Evaluator& solid, const BoundingBox& bounds,
                                  const RenderOptions& options, const Progress& progress) {
  rendering::check_options(options, bounds);
  std::vector<double> depths(size_t(options.width) * options.height, infinity);
  rendering::for_tiles(
      solid, bounds, options, progress,
      [&](const auto& subject, const rendering::Tile& tile, rendering::Watch& watch) {
        rendering::TileHits& hits = rendering::cast(subject, tile, options, watch);
        for (const rendering::Ray& ray : rendering::on_surface(subject, hits, watch)) {
          depths[size_t(ray.y) * options.width + ray.x] = ray.beyond;
        }
      });
  return depths;
}

}  // namespace sardf

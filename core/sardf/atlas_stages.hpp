// Shared by the stages of the atlas, in their order: surface, patches, flatten, measure,
// untangle, crossings, checks, charts, seams, sew, bitmap, pack.
// Private to core/sardf/atlas*.cpp. Lengths are scene units until atlas_pack; then texels.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "sardf/mesh.hpp"

namespace sardf {
struct Chart;
}

namespace sardf::atlas {

inline constexpr uint32_t none = 0xFFFFFFFFu;

/// Called within every long loop, from any thread; throws Cancelled.
using Report = std::function<void()>;

/// Half-edge h = 4 * face + k runs from corner k to the next corner; corners have the same numbers.
struct Surface {
  const Mesh* mesh;
  /// The half-edge on the other side; none at creases, borders and where more than two faces meet.
  std::vector<uint32_t> twin;
  /// For each face.
  std::vector<Vec3> normal;
  std::vector<Vec3> centre;
  std::vector<double> area;

  size_t face_count() const { return area.size(); }
  uint32_t vertex(uint32_t corner) const { return mesh->faces[corner / 4][corner % 4]; }
  const Vec3& point(uint32_t corner) const { return mesh->vertices[vertex(corner)]; }
  uint32_t next(uint32_t half_edge) const { return (half_edge & ~3u) | ((half_edge + 1) & 3u); }
  bool degenerate(uint32_t half_edge) const { return vertex(half_edge) == vertex(next(half_edge)); }
};

/// Face data and neighbours. Throws Error for bad indices and coordinates.
Surface build_surface(const Mesh& mesh);

/// Pieces of surface that turn little and never span a crease: for each face its patch.
/// `report` is called now and then and may throw to cancel.
std::vector<uint32_t> cut_patches(const Surface& surface, const Report& report);

/// The state that flattening and sewing work on. A chart is a set of faces connected through sewn
/// half-edges; corners that meet through sewn half-edges share their flat position.
struct Layout {
  std::vector<uint32_t> chart_of_face;
  /// Empty for charts that were sewn into a newer one.
  std::vector<std::vector<uint32_t>> faces;
  std::vector<char> sewn;
  std::vector<Vec2> flat;
};

/// One chart, prepared for flattening.
struct ChartMesh {
  std::vector<std::array<uint32_t, 3>> triangles;
  /// Each triangle's own shape in a plane: corner 0 at the origin, corner 1 at (x1, 0), corner 2.
  std::vector<std::array<double, 3>> shapes;
  /// Each triangle's corners before parts were sewn together: its first rotation comes from there,
  /// as seams whose sides do not match yet would fold the triangles beside them.
  std::vector<std::array<Vec2, 3>> parts;
  std::vector<Vec2> flat;
  /// For each corner of the listed faces, in order, its vertex.
  std::vector<uint32_t> vertex_of_corner;
};

ChartMesh build_chart(const Surface& surface, const Layout& layout,
                      const std::vector<uint32_t>& faces);
void store_chart(const ChartMesh& chart, const std::vector<uint32_t>& faces, Layout& layout);
/// Flat start for a patch: its projection along its mean normal.
void project(const Surface& surface, const std::vector<uint32_t>& faces, Layout& layout);
/// Moves the vertices of folded triangles so that nothing is folded, where a few moves can do it.
void untangle(ChartMesh& chart);
/// Smooths the chart where its boundary crosses itself in small loops, as slivers along creases
/// make them. Returns whether it found any and removed all.
bool remove_crossings(ChartMesh& chart);
/// Moves the chart's vertices so that its triangles keep their shapes as well as they can, and
/// scales it to its true area.
void relax(ChartMesh& chart, int iterations, const Report& report);

/// How well a chart lies flat, at its true scale.
struct Quality {
  int folded = 0;           // triangles with the wrong winding
  double stretch_high = 1;  // see Chart::stretch_max, here without 0.3 % of the area
  double stretch_mean = 1;
};
bool folds(const ChartMesh& chart, size_t triangle);
Quality measure(const ChartMesh& chart);
/// Fills all of `result` but its faces. chart.flat is in texels.
void describe(const ChartMesh& chart, double texels_per_unit, Chart& result);

/// Closed boundary curves of a chart in the plane, the chart on their left; half-edges in order.
std::vector<std::vector<uint32_t>> boundary_loops(const Surface& surface, const Layout& layout,
                                                  const std::vector<uint32_t>& faces);
/// A point just inside the boundary, with the direction out of the chart.
struct BoundarySample {
  Vec2 position;
  Vec2 outward;
  uint32_t loop;
  double arc;
  double loop_length;
};
std::vector<BoundarySample> sample_boundary(const Surface& surface, const Layout& layout,
                                            const std::vector<std::vector<uint32_t>>& loops,
                                            double gap);
/// Whether two samples that look at each other are nearer than `gap`, and not neighbours on a
/// curve.
bool too_close(const std::vector<BoundarySample>& samples, double gap);
struct Segment {
  Vec2 a, b;
};
/// The first few pairs of segments, by index, that cross at an inner point of both.
std::vector<std::array<size_t, 2>> crossings(const std::vector<Segment>& segments, size_t most);
/// Whether the chart's boundary is simple, keeps `gap` to itself and has one outer curve: with no
/// flipped triangle the chart then covers no point of the plane twice.
bool is_embedded(const Surface& surface, const Layout& layout, const std::vector<uint32_t>& faces,
                 double gap);

/// The parts of a chart on each side of the middle of its longer flat direction, each connected
/// through sewn half-edges.
std::vector<std::vector<uint32_t>> halve(const Surface& surface, const Layout& layout,
                                         const std::vector<uint32_t>& faces);
/// Stores a relaxed chart in the layout; false when it is folded or not embedded and that is not
/// to be mended. The layout then holds the chart as it was given or half mended.
bool store_embedded(const Surface& surface, const std::vector<uint32_t>& faces, double gap,
                    ChartMesh& chart, Layout& layout, const Report& report);
/// Flattens every patch, splitting those that do not flatten well.
Layout flatten_patches(const Surface& surface, const std::vector<uint32_t>& patch_of_face,
                       double gap, const Report& report);
/// Sews neighbouring charts while the result stays flat and apart from itself; down to
/// `target` charts it takes more stretch. gap: the gutter in scene units.
void sew_charts(const Surface& surface, Layout& layout, double gap, double thin_gap, size_t target,
                const Report& report);

/// Relaxes all charts once more, longer, where that helps.
void polish(const Surface& surface, Layout& layout, double gap, const Report& report);

/// Halves the charts larger than half of the largest one, as long as there are no more than `limit`
/// charts. Returns the number of charts, or 0 when nothing could be halved.
size_t halve_largest(const Surface& surface, Layout& layout, size_t limit, const Report& report);

/// Where one chart lies: texel = scale * rotate(flat) + offset.
struct Placement {
  double cosine = 1;
  double sine = 0;
  Vec2 offset{0, 0};
};
struct Packing {
  double scale = 0;  // 0: nothing fits
  std::vector<Placement> placements;
};
/// charts: for each chart its triangles in the plane, three points after another.
Packing pack(const std::vector<std::vector<Vec2>>& charts, int size, int gutter,
             const Report& report);

}  // namespace sardf::atlas

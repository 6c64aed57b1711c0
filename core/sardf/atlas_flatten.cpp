// The atlas's third stage: flattens charts as rigidly as possible (Liu, Zhang, Xu, Gotsman, Gortler
// 2008, "A local/global approach to mesh parameterization"): in turn every triangle finds the
// rotation that fits it best, and one sparse system moves the vertices so that the triangles keep
// their shapes. Starting without folds and nearly flat it ends with little stretch.
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "sardf/atlas_stages.hpp"

namespace sardf::atlas {
namespace {

uint32_t find_root(std::vector<uint32_t>& parent, uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

/// For each corner of `faces` its vertex, numbered from 0 in order of appearance.
uint32_t number_vertices(const Surface& surface, const Layout& layout,
                         const std::vector<uint32_t>& faces, std::vector<uint32_t>& numbers) {
  const auto corner_count = static_cast<uint32_t>(4 * faces.size());
  std::vector<uint32_t> parent(corner_count);
  std::iota(parent.begin(), parent.end(), 0u);
  const auto join = [&](uint32_t a, uint32_t b) {
    a = find_root(parent, a);
    b = find_root(parent, b);
    parent[std::max(a, b)] = std::min(a, b);
  };
  const auto local = [&](uint32_t corner) {
    const auto at = std::lower_bound(faces.begin(), faces.end(), corner / 4);
    return static_cast<uint32_t>(4 * (at - faces.begin())) + corner % 4;
  };
  for (uint32_t i = 0; i < corner_count; ++i) {
    const uint32_t h = 4 * faces[i / 4] + i % 4;
    const uint32_t after = (i & ~3u) | ((i + 1) & 3u);
    if (surface.degenerate(h)) {
      join(i, after);
    } else if (layout.sewn[h] && surface.twin[h] > h) {
      const uint32_t other = local(surface.twin[h]);
      join(i, (other & ~3u) | ((other + 1) & 3u));
      join(after, other);
    }
  }
  numbers.assign(corner_count, none);
  uint32_t count = 0;
  for (uint32_t i = 0; i < corner_count; ++i) {
    const uint32_t root = find_root(parent, i);
    numbers[i] = root == i ? count++ : numbers[root];
  }
  return count;
}

std::array<double, 3> shape_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a;
  const double x1 = norm(ab);
  if (x1 == 0) return {1e-12, 0, 1e-12};
  const double x2 = dot(ab, ac) / x1;
  const double y2 = norm(cross(ab, ac)) / x1;
  // A sliver is fattened: its cotangents would drown those of its neighbours.
  return {x1, x2, std::max(y2, 0.02 * std::max(x1, std::abs(x2)))};
}

struct Corners {
  std::array<Vec2, 3> point;
  std::array<double, 3> cotangent;  // at each corner
};

Corners corners_of(const std::array<double, 3>& shape) {
  const auto [x1, x2, y2] = shape;
  const double x3 = x1 - x2;
  return {{{{0, 0}, {x1, 0}, {x2, y2}}}, {x2 / y2, x3 / y2, (y2 * y2 - x2 * x3) / (x1 * y2)}};
}

using Matrix = Eigen::SparseMatrix<double>;

Matrix stiffness(const ChartMesh& chart) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(12 * chart.triangles.size());
  for (size_t t = 0; t < chart.triangles.size(); ++t) {
    const Corners corners = corners_of(chart.shapes[t]);
    for (size_t k = 0; k < 3; ++k) {
      const auto i = static_cast<int>(chart.triangles[t][(k + 1) % 3]);
      const auto j = static_cast<int>(chart.triangles[t][(k + 2) % 3]);
      const double c = corners.cotangent[k];
      entries.emplace_back(i, i, c);
      entries.emplace_back(j, j, c);
      entries.emplace_back(std::max(i, j), std::min(i, j), -c);
    }
  }
  entries.emplace_back(0, 0, 1.0);  // holds vertex 0: only rotations and a shift would be free
  const auto count = static_cast<Eigen::Index>(chart.flat.size());
  Matrix matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// The sum over triangles of cotangent * (best rotation) * (edge of the triangle's own shape).
Eigen::MatrixX2d rotated_edges(const ChartMesh& chart, bool from_parts) {
  Eigen::MatrixX2d sum = Eigen::MatrixX2d::Zero(static_cast<Eigen::Index>(chart.flat.size()), 2);
  for (size_t t = 0; t < chart.triangles.size(); ++t) {
    const Corners corners = corners_of(chart.shapes[t]);
    double along = 0, across = 0;
    for (size_t k = 0; k < 3; ++k) {
      const size_t i = (k + 1) % 3, j = (k + 2) % 3;
      const Vec2& u = from_parts ? chart.parts[t][i] : chart.flat[chart.triangles[t][i]];
      const Vec2& v = from_parts ? chart.parts[t][j] : chart.flat[chart.triangles[t][j]];
      const double ux = u[0] - v[0], uy = u[1] - v[1];
      const double px = corners.point[i][0] - corners.point[j][0];
      const double py = corners.point[i][1] - corners.point[j][1];
      along += corners.cotangent[k] * (ux * px + uy * py);
      across += corners.cotangent[k] * (uy * px - ux * py);
    }
    const double length = std::hypot(along, across);
    const double cosine = length > 0 ? along / length : 1, sine = length > 0 ? across / length : 0;
    for (size_t k = 0; k < 3; ++k) {
      const size_t i = (k + 1) % 3, j = (k + 2) % 3;
      const double px = corners.cotangent[k] * (corners.point[i][0] - corners.point[j][0]);
      const double py = corners.cotangent[k] * (corners.point[i][1] - corners.point[j][1]);
      const Eigen::RowVector2d edge(cosine * px - sine * py, sine * px + cosine * py);
      sum.row(chart.triangles[t][i]) += edge;
      sum.row(chart.triangles[t][j]) -= edge;
    }
  }
  return sum;
}

void scale_to_true_area(ChartMesh& chart) {
  double flat = 0, real = 0;
  for (size_t t = 0; t < chart.triangles.size(); ++t) {
    const auto& [a, b, c] = chart.triangles[t];
    const Vec2 &p = chart.flat[a], &q = chart.flat[b], &r = chart.flat[c];
    flat += 0.5 * ((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]));
    real += 0.5 * chart.shapes[t][0] * chart.shapes[t][2];
  }
  if (!(flat > 0)) return;
  const double scale = std::sqrt(real / flat);
  for (Vec2& p : chart.flat) p = {scale * p[0], scale * p[1]};
}

bool is_slightly_folded(const ChartMesh& chart) {
  size_t folded = 0;
  for (size_t t = 0; t < chart.triangles.size(); ++t) folded += folds(chart, t);
  return folded > 0 && (folded < 4 || 50 * folded < chart.triangles.size());
}

}  // namespace

ChartMesh build_chart(const Surface& surface, const Layout& layout,
                      const std::vector<uint32_t>& faces) {
  ChartMesh chart;
  const uint32_t count = number_vertices(surface, layout, faces, chart.vertex_of_corner);
  std::vector<double> shares(count, 0);
  chart.flat.assign(count, {0, 0});
  for (size_t i = 0; i < chart.vertex_of_corner.size(); ++i) {
    const uint32_t v = chart.vertex_of_corner[i];
    const Vec2& at = layout.flat[4 * faces[i / 4] + i % 4];
    chart.flat[v] = {chart.flat[v][0] + at[0], chart.flat[v][1] + at[1]};
    ++shares[v];
  }
  for (uint32_t v = 0; v < count; ++v)
    chart.flat[v] = {chart.flat[v][0] / shares[v], chart.flat[v][1] / shares[v]};
  for (size_t f = 0; f < faces.size(); ++f) {
    const uint32_t* v = &chart.vertex_of_corner[4 * f];
    const uint32_t h = 4 * faces[f];
    for (uint32_t k = 1; k < 3; ++k) {
      if (v[0] == v[k] || v[k] == v[k + 1] || v[0] == v[k + 1]) continue;
      chart.triangles.push_back({v[0], v[k], v[k + 1]});
      chart.parts.push_back({layout.flat[h], layout.flat[h + k], layout.flat[h + k + 1]});
      chart.shapes.push_back(
          shape_of(surface.point(h), surface.point(h + k), surface.point(h + k + 1)));
    }
  }
  return chart;
}

void store_chart(const ChartMesh& chart, const std::vector<uint32_t>& faces, Layout& layout) {
  for (size_t i = 0; i < chart.vertex_of_corner.size(); ++i)
    layout.flat[4 * faces[i / 4] + i % 4] = chart.flat[chart.vertex_of_corner[i]];
}

void project(const Surface& surface, const std::vector<uint32_t>& faces, Layout& layout) {
  Vec3 normal{0, 0, 0};
  for (const uint32_t f : faces) normal = normal + surface.area[f] * surface.normal[f];
  normal = norm(normal) > 0 ? normalized(normal) : surface.normal[faces[0]];
  const size_t least = std::abs(normal[0]) < 0.6 ? 0 : std::abs(normal[1]) < 0.6 ? 1 : 2;
  Vec3 axis{0, 0, 0};
  axis[least] = 1;
  const Vec3 right = normalized(cross(axis, normal)), up = cross(normal, right);
  const Vec3 origin = surface.centre[faces[0]];
  for (const uint32_t f : faces)
    for (uint32_t c = 4 * f; c < 4 * f + 4; ++c) {
      const Vec3 way = surface.point(c) - origin;
      layout.flat[c] = {dot(way, right), dot(way, up)};
    }
}

void relax(ChartMesh& chart, int iterations, const Report& report) {
  if (chart.triangles.empty()) return;
  if (iterations > 0) {
    const Eigen::SimplicialLDLT<Matrix> solver(stiffness(chart));
    const Vec2 held = chart.flat[0];
    for (int i = 0; solver.info() == Eigen::Success; ++i) {
      report();
      Eigen::MatrixX2d target = rotated_edges(chart, i == 0);
      target.row(0) += Eigen::RowVector2d(held[0], held[1]);
      const Eigen::MatrixX2d moved = solver.solve(target);
      if (!moved.allFinite()) break;
      for (size_t v = 0; v < chart.flat.size(); ++v) {
        const auto row = static_cast<Eigen::Index>(v);
        chart.flat[v] = {moved(row, 0), moved(row, 1)};
      }
      // A few folded triangles beside a seam often need a few rounds more.
      if (i + 1 >= iterations && (i + 1 >= 2 * iterations || !is_slightly_folded(chart))) break;
    }
  }
  if (is_slightly_folded(chart)) untangle(chart);
  scale_to_true_area(chart);
}

}  // namespace sardf::atlas

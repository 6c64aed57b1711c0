// Vertices of smooth pieces: the middle of the piece's crossings, moved onto the surface.
#include <algorithm>
#include <cmath>

#include "sardf/mesher_stages.hpp"

namespace sardf::mesher {

namespace {

// Normals of one piece that differ more than this may mean an edge: cos(15 degrees).
constexpr double smooth_cosine = 0.9659;

bool is_smooth(const Net& net, const CrossingPoints& crossings, uint32_t vertex) {
  const uint32_t begin = net.first_use[vertex], end = net.first_use[vertex + 1];
  for (uint32_t i = begin; i < end; ++i) {
    const Vec3& a = crossings.normal[net.uses[i] / 4];
    if (!(dot(a, a) > 0.5)) return false;
    for (uint32_t j = begin; j < i; ++j) {
      if (dot(a, crossings.normal[net.uses[j] / 4]) < smooth_cosine) return false;
    }
  }
  return true;
}

template <class T>
void move_once(const Field& field, const Net& net, const uint32_t* numbers, size_t n, Vec3* at,
               Vec3* gradients) {
  Points<T> points;
  for (size_t i = 0; i < n; ++i) points.set(i, at[i]);
  field.differentiate(points, n);
  for (size_t i = 0; i < n; ++i) {
    gradients[i] = points.gradient_at(i);
    at[i] =
        clamped(at[i] + newton_step(double(points.value[i]), gradients[i]), net.room[numbers[i]]);
  }
}

// Moves n vertices onto the surface: two steps with fresh gradients, the last one with a value in
// double precision. marks the vertices for which that was not enough.
void move_vertices(const Field& field, const Grid& grid, const Net& net, const uint32_t* numbers,
                   size_t n, Vertices& vertices, uint8_t* sharp) {
  std::array<Vec3, Evaluator::block_size> at, gradients;
  for (size_t i = 0; i < n; ++i) at[i] = vertices.at[numbers[i]];
  const auto move = grid.single ? &move_once<float> : &move_once<double>;
  move(field, net, numbers, n, at.data(), gradients.data());
  move(field, net, numbers, n, at.data(), gradients.data());
  Points<double> points;
  for (size_t i = 0; i < n; ++i) points.set(i, at[i]);
  field.evaluate(points, n);
  for (size_t i = 0; i < n; ++i) {
    const uint32_t v = numbers[i];
    const Vec3 wanted = at[i] + newton_step(points.value[i], gradients[i]);
    vertices.at[v] = clamped(wanted, net.room[v]);
    vertices.normal[v] = outward_normal(gradients[i]);
    const bool found = norm(wanted - at[i]) < 2e-3 * grid.cell &&
                       norm(wanted - vertices.at[v]) < 1e-3 * grid.cell &&
                       dot(vertices.normal[v], vertices.normal[v]) > 0.5;
    sharp[i] = !found;
  }
}

}  // namespace

Vec3 clamped(const Vec3& point, const BoundingBox& room) {
  Vec3 result;
  for (int axis = 0; axis < 3; ++axis) {
    result[axis] = std::clamp(point[axis], room.lo[axis], room.hi[axis]);
  }
  return result;
}

Vertices place_vertices(const Field& field, const Grid& grid, const Net& net,
                        const CrossingPoints& crossings, Work& work) {
  const size_t count = net.vertex_count();
  Vertices vertices;
  vertices.at.resize(count);
  vertices.normal.resize(count);
  std::vector<uint8_t> sharp(count);
  work.run(count, Evaluator::block_size, [&](size_t first, size_t last) {
    std::array<uint32_t, Evaluator::block_size> smooth;
    std::array<uint8_t, Evaluator::block_size> failed;
    size_t n = 0;
    for (uint32_t v = uint32_t(first); v < last; ++v) {
      const uint32_t begin = net.first_use[v], end = net.first_use[v + 1];
      Vec3 sum{};
      for (uint32_t i = begin; i < end; ++i) sum = sum + crossings.at[net.uses[i] / 4];
      vertices.at[v] = clamped((1.0 / (end - begin)) * sum, net.room[v]);
      sharp[v] = !is_smooth(net, crossings, v);
      if (!sharp[v]) smooth[n++] = v;
    }
    if (n > 0) move_vertices(field, grid, net, smooth.data(), n, vertices, failed.data());
    for (size_t i = 0; i < n; ++i) sharp[smooth[i]] = failed[i];
  });
  for (uint32_t v = 0; v < count; ++v) {
    if (sharp[v]) vertices.sharp.push_back(v);
  }
  return vertices;
}

}  // namespace sardf::mesher

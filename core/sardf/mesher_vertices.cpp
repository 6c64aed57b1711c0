// Faces, and vertices of smooth pieces: the middle of the piece's crossings, moved onto the
// surface.
#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "sardf/mesher_blocks.hpp"

namespace sardf::mesher {

namespace {

// Normals of one piece that differ more than this may mean an edge: cos(15 degrees).
constexpr float smooth_cosine = 0.9659f;
// After a longer step, in cells, the gradient is taken again: it would no longer be the vertex's.
constexpr double short_step = 0.01;

// The crossings around the vertex of one piece.
struct Around {
  Vec3 sum{};  // of the crossings, in cells from corner 0
  std::array<const Crossing*, 12> crossings;
  int count = 0;

  void add(const Crossing& crossing, const EdgeOfCell& edge) {
    sum[size_t(edge.axis)] += double(crossing.at);
    sum[size_t(edge.e)] += edge.side_e;
    sum[size_t(edge.g)] += edge.side_g;
    crossings[size_t(count++)] = &crossing;
  }

  bool is_smooth() const {
    const auto dot3 = [](const std::array<float, 3>& a, const std::array<float, 3>& b) {
      return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    };
    for (int i = 0; i < count; ++i) {
      const auto& a = crossings[size_t(i)]->normal;
      if (!(dot3(a, a) > 0.5f)) return false;
      for (int j = 0; j < i; ++j) {
        if (dot3(a, crossings[size_t(j)]->normal) < smooth_cosine) return false;
      }
    }
    return true;
  }
};

// The smooth vertices of one block, some at a time.
class SmoothVertices {
 public:
  SmoothVertices(const Field& field, const Grid& grid, const Cells& cells, const Net& net,
                 Vertices& vertices)
      : field_(field), grid_(grid), cells_(cells), net_(net), vertices_(vertices) {}

  void begin(const Index3& block) {
    move();
    local_ = field_.local(block, block_level);
    in_parts_ = local_.program->tape().instructions().size() > long_program;
  }

  void add(uint32_t vertex) {
    if (count_ == numbers_.size()) move();
    numbers_[count_++] = vertex;
  }

  // Moves them onto the surface: one step, or two where the first was long, and a last one with a
  // value in double precision. Those for which that is not enough are sharp.
  void move() {
    if (count_ == 0) return;
    std::iota(open_.begin(), open_.begin() + count_, uint16_t(0));
    size_t open = count_;
    for (int step = 0; step < 2 && open > 0; ++step) {
      open = grid_.single ? move_once<float>(open) : move_once<double>(open);
    }
    Points<double> points;
    for (size_t i = 0; i < count_; ++i) points.set(i, vertices_.at[numbers_[i]]);
    evaluate(points, count_);
    for (size_t i = 0; i < count_; ++i) finish(numbers_[i], points.value[i], gradients_[i]);
    count_ = 0;
  }

 private:
  BoundingBox room(uint32_t v) const {
    return room_of(grid_, cells_.at[net_.cell[v]], net_.sides[v]);
  }

  // Moves the open ones; the number of those, now first, whose step was long.
  template <class T>
  size_t move_once(size_t open) {
    Points<T> points;
    for (size_t k = 0; k < open; ++k) points.set(k, vertices_.at[numbers_[open_[k]]]);
    differentiate(points, open);
    size_t left = 0;
    for (size_t k = 0; k < open; ++k) {
      const uint16_t i = open_[k];
      gradients_[i] = points.gradient_at(k);
      const Vec3 step = newton_step(double(points.value[k]), gradients_[i]);
      Vec3& at = vertices_.at[numbers_[i]];
      at = clamped(at + step, room(numbers_[i]));
      const double longest = short_step * grid_.cell;
      if (dot(step, step) > longest * longest) open_[left++] = i;
    }
    return left;
  }

  void finish(uint32_t v, double value, const Vec3& gradient) {
    Vec3& at = vertices_.at[v];
    const Vec3 step = newton_step(value, gradient), wanted = at + step;
    const Vec3 placed = clamped(wanted, room(v)), beyond = wanted - placed;
    vertices_.normal[v] = outward_normal(gradient);
    const double cell = grid_.cell;
    const bool found = dot(step, step) < 4e-6 * cell * cell &&
                       dot(beyond, beyond) < 1e-6 * cell * cell &&
                       dot(vertices_.normal[v], vertices_.normal[v]) > 0.5;
    at = placed;
    vertices_.is_sharp[v] = !found;
  }

  template <class T>
  void differentiate(Points<T>& points, size_t n) const {
    in_parts_ ? field_.differentiate(points, n) : field_.differentiate(local_, points, n);
  }
  void evaluate(Points<double>& points, size_t n) const {
    in_parts_ ? field_.evaluate(points, n) : field_.evaluate(local_, points, n);
  }

  const Field& field_;
  const Grid& grid_;
  const Cells& cells_;
  const Net& net_;
  Vertices& vertices_;
  Field::Local local_{};
  bool in_parts_ = false;  // the parts of the block have shorter programs
  size_t count_ = 0;
  std::array<uint32_t, Evaluator::block_size> numbers_;
  std::array<uint16_t, Evaluator::block_size> open_;
  std::array<Vec3, Evaluator::block_size> gradients_;
};

// Makes the corners of faces that lie in the cell and places its vertices.
void place_in_cell(const Grid& grid, const Cells& cells, Net& net, uint32_t cell, CellFinder& find,
                   Vertices& vertices, SmoothVertices& smooth) {
  const uint8_t inside = cells.inside[cell];
  const Pieces pieces = pieces_of(inside, cells.joined[cell]);
  std::array<Around, 4> around;
  for (int left = crossed_edges(inside); left != 0; left &= left - 1) {
    const size_t k = size_t(std::countr_zero(unsigned(left)));
    const EdgeOfCell& edge = edges_of_cell[k];
    const uint32_t c = crossing_of(cells, cell, edge, find);
    const Crossing& crossing = cells.crossings[c];
    const size_t piece = size_t(pieces.of_edge[k]);
    const int corner = crossing.leaves ? edge.face_corner : 3 - edge.face_corner;
    net.faces[c][size_t(corner)] = net.first_vertex[cell] + uint32_t(piece);
    around[piece].add(crossing, edge);
  }
  const Vec3 lo = grid.point(cells.at[cell]);
  for (int piece = 0; piece < pieces.count; ++piece) {
    const uint32_t v = net.first_vertex[cell] + uint32_t(piece);
    const Around& all = around[size_t(piece)];
    vertices.at[v] = clamped(lo + (grid.cell / all.count) * all.sum,
                             room_of(grid, cells.at[cell], net.sides[v]));
    vertices.is_sharp[v] = !all.is_smooth();
    if (!vertices.is_sharp[v]) smooth.add(v);
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

Vertices place_vertices(const Field& field, const Grid& grid, const Cells& cells, Net& net,
                        Work& work) {
  const size_t count = net.vertex_count();
  Vertices vertices;
  resize_large(vertices.at, count);
  vertices.normal.resize(count);
  vertices.is_sharp.resize(count);
  resize_large(net.faces, cells.crossings.size());
  work.run(cells.blocks.size(), 4, [&](size_t first, size_t last) {
    CellFinder find(cells);
    SmoothVertices smooth(field, grid, cells, net, vertices);
    for (size_t b = first; b < last; ++b) {
      const Cells::Block& block = cells.blocks[b];
      smooth.begin(block.place);
      const uint32_t end =
          b + 1 < cells.blocks.size() ? cells.blocks[b + 1].first[0] : uint32_t(cells.at.size());
      for (uint32_t i = block.first[0]; i < end; ++i) {
        place_in_cell(grid, cells, net, i, find, vertices, smooth);
      }
    }
    smooth.move();
  });
  for (uint32_t v = 0; v < count; ++v) {
    if (vertices.is_sharp[v]) vertices.sharp.push_back(v);
  }
  return vertices;
}

}  // namespace sardf::mesher
